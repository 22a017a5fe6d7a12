/* ring.c - a token goes once round a ring of ranks; every rank adds one to it. */
#include <mimdsim/program.h>

static int64_t bytes = 1000;

static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    double *token = comm_memory(c, bytes);
    if (me == 0) {
        token[0] = 1;
        comm_send(c, 1, 0, token, bytes);
        comm_recv(c, p - 1, 0, token, bytes);
        comm_publish(c, 0, 0, 1, token);
    } else {
        /* GAP: receive the token from the rank before, add one to token[0], and send it to the
         * rank behind. Behind the last rank comes rank 0. */
    }
}

/* Every rank must have added its one. */
static void check(struct comm *c)
{
    int64_t n;
    const double *count = comm_output(c, 0, &n);
    comm_error(c, "ranks that were there", n == 1 && count[0] == comm_run_size(c) ? 0 : 1);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "a token round a ring",
        .parameter = {PROGRAM_SIZE(bytes, 8, 1e9, "length of the token")}, .output = {"count"},
        .run = run, .check = check, .cost = MIMDSIM_COST_AUTHOR);
