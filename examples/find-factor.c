/* find-factor.c - a factor of n by trial division. Each rank looks at its own blocks of odd numbers;
 * the first that finds one ends the search of all, on a machine with an eureka in the middle of
 * whatever the others do. */
#include <mimdsim/program.h>

static int64_t n = INT64_C(90001) * 110017, block = 256;

/* The first odd number of first, first + 2, ... below `end` that divides n; 0: none. */
static int64_t divisor(int64_t first, int64_t end)
{
    for (int64_t d = first; d < end && d * d <= n; d += 2)
        if (n % d == 0) return d;
    return 0;
}

static void run(struct comm *c)
{
    int64_t at = 3 + 2 * block * comm_rank(c), factor = 0;
    int ended = 0;
    comm_search_begin(c);
    while (ended == 0) {
        enum comm_search_state state = COMM_SEARCH_EXHAUSTED;
        if (at <= n / at) {
            factor = divisor(at, at + 2 * block);
            at += 2 * block * comm_size(c);
            state = factor != 0 ? COMM_SEARCH_FOUND : COMM_SEARCH_GOES_ON;
        }
        ended = comm_search(c, state);
    }
    /* What an interrupted rank had in its hands does not count. Several may have found one. */
    if (ended != 2) factor = 0;
    comm_allreduce(c, COMM_MAX_INT64, &factor, 1);
    const double found = (double)factor;
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &found);
}

static void serial(struct comm *c)
{
    const double found = (double)divisor(3, n);
    comm_publish(c, 0, 0, 1, &found);
}

PROGRAM(.title = "a factor by trial division",
        .parameter = {PROGRAM_WHOLE(n, 9, 9e15, "odd, with one factor above 2 and up to its root"),
                      PROGRAM_WHOLE(block, 1, 1e6, "numbers that a step looks at")},
        .output = {"factor"}, .run = run, .serial = {{"one loop", serial}}, .wildcards = 1,
        .tolerance = 1e-12);
