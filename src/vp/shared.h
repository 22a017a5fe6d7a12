/* shared.h - what the processes of a job know of a run that they shared, brought together on
 * process 0. */
#ifndef VP_SHARED_H
#define VP_SHARED_H

#include <pthread.h>

#include "vp/vp.h"

/* Elements of an output; those that ranks of this process published, in that order. */
struct interval {
    int64_t output, first, count;
};
struct published {
    pthread_mutex_t lock;
    struct interval *interval; /* (n), room for `room`; from the heap, owned */
    int64_t n, room;
};

/* shared_built: whether all processes have what they need for their ranks, `ok` for this one; where
 * one has not, no other waits for its messages, and *e is the reason on all (hosts_agree). */
bool shared_built(struct world *w, bool ok, struct err *e);

/* How a shared run has ended, the same on all processes; of more than one, the last. */
enum shared_end { SHARED_FINISHED, SHARED_DEADLOCK, SHARED_FAILED, SHARED_BROKEN };

/* shared_end: by what all processes say of their ranks; called by all when team_run is back. */
enum shared_end shared_end(struct world *w);

/* shared_collect: times, accounts, loads, outputs and digests of all ranks to process 0, as collect
 * in world.c makes them of a whole run. shared_gather_waiting: to process 0 what deadlock_explain
 * looks at, as if the ranks were its own. Both are called by all processes; false: one of them does
 * not answer. */
bool shared_collect(struct world *w);
bool shared_gather_waiting(struct world *w);

/* shared_published: n elements of `output` from `first` on were published by a rank of this
 * process. */
void shared_published(struct world *w, int output, int64_t first, int64_t n);

#endif
