/* collectives_allreduce.c - all ranks' vectors combined, on every rank.
 *
 * Recursive doubling for short vectors, Rabenseifner's algorithm or a ring for long ones. The order
 * in which vectors are combined is part of each algorithm: results may differ by rounding between
 * algorithms, never between machines or runs. */
#include "comm/collectives_internal.h"

/* Room for what comes in, beside the sum in recv. */
static int64_t one_vector(const struct collective_shape *s, int rank)
{
    (void)rank;
    return s->count * s->element;
}

/* What comes in, and the accumulator of the ranks that are not root. */
static int64_t two_vectors(const struct collective_shape *s, int rank)
{
    return 2 * one_vector(s, rank);
}

/* lg (alpha + n beta + n gamma). Both partners combine the same two vectors, in the order of ranks,
 * so that all ranks get the same bits. */
static void recursive_doubling(const struct collective_call *k)
{
    struct fold f = fold_make(comm_rank(k->comm), comm_size(k->comm));
    own_copy(k, k->recv, k->send, k->count);
    fold_in(k, &f, 0, k->recv, k->scratch, k->count);
    for (int mask = 1; f.rank >= 0 && mask < f.core; mask *= 2) {
        int peer = fold_actual(&f, f.rank ^ mask);
        exchange(k, 1, peer, k->recv, k->count, peer, k->scratch, k->count);
        combine(k, k->recv, k->scratch, f.rank & mask, k->count);
    }
    fold_out(k, &f, 2, k->recv, k->count);
}

/* Ranks outside the core cost one message in and one out, and two rounds. */
static void recursive_doubling_cost(const struct collective_shape *s, struct collective_cost *out)
{
    struct fold f = fold_make(0, s->size);
    int64_t bytes = s->count * s->element, steps = log2_floor(f.core);
    *out = (struct collective_cost){.messages = f.core * steps + 2 * f.rest,
                                    .rounds = steps + (f.rest ? 2 : 0),
                                    .combined = (f.rest + f.core * steps) * s->count};
    out->bytes = out->messages * bytes;
    out->path = out->rounds * bytes;
}

/* 2 lg alpha + 2 (P-1)/P n beta + (P-1)/P n gamma: reduce-scatter by halves, allgather by doubling.
 * Twice the messages of recursive doubling, but each byte travels about twice instead of lg
 * times. */
static void rabenseifner(const struct collective_call *k)
{
    struct fold f = fold_make(comm_rank(k->comm), comm_size(k->comm));
    own_copy(k, k->recv, k->send, k->count);
    fold_in(k, &f, 0, k->recv, k->scratch, k->count);
    if (f.rank >= 0) {
        halve(k, &f, 1, k->recv, k->scratch, even_part);
        regrow(k, &f, 2, k->recv, even_part);
    }
    fold_out(k, &f, 3, k->recv, k->count);
}

/* The core exchanges twice (core - 1)/core of the vector; each rank outside adds two whole
 * vectors. */
static void rabenseifner_cost(const struct collective_shape *s, struct collective_cost *out)
{
    struct fold f = fold_make(0, s->size);
    int64_t bytes = s->count * s->element, steps = log2_floor(f.core), outside = f.rest ? 2 : 0;
    *out = (struct collective_cost){
        .messages = 2 * f.core * steps + 2 * f.rest,
        .bytes = 2 * (f.core - 1 + f.rest) * bytes,
        .rounds = 2 * steps + outside,
        .path = s->count % f.core ? -1 : 2 * (bytes - bytes / f.core) + outside * bytes,
        .combined = (s->size - 1) * s->count};
}

/* 2 (P - 1) alpha + 2 (P-1)/P n beta + (P-1)/P n gamma: each part goes round the ring twice, once
 * to be summed up and once to be given out. Least bytes, most messages. */
static void ring(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    int up = ring_up(rank, 1, size), down = ring_down(rank, 1, size);
    own_copy(k, k->recv, k->send, k->count);
    for (int step = 0; step < 2 * (size - 1); step++) {
        int out = ring_down(rank, step, size), in = ring_down(rank, step + 1, size);
        bool gathers = step >= size - 1; /* parts are complete from here on, and only passed on */
        /* Parts as even as they can be; empty ones are sent, too, to keep the rounds alike. */
        int64_t a = split(k->count, out, size), na = split(k->count, out + 1, size) - a;
        int64_t b = split(k->count, in, size), nb = split(k->count, in + 1, size) - b;
        /* Before the parts are complete they come into scratch, to be combined; afterwards in
         * place. */
        exchange(k, gathers, up, at(k, k->recv, a), na, down,
                 gathers ? at(k, k->recv, b) : k->scratch, nb);
        if (!gathers) combine(k, at(k, k->recv, b), k->scratch, true, nb);
    }
}

/* A path in closed form exists where all parts have one size. */
static void ring_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t bytes = s->count * s->element, P = s->size;
    *out = (struct collective_cost){.messages = 2 * P * (P - 1),
                                    .bytes = 2 * (P - 1) * bytes,
                                    .rounds = 2 * (P - 1),
                                    .path = s->count % P ? -1 : 2 * (bytes - bytes / P),
                                    .combined = (P - 1) * s->count};
}

/* Round j joins the results of the 2^j ranks up to here with those of the 2^j before: an element
 * may enter twice, hence only operations with a op a = a. lg (alpha + n beta + n gamma) for any P,
 * without a fold.
 *
 *     P = 3, what rank 0 has:   0   ->   2 0   ->   0 1 2 0     (0 has entered twice) */
static void dissemination(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_copy(k, k->recv, k->send, k->count);
    for (int distance = 1, round = 0; distance < size; distance *= 2, round++) {
        give(k, round, ring_up(rank, distance, size), k->recv, k->count);
        take(k, round, ring_down(rank, distance, size), k->scratch, k->count);
        combine(k, k->recv, k->scratch, true, k->count);
    }
}

/* Maxima, not sums; in any order. */
static bool counts_twice(const struct collective_shape *s)
{
    return s->commutative && s->idempotent;
}

/* Every rank sends and combines in every round. */
static void dissemination_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t bytes = s->count * s->element, rounds = log2_ceil(s->size);
    *out = (struct collective_cost){.messages = s->size * rounds,
                                    .bytes = s->size * rounds * bytes,
                                    .rounds = rounds,
                                    .path = rounds * bytes,
                                    .combined = s->size * rounds * s->count};
}

/* part: this call as one of another collective, with root 0. */
static struct collective_call part(const struct collective_call *k, enum collective_kind kind)
{
    struct collective_call c = *k;
    c.kind = kind;
    c.root = 0;
    return c;
}

/* 2 lg (alpha + n beta) + lg n gamma: what a program does that has no allreduce. */
static void reduce_broadcast(const struct collective_call *k)
{
    struct collective_call down = part(k, COLLECTIVE_BROADCAST), up = part(k, COLLECTIVE_REDUCE);
    collective_in_table(&reduce_algorithms, "binomial")->run(&up);
    down.tag += 2;
    collective_in_table(&broadcast_algorithms, "binomial")->run(&down);
}

/* Each vector goes up one edge of the tree and the result comes down it. */
static void reduce_broadcast_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t bytes = s->count * s->element, rounds = log2_ceil(s->size), P = s->size;
    *out = (struct collective_cost){.messages = 2 * (P - 1),
                                    .bytes = 2 * (P - 1) * bytes,
                                    .rounds = 2 * rounds,
                                    .path = 2 * rounds * bytes,
                                    .combined = (P - 1) * s->count};
}

static const struct collective_algorithm rows[] = {
    {"recursive-doubling", NULL, "Thakur, Rabenseifner, Gropp 2005", NULL, one_vector,
     recursive_doubling, recursive_doubling_cost},
    {"rabenseifner", "a commutative operation", "Rabenseifner 1997", needs_commutative, one_vector,
     rabenseifner, rabenseifner_cost},
    {"ring", "a commutative operation", "Patarasuk, Yuan 2009", needs_commutative, one_vector, ring,
     ring_cost},
    {"reduce-broadcast", NULL, "two binomial trees", NULL, two_vectors, reduce_broadcast,
     reduce_broadcast_cost},
    {"dissemination", "an operation with a op a = a", "Hensgen, Finkel, Manber 1988", counts_twice,
     one_vector, dissemination, dissemination_cost},
    HARDWARE_ROW,
};
COLLECTIVE_TABLE(allreduce_algorithms, rows);
