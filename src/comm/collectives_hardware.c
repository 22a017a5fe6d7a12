/* collectives_hardware.c - collectives that the machine's network does by itself: the algorithm
 * "hardware" of barrier, broadcast, reduce and allreduce.
 *
 * The ranks send no messages: each brings its vector to the network, and all leave with the result
 * when it is everywhere (comm_meet; how long that takes is the machine's, vp/meeting.c). What comes
 * out is what software would compute, to the bit: vectors are combined in the order of the binomial
 * tree that has rank 0 at its root,
 *
 *     ((x0 + x1) + (x2 + x3)) + ((x4 + x5) + ...)
 *
 * whatever the root of the call. That is the order of "reduce-broadcast" and of a binomial
 * reduction to rank 0 for any number of ranks, and of recursive doubling for powers of two. Real
 * trees combine in the order of their switches, which is not published for any machine. */
#include "comm/collectives_internal.h"

const char collective_hardware_needs[] =
    "a network that does it (software.barrier.kind, network.collective), vectors within its limit";

bool collective_by_network(const struct collective_algorithm *a) { return a->run == hardware_run; }

/* Sub-communicators and non-blocking calls have no hardware: their comm says so. */
bool needs_hardware(const struct collective_shape *s)
{
    const struct comm_hardware *h = s->hardware;
    if (!h || !(h->kinds >> s->kind & 1) || s->irregular) return false;
    if (s->count * s->element > h->largest) return false;
    const bool combines = s->kind == COLLECTIVE_REDUCE || s->kind == COLLECTIVE_ALLREDUCE;
    return !combines || (s->operation != COMM_OWN && s->operation <= h->operations);
}

/* One vector that the network reads and writes; two where messages take its place
 * (collective_run). */
int64_t hardware_scratch(const struct collective_shape *s, int rank)
{
    (void)rank;
    return s->kind == COLLECTIVE_BARRIER ? 0 : 2 * s->count * s->element;
}

/* The processors combine nothing and send nothing. */
void hardware_cost(const struct collective_shape *s, struct collective_cost *out)
{
    (void)s;
    *out = (struct collective_cost){0};
}

/* All vectors into that of rank 0, by the tree described above: after the pass with `mask`, rank r
 * (a multiple of 2 mask) has those of r .. r + 2 mask - 1. Nobody is charged for the work. */
static void combine_all(const struct collective_call *k, void *const *data, int n)
{
    struct work unpaid = {0};
    for (int mask = 1; mask < n; mask *= 2)
        for (int r = 0; r + mask < n; r += 2 * mask)
            k->op->combine(data[r], data[r + mask], false, k->count, k->op->context, &unpaid);
}

/* When all are there: one vector, and a copy of it for everybody. A rank that gets no result of a
 * reduction has it in its scratch, where nobody looks. */
static void act(void *const *data, int n, void *context)
{
    const struct collective_call *k = context;
    const size_t bytes = (size_t)(k->count * k->element);
    const int from = k->kind == COLLECTIVE_BROADCAST ? k->root : 0;
    if (bytes == 0) return;
    if (k->kind != COLLECTIVE_BROADCAST) combine_all(k, data, n);
    for (int r = 0; r < n; r++)
        if (r != from) memcpy(data[r], data[from], bytes);
}

/* A barrier has no data, and a way of its own. */
void hardware_run(const struct collective_call *k)
{
    struct comm *c = k->comm;
    if (k->kind == COLLECTIVE_BARRIER) {
        comm_barrier(c);
        return;
    }
    /* In scratch, which no other operation of this rank touches until it leaves. */
    const bool root = comm_rank(c) == k->root, out = k->kind == COLLECTIVE_BROADCAST;
    if (out && root) own_copy(k, k->scratch, k->recv, k->count);
    if (!out) own_copy(k, k->scratch, k->send, k->count);
    const struct comm_meeting m = {.kind = k->kind,
                                   .root = k->kind == COLLECTIVE_ALLREDUCE ? 0 : k->root,
                                   .bytes = k->count * k->element,
                                   .data = k->scratch,
                                   .act = act,
                                   .context = (void *)(uintptr_t)k};
    comm_meet(c, &m);
    if (k->kind == COLLECTIVE_ALLREDUCE || (out ? !root : root))
        own_copy(k, k->recv, k->scratch, k->count);
}
