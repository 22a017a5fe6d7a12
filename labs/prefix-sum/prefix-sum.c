/* prefix-sum.c - the sum of the numbers of all ranks up to the own one, by recursive doubling. */
#include <mimdsim/program.h>

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    double sum = me + 1;
    for (int d = 1; d < p; d *= 2) {
        /* GAP: send the sum to the rank d above (if there is one, with tag d), receive the sum of
         * the rank d below (if there is one), and add it. */
    }
    comm_publish(c, 0, me, 1, &sum);
}

/* 1 + 2 + ... + i + 1. */
static void check(struct comm *c)
{
    int64_t n, right = 0;
    const double *x = comm_output(c, 0, &n);
    for (int64_t i = 0; i < n; i++) right += x[i] == (double)((i + 1) * (i + 2) / 2);
    comm_error(c, "sum of a rank", n == comm_run_size(c) && right == n ? 0 : 1);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "prefix sums by recursive doubling", .output = {"sum"}, .run = run,
        .check = check, .cost = MIMDSIM_COST_AUTHOR);
