/* @NAME@.c - the sum 1 + 1/4 + 1/9 + ... of n terms, which tends to pi^2 / 6.
 *
 * A parallel program of your own. Run it:       mimdsim run @NAME@.c
 * On three machines, with a figure:             mimdsim run @NAME@.yaml
 *                                               mimdsim plot mimdsim.db speedup
 * What it may call is described in mimdsim/program.h, each function with its rules.
 *
 * Every rank runs `run` below, each with its own copy of all variables. Ranks share nothing: what
 * one knows another learns by a message. */
#include <mimdsim/program.h>

/* A parameter: `mimdsim run @NAME@.c --set n=50000` sets it. This is its default. */
static int64_t n = 100000;

/* The work itself: terms first .. last - 1. Both codes below use it, so that they do the same. */
static double add_terms(int64_t first, int64_t last)
{
    double sum = 0;
    for (int64_t i = first; i < last; i++) sum += 1.0 / ((double)(i + 1) * (double)(i + 1));
    return sum;
}

/* The parallel program: what each rank does. */
static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c); /* my number, and how many we are */

    /* 1. Every rank adds up its share: computing takes simulated time by itself. */
    comm_stage(c, 0);
    double sum = add_terms(n * me / p, n * (me + 1) / p);

    /* 2. The shares go to rank 0, by messages with tag 1, and are added up there. */
    comm_stage(c, 1);
    if (me > 0) comm_send(c, 0, 1, &sum, sizeof sum);
    for (int from = 1; me == 0 && from < p; from++) {
        double share;
        comm_recv(c, from, 1, &share, sizeof share);
        sum += share;
    }

    /* 3. The result is handed over: element 0 of result 0. Exactly one rank publishes it. */
    if (me == 0) comm_publish(c, 0, 0, 1, &sum);
}

/* The same on one processor. The speedup is measured against it, and its result is what the
 * parallel one is compared with: a run whose result differs by more than .tolerance is stored as invalid. */
static void serial(struct comm *c)
{
    const double sum = add_terms(0, n);
    comm_publish(c, 0, 0, 1, &sum);
}

PROGRAM(.title = "sum of 1/i^2",
        .parameter = {PROGRAM_WHOLE(n, 1, 1e9, "number of terms")},
        .stage = {"own share", "collect"}, /* parts whose time is told apart: comm_stage */
        .output = {"sum"},                 /* results: comm_publish */
        .run = run, .serial = {{"one loop", serial}}, .tolerance = 1e-12);

/* To try: 1. Collect the shares in pairs (log2 P rounds), or by
 *            comm_allreduce(c, COMM_SUM, &sum, 1).
 *         2. mimdsim timeline @NAME@.c --set ranks=8   shows where the time goes.
 *         3. Let rank 0 wait for a message that nobody sends, and read what is told. */
