/* micro_collective.c - micro-benchmarks of collectives (micro_collective.h): one program for all,
 * told by its name. */
#include "kernel/micro_collective.h"

#include <string.h>

#include "base/check.h"
#include "comm/collective_rules.h"
#include "kernel/carve.h"
#include "kernel/micro_program.h"
#include "kernel/tags.h"
#include "spec/collective_spec.h"

enum { STAGE_COLLECTIVE, STAGE_SYNCHRONISE, NSTAGE };
static const char *const stage_name[] = {"collective", "synchronise"};

/* What all ranks share: the algorithm chosen, before any rank runs. */
struct shared {
    const struct collective_algorithm *algorithm;
    struct collective_shape shape;
    struct collective_op op;
};

/* One rank's buffers. */
struct buffers {
    char *send, *recv, *scratch;
    int64_t *counts, *send_counts; /* alltoallv */
};

static bool is_varied(const struct run_spec *spec)
{
    return strcmp(spec->kernel.name, "alltoallv") == 0;
}

/* Names of programs and of collectives agree but for two. */
static enum collective_kind kind_of(const struct run_spec *spec)
{
    if (strcmp(spec->kernel.name, "message-barrier") == 0) return COLLECTIVE_BARRIER;
    return is_varied(spec) ? COLLECTIVE_ALLTOALL : collective_find(spec->kernel.name);
}

/* What the choice of an algorithm depends on. The element is the widest type that divides the
 * message, so that a vector of any number of bytes can be summed. */
struct collective_shape micro_collective_shape(const struct run_spec *spec)
{
    const int64_t bytes = spec->kernel.message_bytes;
    struct collective_shape s = {.kind = kind_of(spec), .size = spec->nrank, .commutative = true};
    s.element = bytes % 8 == 0 ? 8 : bytes % 4 == 0 ? 4 : 1;
    s.count = s.kind == COLLECTIVE_BARRIER ? 0 : bytes / s.element;
    s.total = s.count * s.size;
    /* A negative root counts from the last rank, as in the settings. */
    s.root = (spec->kernel.root % s.size + s.size) % s.size;
    s.irregular = is_varied(spec);
    s.operation = s.element == 1 ? COMM_INTEGER : COMM_REAL;
    return s;
}

/* An algorithm by name: an unknown one is refused with the list of names, one that does not fit
 * this number of ranks with what it needs. The error names what exists, because users type these
 * names. */
static const struct collective_algorithm *named(const struct run_spec *spec,
                                                const struct collective_shape *s, const char *name,
                                                struct err *e)
{
    char names[240];
    const struct collective_algorithm *a = collective_algorithm_find(s->kind, name);
    collective_algorithm_names(s->kind, names, (int)sizeof names);
    if (!a)
        err_set(e, ERR_CONFIG, "%s has no algorithm '%s'; expected auto, %s",
                collective_name(s->kind), name, names);
    else if (!collective_applies(a, s)) {
        char why[200];
        if (collective_by_network(a)) {
            collective_refusal(&spec->machine, s, why, (int)sizeof why);
            err_set(e, ERR_CONFIG, "%s by '%s': %s", collective_name(s->kind), name, why);
            return NULL;
        }
        err_set(e, ERR_CONFIG, "%s by '%s' on %d processors: it needs %s", collective_name(s->kind),
                name, s->size, a->needs);
        return NULL;
    }
    return a;
}

const struct collective_algorithm *micro_collective_algorithm(const struct run_spec *spec,
                                                              struct err *e)
{
    struct collective_rule rule[COLLECTIVE_MAX_RULES];
    const struct comm_hardware hardware = collective_hardware(&spec->machine);
    struct collective_shape s = micro_collective_shape(spec);
    const char *name = spec->kernel.algorithm;
    s.hardware = &hardware;
    /* An explicit name wins over the machine's rules; "auto" is the rules' choice. */
    char why[320];
    int n;
    if (*name && strcmp(name, "auto") != 0) return named(spec, &s, name, e);
    /* The machine's rules are text in its file: parsed here, once a run, and the choice is shared
     * by all ranks. */
    if (!collective_rules_parse(spec->machine.software.collectives, rule, &n, why,
                                (int)sizeof why)) {
        err_set(e, ERR_CONFIG, "machine.software.collectives: %s", why);
        return NULL;
    }
    return collective_choose(&s, rule, n);
}

/* Refused before the run: a bad size, a root outside, an algorithm that does not fit. */
static bool accepts(const struct kernel_job *job, struct err *e)
{
    const struct run_spec *spec = job->spec;
    const struct kernel_spec *k = &spec->kernel;
    if (k->message_bytes < 0)
        return err_set(e, ERR_CONFIG, "a message of %lld bytes", (long long)k->message_bytes);
    /* Beyond -P .. P-1 a root is a mistake, not a number to be taken modulo P. */
    if (k->root >= spec->nrank || k->root < -spec->nrank)
        return err_set(e, ERR_CONFIG, "kernel.root is %d, but there are %d ranks", k->root,
                       spec->nrank);
    return micro_collective_algorithm(spec, e) != NULL;
}

/* Sums of doubles, floats or bytes. */
static void add(void *into, const void *with, bool before, int64_t n, void *context, struct work *w)
{
    const int64_t element = *(const int64_t *)context;
    (void)before;
    /* One addition an element, whatever its type. */
    w->flop += (uint64_t)n;
    if (element == 8)
        for (int64_t i = 0; i < n; i++) ((double *)into)[i] += ((const double *)with)[i];
    else if (element == 4)
        for (int64_t i = 0; i < n; i++) ((float *)into)[i] += ((const float *)with)[i];
    else
        for (int64_t i = 0; i < n; i++)
            ((unsigned char *)into)[i] += ((const unsigned char *)with)[i];
}

static bool prepare(struct kernel_job *job, struct arena *a, struct err *e)
{
    struct shared *s = TAKE(a, 1, struct shared);
    s->shape = micro_collective_shape(job->spec);
    s->algorithm = micro_collective_algorithm(job->spec, e);
    s->op =
        (struct collective_op){.combine = add, .context = &s->shape.element, .commutative = true};
    s->op.operation = s->shape.operation;
    /* Read by all ranks; no rank changes it. */
    job->shared = s;
    return s->algorithm != NULL;
}

/* Blocks that nobody reads lie on one another, but where algorithms send several at once. */
static bool one_place(enum collective_kind kind)
{
    return kind == COLLECTIVE_GATHER || kind == COLLECTIVE_SCATTER || kind == COLLECTIVE_ALLTOALL;
}

/* Rooms for the largest of the ranks' roles. Reduce-scatter sends and allgather receives one block
 * for every rank; the others work on one block. */
static void carve_buffers(struct buffers *b, struct carve *c, const struct run_spec *spec,
                          const struct collective_algorithm *algorithm,
                          const struct collective_shape *s, int rank)
{
    const int64_t block = s->count * s->element, all = s->total * s->element;
    /* Blocks of alltoallv are at most twice the mean. */
    const int64_t largest = s->irregular ? 2 * block : block;
    b->send = CARVE(c, s->kind == COLLECTIVE_REDUCE_SCATTER ? all : largest, char);
    b->recv = CARVE(c, s->kind == COLLECTIVE_ALLGATHER ? all : largest, char);
    b->scratch = CARVE(c, collective_scratch(algorithm, s, rank), char);
    b->counts = CARVE(c, is_varied(spec) ? s->size : 0, int64_t);
    b->send_counts = CARVE(c, is_varied(spec) ? s->size : 0, int64_t);
}

/* Carving without a base measures (carve.h). */
static size_t workspace_bytes(const void *job_, int rank)
{
    const struct kernel_job *job = job_;
    const struct shared *s = job->shared;
    struct carve c = {0};
    struct buffers b;
    carve_buffers(&b, &c, job->spec, s->algorithm, &s->shape, rank);
    return c.used;
}

/* Elements from one rank to another, or back: it is the same. Sizes go from 0 to twice the mean in
 * equal steps over the other ranks, so that the total of a rank is that of equal blocks. */
static int64_t varied(const struct collective_shape *s, int r, int d)
{
    return s->size > 1 ? 2 * s->count * ((r + d) % s->size) / (s->size - 1) : s->count;
}

/* The call is made once: its buffers are the same in every repetition. */
static struct collective_call make_call(struct comm *c, const struct shared *s,
                                        const struct buffers *b)
{
    struct collective_call k = {
        .kind = s->shape.kind, .comm = c, .tag = TAG_BENCH, .root = s->shape.root};
    k.count = s->shape.count;
    k.element = s->shape.element;
    k.op = &s->op;
    k.one_place = one_place(k.kind);
    k.send = b->send;
    k.recv = b->recv;
    k.scratch = b->scratch;
    /* alltoallv: each rank knows both directions, as MPI requires. */
    for (int r = 0; s->shape.irregular && r < s->shape.size; r++)
        b->counts[r] = b->send_counts[r] = varied(&s->shape, comm_rank(c), r);
    if (s->shape.irregular) k.counts = b->counts, k.send_counts = b->send_counts;
    return k;
}

static int repetitions(const struct run_spec *spec)
{
    return spec->kernel.repeat > 1 ? spec->kernel.repeat : 1;
}

/* The collective alone is timed; barriers between repetitions are a stage of their own. */
static void run(struct comm *c, const void *job_, void *workspace)
{
    const struct kernel_job *job = job_;
    const struct shared *s = job->shared;
    const int repeat = repetitions(job->spec);
    int64_t spent = 0;
    struct carve carve = {.base = workspace};
    struct buffers b;
    /* The same carving as workspace_bytes, now with a base. */
    carve_buffers(&b, &carve, job->spec, s->algorithm, &s->shape, comm_rank(c));
    struct collective_call k = make_call(c, s, &b);
    for (int i = 0; i < repeat; i++) {
        /* Without the barrier a rank could begin the next collective while others still are in this
         * one, and the times would overlap. The barrier's time is not counted. */
        if (i > 0) {
            comm_stage(c, STAGE_SYNCHRONISE);
            comm_barrier(c);
        }
        comm_stage(c, STAGE_COLLECTIVE);
        int64_t begin = comm_now_ps(c);
        collective_run(s->algorithm, &k);
        spent += comm_now_ps(c) - begin;
    }
    const double seconds = (double)spent * 1e-12 / repeat;
    comm_publish(c, OUTPUT_SECONDS, comm_rank(c), 1, &seconds);
}

/* alltoallv: what the ring of all pairs carries, less what stays. Every row of the table of sizes
 * holds the same numbers, shifted, hence the product. */
static int64_t varied_bytes(const struct collective_shape *s)
{
    int64_t sum = 0;
    for (int r = 0; r < s->size; r++) sum += varied(s, r, 0);
    sum *= s->size;
    for (int r = 0; r < s->size; r++) sum -= varied(s, r, r);
    return sum * s->element;
}

static void estimate(const struct run_spec *spec, const struct model *model,
                     const struct job_omit *omit, struct program_estimate *out)
{
    (void)model, (void)omit;
    struct err e = {0};
    const struct collective_shape s = micro_collective_shape(spec);
    const struct collective_algorithm *a = micro_collective_algorithm(spec, &e);
    struct collective_cost cost = {0};
    struct carve c = {0};
    struct buffers b;
    *out = (struct program_estimate){0};
    err_clear(&e);
    if (!a) return;
    /* Each algorithm knows its own counts (comm/collectives.h). */
    a->cost(&s, &cost);
    if (s.irregular) cost.bytes = varied_bytes(&s);
    /* The root's workspace is the largest. */
    carve_buffers(&b, &c, spec, a, &s, s.root);
    const double repeat = repetitions(spec);
    out->messages = repeat * (double)cost.messages;
    out->bytes = repeat * (double)cost.bytes;
    out->flops = repeat * (double)cost.combined;
    out->rank_bytes = (double)c.used;
}

#define COLLECTIVE(stem, word, text)                                                               \
    const struct kernel_type stem##_kernel = {                                                     \
        .name = word,                                                                              \
        .title = text,                                                                             \
        .rank = {.nstage = NSTAGE,                                                                 \
                 .stage_name = stage_name,                                                         \
                 .workspace_bytes = workspace_bytes,                                               \
                 .run = run},                                                                      \
        .accepts = accepts,                                                                        \
        .prepare = prepare,                                                                        \
        .estimate = estimate,                                                                      \
    };                                                                                             \
    const struct program_type stem##_program = MICRO_PROGRAM(stem, word, text)

COLLECTIVE(broadcast, "broadcast", "one rank's vector to all");
COLLECTIVE(reduce, "reduce", "all ranks' vectors added up, on one rank");
COLLECTIVE(allreduce, "allreduce", "all ranks' vectors added up, on all");
COLLECTIVE(gather, "gather", "a block from every rank to one");
COLLECTIVE(scatter, "scatter", "a block from one rank to every other");
COLLECTIVE(allgather, "allgather", "a block from every rank to all");
COLLECTIVE(alltoall, "alltoall", "a block from every rank to every other, by the algorithm chosen");
COLLECTIVE(alltoallv, "alltoallv", "the same with blocks of different sizes");
COLLECTIVE(scan, "scan", "the ranks' vectors added up, up to each rank");
COLLECTIVE(reduce_scatter, "reduce-scatter",
           "all ranks' vectors added up, a block of the sum on each");
COLLECTIVE(message_barrier, "message-barrier",
           "a barrier out of messages, by the algorithm chosen");
