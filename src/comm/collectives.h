/* collectives.h - collective operations out of point-to-point messages, for kernels. Every rank must call.
 *
 * Tags from `tag` upwards are used: at most 2 ceil(log2 size) of them. */
#ifndef COMM_COLLECTIVES_H
#define COMM_COLLECTIVES_H

#include "comm/comm.h"

/* collective_barrier: dissemination barrier, ceil(log2 P) rounds of empty messages (Hensgen, Finkel, Manber 1988). */
void collective_barrier(struct comm *c, int tag);

/* collective_broadcast: `bytes` bytes of `data` from `root` to all, binomial tree. */
void collective_broadcast(struct comm *c, int root, int tag, void *data, int64_t bytes);

/* collective_sum: data[k] = sum over ranks in rank order of a binomial tree, on every rank; (n) doubles; the same
 * bits on every rank. */
void collective_sum(struct comm *c, int tag, double *data, int n);

#endif
