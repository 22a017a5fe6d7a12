/* collectives_alltoall.c - a block from every rank to every other.
 *
 * P (P - 1) blocks must cross the network. Directly each travels once, in P - 1 messages a rank;
 * Bruck's algorithm passes blocks on and needs lg messages, for blocks so short that only their
 * number counts. */
#include "comm/collectives_internal.h"

/* Places of blocks, in send and in recv: they may differ when blocks do. */
static const void *send_block(const struct collective_call *k, int r)
{
    return at_const(k, k->send, send_block_place(k, r));
}

static void *recv_block(const struct collective_call *k, int r)
{
    return at(k, k->recv, block_place(k, r));
}

static void own_block(const struct collective_call *k)
{
    int rank = comm_rank(k->comm);
    own_copy(k, recv_block(k, rank), send_block(k, rank), block_count(k, rank));
}

/* One block out, one block in. */
static void step(const struct collective_call *k, int dst, int src)
{
    exchange(k, 0, dst, send_block(k, dst), send_block_count(k, dst), src, recv_block(k, src),
             block_count(k, src));
}

/* Round d: to the rank d up, from the rank d down. (P - 1) (alpha + b beta); every round is a
 * permutation of the ranks. */
static void pairwise(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_block(k);
    for (int d = 1; d < size; d++) step(k, ring_up(rank, d, size), ring_down(rank, d, size));
}

/* Any order of direct messages has these counts. */
static void pairwise_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element;
    *out = (struct collective_cost){.messages = P * (P - 1),
                                    .bytes = P * (P - 1) * block,
                                    .rounds = P - 1,
                                    .path = (P - 1) * block};
}

/* Round d: with the rank whose number differs in the bits of d: pairs that exchange. */
static void xor_pairs(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    own_block(k);
    for (int d = 1; d < size; d++) step(k, rank ^ d, rank ^ d);
}

/* Requests of all receives and all sends. */
static int64_t requests(const struct collective_shape *s, int rank)
{
    (void)rank;
    return 2 * (s->size - 1) * (int64_t)sizeof(struct comm_request);
}

/* All receives, all sends, then all waits: the network orders the messages. Best for medium sizes
 * on a network that shares well; P - 1 open requests a rank. */
static void linear(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm), n = size - 1;
    own_block(k);
    if (n == 0) return; /* one rank has no scratch */
    struct comm_request *in = k->scratch, *out = in + n;
    for (int d = 1; d < size; d++) {
        int src = ring_down(rank, d, size);
        comm_irecv(k->comm, src, k->tag, recv_block(k, src), block_count(k, src) * k->element,
                   &in[d - 1]);
    }
    for (int d = 1; d < size; d++) {
        int dst = ring_up(rank, d, size);
        out[d - 1] = (struct comm_request){0};
        comm_isend(k->comm, dst, k->tag, send_block(k, dst), send_block_count(k, dst) * k->element,
                   &out[d - 1]);
    }
    comm_waitall(k->comm, n, in);
    comm_waitall(k->comm, n, out);
}

/* What is turned, and as much again to send and to receive. */
static int64_t bruck_bytes(const struct collective_shape *s, int rank)
{
    (void)rank;
    return (s->size + 2 * ((s->size + 1) / 2)) * s->count * s->element;
}

/* Blocks with `bit` in their distance: packed into out, exchanged, unpacked. About half of all
 * blocks. */
static void bruck_round(const struct collective_call *k, int bit, char *out, char *in)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm), n = 0;
    for (int d = bit; d < size; d++)
        if (d & bit) copy(k, at(k, out, n++ * k->count), at(k, k->scratch, d * k->count), k->count);
    exchange(k, 0, ring_up(rank, bit, size), out, n * k->count, ring_down(rank, bit, size), in,
             n * k->count);
    n = 0;
    for (int d = bit; d < size; d++)
        if (d & bit) copy(k, at(k, k->scratch, d * k->count), at(k, in, n++ * k->count), k->count);
}

/* A block that has to go d ranks up goes there by the bits of d: lg alpha + P/2 lg b beta, and two
 * turns of all blocks (Bruck et al. 1997). P = 8, d = 5 = 101b: one rank up, then four. */
static void bruck(const struct collective_call *k)
{
    int rank = comm_rank(k->comm), size = comm_size(k->comm);
    char *out = at(k, k->scratch, size * k->count), *in = at(k, out, (size + 1) / 2 * k->count);
    if (size == 1) own_block(k);
    /* First turn: block d is the one for the rank d up. */
    for (int d = 0; size > 1 && d < size; d++)
        copy(k, at(k, k->scratch, d * k->count), send_block(k, ring_up(rank, d, size)), k->count);
    for (int bit = 1; bit < size; bit *= 2) bruck_round(k, bit, out, in);
    /* Second turn: what is in place d came from the rank d down. */
    for (int d = 0; size > 1 && d < size; d++)
        copy(k, recv_block(k, ring_down(rank, d, size)), at(k, k->scratch, d * k->count), k->count);
}

static void bruck_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element, moves = 0;
    /* Each block moves once for each bit of its distance. */
    for (int d = 1; d < s->size; d++) moves += __builtin_popcount((unsigned)d);
    int rounds = log2_ceil(s->size);
    *out = (struct collective_cost){.messages = P * rounds,
                                    .bytes = P * moves * block,
                                    .rounds = rounds,
                                    .path = moves * block};
    out->copied = P > 1 ? (2 * P * P + 2 * P * moves) * block : 0;
}

static const struct collective_algorithm rows[] = {
    {"bruck", "equal blocks", "Bruck et al. 1997", needs_regular, bruck_bytes, bruck, bruck_cost},
    {"linear", NULL, "all messages at once", NULL, requests, linear, pairwise_cost},
    {"pairwise", NULL, "Thakur, Rabenseifner, Gropp 2005", NULL, NULL, pairwise, pairwise_cost},
    {"xor", "a power of two of ranks", "Thakur, Rabenseifner, Gropp 2005", needs_power_of_two, NULL,
     xor_pairs, pairwise_cost},
};
COLLECTIVE_TABLE(alltoall_algorithms, rows);
