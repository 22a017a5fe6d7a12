/* halo.c - a grid of ranks that exchange their faces; each knows its neighbours by a function of
 * many arguments, so that the compiler keeps what it can in registers. */
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

int rank_at(int px, int py, int pz, int x, int y, int z)
{
    if (x < 0 || y < 0 || z < 0 || x >= px || y >= py || z >= pz) return MPI_PROC_NULL;
    return (z * py + y) * px + x;
}

int main(int argc, char **argv)
{
    int rank, ranks, bad = 0, all;
    int p[3] = {1, 1, 1};
    enum { FACE = 100 };
    double out[6][FACE], in[6][FACE];
    MPI_Request q[12];
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    for (int d = 0; d < 3 && d + 1 < argc; d++) p[d] = atoi(argv[d + 1]);
    int x = rank % p[0], y = rank / p[0] % p[1], z = rank / p[0] / p[1];
    const int left = rank_at(p[0], p[1], p[2], x - 1, y, z),
              right = rank_at(p[0], p[1], p[2], x + 1, y, z);
    const int front = rank_at(p[0], p[1], p[2], x, y - 1, z),
              back = rank_at(p[0], p[1], p[2], x, y + 1, z);
    const int below = rank_at(p[0], p[1], p[2], x, y, z - 1),
              above = rank_at(p[0], p[1], p[2], x, y, z + 1);
    const int neighbour[6] = {left, right, front, back, below, above};
    for (int step = 0; step < 10; step++) {
        for (int k = 0; k < 6; k++) {
            for (int i = 0; i < FACE; i++) {
                out[k][i] = sqrt((double)(rank + 1) * (i + step));
                in[k][i] = -1;
            }
            MPI_Irecv(in[k], FACE, MPI_DOUBLE, neighbour[k], k ^ 1, MPI_COMM_WORLD, &q[k]);
            MPI_Isend(out[k], FACE, MPI_DOUBLE, neighbour[k], k, MPI_COMM_WORLD, &q[6 + k]);
        }
        MPI_Waitall(12, q, MPI_STATUSES_IGNORE);
        for (int k = 0; k < 6; k++)
            for (int i = 0; i < FACE && neighbour[k] != MPI_PROC_NULL; i++)
                bad += in[k][i] != sqrt((double)(neighbour[k] + 1) * (i + step));
    }
    MPI_Reduce(&bad, &all, 1, MPI_INT, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0) printf("halo %d x %d x %d is %s\n", p[0], p[1], p[2], all ? "wrong" : "right");
    MPI_Finalize();
    return 0;
}
