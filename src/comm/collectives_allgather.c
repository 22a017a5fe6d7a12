/* collectives_allgather.c - every rank's block to all.
 *
 * All algorithms move (P - 1) b bytes into each rank; they differ in the number of messages (lg or
 * P - 1) and in who talks to whom: neighbours (ring), ranks at distances 2^j (recursive doubling,
 * Bruck), everybody (linear). Short blocks want few messages, long ones short ways. */
#include "comm/collectives_internal.h"

/* The own block, from send to its place in recv; free, as it may already lie there. */
static void own_block(const struct collective_call *k)
{
    own_copy(k, at(k, k->recv, block_place(k, comm_rank(k->comm))), k->send,
             block_count(k, comm_rank(k->comm)));
}

/* (P - 1) (alpha + b beta). What came in last goes on next; talks to neighbours only. */
static void ring(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_block(k);
    for (int step = 0; step < size - 1; step++) {
        int out = ring_down(rank, step, size), in = ring_down(rank, step + 1, size);
        exchange(k, 0, ring_up(rank, 1, size), at(k, k->recv, block_place(k, out)),
                 block_count(k, out), ring_down(rank, 1, size), at(k, k->recv, block_place(k, in)),
                 block_count(k, in));
    }
}

/* All algorithms bring every block to every rank once: bytes and path are the same, messages
 * differ. */
static void cost(const struct collective_shape *s, int64_t messages, int64_t rounds,
                 struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element;
    *out = (struct collective_cost){.messages = messages,
                                    .bytes = P * (P - 1) * block,
                                    .rounds = rounds,
                                    .path = (P - 1) * block};
}

/* One block a rank and round. */
static void ring_cost(const struct collective_shape *s, struct collective_cost *out)
{
    cost(s, (int64_t)s->size * (s->size - 1), s->size - 1, out);
}

/* lg alpha + (P - 1) b beta. After round j each rank has the 2^(j+1) blocks of its group, which lie
 * together; the partner's group is the neighbouring one. */
static void recursive_doubling(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_block(k);
    for (int mask = 1; mask < size; mask *= 2) {
        /* Groups of `mask` ranks exchange all that they have. */
        int mine = rank & ~(mask - 1), other = mine ^ mask;
        exchange(k, 0, rank ^ mask, at(k, k->recv, block_place(k, mine)), mask * k->count,
                 rank ^ mask, at(k, k->recv, block_place(k, other)), mask * k->count);
    }
}

/* One message a rank and round. */
static void recursive_doubling_cost(const struct collective_shape *s, struct collective_cost *out)
{
    cost(s, (int64_t)s->size * log2_floor(s->size), log2_floor(s->size), out);
}

/* Blocks in the order of distance from this rank. */
static int64_t all_blocks(const struct collective_shape *s, int rank)
{
    (void)rank;
    return s->total * s->element;
}

/* scratch: the blocks of this rank and of those above it; twice as many a round. lg alpha + (P - 1)
 * b beta for any P, and a turn of all blocks at the end, since they begin with the own one. */
static void bruck(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    if (size > 1) copy(k, k->scratch, k->send, k->count);
    else own_block(k);
    for (int have = 1; have < size; have *= 2) {
        /* The last round of a P that is no power of two fetches the rest only. */
        int n = have < size - have ? have : size - have;
        exchange(k, 0, ring_down(rank, have, size), k->scratch, n * k->count,
                 ring_up(rank, have, size), at(k, k->scratch, have * k->count), n * k->count);
    }
    for (int d = 0; size > 1 && d < size; d++)
        copy(k, at(k, k->recv, block_place(k, ring_up(rank, d, size))),
             at(k, k->scratch, d * k->count), k->count);
}

/* Copied: the own block at first, all blocks in the turn at the end. */
static void bruck_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size;
    cost(s, P * log2_ceil(s->size), log2_ceil(s->size), out);
    out->copied = P > 1 ? P * (P + 1) * s->count * s->element : 0;
}

/* Every block straight to everybody, the next rank first: no two ranks begin with the same
 * receiver. As many rounds as the ring, (P - 1) (alpha + b beta), over longer ways. */
static void linear(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_block(k);
    for (int d = 1; d < size; d++) {
        int dst = ring_up(rank, d, size), src = ring_down(rank, d, size);
        exchange(k, 0, dst, at(k, k->recv, block_place(k, rank)), block_count(k, rank), src,
                 at(k, k->recv, block_place(k, src)), block_count(k, src));
    }
}

static const struct collective_algorithm rows[] = {
    {"recursive-doubling", "equal blocks, a power of two of ranks",
     "Thakur, Rabenseifner, Gropp 2005", needs_regular_power_of_two, NULL, recursive_doubling,
     recursive_doubling_cost},
    {"bruck", "equal blocks", "Bruck et al. 1997", needs_regular, all_blocks, bruck, bruck_cost},
    {"ring", NULL, "Thakur, Rabenseifner, Gropp 2005", NULL, NULL, ring, ring_cost},
    {"linear", NULL, "everybody to everybody", NULL, NULL, linear, ring_cost},
};
COLLECTIVE_TABLE(allgather_algorithms, rows);
