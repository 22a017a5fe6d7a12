/* ring-mpi.c - a token goes once round a ring of ranks; every rank adds one to it. */
#include <mpi.h>
#include <stdlib.h>

enum { BYTES = @b@ };

int main(int argc, char **argv)
{
    static double token[BYTES / sizeof(double)];
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (me == 0) {
        token[0] = 1;
        MPI_Send(token, BYTES, MPI_BYTE, 1, 0, MPI_COMM_WORLD);
        MPI_Recv(token, BYTES, MPI_BYTE, p - 1, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
        /* GAP: receive the token from the rank before, add one to token[0], and send it to the
         * rank behind. Behind the last rank comes rank 0. */
    }
    MPI_Finalize();
    /* Every rank must have added its one. */
    return token[0] == (me == 0 ? p : me + 1) ? EXIT_SUCCESS : EXIT_FAILURE;
}
