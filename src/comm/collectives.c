/* collectives.c - which algorithm runs: tables by name, the machine's rules, MPICH's thresholds. */
#include "comm/collectives.h"

#include "base/check.h"
#include "comm/collectives_internal.h"

static const char *const name[COLLECTIVE_KINDS] = {"barrier", "broadcast", "reduce",   "allreduce", "gather",
                                                   "scatter", "allgather", "alltoall", "scan",      "reduce-scatter"};

static const struct collective_table *const table[COLLECTIVE_KINDS] = {
    &barrier_algorithms, &broadcast_algorithms, &reduce_algorithms,   &allreduce_algorithms, &gather_algorithms,
    &scatter_algorithms, &allgather_algorithms, &alltoall_algorithms, &scan_algorithms,      &reduce_scatter_algorithms,
};

const char *collective_name(enum collective_kind kind) { return name[kind]; }

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

const struct collective_algorithm *collective_algorithm_find(enum collective_kind kind, const char *wanted)
{
    return collective_in_table(table[kind], wanted);
}

bool collective_applies(const struct collective_algorithm *a, const struct collective_shape *s)
{
    return !a->applies || a->applies(s);
}

/* What ranks do not know of each other's blocks must not decide. */
int64_t collective_shape_bytes(const struct collective_shape *s)
{
    switch (s->kind) {
    case COLLECTIVE_BARRIER:
        return 0;
    case COLLECTIVE_ALLGATHER:
    case COLLECTIVE_REDUCE_SCATTER:
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

static const char *broadcast_choice(int64_t bytes, int P)
{
    if (bytes < BROADCAST_SHORT || P < BROADCAST_MIN_RANKS) return "binomial";
    return bytes < BROADCAST_LONG && is_power_of_two(P) ? "scatter-recursive-doubling" : "scatter-allgather";
}

/* Splitting a vector pays off from a size on, and needs an element for every rank of the largest power of two. */
static const char *reduce_choice(const struct collective_shape *s, int64_t bytes, const char *small)
{
    bool splits = bytes > REDUCE_SHORT && s->commutative && s->count >= 1 << log2_floor(s->size);
    return splits ? "rabenseifner" : small;
}

static const char *allgather_choice(const struct collective_shape *s, int64_t bytes)
{
    if (s->irregular) return "ring";
    if (bytes < ALLGATHER_LONG && is_power_of_two(s->size)) return "recursive-doubling";
    return bytes < ALLGATHER_SHORT ? "bruck" : "ring";
}

static const char *alltoall_choice(const struct collective_shape *s, int64_t bytes)
{
    if (s->irregular) return "linear";
    if (bytes <= ALLTOALL_SHORT && s->size >= ALLTOALL_MIN_RANKS) return "bruck";
    return bytes <= ALLTOALL_MEDIUM ? "linear" : is_power_of_two(s->size) ? "xor" : "pairwise";
}

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
    for (int i = n - 1; i >= 0; i--)
        if (rule[i].kind == s->kind && bytes >= rule[i].from_bytes && s->size >= rule[i].from_ranks &&
            collective_applies(rule[i].algorithm, s))
            return rule[i].algorithm;
    const struct collective_algorithm *a = collective_algorithm_find(s->kind, default_choice(s));
    CHECK(a && collective_applies(a, s));
    return a;
}

int64_t collective_scratch(const struct collective_algorithm *a, const struct collective_shape *s, int rank)
{
    return a->scratch ? a->scratch(s, rank) : 0;
}

void collective_run(const struct collective_algorithm *a, const struct collective_call *k) { a->run(k); }

/* run_named: by an algorithm that is known to be there. */
static void run_named(const struct collective_call *k, const char *algorithm)
{
    const struct collective_algorithm *a = collective_algorithm_find(k->kind, algorithm);
    CHECK(a);
    a->run(k);
}

void collective_barrier(struct comm *c, int64_t tag)
{
    run_named(&(struct collective_call){.kind = COLLECTIVE_BARRIER, .comm = c, .tag = tag}, "dissemination");
}

void collective_broadcast(struct comm *c, int root, int64_t tag, void *data, int64_t bytes)
{
    struct collective_call k = {.kind = COLLECTIVE_BROADCAST, .comm = c, .tag = tag, .root = root};
    k.count = bytes;
    k.element = 1;
    k.recv = data;
    run_named(&k, "binomial");
}

static void add_doubles(void *into, const void *with, bool before, int64_t n, void *context, struct work *w)
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
    struct collective_call k = {.kind = COLLECTIVE_REDUCE, .comm = c, .tag = tag, .element = sizeof *data, .op = &add};
    k.scratch = scratch;
    for (int first = 0; first < n; first += SUM_CHUNK) {
        k.send = k.recv = data + first;
        k.count = n - first < SUM_CHUNK ? n - first : SUM_CHUNK;
        run_named(&k, "binomial");
    }
    collective_broadcast(c, 0, tag + 1, data, n * (int64_t)sizeof *data);
}
