/* micro_collective.h - micro-benchmarks of the collectives in room comm; each publishes one time
 * per rank [s], the mean of its own times in the collective.
 *
 * kernel_spec.message_bytes is the vector of broadcast, reduce, allreduce and scan and a block of
 * the others. Elements have 8, 4 or 1 bytes, whichever divides the size; the operation is their
 * sum, one flop each. The algorithm is kernel_spec.algorithm or, "auto", what the machine's rules
 * or MPICH's thresholds say. Repetitions begin after a barrier, in a stage of its own. */
#ifndef KERNEL_MICRO_COLLECTIVE_H
#define KERNEL_MICRO_COLLECTIVE_H

#include "comm/collectives.h"
#include "kernel/kernel.h"
#include "program/program.h"

/* One of each collective (gather's and scatter's linear algorithms are those for blocks of
 * different sizes, too). */
extern const struct kernel_type broadcast_kernel, reduce_kernel, allreduce_kernel, gather_kernel,
    scatter_kernel, allgather_kernel, alltoall_kernel, scan_kernel, reduce_scatter_kernel;

/* message-barrier: a barrier out of messages, whatever the machine has. */
extern const struct kernel_type message_barrier_kernel;

/* alltoallv: rank r has (r + d) mod P / (P - 1) of twice the message for rank d, in whole elements:
 * blocks from nothing to twice the message, their mean. */
extern const struct kernel_type alltoallv_kernel;

/* micro_collective_algorithm: what a spec's kernel will use, NULL with ERR_CONFIG when it cannot:
 * no such algorithm, not at this number of ranks. */
const struct collective_algorithm *micro_collective_algorithm(const struct run_spec *spec,
                                                              struct err *e);

/* micro_collective_shape: what the spec's kernel calls. */
struct collective_shape micro_collective_shape(const struct run_spec *spec);

#endif
