/* host_speed.c - see host_speed.h. Each loop works on data of the first cache, and its compiler is
 * kept from leaving out what nobody reads. */
#include "host/host_speed.h"

#include <math.h>
#include <string.h>

#include "comm/comm.h"

enum {
    SAMPLES = 25,
    MOST_SAMPLES = 200,
    ROWS = 6,
    PRODUCTS = 1000,
    LINKS = 64,
    SWEEPS = 10,
    ELEMENTS = 512,
    PER_ELEMENT = 5,
    COPY_BYTES = 16384,
    COPIES = 32,
    ROUNDS = 4,
    MESSAGE = 8,
    TAG = 5
};

/* What stands in for a use of `p`: all that it points to is read and written here. */
#define USED(p) __asm__ volatile("" ::"r"(p) : "memory")

/* Data and loops at a line of the cache, whatever the environment makes of the stack and the linker
 * of the code: what crosses lines takes up to a third longer, and no other process, or the next
 * build, would tell the same. */
#define LINED _Alignas(64)
#define LINED_CODE __attribute__((aligned(64)))

/* --- the operations, each some thousand times: [s] of one ------------------------------------- */

/* Since host_clock_ns was `begin` [s]. */
static double since(int64_t begin) { return (double)(host_clock_ns() - begin) * 1e-9; }

/* Products of a 6x6 matrix and a vector, as the operators of kernels are made of: what a processor
 * can issue in a cycle. */
LINED_CODE static double multiply_add(void)
{
    LINED double a[ROWS * ROWS];
    LINED double x[ROWS];
    LINED double y[ROWS];
    for (int k = 0; k < ROWS * ROWS; k++) a[k] = 1.0 / (k + 1);
    for (int k = 0; k < ROWS; k++) x[k] = 1;
    const int64_t begin = host_clock_ns();
    for (int round = 0; round < PRODUCTS; round++) {
        for (int r = 0; r < ROWS; r++) {
            double sum = 0;
            for (int k = 0; k < ROWS; k++) sum += a[r * ROWS + k] * x[k];
            y[r] = sum;
        }
        USED(y);
        USED(a);
        USED(x); /* each round is made */
    }
    return since(begin) / PRODUCTS / (2 * ROWS * ROWS);
}

/* y = R x + y, never inlined: an operator as small as those of kernels. */
__attribute__((noinline)) LINED_CODE static void turn(double *y, const double *r, const double *x)
{
    for (int i = 0; i < 3; i++) y[i] += r[3 * i] * x[0] + r[3 * i + 1] * x[1] + r[3 * i + 2] * x[2];
    USED(y);
}

/* From link to link of a chain, each call with what the one before has stored. */
LINED_CODE static double call(void)
{
    LINED double r[9] = {0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1};
    LINED double x[3 * (LINKS + 1)];
    for (int k = 0; k < 3 * (LINKS + 1); k++) x[k] = 1.0 / (k + 1);
    const int64_t begin = host_clock_ns();
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int i = 0; i < LINKS; i++) turn(&x[3 * i + 3], r, &x[3 * i]);
        for (int k = 0; k < 3; k++) x[k] *= 0.5;
    }
    return since(begin) / (SWEEPS * LINKS);
}

/* A scalar product, whose sum waits for each product: the clock of the processor. Five instructions
 * an element (load, load and multiply, add, advance, branch), as node_cost.c counts them where no
 * file says what one costs. */
LINED_CODE static double chain(void)
{
    LINED double x[ELEMENTS];
    LINED double y[ELEMENTS];
    double sum = 0;
    for (int k = 0; k < ELEMENTS; k++) x[k] = y[k] = 1.0 / (k + 1);
    USED(x);
    USED(y);
    const int64_t begin = host_clock_ns();
    for (int k = 0; k < ELEMENTS; k++) sum += x[k] * y[k];
    USED(&sum);
    return since(begin) / ELEMENTS / PER_ELEMENT;
}

/* A block to and fro, as packing copies it. */
LINED_CODE static double copy(void)
{
    LINED char a[COPY_BYTES];
    LINED char b[COPY_BYTES];
    memset(a, 1, sizeof a);
    memset(b, 2, sizeof b);
    const int64_t begin = host_clock_ns();
    for (int k = 0; k < COPIES; k++) {
        memcpy(k % 2 ? a : b, k % 2 ? b : a, COPY_BYTES);
        USED(a);
        USED(b); /* the copy is made, although nobody reads it */
    }
    return since(begin) / COPIES / COPY_BYTES;
}

/* Half a round trip between the first two processes; the others wait. */
static double message(struct host_comm *host, const struct hosts *hosts)
{
    struct comm *c = host_comm_run_begin(host, false, 1, NULL, 0);
    char data[MESSAGE] = {0};
    double time[SAMPLES];
    /* Some round trips a sample: reading the clock is a part of it. */
    if (hosts->rank > 1) return 0;
    for (int i = 0; i < SAMPLES; i++) {
        const int64_t begin = host_clock_ns();
        for (int k = 0; k < ROUNDS; k++) {
            if (hosts->rank == 0) comm_send(c, 1, TAG, data, sizeof data);
            comm_recv(c, 1 - hosts->rank, TAG, data, sizeof data);
            if (hosts->rank == 1) comm_send(c, 0, TAG, data, sizeof data);
        }
        time[i] = since(begin) / (2 * ROUNDS);
    }
    return real_times_of(time, SAMPLES).median;
}

/* --- samples ---------------------------------------------------------------------------------- */

/* In the order of enum host_operation. */
static double once(enum host_operation o)
{
    static double (*const loop[HOST_MESSAGE])(void) = {multiply_add, call, chain, copy};
    return loop[o]();
}

/* `n` samples that count first, in *clean; then those that the system interrupted. */
static void samples_of(enum host_operation o, int n, double *time, int *clean)
{
    int bad = n;
    *clean = 0;
    for (int i = 0; i < n; i++) {
        const int64_t before = host_interruptions();
        const double took = once(o);
        if (host_interruptions() == before) time[(*clean)++] = took;
        else time[--bad] = took;
    }
}

/* What the computer does, not what it can do at its best: the least of some is a lucky one. */
static double median_of(enum host_operation o)
{
    double time[SAMPLES];
    int clean;
    samples_of(o, SAMPLES, time, &clean);
    return real_times_of(time, clean > 0 ? clean : SAMPLES).median;
}

/* What it can do at its best: a price to which the fits of kernels add. */
double host_speed_least(enum host_operation o)
{
    double time[MOST_SAMPLES], least = INFINITY;
    int clean;
    samples_of(o, MOST_SAMPLES, time, &clean);
    for (int i = 0; i < clean; i++) least = fmin(least, time[i]);
    return least;
}

bool host_speed_now(const struct hosts *hosts, struct host_comm *comm, struct host_speed *out)
{
    const bool job = hosts != NULL && comm != NULL && hosts->size > 1;
    struct host_times times;
    bool left;
    *out = (struct host_speed){0};
    /* All begin together: processors that share a core are told from those that do not. */
    if (job && !host_comm_barrier(comm)) return false;
    for (int o = 0; o < HOST_MESSAGE; o++) out->time[o] = median_of((enum host_operation)o);
    if (!job) return true;
    /* The slowest process is the one that the others wait for. */
    out->time[HOST_MESSAGE] = message(comm, hosts);
    if (!host_comm_run_end(comm, &times, &left)) return false;
    /* Attoseconds are whole numbers, as reductions are. */
    int64_t whole[HOST_OPERATIONS];
    for (int o = 0; o < HOST_OPERATIONS; o++) whole[o] = (int64_t)(out->time[o] * 1e18);
    if (!hosts->call->reduce(HOSTS_LARGEST, whole, HOST_OPERATIONS)) return false;
    for (int o = 0; o < HOST_OPERATIONS; o++) out->time[o] = (double)whole[o] * 1e-18;
    return true;
}
