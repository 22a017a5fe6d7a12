/* broadcast.c - a message from rank 0 to all others: as a star, by a binomial tree, or along a chain
 * of ranks in segments. */
#include <mimdsim/program.h>

static int64_t bytes = 8, segments = 0;
static int tree = 1;

static void send_star(struct comm *c, char *message)
{
    const int me = comm_rank(c), p = comm_size(c);
    for (int to = 1; me == 0 && to < p; to++) comm_send(c, to, 0, message, bytes);
    if (me != 0) comm_recv(c, 0, 0, message, bytes);
}

static void send_tree(struct comm *c, char *message)
{
    (void)c, (void)message;
    /* GAP: receive the message from the rank below that has it first, and send it to the ranks
     * 1, 2, 4, ... above that do not have it yet. Rank 5 (binary 101) receives from rank 1, and
     * sends to ranks 5 + 8, 5 + 16, ... as far as there are ranks. */
}

/* Along the chain 0, 1, 2, ... in `segments` pieces of equal length. */
static void send_pipeline(struct comm *c, char *message)
{
    const int64_t m = bytes / segments;
    (void)c, (void)message, (void)m;
    /* GAP: one piece after the other, of m bytes from message + i * m on: receive it from the rank
     * before, and send it to the rank behind at once. The first rank receives nothing, the last one
     * sends nothing. */
}

static void run(struct comm *c)
{
    char *message = comm_memory(c, bytes);
    if (comm_rank(c) == 0) message[0] = message[bytes - 1] = 42;
    if (segments > 0) send_pipeline(c, message);
    else if (tree) send_tree(c, message);
    else send_star(c, message);
    const double whole = message[0] == 42 && message[bytes - 1] == 42;
    comm_publish(c, 0, comm_rank(c), 1, &whole);
}

/* Every rank must have the whole message. */
static void check(struct comm *c)
{
    int64_t n, right = 0;
    const double *x = comm_output(c, 0, &n);
    for (int64_t i = 0; i < n; i++) right += x[i] == 1;
    comm_error(c, "message of a rank", n == comm_run_size(c) && right == n ? 0 : 1);
}

/* The cost of computing is the author's: none here, so that times are those of messages alone. */
PROGRAM(.title = "a broadcast as a star, by a binomial tree, or in segments along a chain",
        .parameter = {PROGRAM_SIZE(bytes, 1, 1e9, "length of the message"),
                      PROGRAM_FLAG(tree, "a binomial tree, not a star"),
                      PROGRAM_WHOLE(segments, 0, 1e6, "pieces of a pipeline; 0: tree or star")},
        .output = {"message"}, .run = run, .check = check, .cost = MIMDSIM_COST_AUTHOR);
