/* matrix-multiply-mpi.c - C = A B for square matrices, in strips of rows (1-D) or in square blocks
 * (2-D): the word "rows" or "blocks" is the program's argument. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#ifdef __MIMDSIM__
#include <mimdsim/compute.h>
#else
#define mimdsim_compute(flops, bytes) ((void)0)
#endif

/* P = Q x Q ranks, STRIP rows for each of them, N rows in all; a square block has M rows. */
enum { P = @P@, Q = @q@, STRIP = @strip@, N = STRIP * P, M = N / Q, NUMBERS = M * M };

static double a_at(int i, int j) { return (i * 3 + j * 5) % 17 - 8; }
static double b_at(int i, int j) { return (i * 7 + j * 2) % 13 - 6; }

/* The part of a matrix with its upper left corner at (i0, j0), m rows of w numbers. */
static void fill(double *x, int i0, int m, int j0, int w, double (*at)(int, int))
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < w; j++) x[i * w + j] = at(i0 + i, j0 + j);
}

/* z (m x w) += x (m x k) y (k x w); rows of x are `skip` apart. 2 m k w operations: mimdsim_compute
 * states what they cost; on a real machine it does nothing. */
static void multiply(int m, int k, int w, const double *x, int skip, const double *y, double *z)
{
    for (int i = 0; i < m; i++)
        for (int l = 0; l < k; l++)
            for (int j = 0; j < w; j++) z[i * w + j] += x[i * skip + l] * y[l * w + j];
    mimdsim_compute(2.0 * m * k * w, 0);
}

/* Whether the part at (i0, j0) of the product is right: whole numbers, so exactly. */
static int is_right(const double *z, int i0, int m, int j0, int w)
{
    for (int i = 0; i < m; i++)
        for (int j = 0; j < w; j++) {
            double sum = 0;
            for (int l = 0; l < N; l++) sum += a_at(i0 + i, l) * b_at(l, j0 + j);
            if (z[i * w + j] != sum) return 0;
        }
    return 1;
}

/* 1-D: every rank has a strip of A, of B and of C. The strips of B go once round the ring of ranks. */
static int rows(int me)
{
    static double a[STRIP * N], b[STRIP * N], next[STRIP * N], product[STRIP * N];
    fill(a, me * STRIP, STRIP, 0, N, a_at);
    fill(b, me * STRIP, STRIP, 0, N, b_at);
    for (int step = 0; step < P; step++) {
        multiply(STRIP, STRIP, N, a + (me + step) % P * STRIP, N, b, product);
        if (step == P - 1) break;
        MPI_Sendrecv(b, STRIP * N, MPI_DOUBLE, (me + P - 1) % P, step, next, STRIP * N, MPI_DOUBLE,
                     (me + 1) % P, step, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        memcpy(b, next, sizeof b);
    }
    return is_right(product, me * STRIP, STRIP, 0, N);
}

/* The blocks of all Q ranks of a row or of a column of the grid, in all[0] to all[(Q - 1) *
 * NUMBERS]: the own one is in its place `mine`, and every rank sends Q - 1 blocks to the rank `next`
 * and receives as many from the rank `last`. */
static void collect(double *all, int mine, int next, int last)
{
    for (int step = 0; step < Q - 1; step++) {
        (void)all, (void)mine, (void)next, (void)last;
        /* GAP: send the block that came last (in the first step the own one) to `next`, and
         * receive the one before it from `last`, by MPI_Sendrecv. In step 0 that is block number
         * mine - 1, in step 1 number mine - 2, ...; before number 0 comes number Q - 1. */
    }
}

/* 2-D: a grid of Q x Q ranks, each with a square block of A, of B and of C. It needs all blocks of A
 * in its row of the grid, and all blocks of B in its column. */
static int blocks(int me)
{
    static double a[Q * NUMBERS], b[Q * NUMBERS], product[NUMBERS];
    const int row = me / Q, column = me % Q;
    fill(a + column * NUMBERS, row * M, M, column * M, M, a_at);
    fill(b + row * NUMBERS, row * M, M, column * M, M, b_at);
    collect(a, column, row * Q + (column + 1) % Q, row * Q + (column + Q - 1) % Q);
    collect(b, row, (row + 1) % Q * Q + column, (row + Q - 1) % Q * Q + column);
    for (int l = 0; l < Q; l++) multiply(M, M, M, a + l * NUMBERS, M, b + l * NUMBERS, product);
    return is_right(product, row * M, M, column * M, M);
}

int main(int argc, char **argv)
{
    int me, p, right;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (p != P) MPI_Abort(MPI_COMM_WORLD, 2);
    right = argc > 1 && strcmp(argv[1], "rows") == 0 ? rows(me) : blocks(me);
    MPI_Finalize();
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
