/* dynamics.c - a tridiagonal system by parallel cyclic reduction, one row on each rank: the step that
 * gives the paper's forward dynamics its O(log n), here for rows of one number. */
#include <mimdsim/program.h>

static int64_t row_flops = 1000;   /* what a row costs one processor that goes through all of them */
static int64_t level_flops = 2000; /* what a row costs in a level of the reduction */

/* low x(i-1) + middle x(i) + high x(i+1) = right: row i of the system, 32 bytes. */
struct row {
    double low, middle, high, right;
};

static struct row row_of(int i, int n)
{
    return (struct row){i > 0 ? -1 : 0, 4, i < n - 1 ? -1 : 0, 1 + i % 5};
}

/* `own`, with the unknowns before and behind it eliminated by the rows that have them in the middle:
 * what is left couples it to the unknowns twice as far away. */
static struct row eliminate(struct row own, struct row below, struct row above)
{
    const double f = own.low / below.middle, g = own.high / above.middle;
    return (struct row){-f * below.low, own.middle - f * below.high - g * above.low,
                        -g * above.high, own.right - f * below.right - g * above.right};
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    struct row own = row_of(me, p);
    for (int d = 1; d < p; d *= 2) {
        /* A row outside the system changes nothing. */
        struct row below = {0, 1, 0, 0}, above = {0, 1, 0, 0};
        /* GAP: send the own row (sizeof own bytes, tag d) first to rank me + d, then to rank me - d,
         * as far as there are such ranks; then receive `below` from rank me - d and `above` from
         * rank me + d. */
        own = eliminate(own, below, above);
        comm_compute(c, (double)level_flops, 0);
    }
    const double x = own.right / own.middle;
    comm_publish(c, 0, me, 1, &x);
}

/* Gaussian elimination without pivots, and back. */
static void serial(struct comm *c)
{
    const int n = comm_run_size(c);
    struct row *row = comm_memory(c, n * (int64_t)sizeof *row);
    double *x = comm_memory(c, n * 8);
    for (int i = 0; i < n; i++) {
        row[i] = row_of(i, n);
        if (i == 0) continue;
        const double f = row[i].low / row[i - 1].middle;
        row[i].middle -= f * row[i - 1].high;
        row[i].right -= f * row[i - 1].right;
    }
    for (int i = n - 1; i >= 0; i--)
        x[i] = (row[i].right - (i < n - 1 ? row[i].high * x[i + 1] : 0)) / row[i].middle;
    comm_compute(c, (double)(row_flops * n), 0);
    comm_publish(c, 0, 0, n, x);
}

/* A row of one number stands for a block row of a body's 6 x 6 matrices: computing costs what
 * row_flops and level_flops say. */
PROGRAM(.title = "a tridiagonal system by parallel cyclic reduction",
        .parameter = {PROGRAM_WHOLE(row_flops, 0, 1e9, "operations a row of the serial solution"),
                      PROGRAM_WHOLE(level_flops, 0, 1e9, "operations a row of each level")},
        .output = {"solution"}, .run = run, .serial = {{"elimination", serial}}, .tolerance = 1e-12,
        .cost = MIMDSIM_COST_AUTHOR);
