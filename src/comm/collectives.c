/* collectives.c - which algorithm runs: tables by name, the machine's rules, MPICH's thresholds.
 *
 * In the files of the algorithms times are given by the usual model: alpha for a message, beta for
 * a byte on the way, gamma for a byte combined; n bytes of the vector (or b of a block), P ranks,
 * lg = ceil(log2 P). They assume no contention and one message in and out at a time; the simulated
 * machine decides itself. */
#include "comm/collectives.h"

#include "base/check.h"
#include "comm/collectives_internal.h"

/* In the order of enum collective_kind, as the table below. */
static const char *const name[COLLECTIVE_KINDS] = {
    "barrier", "broadcast", "reduce",   "allreduce", "gather",
    "scatter", "allgather", "alltoall", "scan",      "reduce-scatter"};

/* Each collective's file ends with its table. */
static const struct collective_table *const table[COLLECTIVE_KINDS] = {
    &barrier_algorithms, &broadcast_algorithms,      &reduce_algorithms,    &allreduce_algorithms,
    &gather_algorithms,  &scatter_algorithms,        &allgather_algorithms, &alltoall_algorithms,
    &scan_algorithms,    &reduce_scatter_algorithms,
};

const char *collective_name(enum collective_kind kind) { return name[kind]; }

/* COLLECTIVE_KINDS, one past the last, says that there is none. */
enum collective_kind collective_find(const char *wanted)
{
    int k = 0;
    while (k < COLLECTIVE_KINDS && strcmp(name[k], wanted) != 0) k++;
    return (enum collective_kind)k;
}

const struct collective_algorithm *collective_algorithms(enum collective_kind kind, int *n)
{
    *n = table[kind]->n;
    return table[kind]->row;
}

const struct collective_algorithm *collective_algorithm_find(enum collective_kind kind,
                                                             const char *wanted)
{
    return collective_in_table(table[kind], wanted);
}

/* Most algorithms take anything. */
bool collective_applies(const struct collective_algorithm *a, const struct collective_shape *s)
{
    return !a->applies || a->applies(s);
}

/* What ranks do not know of each other's blocks must not decide: all ranks must take the same
 * algorithm. Irregular blocks therefore count as none. */
int64_t collective_shape_bytes(const struct collective_shape *s)
{
    switch (s->kind) {
    case COLLECTIVE_BARRIER:
        return 0;
    case COLLECTIVE_ALLGATHER:
    case COLLECTIVE_REDUCE_SCATTER:
        /* Every rank knows the sum of all blocks here. */
        return s->total * s->element;
    default:
        return s->irregular ? 0 : s->count * s->element;
    }
}

/* MPICH's thresholds (Thakur, Rabenseifner, Gropp 2005, and its control variables): [B]. */
enum {
    BROADCAST_SHORT = 12288,
    BROADCAST_LONG = 524288,
    BROADCAST_MIN_RANKS = 8,
    REDUCE_SHORT = 2048,
    ALLGATHER_SHORT = 81920,
    ALLGATHER_LONG = 524288,
    ALLTOALL_SHORT = 256,
    ALLTOALL_MIN_RANKS = 8,
    ALLTOALL_MEDIUM = 32768,
    REDUCE_SCATTER_LONG = 524288
};

/* Short vectors: few messages. Long ones: every byte leaves the root about once. */
static const char *broadcast_choice(int64_t bytes, int P)
{
    if (bytes < BROADCAST_SHORT || P < BROADCAST_MIN_RANKS) return "binomial";
    return bytes < BROADCAST_LONG && is_power_of_two(P) ? "scatter-recursive-doubling"
                                                        : "scatter-allgather";
}

/* Splitting a vector pays off from a size on, and needs an element for every rank of the largest
 * power of two. */
static const char *reduce_choice(const struct collective_shape *s, int64_t bytes, const char *small)
{
    bool splits = bytes > REDUCE_SHORT && s->commutative && s->count >= 1 << log2_floor(s->size);
    return splits ? "rabenseifner" : small;
}

/* Recursive doubling needs a power of two; Bruck does not but moves blocks within the rank; a ring
 * only talks to neighbours. */
static const char *allgather_choice(const struct collective_shape *s, int64_t bytes)
{
    if (s->irregular) return "ring";
    if (bytes < ALLGATHER_LONG && is_power_of_two(s->size)) return "recursive-doubling";
    return bytes < ALLGATHER_SHORT ? "bruck" : "ring";
}

/* Bruck: lg messages that carry each byte several times. Medium sizes all at once, long ones in
 * rounds, so that no rank is sent to by all others at the same time. */
static const char *alltoall_choice(const struct collective_shape *s, int64_t bytes)
{
    if (s->irregular) return "linear";
    if (bytes <= ALLTOALL_SHORT && s->size >= ALLTOALL_MIN_RANKS) return "bruck";
    return bytes <= ALLTOALL_MEDIUM ? "linear" : is_power_of_two(s->size) ? "xor" : "pairwise";
}

/* What MPICH would take; every name here applies to the shape it is chosen for. */
static const char *default_choice(const struct collective_shape *s)
{
    int64_t bytes = collective_shape_bytes(s);
    switch (s->kind) {
    case COLLECTIVE_BARRIER:
        return "dissemination";
    case COLLECTIVE_BROADCAST:
        return broadcast_choice(bytes, s->size);
    case COLLECTIVE_REDUCE:
        return reduce_choice(s, bytes, "binomial");
    case COLLECTIVE_ALLREDUCE:
        return reduce_choice(s, bytes, "recursive-doubling");
    /* Trees carry equal blocks only. */
    case COLLECTIVE_GATHER:
    case COLLECTIVE_SCATTER:
        return s->irregular ? "linear" : "binomial";
    case COLLECTIVE_ALLGATHER:
        return allgather_choice(s, bytes);
    case COLLECTIVE_ALLTOALL:
        return alltoall_choice(s, bytes);
    case COLLECTIVE_SCAN:
        return "recursive-doubling";
    case COLLECTIVE_REDUCE_SCATTER:
        /* Only a tree in the order of ranks keeps that order. */
        if (!s->commutative) return "reduce-then-scatter";
        return bytes < REDUCE_SCATTER_LONG ? "recursive-halving" : "pairwise";
    case COLLECTIVE_KINDS:
        break;
    }
    return "";
}

const struct collective_algorithm *collective_choose(const struct collective_shape *s,
                                                     const struct collective_rule *rule, int n)
{
    int64_t bytes = collective_shape_bytes(s);
    /* From the last rule. One whose algorithm cannot do this call is passed over. */
    for (int i = n - 1; i >= 0; i--)
        if (rule[i].kind == s->kind && bytes >= rule[i].from_bytes &&
            s->size >= rule[i].from_ranks && collective_applies(rule[i].algorithm, s))
            return rule[i].algorithm;
    const struct collective_algorithm *a = collective_algorithm_find(s->kind, default_choice(s));
    /* A default that does not apply is a mistake in the lines above. */
    CHECK(a && collective_applies(a, s));
    return a;
}

/* The caller's memory: algorithms allocate nothing while the clock runs. */
int64_t collective_scratch(const struct collective_algorithm *a, const struct collective_shape *s,
                           int rank)
{
    return a->scratch ? a->scratch(s, rank) : 0;
}

/* run_named: by an algorithm that is known to be there. */
static void run_named(const struct collective_call *k, const char *algorithm)
{
    const struct collective_algorithm *a = collective_algorithm_find(k->kind, algorithm);
    CHECK(a);
    a->run(k);
}

/* What a network would do where there is none to do it, as on a real computer: messages that give
 * the same bits. */
static void run_without_hardware(const struct collective_call *k)
{
    struct collective_call call = *k;
    switch (k->kind) {
    case COLLECTIVE_BARRIER:
        run_named(k, "dissemination");
        return;
    case COLLECTIVE_BROADCAST:
        run_named(k, "binomial");
        return;
    case COLLECTIVE_REDUCE:
        /* To another rank than 0 in the order of a tree at 0: everybody gets it. */
        call.kind = COLLECTIVE_ALLREDUCE;
        if (comm_rank(k->comm) != k->root) call.recv = at(k, k->scratch, k->count);
        break;
    default:
        break;
    }
    run_named(&call, "reduce-broadcast");
}

/* The caller has chosen: by rules (collective_choose) or by name. */
void collective_run(const struct collective_algorithm *a, const struct collective_call *k)
{
    const bool network = k->comm->type->meet && k->comm->hardware;
    if (collective_by_network(a) && !network) run_without_hardware(k);
    else a->run(k);
}

void collective_barrier(struct comm *c, int64_t tag)
{
    run_named(&(struct collective_call){.kind = COLLECTIVE_BARRIER, .comm = c, .tag = tag},
              "dissemination");
}

/* Short forms for programs that want one fixed algorithm, whatever the machine's rules say: the
 * kernels, whose messages are counted in closed form. */
void collective_broadcast(struct comm *c, int root, int64_t tag, void *data, int64_t bytes)
{
    struct collective_call k = {.kind = COLLECTIVE_BROADCAST, .comm = c, .tag = tag, .root = root};
    k.count = bytes;
    k.element = 1;
    k.recv = data;
    run_named(&k, "binomial");
}

/* One addition an element, counted as the work of whoever combines. */
static void add_doubles(void *into, const void *with, bool before, int64_t n, void *context,
                        struct work *w)
{
    double *sum = into;
    const double *x = with;
    (void)before, (void)context;
    for (int64_t i = 0; i < n; i++) sum[i] += x[i];
    w->flop += (uint64_t)n;
}

enum { SUM_CHUNK = 64 };

void collective_sum(struct comm *c, int64_t tag, double *data, int n)
{
    const struct collective_op add = {.combine = add_doubles, .commutative = true};
    double scratch[2 * SUM_CHUNK];
    struct collective_call k = {
        .kind = COLLECTIVE_REDUCE, .comm = c, .tag = tag, .element = sizeof *data, .op = &add};
    k.scratch = scratch;
    /* In pieces, so that the scratch fits on a fiber's small stack. */
    for (int first = 0; first < n; first += SUM_CHUNK) {
        k.send = k.recv = data + first;
        k.count = n - first < SUM_CHUNK ? n - first : SUM_CHUNK;
        run_named(&k, "binomial");
    }
    /* The sums of rank 0 to all: every rank has the same bits. */
    collective_broadcast(c, 0, tag + 1, data, n * (int64_t)sizeof *data);
}
