/* micro_ring.c - ring and random-ring: every rank sends to both its neighbours (micro.h). */
#include "base/random.h"
#include "kernel/carve.h"
#include "kernel/micro.h"
#include "kernel/micro_program.h"
#include "kernel/tags.h"

static const char *const stage_name[] = {"exchange"};

/* Who stands where: rings lie one behind the other. */
struct ring {
    int *member; /* (nrank) rank at each place */
    int *place;  /* (nrank) of each rank */
    int nring;
};

static int64_t message_bytes(const void *job)
{
    return ((const struct kernel_job *)job)->spec->kernel.message_bytes;
}

static int repetitions(const struct run_spec *spec)
{
    return spec->kernel.repeat > 1 ? spec->kernel.repeat : 1;
}

/* Rings of `ring_ranks` or a little more: P / size of them, so that no rank is left over. */
static int ring_count(const struct run_spec *spec)
{
    const int size = spec->kernel.ring_ranks;
    return size > 0 && size < spec->nrank ? spec->nrank / size : 1;
}

/* A ring of two has one neighbour on both sides; a ring of one has none. */
static bool accepts(const struct kernel_job *job, struct err *e)
{
    const struct run_spec *spec = job->spec;
    if (spec->kernel.message_bytes < 0)
        return err_set(e, ERR_CONFIG, "a message of %lld bytes",
                       (long long)spec->kernel.message_bytes);
    if (spec->nrank < 2)
        return err_set(e, ERR_CONFIG, "%d ranks: a ring needs at least two", spec->nrank);
    return spec->kernel.ring_ranks != 1 ||
           err_set(e, ERR_CONFIG, "kernel.ring_ranks is 1: a ring needs two ranks");
}

/* Fisher and Yates, from the run's seed: every order is equally likely, and the same seed gives the
 * same order on every host. */
static void shuffle(int *member, int n, uint64_t seed)
{
    /* 0x72696e67 ("ring") names the stream: another use of the same seed gets other numbers. */
    struct random r = random_make(seed, 0x72696e67, (uint64_t)n);
    for (int i = n - 1; i > 0; i--) {
        int k = (int)random_below(&r, (uint64_t)i + 1), kept = member[i];
        member[i] = member[k];
        member[k] = kept;
    }
}

/* The order is drawn once for all ranks, so that neighbours agree about it. */
static bool prepare_order(struct kernel_job *job, struct arena *a, bool random)
{
    const int P = job->spec->nrank;
    struct ring *g = TAKE(a, 1, struct ring);
    g->member = TAKE(a, P, int);
    g->place = TAKE(a, P, int);
    g->nring = ring_count(job->spec);
    /* A permutation and its inverse: who stands at a place, and where a rank stands. */
    for (int i = 0; i < P; i++) g->member[i] = i;
    if (random) shuffle(g->member, P, job->spec->seed);
    for (int i = 0; i < P; i++) g->place[g->member[i]] = i;
    job->shared = g;
    return true;
}

static bool prepare(struct kernel_job *job, struct arena *a, struct err *e)
{
    (void)e;
    return prepare_order(job, a, false);
}

static bool prepare_random(struct kernel_job *job, struct arena *a, struct err *e)
{
    (void)e;
    return prepare_order(job, a, true);
}

/* One message that leaves, two that arrive. */
static size_t workspace_bytes(const void *job, int rank)
{
    (void)rank;
    return 3 * (size_t)message_bytes(job) + 16;
}

/* neighbour: `step` places further round the ring of rank `rank`; rings differ by one place at
 * most. */
static int neighbour(const struct ring *g, int P, int rank, int step)
{
    /* Ring r covers the places floor(r P / R) .. floor((r+1) P / R) - 1 of R rings: sizes differ by
     * at most one. 64 bits, since P times R may pass 2^31. */
    const int64_t place = g->place[rank], ring = ((place + 1) * g->nring - 1) / P;
    const int64_t first = ring * P / g->nring, n = (ring + 1) * P / g->nring - first;
    return g->member[first + (place - first + step + n) % n];
}

static void run(struct comm *c, const void *job_, void *workspace)
{
    const struct kernel_job *job = job_;
    const int P = comm_size(c), rank = comm_rank(c), repeat = repetitions(job->spec);
    const int left = neighbour(job->shared, P, rank, -1),
              right = neighbour(job->shared, P, rank, 1);
    const int64_t bytes = message_bytes(job), begin = comm_now_ps(c);
    char *out = workspace, *in = out + bytes;
    for (int k = 0; k < repeat; k++) {
        /* Both receives before both sends: all four messages of a rank are under way at once. */
        struct comm_request r[4] = {{0}};
        comm_irecv(c, left, TAG_BENCH, in, bytes, &r[0]);
        comm_irecv(c, right, TAG_BENCH + 1, in + bytes, bytes, &r[1]);
        comm_isend(c, right, TAG_BENCH, out, bytes, &r[2]);
        comm_isend(c, left, TAG_BENCH + 1, out, bytes, &r[3]);
        comm_waitall(c, 4, r);
    }
    /* Simulated picoseconds to seconds; one exchange is four messages of this rank. */
    const double seconds = (double)(comm_now_ps(c) - begin) * 1e-12 / repeat;
    comm_publish(c, OUTPUT_SECONDS, rank, 1, &seconds);
}

/* Two messages leave every rank in every repetition; nothing is computed. */
static void estimate(const struct run_spec *spec, const struct model *model,
                     const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    *out = (struct program_estimate){.messages = 2.0 * spec->nrank * repetitions(spec)};
    out->bytes = out->messages * (double)spec->kernel.message_bytes;
    out->rank_bytes = 3.0 * (double)spec->kernel.message_bytes + 16;
}

/* Two programs that differ in the order of the ring alone. */
#define RING(stem, word, prepare_, text)                                                           \
    const struct kernel_type stem##_kernel = {                                                     \
        .name = word,                                                                              \
        .title = text,                                                                             \
        .rank = {.nstage = 1,                                                                      \
                 .stage_name = stage_name,                                                         \
                 .workspace_bytes = workspace_bytes,                                               \
                 .run = run},                                                                      \
        .accepts = accepts,                                                                        \
        .prepare = prepare_,                                                                       \
        .estimate = estimate,                                                                      \
    };                                                                                             \
    const struct program_type stem##_program = MICRO_PROGRAM(stem, word, text)

RING(ring, "ring", prepare, "every rank sends to both its neighbours in a ring");
RING(random_ring, "random-ring", prepare_random,
     "every rank sends to both its neighbours in a ring of random order");
