/* broadcast.c - a message from rank 0 to all others: as a star, or by a binomial tree. */
#include <mimdsim/program.h>

static int64_t bytes = 8;
static int tree = 1;

static void send_star(struct comm *c, double *message)
{
    const int me = comm_rank(c), p = comm_size(c);
    for (int to = 1; me == 0 && to < p; to++) comm_send(c, to, 0, message, bytes);
    if (me != 0) comm_recv(c, 0, 0, message, bytes);
}

static void send_tree(struct comm *c, double *message)
{
    const int me = comm_rank(c), p = comm_size(c);
    int distance = 1;
    /* The highest bit of the own number is the round in which the message comes. */
    while (2 * distance <= me) distance *= 2;
    if (me > 0) comm_recv(c, me - distance, 0, message, bytes);
    for (int d = me > 0 ? 2 * distance : 1; me + d < p; d *= 2)
        comm_send(c, me + d, 0, message, bytes);
}

static void run(struct comm *c)
{
    double *message = comm_memory(c, bytes);
    if (comm_rank(c) == 0) message[0] = 42;
    if (tree) send_tree(c, message);
    else send_star(c, message);
    comm_publish(c, 0, comm_rank(c), 1, message);
}

/* Every rank must have the message. */
static void check(struct comm *c)
{
    int64_t n, right = 0;
    const double *x = comm_output(c, 0, &n);
    for (int64_t i = 0; i < n; i++) right += x[i] == 42;
    comm_error(c, "ranks with message", n == comm_run_size(c) && right == n ? 0 : 1);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "a broadcast as a star or by a binomial tree",
        .parameter = {PROGRAM_SIZE(bytes, 8, 1e9, "length of the message"),
                      PROGRAM_FLAG(tree, "a binomial tree, not a star")},
        .output = {"message"}, .run = run, .check = check, .cost = MIMDSIM_COST_AUTHOR);
