/* sample-sort.c - n numbers sorted over all ranks: each sorts its own, samples choose P - 1
 * splitters, every number goes to the rank of its interval, and each sorts what it got (Frazer and
 * McKellar, J. ACM 17, 1970; regular samples: Shi and Schaeffer 1992). */
#include <mimdsim/program.h>
#include <stdlib.h>

static int64_t n = 20000;

/* Numbers that look random, all different: a bijection of 0 .. 2^32 - 1. */
static double value(int64_t i)
{
    uint32_t x = (uint32_t)i * 2654435761u;
    x ^= x >> 15;
    return (double)(x * 2246822519u);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sort(double *x, int64_t m) { qsort(x, (size_t)m, sizeof *x, compare); }

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    const int64_t m = n * (me + 1) / p - n * me / p;
    double *x = comm_memory(c, m * 8), *sample = comm_memory(c, p * p * 8),
           *own = comm_memory(c, p * 8);
    int64_t *out = comm_memory(c, p * 8), *in = comm_memory(c, p * 8);
    for (int64_t i = 0; i < m; i++) x[i] = value(n * me / p + i);
    comm_stage(c, 0);
    sort(x, m);
    /* P numbers at equal distances from each rank; of all together each P-th is a splitter. */
    comm_stage(c, 1);
    for (int i = 0; i < p; i++) own[i] = m > 0 ? x[i * m / p] : 0;
    comm_allgather(c, own, p * 8, sample);
    sort(sample, (int64_t)p * p);
    int64_t at = 0;
    for (int i = 0; i < p; i++) {
        const int64_t begin = at;
        while (at < m && (i == p - 1 || x[at] < sample[(i + 1) * p])) at++;
        out[i] = (at - begin) * 8;
    }
    comm_stage(c, 2);
    comm_alltoall(c, out, 8, in);
    int64_t bytes = 0;
    for (int i = 0; i < p; i++) bytes += in[i];
    double *y = comm_memory(c, bytes);
    comm_alltoallv(c, x, out, y, in);
    comm_stage(c, 3);
    sort(y, bytes / 8);
    /* Where the own numbers begin among all. */
    int64_t first = bytes / 8;
    comm_exscan(c, COMM_SUM_INT64, &first, 1);
    if (me == 0) first = 0;
    comm_publish(c, 0, first, bytes / 8, y);
}

static void serial(struct comm *c)
{
    double *x = comm_memory(c, n * 8);
    for (int64_t i = 0; i < n; i++) x[i] = value(i);
    sort(x, n);
    comm_publish(c, 0, 0, n, x);
}

PROGRAM(.title = "sample sort", .parameter = {PROGRAM_WHOLE(n, 1, 1e8, "numbers to sort")},
        .stage = {"sort", "splitters", "exchange", "sort again"}, .output = {"sorted"}, .run = run,
        .serial = {{"qsort", serial}});
