/* collectives_scan.c - each rank gets the ranks' vectors up to its own combined, with or without
 * its own.
 *
 * Both algorithms combine in the order of ranks: no commutativity is needed. The parallel
 * Newton-Euler sweeps have a scan of their own, which also composes transforms (kernel/scan.c). */
#include "comm/collectives_internal.h"

/* The partial sum of the ranks up to here, and what comes in. */
static int64_t two_vectors(const struct collective_shape *s, int rank)
{
    (void)rank;
    return 2 * s->count * s->element;
}

/* The prefix comes from the rank before and goes on to the one behind. scratch: the prefix with the
 * own element. (P - 1) (alpha + n beta + n gamma): serial, but each rank works once. Least bytes
 * and least work of all scans. */
static void linear(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    void *prefix = k->scratch, *in = at(k, k->scratch, k->count);
    own_copy(k, prefix, k->send, k->count);
    if (rank > 0) {
        take(k, 0, rank - 1, in, k->count);
        /* The last rank of an exclusive scan adds its own to nothing. */
        if (!k->exclusive || rank + 1 < size) combine(k, prefix, in, true, k->count);
    }
    if (rank + 1 < size) give(k, 0, rank + 1, prefix, k->count);
    if (!k->exclusive) own_copy(k, k->recv, prefix, k->count);
    else if (rank > 0) own_copy(k, k->recv, in, k->count);
}

static void linear_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, bytes = s->count * s->element;
    int64_t last = s->exclusive && P > 1; /* the last rank needs nothing but what comes in */
    *out = (struct collective_cost){.messages = P - 1,
                                    .bytes = (P - 1) * bytes,
                                    .rounds = P - 1,
                                    .path = (P - 1) * bytes,
                                    .combined = (P - 1 - last) * s->count};
}

/* Round j: what the 2^j ranks up to here have goes 2^j ranks up (Kogge and Stone 1973; Hillis and
 * Steele 1986). lg (alpha + n beta + 2 n gamma): prefix and partial sum differ only where the own
 * element is left out. P = 4, inclusive, what rank 3 has: 3, then 2 3, then 0 1 2 3. */
static void recursive_doubling(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    void *partial = k->scratch, *in = at(k, k->scratch, k->count);
    own_copy(k, partial, k->send, k->count);
    if (!k->exclusive) own_copy(k, k->recv, k->send, k->count);
    for (int d = 1; d < size; d *= 2) {
        struct comm_request r[2] = {{0}};
        int64_t bytes = k->count * k->element;
        if (rank >= d) comm_irecv(k->comm, rank - d, k->tag, in, bytes, &r[0]);
        if (rank + d < size) comm_isend(k->comm, rank + d, k->tag, partial, bytes, &r[1]);
        comm_waitall(k->comm, 2, r);
        /* Nobody is that far below: this rank's prefix is complete. */
        if (rank < d) continue;
        /* Without the own element the first thing that arrives is the prefix. */
        if (k->exclusive && d == 1) own_copy(k, k->recv, in, k->count);
        else combine(k, k->recv, in, true, k->count);
        /* Nobody asks for the partial sum any more: not combined. */
        if (rank + 2 * d < size) combine(k, partial, in, true, k->count);
    }
}

/* Sums over the rounds of who receives, and of who combines twice. */
static void recursive_doubling_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, bytes = s->count * s->element;
    *out = (struct collective_cost){.rounds = log2_ceil(s->size)};
    for (int64_t d = 1; d < P; d *= 2) {
        out->messages += P - d;
        out->combined += (s->exclusive && d == 1 ? 0 : P - d) + (P > 3 * d ? P - 3 * d : 0);
    }
    out->combined *= s->count;
    out->bytes = out->messages * bytes;
    out->path = out->rounds * bytes;
}

static const struct collective_algorithm rows[] = {
    {"recursive-doubling", NULL, "Kogge, Stone 1973; Hillis, Steele 1986", NULL, two_vectors,
     recursive_doubling, recursive_doubling_cost},
    {"linear", NULL, "down the chain of ranks", NULL, two_vectors, linear, linear_cost},
};
COLLECTIVE_TABLE(scan_algorithms, rows);
