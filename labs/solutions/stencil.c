/* stencil.c - Jacobi's iteration on a square grid of n by n points, in strips of rows. */
#include <mimdsim/program.h>

static int64_t n = 256, steps = 10;
static int overlap = 1;

static double begin(int64_t i, int64_t j) { return (double)((i * 31 + j * 17) % 97); }

/* Rows first .. last - 1 of a strip: each inner point becomes the mean of its four neighbours. */
static void relax(const double *from, double *to, int64_t first, int64_t last)
{
    for (int64_t i = first; i < last; i++)
        for (int64_t j = 1; j < n - 1; j++)
            to[i * n + j] = 0.25 * (from[(i - 1) * n + j] + from[(i + 1) * n + j] +
                                    from[i * n + j - 1] + from[i * n + j + 1]);
}

/* The strip of rows first .. first + m - 1, with a row more on each side; the edge of the grid
 * stays. */
static void fill(double *x, int64_t first, int64_t m)
{
    for (int64_t i = -1; i <= m; i++)
        for (int64_t j = 0; j < n; j++) x[(i + 1) * n + j] = begin(first + i, j);
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t first = n * me / p, m = n * (me + 1) / p - first, row = n * 8;
    double *x = comm_memory(c, (m + 2) * row), *y = comm_memory(c, (m + 2) * row);
    if (m < 1) comm_fail(c, "%d ranks for %ld rows", p, (long)n);
    fill(x, first, m);
    fill(y, first, m);
    /* Rows 1 .. m are the own ones; the first and last row of the grid are never computed. */
    const int64_t low = me == 0 ? 2 : 1, high = me == p - 1 ? m : m + 1;
    for (int64_t s = 0; s < steps; s++) {
        struct comm_request r[2] = {{0}, {0}};
        comm_stage(c, 0);
        if (me > 0) comm_irecv(c, me - 1, 1, x, row, &r[0]);
        if (me < p - 1) comm_irecv(c, me + 1, 2, x + (m + 1) * n, row, &r[1]);
        if (me > 0) comm_send(c, me - 1, 2, x + n, row);
        if (me < p - 1) comm_send(c, me + 1, 1, x + m * n, row);
        if (!overlap) comm_waitall(c, 2, r);
        comm_stage(c, 1);
        relax(x, y, 2, m);
        comm_stage(c, 0);
        comm_waitall(c, 2, r);
        comm_stage(c, 1);
        if (low == 1) relax(x, y, 1, high < 2 ? high : 2);
        if (high == m + 1 && m > 1) relax(x, y, m, m + 1);
        double *t = x;
        x = y;
        y = t;
    }
    comm_publish(c, 0, first * n, m * n, x + n);
}

static void serial(struct comm *c)
{
    double *x = comm_memory(c, (n + 2) * n * 8), *y = comm_memory(c, (n + 2) * n * 8);
    fill(x, 0, n);
    fill(y, 0, n);
    for (int64_t s = 0; s < steps; s++) {
        relax(x, y, 2, n);
        double *t = x;
        x = y;
        y = t;
    }
    comm_publish(c, 0, 0, n * n, x + n);
}

PROGRAM(.title = "Jacobi's iteration on a square grid, in strips of rows",
        .parameter = {PROGRAM_WHOLE(n, 3, 10000, "rows and columns of the grid"),
                      PROGRAM_WHOLE(steps, 1, 1e6, "iterations"),
                      PROGRAM_FLAG(overlap, "compute while the neighbours' rows are on their way")},
        .stage = {"neighbours", "compute"}, .output = {"grid"}, .run = run,
        .serial = {{"one processor", serial}}, .tolerance = 1e-13);
