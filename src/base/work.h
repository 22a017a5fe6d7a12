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
};

/* work_add: *sum += *w, class by class. */
static inline void work_add(struct work *sum, const struct work *w)
{
    sum->flop += w->flop;
    sum->div += w->div;
    sum->sqrt += w->sqrt;
    sum->trig += w->trig;
    sum->bytes += w->bytes;
    sum->call += w->call;
}

#endif
