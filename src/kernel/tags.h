/* tags.h - message tags: one range per phase, its step added. */
#ifndef KERNEL_TAGS_H
#define KERNEL_TAGS_H

enum {
    TAG_STEP = 64,                /* room for the steps of one phase */
    TAG_JOINT = 0 * TAG_STEP,     /* coordinates of edge joints */
    TAG_COMPOSITE = 1 * TAG_STEP, /* block composites to the left (outgoing form) */
    TAG_VELOCITY = 2 * TAG_STEP,
    TAG_ACCELERATION = 4 * TAG_STEP,
    TAG_FORCE = 5 * TAG_STEP,
    TAG_SHIFT = 6 * TAG_STEP,       /* + phase: end of block to the next one */
    TAG_ACTIVE = 7 * TAG_STEP,      /* active joint forces of edge bodies */
    TAG_REACTION = 8 * TAG_STEP,    /* constraint forces of edge bodies */
    TAG_INTERFACE = 9 * TAG_STEP,   /* local Schur complements */
    TAG_BACK = 10 * TAG_STEP,       /* interface solutions to the right */
    TAG_REDUCE = 11 * TAG_STEP,     /* cyclic reduction, parallel cyclic reduction */
    TAG_GATHER = 13 * TAG_STEP,
    TAG_TREE = 14 * TAG_STEP,    /* tree contraction */
    TAG_LOOP = 15 * TAG_STEP,    /* loop closure */
    TAG_EXTREME = 16 * TAG_STEP, /* largest numbers of all ranks */
    TAG_BENCH = 17 * TAG_STEP    /* micro-benchmarks */
};

#endif
