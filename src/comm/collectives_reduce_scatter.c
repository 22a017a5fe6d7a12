/* collectives_reduce_scatter.c - all ranks' vectors combined, a block of the result on each.
 *
 * n is the whole vector, b a block of it. Halving for short vectors, pairwise or a ring for long
 * ones; all of them combine in an order of their own, so that operations that do not commute go by
 * rank 0. */
#include "comm/collectives_internal.h"

/* What comes in. */
static int64_t one_block(const struct collective_shape *s, int rank)
{
    (void)rank;
    return s->count * s->element;
}

/* Round d: to each rank the block that is its own, the rank d up. (P - 1) (alpha + b (beta +
 * gamma)): long vectors; every byte travels once. */
static void pairwise(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    int64_t n = block_count(k, rank);
    own_copy(k, k->recv, at_const(k, k->send, block_place(k, rank)), n);
    for (int d = 1; d < size; d++) {
        int dst = ring_up(rank, d, size);
        exchange(k, 0, dst, at_const(k, k->send, block_place(k, dst)), block_count(k, dst),
                 ring_down(rank, d, size), k->scratch, n);
        combine(k, k->recv, k->scratch, true, n);
    }
}

/* Every rank sends to every other and combines what comes. */
static void pairwise_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element;
    *out = (struct collective_cost){.messages = P * (P - 1),
                                    .bytes = P * (P - 1) * block,
                                    .rounds = P - 1,
                                    .path = (P - 1) * block,
                                    .combined = P * (P - 1) * s->count};
}

static int64_t two_blocks(const struct collective_shape *s, int rank)
{
    return 2 * one_block(s, rank);
}

/* The block of a rank goes once around, from the rank behind it, and every rank adds its share. As
 * many messages as pairwise, to neighbours only. */
static void ring(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    struct collective_shape s = collective_shape(k);
    const void *out = at_const(k, k->send, block_place(k, ring_down(rank, 1, size)));
    for (int step = 0; step < size - 1; step++) {
        int sent = ring_down(rank, step + 1, size), got = ring_down(rank, step + 2, size);
        /* Two buffers in turn: one still leaves while the next comes in. */
        void *in = at(k, k->scratch, step % 2 * s.count);
        exchange(k, 0, ring_up(rank, 1, size), out, block_count(k, sent), ring_down(rank, 1, size),
                 in, block_count(k, got));
        combine(k, in, at_const(k, k->send, block_place(k, got)), false, block_count(k, got));
        out = in;
    }
    own_copy(k, k->recv, out, block_count(k, rank));
}

/* Part p of the core: the blocks of the ranks that its rank p works for: two for the first `rest`
 * of them, one for the others. */
static int64_t core_part(const struct collective_call *k, const struct fold *f, int part)
{
    return block_place(k, part < f->rest ? 2 * part : part + f->rest);
}

/* The vector that is worked on, and what comes in. */
static int64_t whole_vectors(const struct collective_shape *s, int rank)
{
    (void)rank;
    return 2 * s->total * s->element;
}

/* lg alpha + (P-1)/P n (beta + gamma): halving until each rank of the core has the blocks that it
 * works for, its own and perhaps that of a neighbour outside. */
static void recursive_halving(const struct collective_call *k)
{
    struct collective_shape s = collective_shape(k);
    int rank = comm_rank(k->comm);
    struct fold f = fold_make(rank, s.size);
    struct collective_call packed = *k; /* blocks lie behind one another in acc */
    void *acc = at(k, k->scratch, s.total);
    packed.places = NULL;
    for (int r = 0; r < s.size; r++)
        own_copy(k, at(k, acc, block_place(&packed, r)), at_const(k, k->send, block_place(k, r)),
                 block_count(k, r));
    fold_in(k, &f, 0, acc, k->scratch, s.total);
    if (f.rank >= 0) halve(&packed, &f, 1, acc, k->scratch, core_part);
    /* Sits out: its block comes from the neighbour that worked for it. */
    if (f.rank < 0) {
        take(k, 2, rank + 1, k->recv, block_count(k, rank));
        return;
    }
    own_copy(k, k->recv, at(k, acc, block_place(&packed, rank)), block_count(k, rank));
    if (rank < 2 * f.rest)
        give(k, 2, rank - 1, at(k, acc, block_place(&packed, rank - 1)), block_count(k, rank - 1));
}

static void recursive_halving_cost(const struct collective_shape *s, struct collective_cost *out)
{
    struct fold f = fold_make(0, s->size);
    int64_t steps = log2_floor(f.core), bytes = s->total * s->element,
            block = s->count * s->element;
    *out = (struct collective_cost){.messages = f.core * steps + 2 * f.rest,
                                    .bytes = (f.core - 1 + f.rest) * bytes + f.rest * block,
                                    .rounds = steps + (f.rest ? 2 : 0),
                                    .path = f.rest ? -1 : bytes - block,
                                    .combined = (int64_t)(s->size - 1) * s->total};
}

/* reduce to rank 0, then scatter; the result waits in the scratch's last vector. */
static int64_t three_vectors(const struct collective_shape *s, int rank)
{
    (void)rank;
    return 3 * s->total * s->element;
}

/* For operations that do not commute: everything to rank 0 in order, then out. Three vectors of
 * scratch on every rank, though only rank 0 needs the last one. */
static void reduce_then_scatter(const struct collective_call *k)
{
    struct collective_shape s = collective_shape(k);
    struct collective_call up = *k, down = *k, packed = *k;
    void *whole = at(k, k->scratch, 2 * s.total);
    packed.places = NULL;
    for (int r = 0; r < s.size; r++)
        own_copy(k, at(k, whole, block_place(&packed, r)), at_const(k, k->send, block_place(k, r)),
                 block_count(k, r));
    /* Blocks lie behind one another: one vector for the reduction. */
    up.kind = COLLECTIVE_REDUCE, up.root = 0;
    up.send = up.recv = whole;
    up.counts = up.places = NULL;
    up.count = s.total;
    collective_in_table(&reduce_algorithms, "binomial")->run(&up);
    down.kind = COLLECTIVE_SCATTER, down.root = 0, down.tag += 2;
    down.send = whole;
    down.places = NULL;
    down.count = block_count(k, comm_rank(k->comm));
    collective_in_table(&scatter_algorithms, s.irregular ? "linear" : "binomial")->run(&down);
}

/* Sums of the two trees. */
static void reduce_then_scatter_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element, bytes = s->total * s->element,
            rounds = log2_ceil(s->size);
    *out =
        (struct collective_cost){.messages = 2 * (P - 1),
                                 .bytes = (P - 1) * bytes + binomial_block_count(s->size) * block,
                                 .rounds = 2 * rounds,
                                 .path = rounds * bytes + (P - 1) * block,
                                 .combined = (P - 1) * s->total,
                                 .copied = P > 1 ? bytes : 0};
}

static const struct collective_algorithm rows[] = {
    {"recursive-halving", "a commutative operation", "Thakur, Rabenseifner, Gropp 2005",
     needs_commutative, whole_vectors, recursive_halving, recursive_halving_cost},
    {"pairwise", "a commutative operation", "Thakur, Rabenseifner, Gropp 2005", needs_commutative,
     one_block, pairwise, pairwise_cost},
    {"ring", "a commutative operation", "Patarasuk, Yuan 2009", needs_commutative, two_blocks, ring,
     pairwise_cost},
    {"reduce-then-scatter", NULL, "two binomial trees", NULL, three_vectors, reduce_then_scatter,
     reduce_then_scatter_cost},
};
COLLECTIVE_TABLE(reduce_scatter_algorithms, rows);
