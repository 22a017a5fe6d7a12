/* hosts_copy.h - arrays of any size from one process of a job to others. */
#ifndef HOSTS_HOSTS_COPY_H
#define HOSTS_HOSTS_COPY_H

#include "hosts/hosts.h"

/* What is told of a process that sends nothing more. */
#define HOSTS_SILENT "a process of the job has ended, or does not answer"

/* hosts_copy_out: send `bytes` of `data` to process `to`; hosts_copy_in: receive as many from
 * `from`, which must send as many. Whoever waits sleeps in between: MPI's own waiting would take a
 * processor. */
bool hosts_copy_out(const struct hosts *h, int to, int tag, const void *data, size_t bytes);
bool hosts_copy_in(const struct hosts *h, int from, int tag, void *data, size_t bytes);

/* hosts_tell: process 0's `data` to all; called by all. */
bool hosts_tell(const struct hosts *h, int tag, void *data, size_t bytes);

/* hosts_sum: value (n) summed over the processes, on process 0; called by all. hosts_all_sum,
 * hosts_all_largest: the sums, or the largest values, on all processes. False: one of them does not
 * answer. */
bool hosts_sum(const struct hosts *h, int tag, int64_t *value, int n);
bool hosts_all_sum(const struct hosts *h, int tag, int64_t *value, int n);
bool hosts_all_largest(const struct hosts *h, int tag, int64_t *value, int n);

/* hosts_agree: whether all processes can go on; called by all. `ok`: this one can, else *e says why
 * it cannot. False: one cannot, and *e tells on all of them why, in the words of the first of them
 * (behind its number if that is not 0), or HOSTS_SILENT (ERR_INTERNAL). */
bool hosts_agree(const struct hosts *h, int tag, bool ok, struct err *e);

#endif
