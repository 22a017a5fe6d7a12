/* micro.h - micro-benchmarks of a machine's messages; each publishes one time per rank [s].
 *
 * kernel_spec.repeat repetitions (at least 1) of messages of kernel_spec.message_bytes. Nothing is
 * computed. */
#ifndef KERNEL_MICRO_H
#define KERNEL_MICRO_H

#include "kernel/kernel.h"
#include "program/program.h"

/* pingpong: ranks 0 and P-1 exchange; half the round trip. */
extern const struct kernel_type pingpong_kernel;

/* shift: every rank sends to rank + distance (mod P) and receives from rank - distance; time per
 * repetition. */
extern const struct kernel_type shift_kernel;

/* all-to-all: every rank sends to every other, rank + 1 first; time per repetition. */
extern const struct kernel_type all_to_all_kernel;

/* bisection: rank i exchanges with rank i + P/2; time per repetition. */
extern const struct kernel_type bisection_kernel;

/* hot-spot: every rank sends to rank 0; time per repetition. */
extern const struct kernel_type hot_spot_kernel;

/* ring, random-ring: every rank sends to and receives from both its neighbours at once, as the
 * effective bandwidth benchmark's patterns (Rabenseifner, Koniges 2001); in the order of ranks, or
 * in one drawn from the run's seed; in rings of kernel_spec.ring_ranks or a little more. Time per
 * repetition. */
extern const struct kernel_type ring_kernel, random_ring_kernel;

/* barrier: time per barrier. */
extern const struct kernel_type barrier_kernel;

#endif
