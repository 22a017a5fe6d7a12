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
    (void)c, (void)message;
    /* GAP: receive the message from the rank below that has it first, and send it to the ranks
     * 1, 2, 4, ... above that do not have it yet. Rank 5 (binary 101) receives from rank 1, and
     * sends to ranks 5 + 8, 5 + 16, ... as far as there are ranks. */
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
