/* cannon-mpi.c - C = A B by Cannon's algorithm: Q x Q ranks, whose blocks of A move to the left and
 * whose blocks of B move up by one place a step (Cannon 1969). */
#include <mpi.h>
#include <stdlib.h>

/* Q x Q ranks with blocks of M x M numbers, N rows in all. */
enum { Q = @q@, P = Q * Q, M = @m@, N = M * Q };

static double a_at(int i, int j) { return (i * 3 + j * 5) % 17 - 8; }
static double b_at(int i, int j) { return (i * 7 + j * 2) % 13 - 6; }

/* The M x M numbers of a matrix from its row i0 and its column j0 on. */
static void fill(double *x, int i0, int j0, double (*at)(int, int))
{
    for (int i = 0; i < M; i++)
        for (int j = 0; j < M; j++) x[i * M + j] = at(i0 + i, j0 + j);
}

/* z += x y. */
static void multiply(const double *x, const double *y, double *z)
{
    for (int i = 0; i < M; i++)
        for (int l = 0; l < M; l++)
            for (int j = 0; j < M; j++) z[i * M + j] += x[i * M + l] * y[l * M + j];
}

/* Whether the block at (i0, j0) of the product is right: whole numbers, so exactly. */
static int is_right(const double *z, int i0, int j0)
{
    for (int i = 0; i < M; i++)
        for (int j = 0; j < M; j++) {
            double sum = 0;
            for (int l = 0; l < N; l++) sum += a_at(i0 + i, l) * b_at(l, j0 + j);
            if (z[i * M + j] != sum) return 0;
        }
    return 1;
}

int main(int argc, char **argv)
{
    static double a[M * M], b[M * M], product[M * M];
    int me, p;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (p != P) MPI_Abort(MPI_COMM_WORLD, 2);
    const int row = me / Q, column = me % Q;
    /* Cannon's first step, in which row i is turned by i places and column j by j, is left out:
     * each rank makes the blocks that it would then have. */
    fill(a, row * M, (row + column) % Q * M, a_at);
    fill(b, (row + column) % Q * M, column * M, b_at);
    for (int step = 0; step < Q; step++) {
        multiply(a, b, product);
        if (step == Q - 1) break;
        /* Everybody begins a step at the same time. */
        MPI_Barrier(MPI_COMM_WORLD);
        /* GAP: send a (M * M numbers, tag 0) to the rank on the left and receive the one from the
         * right into a; then send b (tag 1) to the rank above and receive the one from below into
         * b. Rank `row * Q + column` is in that row and column; the grid is closed to a torus: left
         * of column 0 is column Q - 1. MPI_Sendrecv_replace does both at once. */
    }
    MPI_Finalize();
    return is_right(product, row * M, column * M) ? EXIT_SUCCESS : EXIT_FAILURE;
}
