/* micro.c - micro-benchmarks of a machine's messages (micro.h).
 *
 * Patterns that are published for real machines, so that a machine file can be compared with
 * measurements: latency and rate (pingpong), one step of recursive doubling (shift), total
 * exchange, bisection, hot spot, barrier. Nobody looks at the data. */
#include "kernel/micro.h"

#include "comm/collectives.h"
#include "kernel/micro_program.h"
#include "kernel/tags.h"

static const char *const stage_name[] = {"exchange"};

static const struct kernel_spec *settings(const struct kernel_job *job)
{
    return &job->spec->kernel;
}
static int64_t message_bytes(const void *job) { return settings(job)->message_bytes; }
static int repetitions(const void *job)
{
    return settings(job)->repeat > 1 ? settings(job)->repeat : 1;
}

/* Every rank's workspace: the message that it sends, then the one that it receives. */
static size_t workspace_bytes(const void *job, int rank)
{
    (void)rank;
    return 2 * (size_t)message_bytes(job) + 16;
}

/* A benchmark of messages needs a partner; a barrier does not. */
static bool accepts(const struct kernel_job *job, struct err *e)
{
    const struct run_spec *spec = job->spec;
    if (spec->nrank < 2)
        return err_set(e, ERR_CONFIG, "%d ranks: a message needs at least two", spec->nrank);
    if (spec->kernel.message_bytes < 0)
        return err_set(e, ERR_CONFIG, "a message of %lld bytes",
                       (long long)spec->kernel.message_bytes);
    return true;
}

static bool accepts_barrier(const struct kernel_job *job, struct err *e)
{
    (void)job, (void)e;
    return true;
}

/* Pairs: with an odd number one rank would have no partner. */
static bool accepts_even(const struct kernel_job *job, struct err *e)
{
    const int ranks = job->spec->nrank;
    if (ranks % 2)
        return err_set(e, ERR_CONFIG, "bisection needs an even number of ranks, not %d", ranks);
    return accepts(job, e);
}

/* Nothing is shared between ranks but the settings. */
static bool prepare(struct kernel_job *job, struct arena *a, struct err *e)
{
    (void)job, (void)a, (void)e;
    return true;
}

/* note: seconds per repetition since `begin`; `divisor` counts the messages that are timed one
 * after the other. One number per rank: the slowest is the result. */
static void note(struct comm *c, int64_t begin_ps, double divisor)
{
    const double seconds = (double)(comm_now_ps(c) - begin_ps) * 1e-12 / divisor;
    comm_publish(c, OUTPUT_SECONDS, comm_rank(c), 1, &seconds);
}

/* There and back, so that no two clocks need to agree; half of it is one message. */
static void pingpong_run(struct comm *c, const void *job, void *workspace)
{
    const int64_t bytes = message_bytes(job), begin = comm_now_ps(c);
    const int repeat = repetitions(job), rank = comm_rank(c), last = comm_size(c) - 1;
    char *in = (char *)workspace + bytes;
    if (rank != 0 && rank != last) return;
    for (int k = 0; k < repeat; k++) {
        if (rank == 0) comm_send(c, last, TAG_BENCH, workspace, bytes);
        comm_recv(c, rank == 0 ? last : 0, TAG_BENCH, in, bytes);
        if (rank == last) comm_send(c, 0, TAG_BENCH, workspace, bytes);
    }
    note(c, begin, 2.0 * repeat);
}

/* exchange: send to `dst`, receive from `src`, and wait for both. The receive is posted first, as
 * good programs do: a message that finds its receive needs no copy. */
static void exchange(struct comm *c, int dst, int src, void *workspace, int64_t bytes)
{
    struct comm_request request[2] = {{0}};
    comm_irecv(c, src, TAG_BENCH, (char *)workspace + bytes, bytes, &request[0]);
    comm_isend(c, dst, TAG_BENCH, workspace, bytes, &request[1]);
    comm_waitall(c, 2, request);
}

/* Every rank both sends and receives in every repetition: a permutation, the pattern of one step of
 * recursive doubling when the distance is a power of two. */
static void shift_run(struct comm *c, const void *job, void *workspace)
{
    const int P = comm_size(c), rank = comm_rank(c), repeat = repetitions(job);
    /* Distance modulo P, also for negative ones; 0 would be a message to oneself. */
    const int distance = (settings(job)->distance % P + P) % P;
    const int64_t begin = comm_now_ps(c);
    for (int k = 0; k < repeat && distance != 0; k++)
        exchange(c, (rank + distance) % P, (rank - distance + P) % P, workspace,
                 message_bytes(job));
    note(c, begin, repeat);
}

/* P (P - 1) messages a repetition; half of all bytes cross the bisection. */
static void all_to_all_run(struct comm *c, const void *job, void *workspace)
{
    const int repeat = repetitions(job);
    const int64_t begin = comm_now_ps(c);
    struct collective_call call = {
        .kind = COLLECTIVE_ALLTOALL, .comm = c, .tag = TAG_BENCH, .one_place = true};
    /* Bytes as elements: nothing is combined. */
    call.count = message_bytes(job);
    call.element = 1;
    call.send = workspace;
    call.recv = (char *)workspace + message_bytes(job);
    /* Pairwise exchange whatever the machine's rules say: this benchmark has one definition. */
    const struct collective_algorithm *pairwise =
        collective_algorithm_find(COLLECTIVE_ALLTOALL, "pairwise");
    for (int k = 0; k < repeat; k++) collective_run(pairwise, &call);
    note(c, begin, repeat);
}

static void bisection_run(struct comm *c, const void *job, void *workspace)
{
    const int P = comm_size(c), peer = (comm_rank(c) + P / 2) % P, repeat = repetitions(job);
    const int64_t begin = comm_now_ps(c);
    /* Rank i and rank i + P/2: every message crosses the middle of the numbering at the same
     * time. */
    for (int k = 0; k < repeat; k++) exchange(c, peer, peer, workspace, message_bytes(job));
    note(c, begin, repeat);
}

/* All to one: measures the receiver's overhead and its ejection port, not the network. */
static void hot_spot_run(struct comm *c, const void *job, void *workspace)
{
    const int P = comm_size(c), repeat = repetitions(job);
    const int64_t bytes = message_bytes(job), begin = comm_now_ps(c);
    for (int k = 0; k < repeat; k++) {
        /* The sends are waited for, so that rank 0's port is the bottleneck and not the senders'
         * memory. */
        if (comm_rank(c) != 0) {
            struct comm_request sent = {0};
            comm_isend(c, 0, TAG_BENCH, workspace, bytes, &sent);
            comm_wait(c, &sent);
            continue;
        }
        for (int src = 1; src < P; src++)
            comm_recv(c, src, TAG_BENCH, (char *)workspace + bytes, bytes);
    }
    note(c, begin, repeat);
}

/* The barrier belongs to the machine (hardware or messages), not to this file. */
static void barrier_run(struct comm *c, const void *job, void *workspace)
{
    (void)workspace;
    const int repeat = repetitions(job);
    const int64_t begin = comm_now_ps(c);
    for (int k = 0; k < repeat; k++) comm_barrier(c);
    note(c, begin, repeat);
}

/* estimate_messages: `messages` of the spec's size a repetition. No flops: nothing is computed. */
static void estimate_messages(const struct run_spec *spec, double messages,
                              struct program_estimate *out)
{
    /* At least once, as the programs do. */
    const double repeat = spec->kernel.repeat > 1 ? spec->kernel.repeat : 1;
    *out = (struct program_estimate){.messages = messages * repeat};
    out->bytes = out->messages * (double)spec->kernel.message_bytes;
    out->rank_bytes = 2.0 * (double)spec->kernel.message_bytes + 16;
}

/* There and back. */
static void estimate_pingpong(const struct run_spec *spec, const struct model *model,
                              const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    estimate_messages(spec, 2, out);
}

/* One message a rank, none when the distance is a multiple of P. */
static void estimate_shift(const struct run_spec *spec, const struct model *model,
                           const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    estimate_messages(spec, spec->kernel.distance % spec->nrank ? spec->nrank : 0, out);
}

static void estimate_all_to_all(const struct run_spec *spec, const struct model *model,
                                const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    estimate_messages(spec, (double)spec->nrank * (spec->nrank - 1), out);
}

static void estimate_bisection(const struct run_spec *spec, const struct model *model,
                               const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    estimate_messages(spec, spec->nrank, out);
}

static void estimate_hot_spot(const struct run_spec *spec, const struct model *model,
                              const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    estimate_messages(spec, spec->nrank - 1, out);
}

static void estimate_barrier(const struct run_spec *spec, const struct model *model,
                             const struct job_omit *omit, struct program_estimate *out)
{
    (void)spec, (void)model, (void)omit;
    /* a barrier's messages belong to the machine */
    *out = (struct program_estimate){.rank_bytes = 16};
}

#define MICRO(stem, word, text, accept)                                                            \
    const struct kernel_type stem##_kernel = {                                                     \
        .name = word,                                                                              \
        .title = text,                                                                             \
        .rank = {.nstage = 1,                                                                      \
                 .stage_name = stage_name,                                                         \
                 .workspace_bytes = workspace_bytes,                                               \
                 .run = stem##_run},                                                               \
        .accepts = accept,                                                                         \
        .prepare = prepare,                                                                        \
        .estimate = estimate_##stem,                                                               \
    };                                                                                             \
    const struct program_type stem##_program = MICRO_PROGRAM(stem, word, text)

MICRO(pingpong, "pingpong", "a message there and back between the first and the last rank",
      accepts);
MICRO(shift, "shift", "every rank sends to the rank a distance further", accepts);
MICRO(all_to_all, "all-to-all", "every rank sends to every other", accepts);
MICRO(bisection, "bisection", "the two halves of the machine exchange, rank by rank", accepts_even);
MICRO(hot_spot, "hot-spot", "every rank sends to rank 0", accepts);
MICRO(barrier, "barrier", "barriers", accepts_barrier);
