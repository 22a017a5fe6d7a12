/* sample-sort-mpi.c - n numbers sorted over all ranks: every number goes to the rank of its interval,
 * and the intervals are equally wide, or chosen by samples (Frazer and McKellar 1970; regular samples:
 * Shi and Schaeffer 1992): the word "equal" or "samples" is the program's argument. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#ifdef __MIMDSIM__
#include <mimdsim/compute.h>
#else
#define mimdsim_compute(flops, bytes) ((void)0)
#endif

/* P ranks with K numbers each before they are sorted. */
enum { P = @P@, K = @m@ };

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Number i of the whole list: the squares of 0 to P K - 1, so that small ones are much denser. */
static double value(int i) { return (double)i * i; }

/* splitter[0] to splitter[P - 2]: rank i gets the numbers from splitter[i - 1] on and below
 * splitter[i]. Equally wide intervals need no messages: everybody knows the largest number. */
static void equal_splitters(double *splitter)
{
    for (int i = 0; i < P - 1; i++) splitter[i] = value(K * P) * (i + 1) / P;
}

/* The same by samples of the sorted x: P of each rank, at equal distances, go to rank 0. It sorts all
 * P * P of them and sends the splitters to everybody. */
static void sample_splitters(int me, const double *x, double *splitter)
{
    static double sample[P * P];
    for (int i = 0; i < P; i++) sample[i] = x[i * K / P];
    if (me == 0) {
        for (int i = 1; i < P; i++)
            MPI_Recv(sample + i * P, P, MPI_DOUBLE, i, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        qsort(sample, P * P, sizeof *sample, compare);
        (void)splitter;
        /* GAP: choose P - 1 splitters of the P * P sorted samples, so that all ranks get about as
         * many numbers, and send them (tag 1) to each of the other ranks by MPI_Send. */
    } else {
        MPI_Send(sample, P, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD);
        MPI_Recv(splitter, P - 1, MPI_DOUBLE, 0, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
}

/* The numbers of every interval to their rank; returns how many came, in y. A rank tells the others
 * nothing but the numbers: the length of a message says how many there are. */
static int exchange(int me, const double *x, const double *splitter, double *y)
{
    int first = 0, got = 0;
    MPI_Request sent[P];
    for (int to = 0; to < P; to++) {
        int n = 0;
        sent[to] = MPI_REQUEST_NULL;
        while (first + n < K && (to == P - 1 || x[first + n] < splitter[to])) n++;
        if (to != me) MPI_Isend(x + first, n, MPI_DOUBLE, to, 2, MPI_COMM_WORLD, &sent[to]);
        for (int i = 0; to == me && i < n; i++) y[got++] = x[first + i];
        first += n;
    }
    for (int from = 0; from < P; from++) {
        MPI_Status status;
        int n;
        if (from == me) continue;
        MPI_Recv(y + got, K, MPI_DOUBLE, from, 2, MPI_COMM_WORLD, &status);
        MPI_Get_count(&status, MPI_DOUBLE, &n);
        got += n;
    }
    MPI_Waitall(P, sent, MPI_STATUSES_IGNORE);
    return got;
}

/* Whether these are n squares of whole numbers that follow each other. */
static int is_right(const double *y, int n)
{
    int first = 0;
    while (n > 0 && value(first) < y[0]) first++;
    for (int i = 0; i < n; i++)
        if (y[i] != value(first + i)) return 0;
    return 1;
}

int main(int argc, char **argv)
{
    static double x[K], y[P * K], splitter[P];
    int me, p, n;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    if (p != P) MPI_Abort(MPI_COMM_WORLD, 2);
    /* Rank `me` has every P-th number. */
    for (int i = 0; i < K; i++) x[i] = value(me + i * P);
    qsort(x, K, sizeof *x, compare);
    if (argc > 1 && strcmp(argv[1], "equal") == 0) equal_splitters(splitter);
    else sample_splitters(me, x, splitter);
    n = exchange(me, x, splitter, y);
    /* What came is merged: one operation for each number, and that is all that computing costs. */
    qsort(y, (size_t)n, sizeof *y, compare);
    mimdsim_compute(n, 0);
    MPI_Finalize();
    return is_right(y, n) ? EXIT_SUCCESS : EXIT_FAILURE;
}
