/* sample-sort.c - n numbers sorted over all ranks: every number goes to the rank of its interval, and
 * the intervals are equally wide, or chosen by samples (Frazer and McKellar 1970; regular samples:
 * Shi and Schaeffer 1992). */
#include <mimdsim/program.h>
#include <stdlib.h>

enum { EQUAL, SAMPLES };

static int64_t m = 64; /* numbers of a rank before they are sorted */
static int method = SAMPLES;

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sort(double *x, int64_t n) { qsort(x, (size_t)n, sizeof *x, compare); }

/* Number i of the whole list: the squares of 0 to n - 1, so that small ones are much denser. */
static double value(int64_t i) { return (double)i * (double)i; }

/* Rank `me` has every p-th of them. */
static void fill(double *x, int me, int p)
{
    for (int64_t i = 0; i < m; i++) x[i] = value(me + (m - 1 - i) * p);
}

/* splitter[0] to splitter[p - 2]: rank i gets the numbers from splitter[i - 1] on and below
 * splitter[i]. Equally wide intervals need no messages: everybody knows the largest number. */
static void equal_splitters(struct comm *c, double *splitter)
{
    const int p = comm_size(c);
    for (int i = 0; i < p - 1; i++) splitter[i] = value(m * p) * (i + 1) / p;
}

/* The same by samples of the sorted x: p of each rank, at equal distances, go to rank 0. It sorts all
 * p * p of them and sends the splitters to everybody. */
static void sample_splitters(struct comm *c, const double *x, double *splitter)
{
    const int me = comm_rank(c), p = comm_size(c);
    double *sample = comm_memory(c, p * p * 8);
    for (int i = 0; i < p; i++) sample[i] = x[i * m / p];
    if (me == 0) {
        for (int i = 1; i < p; i++) comm_recv(c, i, 0, sample + i * p, p * 8);
        sort(sample, (int64_t)p * p);
        /* GAP: choose p - 1 splitters of the p * p sorted samples, so that all ranks get about as
         * many numbers, and send them ((p - 1) * 8 bytes, tag 1) to each of the other ranks. */
    } else {
        comm_send(c, 0, 0, sample, p * 8);
        comm_recv(c, 0, 1, splitter, (p - 1) * 8);
    }
}

/* The numbers of every interval to their rank; returns how many came, in the new array *y. A rank
 * tells the others nothing but the numbers: the length of a message says how many there are. */
static int64_t exchange(struct comm *c, const double *x, const double *splitter, double **y)
{
    const int me = comm_rank(c), p = comm_size(c);
    int64_t first = 0, got = 0;
    *y = comm_memory(c, p * m * 8);
    for (int to = 0; to < p; to++) {
        int64_t n = 0;
        while (first + n < m && (to == p - 1 || x[first + n] < splitter[to])) n++;
        if (to != me) comm_send(c, to, 2, x + first, n * 8);
        for (int64_t i = 0; to == me && i < n; i++) (*y)[got++] = x[first + i];
        first += n;
    }
    for (int from = 0; from < p; from++) {
        struct comm_request r = {0};
        if (from == me) continue;
        comm_irecv_matching(c, from, 2, -1, *y + got, m * 8, &r);
        comm_wait(c, &r);
        got += r.bytes / 8;
    }
    return got;
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    double *x = comm_memory(c, m * 8), *splitter = comm_memory(c, p * 8), *y;
    fill(x, me, p);
    sort(x, m);
    if (method == EQUAL) equal_splitters(c, splitter);
    else sample_splitters(c, x, splitter);
    int64_t n = exchange(c, x, splitter, &y);
    /* What came is merged: one operation for each number, and that is all that computing costs. */
    sort(y, n);
    comm_compute(c, (double)n, 0);
    /* The sorted list begins on rank 0; where the own part begins follows from its numbers, which
     * are squares of all whole numbers. */
    int64_t first = 0;
    while (n > 0 && value(first) < y[0]) first++;
    if (n > 0) comm_publish(c, 0, first, n, y);
}

static void serial(struct comm *c)
{
    const int64_t n = m * comm_run_size(c);
    double *x = comm_memory(c, n * 8);
    for (int64_t i = 0; i < n; i++) x[i] = value(n - 1 - i);
    sort(x, n);
    comm_publish(c, 0, 0, n, x);
}

PROGRAM(.title = "sample sort",
        .parameter = {PROGRAM_WHOLE(m, 1, 1e6, "numbers of a rank"),
                      PROGRAM_CHOICE(method, "equal|samples", "how intervals are chosen")},
        .output = {"sorted"}, .run = run, .serial = {{"qsort", serial}}, .wildcards = 1,
        .cost = MIMDSIM_COST_AUTHOR);
