/* work.h - counts of what a piece of computing did, in the classes that a node's cost
 * distinguishes.
 *
 * Kernels and the mechanics count as they go; `node_cost` (room machine) turns the counts into
 * simulated time. Counts are of useful operations in the source, so they do not depend on compiler
 * or host. */
#ifndef BASE_WORK_H
#define BASE_WORK_H

#include <stdint.h>

struct work {
    uint64_t flop;  /* floating-point additions, subtractions and multiplications */
    uint64_t div;   /* floating-point divisions */
    uint64_t sqrt;  /* square roots */
    uint64_t trig;  /* sine and cosine evaluations, one each */
    uint64_t bytes; /* bytes copied from memory to memory (packing, unpacking) [B] */
    uint64_t call;  /* calls of small dense operators, for a node's per-call cost */
    /* all bytes that this loads and stores, copies included [B]; 0: nobody counted them, see
     * work_moved. No part of stored results */
    uint64_t moved;
};

/* Bytes that a flop of small dense code moves where nobody counts them [B]: those of a matrix times
 * a vector, whose elements of 8 B are each loaded for one multiplication and one addition. */
enum { WORK_FLOP_BYTES = 4 };

/* work_add: *sum += *w, class by class. */
static inline void work_add(struct work *sum, const struct work *w)
{
    sum->flop += w->flop;
    sum->div += w->div;
    sum->sqrt += w->sqrt;
    sum->trig += w->trig;
    sum->bytes += w->bytes;
    sum->call += w->call;
    sum->moved += w->moved;
}

/* work_moved: bytes that `w` loads and stores [B]: as counted, else WORK_FLOP_BYTES for each flop
 * and two for each byte copied, from its place and to the other. */
static inline uint64_t work_moved(const struct work *w)
{
    return w->moved > 0 ? w->moved : WORK_FLOP_BYTES * w->flop + 2 * w->bytes;
}

#endif
