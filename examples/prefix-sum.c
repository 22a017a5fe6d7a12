/* prefix-sum.c - sums of the first 1, 2, ..., n numbers. Each rank adds up its block; the sums of
 * the blocks travel in ceil(log2 P) rounds of recursive doubling (Hillis and Steele, CACM 29,
 * 1986). */
#include <mimdsim/program.h>

static int64_t n = 100000;

static double value(int64_t i) { return (double)((i * 7919 + 13) % 1001); }

/* Sums of values first .. first + m - 1, into x[0 .. m). Returns the last. */
static double sum_block(int64_t first, int64_t m, double *x)
{
    double sum = 0;
    for (int64_t i = 0; i < m; i++) x[i] = sum += value(first + i);
    return sum;
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t first = n * me / p, m = n * (me + 1) / p - first;
    double *x = comm_memory(c, m * 8);
    comm_stage(c, 0);
    double sum = sum_block(first, m, x), before = 0;
    /* After the round of distance d, `sum` is that of the last 2 d blocks up to the own one. */
    comm_stage(c, 1);
    for (int d = 1; d < p; d *= 2) {
        double lower = 0;
        if (me + d < p) comm_send(c, me + d, d, &sum, 8);
        if (me >= d) comm_recv(c, me - d, d, &lower, 8);
        before += lower;
        sum += lower;
    }
    comm_stage(c, 2);
    for (int64_t i = 0; i < m; i++) x[i] += before;
    comm_publish(c, 0, first, m, x);
}

static void serial(struct comm *c)
{
    double *x = comm_memory(c, n * 8);
    sum_block(0, n, x);
    comm_publish(c, 0, 0, n, x);
}

PROGRAM(.title = "prefix sums by recursive doubling",
        .parameter = {PROGRAM_WHOLE(n, 1, 1e8, "numbers")},
        .stage = {"own block", "doubling", "add"}, .output = {"prefix"}, .run = run,
        .serial = {{"one loop", serial}}, .tolerance = 1e-12);
