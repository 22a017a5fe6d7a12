/* collectives_reduce.c - all ranks' vectors combined, on one rank.
 *
 * As broadcast, backwards, with work on the way: a tree lets lg vectors be combined one after the
 * other on the longest way, Rabenseifner's algorithm gives each rank a part of the vector to
 * combine. */
#include "comm/collectives_internal.h"

/* Two vectors: what is combined so far, where that cannot be recv, and what came in. Every rank has
 * both, whatever its role, so that the size does not depend on the root. */
static int64_t two_vectors(const struct collective_shape *s, int rank)
{
    (void)rank;
    return 2 * s->count * s->element;
}

/* acc: recv on the root (or where all ranks get the answer), scratch elsewhere; begins as the own
 * vector. send is never written. */
static void *accumulator(const struct collective_call *k, bool here)
{
    void *acc = here ? k->recv : at(k, k->scratch, k->count);
    own_copy(k, acc, k->send, k->count);
    return acc;
}

/* The order of an operation that does not commute is kept by a tree with rank 0 at its root; the
 * answer then takes one more message to the root that was asked for. */
static int tree_root(const struct collective_shape *s) { return s->commutative ? s->root : 0; }

/* lg (alpha + n beta + n gamma). A child of relative rank r + mask holds the ranks behind those
 * that have been combined so far: the order is kept. */
static void binomial(const struct collective_call *k)
{
    struct collective_shape s = collective_shape(k);
    int rank = comm_rank(k->comm), root = tree_root(&s), relative = ring_down(rank, root, s.size),
        mask = 1;
    void *acc = accumulator(k, rank == k->root);
    for (; mask < s.size && !(relative & mask); mask *= 2) {
        if (relative + mask >= s.size) continue;
        take(k, 0, ring_up(relative + mask, root, s.size), k->scratch, k->count);
        combine(k, acc, k->scratch, false, k->count);
    }
    if (relative) give(k, 0, ring_up(relative - mask, root, s.size), acc, k->count);
    /* The tree's root is not the root that was asked for: one message more. */
    if (root == k->root) return;
    if (rank == root) give(k, 1, k->root, acc, k->count);
    if (rank == k->root) take(k, 1, root, k->recv, k->count);
}

/* A root that is not the tree's costs one more message. */
static void tree_cost(const struct collective_shape *s, int rounds, int further,
                      struct collective_cost *out)
{
    int64_t bytes = s->count * s->element, messages = s->size - 1 + further;
    *out = (struct collective_cost){.messages = messages,
                                    .bytes = messages * bytes,
                                    .rounds = rounds + further,
                                    .path = (rounds + further) * bytes,
                                    .combined = (s->size - 1) * s->count};
}

static void binomial_cost(const struct collective_shape *s, struct collective_cost *out)
{
    tree_cost(s, log2_ceil(s->size), tree_root(s) != s->root, out);
}

/* The root takes the others' vectors in the order of ranks; those before its own wait for it in
 * recv. (P - 1) (alpha + n beta + n gamma) at the root. */
static void linear(const struct collective_call *k)
{
    int size = comm_size(k->comm), rank = comm_rank(k->comm);
    if (rank != k->root) {
        give(k, 0, k->root, k->send, k->count);
        return;
    }
    /* send may be recv: the own vector is put aside first. */
    void *own = at(k, k->scratch, k->count);
    own_copy(k, own, k->send, k->count);
    for (int r = 0; r < size; r++) {
        if (r != rank) take(k, 0, r, r ? k->scratch : k->recv, k->count);
        if (r == 0 && rank == 0) own_copy(k, k->recv, own, k->count);
        if (r > 0) combine(k, k->recv, r == rank ? own : k->scratch, false, k->count);
    }
}

static void linear_cost(const struct collective_shape *s, struct collective_cost *out)
{
    tree_cost(s, s->size - 1, 0, out);
}

/* Down from the last rank to the first, then to the root: one vector at a time, no rank busy twice.
 * (P - 1) (alpha + n beta + n gamma), as a linear reduction, but no rank takes more than one
 * message. */
static void chain(const struct collective_call *k)
{
    int size = comm_size(k->comm), rank = comm_rank(k->comm);
    void *acc = accumulator(k, rank == k->root);
    if (rank + 1 < size) {
        take(k, 0, rank + 1, k->scratch, k->count);
        combine(k, acc, k->scratch, false, k->count);
    }
    if (rank > 0) give(k, 0, rank - 1, acc, k->count);
    if (k->root == 0) return;
    if (rank == 0) give(k, 1, k->root, acc, k->count);
    if (rank == k->root) take(k, 1, 0, k->recv, k->count);
}

/* As many rounds as a linear reduction, but spread over the ranks. */
static void chain_cost(const struct collective_shape *s, struct collective_cost *out)
{
    tree_cost(s, s->size - 1, s->root != 0, out);
}

/* The core's rank that parts are gathered to: the root, or its neighbour when it sits out. */
static int gather_rank(int root, int size)
{
    struct fold f = fold_make(root, size);
    return f.rank >= 0 ? f.rank : root / 2;
}

/* Each rank sends the parts it has to the rank that differs in the lowest bit in which it is not
 * `target`: a binomial tree whose root is the target. After round j whoever goes on has the parts
 * of 2^(j+1) ranks, which lie together. */
static void gather_parts(const struct collective_call *k, const struct fold *f, int target,
                         void *acc)
{
    for (int mask = 1; mask < f->core; mask *= 2) {
        int mine = f->rank & ~(mask - 1), other = mine ^ mask,
            peer = fold_actual(f, f->rank ^ mask);
        int64_t a = even_part(k, f, mine), b = even_part(k, f, other);
        /* This rank's way to the target begins with this bit: give and be done. */
        if ((f->rank ^ target) & mask) {
            give(k, 2, peer, at(k, acc, a), even_part(k, f, mine + mask) - a);
            return;
        }
        take(k, 2, peer, at(k, acc, b), even_part(k, f, other + mask) - b);
    }
}

/* 2 lg alpha + 2 (P-1)/P n beta + (P-1)/P n gamma: reduce-scatter by halves, gather by a tree. */
static void rabenseifner(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), target = gather_rank(k->root, comm_size(k->comm));
    struct fold f = fold_make(rank, comm_size(k->comm));
    void *acc = accumulator(k, rank == k->root);
    fold_in(k, &f, 0, acc, k->scratch, k->count);
    if (f.rank >= 0) {
        halve(k, &f, 1, acc, k->scratch, even_part);
        gather_parts(k, &f, target, acc);
    }
    /* A root that sits out gets the answer from its neighbour. */
    int holder = fold_actual(&f, target);
    if (holder == k->root) return;
    if (rank == holder) give(k, 3, k->root, acc, k->count);
    if (rank == k->root) take(k, 3, holder, acc, k->count);
}

/* Elements that gather_parts sends: each rank but the target sends once, what its subtree has
 * gathered. */
static int64_t gathered(const struct collective_shape *s, int core, int target)
{
    int64_t sum = 0;
    for (int r = 0; r < core; r++) {
        int mask = (r ^ target) & -(r ^ target), mine = r & ~(mask - 1);
        if (mask) sum += split(s->count, mine + mask, core) - split(s->count, mine, core);
    }
    return sum;
}

/* Messages of the fold, of the halving, of the gathering, and of the way to a root that sits
 * out. */
static void rabenseifner_cost(const struct collective_shape *s, struct collective_cost *out)
{
    struct fold f = fold_make(s->root, s->size);
    int steps = log2_floor(f.core), target = gather_rank(s->root, s->size), further = f.rank < 0;
    int64_t elements = (f.rest + f.core - 1 + further) * s->count + gathered(s, f.core, target);
    *out = (struct collective_cost){.messages =
                                        f.rest + (int64_t)f.core * steps + f.core - 1 + further,
                                    .bytes = elements * s->element,
                                    .rounds = 2 * steps + (f.rest > 0) + further,
                                    .combined = (int64_t)(s->size - 1) * s->count};
    out->path = s->count % f.core == 0
                    ? (2 * (s->count - s->count / f.core) + ((f.rest > 0) + further) * s->count) *
                          s->element
                    : -1;
}

static const struct collective_algorithm reduce_rows[] = {
    {"binomial", NULL, "Thakur, Rabenseifner, Gropp 2005", NULL, two_vectors, binomial,
     binomial_cost},
    {"rabenseifner", "a commutative operation", "Rabenseifner 1997", needs_commutative, two_vectors,
     rabenseifner, rabenseifner_cost},
    {"chain", NULL, "down a chain of ranks", NULL, two_vectors, chain, chain_cost},
    {"linear", NULL, "everybody to the root", NULL, two_vectors, linear, linear_cost},
    HARDWARE_ROW,
};
COLLECTIVE_TABLE(reduce_algorithms, reduce_rows);
