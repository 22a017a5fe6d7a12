/* host_speed.h - how fast this computer is just now: a few milliseconds of the operations that
 * calibrate prices.
 *
 * A computer is not the same at all times: processors change their clock, and those of a guest may
 * share a core of their host with others for a minute. No counter of the guest tells it. So short
 * loops are timed right before and after whatever is measured. */
#ifndef HOST_HOST_SPEED_H
#define HOST_HOST_SPEED_H

#include "host/host_comm.h"
#include "measure/real_row.h"

/* host_speed_now: the time of each operation [s], on all processes of the job at once; called by
 * all of them, between runs of `comm`. The median of some tens of samples of about 10 us that the
 * system did not interrupt (of all, where it interrupted each), and of the processes the largest
 * time, so that `out` is the same on all. About 1 ms.
 *
 *   hosts  in   the job, NULL: this process alone
 *   comm   in   made by host_comm_create for that job; NULL: no messages
 *
 *   Returns false when MPI reports an error. */
bool host_speed_now(const struct hosts *hosts, struct host_comm *comm, struct host_speed *out);

/* host_speed_least: the least time of one operation [s] over 200 samples that the system did not
 * interrupt, infinite: it interrupted each. Not of messages. */
double host_speed_least(enum host_operation o);

#endif
