/* mpi_guest.h - how a program's MPI functions reach the simulator. */
#ifndef GUEST_MPI_GUEST_H
#define GUEST_MPI_GUEST_H

#include <limits.h>

#include <mimdsim/host.h>
#include <mimdsim/mpi_table.h>

#include "account.h"

/* What a call needs: the table and this rank's state. */
struct mpi_place {
    const struct mpi_functions *mpi;
    struct mpi_rank *rank;
    struct mimdsim_host *host;
};

/* The table is there for programs that were started as MPI programs, and of this version. */
static inline struct mpi_place mimdsim_mpi_place(const void *address)
{
    struct mimdsim_host *h = mimdsim_host;
    if (!h->mpi || (size_t)h->mpi->size != sizeof *h->mpi)
        h->runtime->fail(
            h, address,
            h->mpi ? "the program was built for another version of mimdsim: build it again"
                   : "the program calls MPI and was not started as an MPI program");
    return (struct mpi_place){h->mpi, h->mpi_rank, h};
}

#define ENTER(call, anytime)                                                                       \
    mimdsim_account();                                                                             \
    const struct mpi_place at = mimdsim_mpi_place(__builtin_return_address(0));                    \
    at.mpi->enter(at.rank, call, __builtin_return_address(0), anytime)

/* Ranks that share one variable mimdsim_host (the tests') find it set by another after a call. */
#ifdef MIMDSIM_SHARED_HOST
#define LEAVE() (mimdsim_host = at.host)
#else
#define LEAVE() (void)0
#endif

/* narrow: a count as int, as the standard has it for those that do not fit. */
static inline int narrow(MPI_Count n)
{
    return n > INT_MAX || n < INT_MIN ? MPI_UNDEFINED : (int)n;
}

/* mimdsim_mpi_refuse: the program calls a function that is not there; does not return. */
static inline int mimdsim_mpi_refuse(const char *call, const char *reason, const void *address)
{
    mimdsim_account();
    const struct mpi_place at = mimdsim_mpi_place(address);
    at.mpi->enter(at.rank, call, address, 1);
    at.mpi->refuse(at.rank, call, reason);
    return MPI_ERR_UNSUPPORTED_OPERATION;
}

#endif
