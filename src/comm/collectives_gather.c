/* collectives_gather.c - every rank's block to one rank, and the way back.
 *
 * The root's port takes (P - 1) b bytes in any case. A binomial tree brings them in lg messages
 * instead of P - 1, at the price of copies on the way; it is worth it for short blocks. */
#include "comm/collectives_internal.h"

/* (P - 1) (alpha + b beta) at the root, in the order of ranks. The only way for blocks of different
 * sizes, which only the root knows. */
static void gather_linear(const struct collective_call *k)
{
    int size = comm_size(k->comm), rank = comm_rank(k->comm);
    if (rank != k->root) {
        give(k, 0, k->root, k->send, k->count);
        return;
    }
    for (int r = 0; r < size; r++) {
        void *block = at(k, k->recv, block_place(k, r));
        if (r == rank) own_copy(k, block, k->send, block_count(k, r));
        else take(k, 0, r, block, block_count(k, r));
    }
}

/* The same backwards. */
static void scatter_linear(const struct collective_call *k)
{
    int size = comm_size(k->comm), rank = comm_rank(k->comm);
    if (rank != k->root) {
        take(k, 0, k->root, k->recv, k->count);
        return;
    }
    for (int r = 0; r < size; r++) {
        const void *block = at_const(k, k->send, block_place(k, r));
        if (r == rank) own_copy(k, k->recv, block, block_count(k, r));
        else give(k, 0, r, block, block_count(k, r));
    }
}

/* All at the root, one after the other. */
static void linear_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t messages = s->size - 1, bytes = messages * s->count * s->element;
    *out = (struct collective_cost){
        .messages = messages, .bytes = bytes, .rounds = messages, .path = bytes};
}

/* Ranks below a rank of the binomial tree and itself; ranks count from the root. The lowest set bit
 * of a number is the size of its full subtree, which the number of ranks may cut. */
static int subtree(int relative, int size)
{
    int ranks = relative ? relative & -relative : size;
    return relative + ranks < size ? ranks : size - relative;
}

/* A leaf's block never leaves send or recv: half of all ranks need no scratch at all. */
static int64_t subtree_bytes(const struct collective_shape *s, int rank)
{
    int ranks = subtree(ring_down(rank, s->root, s->size), s->size);
    return ranks > 1 ? ranks * s->count * s->element : 0;
}

/* turn: the blocks of all ranks between the root's scratch, where they count from the root, and its
 * buffer, where they count from rank 0. Charged as copies: a real library pays for it, too. */
static void turn(const struct collective_call *k, bool out)
{
    int size = comm_size(k->comm);
    for (int d = 0; d < size; d++) {
        int64_t place = block_place(k, ring_up(k->root, d, size));
        void *turned = at(k, k->scratch, d * k->count);
        if (out) copy(k, at(k, k->recv, place), turned, k->count);
        else copy(k, turned, at_const(k, k->send, place), k->count);
    }
}

/* lg alpha + (P - 1) b beta. Blocks of a subtree lie together in scratch, its own first. */
static void gather_binomial(const struct collective_call *k)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size),
        mask = 1;
    int ranks = subtree(relative, size);
    /* A leaf sends straight from its buffer. */
    if (ranks > 1) own_copy(k, k->scratch, k->send, k->count);
    /* Children in rising order; child c's subtree begins at its own place. */
    for (; mask < size && !(relative & mask); mask *= 2) {
        int child = relative + mask;
        if (child >= size) continue;
        take(k, 0, ring_up(child, k->root, size), at(k, k->scratch, mask * k->count),
             subtree(child, size) * k->count);
    }
    const void *gathered = ranks > 1 ? k->scratch : k->send;
    /* A leaf receives its block in place; the root turns the blocks so that subtrees lie together.
     * One message for the whole subtree; the root puts the blocks where they belong. */
    if (relative) give(k, 0, ring_up(relative - mask, k->root, size), gathered, ranks * k->count);
    else if (ranks > 1) turn(k, true);
    else own_copy(k, at(k, k->recv, block_place(k, k->root)), k->send, k->count);
}

/* gather_binomial backwards: the largest subtree first. */
static void scatter_binomial(const struct collective_call *k)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size),
        mask = 1;
    int ranks = subtree(relative, size);
    while (mask < size && !(relative & mask)) mask *= 2;
    if (relative)
        take(k, 0, ring_up(relative - mask, k->root, size), ranks > 1 ? k->scratch : k->recv,
             ranks * k->count);
    else if (ranks > 1) turn(k, false);
    for (mask /= 2; mask > 0; mask /= 2) {
        int child = relative + mask;
        if (child >= size) continue;
        give(k, 0, ring_up(child, k->root, size), at(k, k->scratch, mask * k->count),
             subtree(child, size) * k->count);
    }
    if (ranks > 1) own_copy(k, k->recv, k->scratch, k->count);
    else if (!relative)
        own_copy(k, k->recv, at_const(k, k->send, block_place(k, k->root)), k->count);
}

/* Bytes: each block travels one edge for each level between its rank and the root. */
static void binomial_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size, block = s->count * s->element;
    *out = (struct collective_cost){.messages = P - 1,
                                    .bytes = binomial_block_count(s->size) * block,
                                    .rounds = log2_ceil(s->size),
                                    .path = (P - 1) * block,
                                    .copied = P > 1 ? P * block : 0};
}

static const struct collective_algorithm gather_rows[] = {
    {"binomial", "equal blocks", "Thakur, Rabenseifner, Gropp 2005", needs_regular, subtree_bytes,
     gather_binomial, binomial_cost},
    {"linear", NULL, "everybody to the root", NULL, NULL, gather_linear, linear_cost},
};
COLLECTIVE_TABLE(gather_algorithms, gather_rows);

static const struct collective_algorithm scatter_rows[] = {
    {"binomial", "equal blocks", "Thakur, Rabenseifner, Gropp 2005", needs_regular, subtree_bytes,
     scatter_binomial, binomial_cost},
    {"linear", NULL, "the root to everybody", NULL, NULL, scatter_linear, linear_cost},
};
COLLECTIVE_TABLE(scatter_algorithms, scatter_rows);
