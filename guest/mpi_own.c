/* mpi_own.c - the functions of MPI that need no simulator: handles as integers, sums of addresses.
 */
#include "mpi_guest.h"

#define HANDLE(type, name, argument)                                                               \
    MPI_##type PMPI_##name##_fromint(int argument) { return (MPI_##type)(intptr_t)argument; }      \
    int PMPI_##name##_toint(MPI_##type argument) { return (int)(intptr_t)argument; }               \
    MPI_##type MPI_##name##_fromint(int) __attribute__((weak, alias("PMPI_" #name "_fromint")));   \
    int MPI_##name##_toint(MPI_##type) __attribute__((weak, alias("PMPI_" #name "_toint")));
HANDLE(Comm, Comm, comm)
HANDLE(Errhandler, Errhandler, errhandler)
HANDLE(File, File, file)
HANDLE(Group, Group, group)
HANDLE(Info, Info, info)
HANDLE(Message, Message, message)
HANDLE(Op, Op, op)
HANDLE(Request, Request, request)
HANDLE(Session, Session, session)
HANDLE(Datatype, Type, datatype)
HANDLE(Win, Win, win)

MPI_Aint PMPI_Aint_add(MPI_Aint base, MPI_Aint disp) { return base + disp; }
MPI_Aint PMPI_Aint_diff(MPI_Aint addr1, MPI_Aint addr2) { return addr1 - addr2; }
MPI_Aint MPI_Aint_add(MPI_Aint, MPI_Aint) __attribute__((weak, alias("PMPI_Aint_add")));
MPI_Aint MPI_Aint_diff(MPI_Aint, MPI_Aint) __attribute__((weak, alias("PMPI_Aint_diff")));
