/* program_list.h - the built-in programs, one line each: what they are called and which settings
 * act on them.
 *
 * A new program is a line here and files in room kernel that define `STEM_program`
 * (program/program.h). Columns of X: word in files, stem, traits. */
#ifndef SPEC_PROGRAM_LIST_H
#define SPEC_PROGRAM_LIST_H

#define PROGRAM_LIST(X)                                                                            \
    X("inverse", inverse, PROGRAM_SCENE | PROGRAM_INVERSE)                                         \
    X("forward", forward, PROGRAM_SCENE | PROGRAM_FORWARD)                                         \
    X("dynamics", dynamics, PROGRAM_SCENE | PROGRAM_INVERSE | PROGRAM_FORWARD)                     \
    X("pingpong", pingpong, PROGRAM_MESSAGE)                                                       \
    X("shift", shift, PROGRAM_MESSAGE | PROGRAM_DISTANCE)                                          \
    X("bisection", bisection, PROGRAM_MESSAGE)                                                     \
    X("all-to-all", all_to_all, PROGRAM_MESSAGE)                                                   \
    X("hot-spot", hot_spot, PROGRAM_MESSAGE)                                                       \
    X("ring", ring, PROGRAM_MESSAGE | PROGRAM_RING)                                                \
    X("random-ring", random_ring, PROGRAM_MESSAGE | PROGRAM_RING | PROGRAM_RANDOM)                 \
    X("barrier", barrier, 0)                                                                       \
    X("message-barrier", message_barrier, PROGRAM_COLLECTIVE)                                      \
    X("broadcast", broadcast, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE | PROGRAM_ROOT)                 \
    X("reduce", reduce, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE | PROGRAM_ROOT)                       \
    X("allreduce", allreduce, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)                                \
    X("gather", gather, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE | PROGRAM_ROOT)                       \
    X("scatter", scatter, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE | PROGRAM_ROOT)                     \
    X("allgather", allgather, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)                                \
    X("alltoall", alltoall, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)                                  \
    X("alltoallv", alltoallv, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)                                \
    X("scan", scan, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)                                          \
    X("reduce-scatter", reduce_scatter, PROGRAM_MESSAGE | PROGRAM_COLLECTIVE)

/* Which settings act on a program. */
enum program_trait {
    PROGRAM_SCENE = 1, /* it works on a multibody system: model.*, and all of kernel.* that is about
                          arithmetic */
    PROGRAM_INVERSE = 2,      /* it computes joint forces */
    PROGRAM_FORWARD = 4,      /* it computes accelerations: it solves a system */
    PROGRAM_MESSAGE = 8,      /* kernel.message: its messages have a size of their own */
    PROGRAM_DISTANCE = 16,    /* kernel.distance */
    PROGRAM_RING = 32,        /* kernel.ring_ranks */
    PROGRAM_RANDOM = 64,      /* it draws from the run's seed: repetitions differ */
    PROGRAM_COLLECTIVE = 128, /* kernel.algorithm */
    PROGRAM_ROOT = 256        /* kernel.root */
};

#endif
