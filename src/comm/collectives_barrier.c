/* collectives_barrier.c - barriers out of empty messages.
 *
 * No rank may leave before all have come: every rank must hear of every other, which takes at least
 * lg rounds. Hardware barriers are the machine's (vp), not in here. */
#include "comm/collectives_internal.h"

/* lg alpha for any P: after round j each rank has heard, directly or not, of the 2^(j+1) - 1 ranks
 * below it and of itself. */
static void dissemination(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    for (int distance = 1, round = 0; distance < size; distance *= 2, round++) {
        give(k, round, ring_up(rank, distance, size), NULL, 0);
        take(k, round, ring_down(rank, distance, size), NULL, 0);
    }
}

/* Empty messages: the bytes of headers are the network's business. */
static void dissemination_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int rounds = log2_ceil(s->size);
    *out = (struct collective_cost){.messages = (int64_t)s->size * rounds, .rounds = rounds};
}

/* 2 (P - 1) alpha, all at rank 0: a central counter. */
static void linear(const struct collective_call *k)
{
    int size = comm_size(k->comm);
    if (comm_rank(k->comm) != 0) {
        give(k, 0, 0, NULL, 0);
        take(k, 1, 0, NULL, 0);
        return;
    }
    for (int r = 1; r < size; r++) take(k, 0, r, NULL, 0);
    for (int r = 1; r < size; r++) give(k, 1, r, NULL, 0);
}

static void linear_cost(const struct collective_shape *s, struct collective_cost *out)
{
    *out = (struct collective_cost){.messages = 2 * (int64_t)(s->size - 1),
                                    .rounds = 2 * (s->size - 1)};
}

/* Up a binomial tree to rank 0 and down again: 2 lg alpha, and the least messages of all: 2 (P -
 * 1). Rank 0 knows first that all have come; the others learn it level by level. */
static void binomial(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm), mask = 1;
    for (; mask < size && !(rank & mask); mask *= 2)
        if (rank + mask < size) take(k, 0, rank + mask, NULL, 0);
    /* The subtree is complete: report, and wait for the release. */
    if (rank) {
        give(k, 0, rank - mask, NULL, 0);
        take(k, 1, rank - mask, NULL, 0);
    }
    for (mask /= 2; mask > 0; mask /= 2)
        if (rank + mask < size) give(k, 1, rank + mask, NULL, 0);
}

/* Every edge of the tree once up and once down. */
static void binomial_cost(const struct collective_shape *s, struct collective_cost *out)
{
    *out = (struct collective_cost){.messages = 2 * (int64_t)(s->size - 1),
                                    .rounds = 2 * log2_ceil(s->size)};
}

/* Pairs; a P that is no power of two costs two rounds more (fold). */
static void recursive_doubling(const struct collective_call *k)
{
    struct fold f = fold_make(comm_rank(k->comm), comm_size(k->comm));
    fold_in(k, &f, 0, NULL, NULL, 0);
    for (int mask = 1; f.rank >= 0 && mask < f.core; mask *= 2) {
        int peer = fold_actual(&f, f.rank ^ mask);
        exchange(k, 1, peer, NULL, 0, peer, NULL, 0);
    }
    fold_out(k, &f, 2, NULL, 0);
}

static void recursive_doubling_cost(const struct collective_shape *s, struct collective_cost *out)
{
    struct fold f = fold_make(0, s->size);
    int steps = log2_floor(f.core);
    *out = (struct collective_cost){.messages = (int64_t)f.core * steps + 2 * (int64_t)f.rest,
                                    .rounds = steps + (f.rest ? 2 : 0)};
}

static const struct collective_algorithm rows[] = {
    {"dissemination", NULL, "Hensgen, Finkel, Manber 1988", NULL, NULL, dissemination,
     dissemination_cost},
    {"recursive-doubling", NULL, "pairwise exchange: Brooks 1986", NULL, NULL, recursive_doubling,
     recursive_doubling_cost},
    {"binomial", NULL, "Culler et al. 1993", NULL, NULL, binomial, binomial_cost},
    {"linear", NULL, "central counter", NULL, NULL, linear, linear_cost},
    HARDWARE_ROW,
};
COLLECTIVE_TABLE(barrier_algorithms, rows);
