/* collectives_broadcast.c - one rank's vector to all.
 *
 * A tree for short vectors: lg messages one after the other. For long ones the tree sends the whole
 * vector lg times over the same wire; then it pays to cut it up: scatter and allgather, or a
 * pipeline of segments. */
#include "comm/collectives_internal.h"

/* From the root of a binomial tree the largest subtree first; ranks count from the root. lg (alpha
 * + n beta). P = 8:
 *
 *     0 -> 4, then 0 -> 2 and 4 -> 6, then 0 -> 1, 2 -> 3, 4 -> 5, 6 -> 7 */
static void binomial(const struct collective_call *k)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size),
        mask = 1;
    while (mask < size && !(relative & mask)) mask *= 2;
    if (relative) take(k, 0, ring_up(relative - mask, k->root, size), k->recv, k->count);
    for (mask /= 2; mask > 0; mask /= 2)
        if (relative + mask < size)
            give(k, 0, ring_up(relative + mask, k->root, size), k->recv, k->count);
}

/* P - 1 messages of the whole vector; the longest way has `rounds` of them. */
static void tree_cost(const struct collective_shape *s, int rounds, struct collective_cost *out)
{
    int64_t bytes = s->count * s->element, messages = s->size - 1;
    *out = (struct collective_cost){
        .messages = messages, .bytes = messages * bytes, .rounds = rounds, .path = rounds * bytes};
}

static void binomial_cost(const struct collective_shape *s, struct collective_cost *out)
{
    tree_cost(s, log2_ceil(s->size), out);
}

/* The root sends P - 1 messages itself; all others wait for it. */
static void linear(const struct collective_call *k)
{
    int size = comm_size(k->comm);
    if (comm_rank(k->comm) != k->root) {
        take(k, 0, k->root, k->recv, k->count);
        return;
    }
    for (int d = 1; d < size; d++) give(k, 0, ring_up(k->root, d, size), k->recv, k->count);
}

static void linear_cost(const struct collective_shape *s, struct collective_cost *out)
{
    tree_cost(s, s->size - 1, out);
}

/* Down a chain of ranks in pieces of `piece` elements. With s pieces (s + P - 2) (alpha + n/s
 * beta): for long vectors about n beta, whatever P. */
static void chain_by(const struct collective_call *k, int64_t piece)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size);
    int before = ring_up(relative + size - 1, k->root, size),
        after = ring_up(relative + 1, k->root, size);
    int64_t done = 0;
    /* An empty vector is one empty message: a broadcast also tells that the root has come so
     * far. */
    do {
        int64_t n = k->count - done < piece ? k->count - done : piece;
        void *part = at(k, k->recv, done);
        /* Receive a piece, pass it on, then wait for the next: the pieces overlap along the
         * chain. */
        if (relative > 0) take(k, 0, before, part, n);
        if (relative + 1 < size) give(k, 0, after, part, n);
        done += n;
    } while (done < k->count);
}

/* One piece: nothing overlaps. */
static void chain(const struct collective_call *k) { chain_by(k, k->count); }

/* Elements of a segment: as many as fit, at least one. Longer segments fill the pipeline more
 * slowly, shorter ones pay alpha more often. */
static int64_t segment(int64_t element)
{
    return element > 0 && element < COLLECTIVE_SEGMENT ? COLLECTIVE_SEGMENT / element : 1;
}

static void pipeline(const struct collective_call *k) { chain_by(k, segment(k->element)); }

/* Last pieces may be shorter, which only the last message on the path feels. */
static void pipeline_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t piece = segment(s->element), n = s->count > 0 ? (s->count + piece - 1) / piece : 1,
            P = s->size;
    int64_t last = s->count - (n - 1) * piece;
    *out =
        (struct collective_cost){.messages = n * (P - 1), .bytes = (P - 1) * s->count * s->element};
    if (P == 1) return;
    out->rounds = n - 1 + P - 1;
    out->path =
        n == 1 ? (P - 1) * last * s->element : ((n - 1 + P - 2) * piece + last) * s->element;
}

/* Part p of the vector belongs to the rank p after the root. */
static int64_t part(const struct collective_call *k, int p)
{
    return split(k->count, p, comm_size(k->comm));
}

/* Each message of a binomial tree carries the parts of its receiver's subtree, which lie
 * together. */
static void scatter_parts(const struct collective_call *k, int relative)
{
    int size = comm_size(k->comm), mask = 1;
    while (mask < size && !(relative & mask)) mask *= 2;
    int end = relative + mask < size ? relative + mask : size;
    int64_t begin = part(k, relative);
    if (relative)
        take(k, 0, ring_up(relative - mask, k->root, size), at(k, k->recv, begin),
             part(k, end) - begin);
    for (mask /= 2; mask > 0; mask /= 2) {
        int child = relative + mask, last = child + mask < size ? child + mask : size;
        if (child >= size) continue;
        give(k, 0, ring_up(child, k->root, size), at(k, k->recv, part(k, child)),
             part(k, last) - part(k, child));
    }
}

/* (lg + P - 1) alpha + 2 (P-1)/P n beta: scatter by a tree, allgather by a ring (van de Geijn).
 * Each byte leaves the root once. */
static void scatter_allgather(const struct collective_call *k)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size);
    int up = ring_up(comm_rank(k->comm), 1, size), down = ring_down(comm_rank(k->comm), 1, size);
    scatter_parts(k, relative);
    for (int step = 0; step < size - 1; step++) {
        int out = ring_down(relative, step, size), in = ring_down(relative, step + 1, size);
        exchange(k, 1, up, at(k, k->recv, part(k, out)), part(k, out + 1) - part(k, out), down,
                 at(k, k->recv, part(k, in)), part(k, in + 1) - part(k, in));
    }
}

/* The scatter's messages get shorter down the tree; the allgather's are those of its algorithm. */
static void scatter_cost(const struct collective_shape *s, int64_t messages, int steps,
                         struct collective_cost *out)
{
    int64_t P = s->size, bytes = s->count * s->element;
    *out = (struct collective_cost){.messages = P - 1 + messages,
                                    .bytes = binomial_part_bytes(s->count, s->size, s->element) +
                                             (P - 1) * bytes,
                                    .rounds = log2_ceil(s->size) + steps};
    out->path = is_power_of_two(s->size) && s->count % P == 0 ? 2 * (bytes - bytes / P) : -1;
}

static void scatter_allgather_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int64_t P = s->size;
    scatter_cost(s, P * (P - 1), s->size - 1, out);
}

/* 2 lg alpha + 2 (P-1)/P n beta: the allgather by recursive doubling. */
static void scatter_doubling(const struct collective_call *k)
{
    int size = comm_size(k->comm), relative = ring_down(comm_rank(k->comm), k->root, size);
    scatter_parts(k, relative);
    for (int mask = 1; mask < size; mask *= 2) {
        int mine = relative & ~(mask - 1), other = mine ^ mask,
            peer = ring_up(relative ^ mask, k->root, size);
        exchange(k, 1, peer, at(k, k->recv, part(k, mine)), part(k, mine + mask) - part(k, mine),
                 peer, at(k, k->recv, part(k, other)), part(k, other + mask) - part(k, other));
    }
}

static void scatter_doubling_cost(const struct collective_shape *s, struct collective_cost *out)
{
    int steps = log2_floor(s->size);
    scatter_cost(s, (int64_t)s->size * steps, steps, out);
}

static const struct collective_algorithm rows[] = {
    {"binomial", NULL, "Thakur, Rabenseifner, Gropp 2005", NULL, NULL, binomial, binomial_cost},
    {"scatter-allgather", NULL, "van de Geijn: Barnett et al. 1994", NULL, NULL, scatter_allgather,
     scatter_allgather_cost},
    {"scatter-recursive-doubling", "a power of two of ranks", "Thakur, Rabenseifner, Gropp 2005",
     needs_power_of_two, NULL, scatter_doubling, scatter_doubling_cost},
    {"pipeline", NULL, "a chain in segments of 8 KiB", NULL, NULL, pipeline, pipeline_cost},
    {"chain", NULL, "whole vectors down a chain", NULL, NULL, chain, linear_cost},
    {"linear", NULL, "the root to everybody", NULL, NULL, linear, linear_cost},
    HARDWARE_ROW,
};
COLLECTIVE_TABLE(broadcast_algorithms, rows);
