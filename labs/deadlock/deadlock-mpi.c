/* deadlock-mpi.c - each rank sends its number to the next one of a ring, by synchronous sends. */
#include <mpi.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    const int next = (me + 1) % p, last = (me + p - 1) % p;
    double own = me, got = -1;
    /* GAP: all ranks send first, and nobody receives. Change the order. */
    MPI_Ssend(&own, 1, MPI_DOUBLE, next, 0, MPI_COMM_WORLD);
    MPI_Recv(&got, 1, MPI_DOUBLE, last, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    /* End of the gap. */
    MPI_Finalize();
    /* Every rank must have the number of the one before it. */
    return got == last ? EXIT_SUCCESS : EXIT_FAILURE;
}
