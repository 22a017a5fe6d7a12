/* prefix-sum-mpi.c - the sum of the numbers of all ranks up to the own one, by recursive doubling. */
#include <mpi.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    double sum = me + 1;
    for (int d = 1; d < p; d *= 2) {
        /* GAP: send the sum to the rank d above (if there is one, with tag d), receive the sum of
         * the rank d below (if there is one), and add it. A message of 8 bytes is buffered:
         * MPI_Send does not wait for its receiver. */
    }
    MPI_Finalize();
    /* 1 + 2 + ... + me + 1. */
    return sum == (me + 1) * (me + 2) / 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
