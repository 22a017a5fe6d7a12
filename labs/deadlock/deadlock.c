/* deadlock.c - each rank sends its number to the next one of a ring, by synchronous sends. */
#include <mimdsim/program.h>

static void send_synchronously(struct comm *c, int to, double *x)
{
    struct comm_request r = {0};
    comm_issend(c, to, 0, x, 8, &r);
    comm_wait(c, &r);
}

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c), next = (me + 1) % p, last = (me + p - 1) % p;
    double own = me, got = -1;
    /* GAP: all ranks send first, and nobody receives. Change the order. */
    send_synchronously(c, next, &own);
    comm_recv(c, last, 0, &got, 8);
    /* End of the gap. */
    comm_publish(c, 0, me, 1, &got);
}

/* Every rank must have the number of the one before it. */
static void check(struct comm *c)
{
    int64_t n, right = 0;
    const double *x = comm_output(c, 0, &n);
    for (int64_t i = 0; i < n; i++) right += x[i] == (double)((i + n - 1) % n);
    comm_error(c, "number of a rank", n == comm_run_size(c) && right == n ? 0 : 1);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "numbers round a ring by synchronous sends", .output = {"received"}, .run = run,
        .wildcards = 1, .check = check, .cost = MIMDSIM_COST_AUTHOR);
