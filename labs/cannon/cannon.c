/* cannon.c - C = A B by Cannon's algorithm: q x q ranks, whose blocks of A move to the left and
 * whose blocks of B move up by one place a step (Cannon 1969). */
#include <mimdsim/program.h>

static int64_t m = 6; /* rows of a block */

static double a_at(int64_t i, int64_t j) { return (double)((i * 3 + j * 5) % 17) - 8; }
static double b_at(int64_t i, int64_t j) { return (double)((i * 7 + j * 2) % 13) - 6; }

/* The w x w numbers of a matrix from its row i0 and its column j0 on. */
static void fill(double *x, int64_t w, int64_t i0, int64_t j0, double (*at)(int64_t, int64_t))
{
    for (int64_t i = 0; i < w; i++)
        for (int64_t j = 0; j < w; j++) x[i * w + j] = at(i0 + i, j0 + j);
}

/* z += x y, all w x w. */
static void multiply(int64_t w, const double *x, const double *y, double *z)
{
    for (int64_t i = 0; i < w; i++)
        for (int64_t l = 0; l < w; l++)
            for (int64_t j = 0; j < w; j++) z[i * w + j] += x[i * w + l] * y[l * w + j];
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    int q = 1;
    while (q * q < p) q++;
    if (q * q != p) comm_fail(c, "%d ranks: expected a square number", p);
    const int row = me / q, column = me % q;
    const int64_t bytes = m * m * 8;
    double *a = comm_memory(c, bytes), *b = comm_memory(c, bytes), *product = comm_memory(c, bytes);
    /* Cannon's first step, in which row i is turned by i places and column j by j, is left out:
     * each rank makes the blocks that it would then have. */
    fill(a, m, row * m, (row + column) % q * m, a_at);
    fill(b, m, (row + column) % q * m, column * m, b_at);
    for (int step = 0; step < q; step++) {
        multiply(m, a, b, product);
        if (step == q - 1) break;
        /* Everybody begins a step at the same time. */
        comm_barrier(c);
        /* GAP: send a (`bytes` bytes, tag 0) to the rank on the left and receive the one from the
         * right into a; then send b (tag 1) to the rank above and receive the one from below into
         * b. Rank `row * q + column` is in that row and column; the grid is closed to a torus: left
         * of column 0 is column q - 1. comm_send copies the data, so that a may be received into
         * at once. */
    }
    for (int64_t i = 0; i < m; i++)
        comm_publish(c, 0, (row * m + i) * m * q + column * m, m, product + i * m);
}

static void serial(struct comm *c)
{
    int q = 1;
    while (q * q < comm_run_size(c)) q++;
    const int64_t n = m * q;
    double *a = comm_memory(c, n * n * 8), *b = comm_memory(c, n * n * 8);
    double *product = comm_memory(c, n * n * 8);
    fill(a, n, 0, 0, a_at);
    fill(b, n, 0, 0, b_at);
    multiply(n, a, b, product);
    comm_publish(c, 0, 0, n * n, product);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "Cannon's matrix multiplication",
        .parameter = {PROGRAM_WHOLE(m, 1, 100, "rows of a block")}, .output = {"product"},
        .run = run, .serial = {{"three loops", serial}}, .tolerance = 1e-12,
        .cost = MIMDSIM_COST_AUTHOR);
