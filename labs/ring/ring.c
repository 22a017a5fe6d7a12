/* ring.c - a token goes once round a ring of ranks; every rank adds one to it. Two experiments are
 * ready to measure what the ring cannot tell: a train of messages, and a late receive. */
#include <mimdsim/program.h>

enum { RING, TRAIN, LATE };
static const int messages_of_train = 11;
static const double late_flops = 100000; /* 1 ms on this machine */

static int64_t bytes = 1000;
static int experiment = RING;

static void ring(struct comm *c, double *token)
{
    const int me = comm_rank(c), p = comm_size(c);
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

/* Rank 0 sends 11 messages to rank 1, one after the other. */
static void train(struct comm *c, double *token)
{
    for (int i = 0; i < messages_of_train; i++) {
        if (comm_rank(c) == 0) comm_send(c, 1, 0, token, bytes);
        if (comm_rank(c) == 1) comm_recv(c, 0, 0, token, bytes);
    }
}

/* Rank 1 computes for 1 ms; the message has been there for long when its receive begins. */
static void late(struct comm *c, double *token)
{
    if (comm_rank(c) == 0) comm_send(c, 1, 0, token, bytes);
    if (comm_rank(c) == 1) {
        comm_compute(c, late_flops, 0);
        comm_recv(c, 0, 0, token, bytes);
    }
}

static void run(struct comm *c)
{
    double *token = comm_memory(c, bytes);
    const double all = comm_size(c);
    if (experiment == TRAIN) train(c, token);
    if (experiment == LATE) late(c, token);
    if (experiment == RING) ring(c, token);
    else if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &all);
}

/* Every rank must have added its one. */
static void check(struct comm *c)
{
    int64_t n;
    const double *count = comm_output(c, 0, &n);
    comm_error(c, "number of ranks", n == 1 && count[0] == comm_run_size(c) ? 0 : 1);
}

/* The cost of computing is the author's: none in the ring, so that times are those of messages. */
PROGRAM(.title = "a token round a ring",
        .parameter = {PROGRAM_SIZE(bytes, 8, 1e9, "length of the token"),
                      PROGRAM_CHOICE(experiment, "ring|train|late", "what is sent")},
        .output = {"count"}, .run = run, .check = check, .cost = MIMDSIM_COST_AUTHOR);
