/* matrix-multiply.c - C = A B for square matrices, in strips of rows (1-D) or in square blocks (2-D). */
#include <mimdsim/program.h>
#include <string.h>

enum { ROWS, BLOCKS };

static int64_t strip = 4; /* rows of a strip: the matrices have n = strip * ranks rows and columns */
static int method = BLOCKS;

static double a_at(int64_t i, int64_t j) { return (double)((i * 3 + j * 5) % 17) - 8; }
static double b_at(int64_t i, int64_t j) { return (double)((i * 7 + j * 2) % 13) - 6; }

/* The part of a matrix with its upper left corner at (i0, j0), m rows of w numbers. */
static void fill(double *x, int64_t i0, int64_t m, int64_t j0, int64_t w,
                 double (*at)(int64_t, int64_t))
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t j = 0; j < w; j++) x[i * w + j] = at(i0 + i, j0 + j);
}

/* z (m x w) += x (m x k) y (k x w); rows of x are `skip` apart. 2 m k w operations. */
static void multiply(struct comm *c, int64_t m, int64_t k, int64_t w, const double *x, int64_t skip,
                     const double *y, double *z)
{
    for (int64_t i = 0; i < m; i++)
        for (int64_t l = 0; l < k; l++)
            for (int64_t j = 0; j < w; j++) z[i * w + j] += x[i * skip + l] * y[l * w + j];
    comm_compute(c, 2.0 * (double)(m * k * w), 0);
}

/* 1-D: every rank has a strip of A, of B and of C. The strips of B go once round the ring of ranks. */
static void rows(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t n = strip * p, bytes = strip * n * 8;
    double *a = comm_memory(c, bytes), *b = comm_memory(c, bytes);
    double *next = comm_memory(c, bytes), *product = comm_memory(c, bytes);
    fill(a, me * strip, strip, 0, n, a_at);
    fill(b, me * strip, strip, 0, n, b_at);
    for (int step = 0; step < p; step++) {
        multiply(c, strip, strip, n, a + (me + step) % p * strip, n, b, product);
        if (step == p - 1) break;
        comm_send(c, (me + p - 1) % p, step, b, bytes);
        comm_recv(c, (me + 1) % p, step, next, bytes);
        memcpy(b, next, (size_t)bytes);
    }
    comm_publish(c, 0, me * strip * n, strip * n, product);
}

/* The blocks of all `q` ranks of a row or of a column of the grid, in all[0] to all[q - 1]: the own
 * one is in its place all[mine], and every rank sends q - 1 blocks to the rank `next` and receives
 * as many from the rank `last`. */
static void collect(struct comm *c, double *all, int64_t numbers, int mine, int q, int next,
                    int last)
{
    for (int step = 0; step < q - 1; step++) {
        (void)c, (void)all, (void)numbers, (void)mine, (void)next, (void)last;
        /* GAP: send the block that came last (in the first step the own one) to `next`, and
         * receive the one before it from `last`. In step 0 that is block number mine - 1, in step 1
         * number mine - 2, ...; before number 0 comes number q - 1. */
    }
}

/* 2-D: a grid of q x q ranks, each with a square block of A, of B and of C. It needs all blocks of A
 * in its row of the grid, and all blocks of B in its column. */
static void blocks(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    int q = 1;
    while (q * q < p) q++;
    if (q * q != p) comm_fail(c, "%d ranks: expected a square number", p);
    const int row = me / q, column = me % q;
    const int64_t n = strip * p, m = n / q, numbers = m * m;
    double *a = comm_memory(c, q * numbers * 8), *b = comm_memory(c, q * numbers * 8);
    double *product = comm_memory(c, numbers * 8);
    fill(a + column * numbers, row * m, m, column * m, m, a_at);
    fill(b + row * numbers, row * m, m, column * m, m, b_at);
    collect(c, a, numbers, column, q, row * q + (column + 1) % q, row * q + (column + q - 1) % q);
    collect(c, b, numbers, row, q, (row + 1) % q * q + column, (row + q - 1) % q * q + column);
    for (int l = 0; l < q; l++) multiply(c, m, m, m, a + l * numbers, m, b + l * numbers, product);
    for (int64_t i = 0; i < m; i++)
        comm_publish(c, 0, (row * m + i) * n + column * m, m, product + i * m);
}

static void run(struct comm *c)
{
    if (method == ROWS) rows(c);
    else blocks(c);
}

static void serial(struct comm *c)
{
    const int64_t n = strip * comm_run_size(c);
    double *a = comm_memory(c, n * n * 8), *b = comm_memory(c, n * n * 8);
    double *product = comm_memory(c, n * n * 8);
    fill(a, 0, n, 0, n, a_at);
    fill(b, 0, n, 0, n, b_at);
    multiply(c, n, n, n, a, n, b, product);
    comm_publish(c, 0, 0, n * n, product);
}

/* Computing costs what multiply() states: 2 operations for each product of two numbers. */
PROGRAM(.title = "matrix multiplication in strips or in square blocks",
        .parameter = {PROGRAM_WHOLE(strip, 1, 100, "rows of a strip"),
                      PROGRAM_CHOICE(method, "rows|blocks", "strips (1-D) or blocks (2-D)")},
        .output = {"product"}, .run = run, .serial = {{"three loops", serial}}, .tolerance = 1e-12,
        .cost = MIMDSIM_COST_AUTHOR);
