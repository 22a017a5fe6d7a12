/* explain.h - why a run did not end well: deadlocks, failures of programs, the end of time. */
#ifndef VP_EXPLAIN_H
#define VP_EXPLAIN_H

#include "vp/vp.h"

/* --- failure.c --- */

/* vp_base_name: the file name of a call site. */
const char *vp_base_name(const char *path);

/* vp_record_failure: v's program has failed at file:line. The first failure on the host is the one
 * that is told: the order of ranks there is fixed. */
void vp_record_failure(struct vp *v, const char *file, int line, const char *text);

/* vp_fail: comm_fail. vp_misuse: v's program has done what it must not: in a foreign one the same,
 * printf-like, else a CHECK. Neither returns. */
_Noreturn void vp_fail(struct comm *c, const char *text);
_Noreturn void vp_misuse(struct vp *v, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* size_mismatch: a receive of exactly r->bytes has found m, of another size. */
void size_mismatch(struct vp *v, const struct comm_request *r, const struct message *m);

/* forget_parts: what the ranks of a run that failed have so far is no result. */
void forget_parts(struct world *w);

/* --- deadlock.c --- */

/* find_leftovers: a message that no receive has taken fails the run. */
void find_leftovers(struct world *w);

/* late_explain: who had come how far when simulated time ended, into the result's text. */
void late_explain(struct world *w);

/* deadlock_explain: the wait-for cycle, or the network's if it is the network, into the result's
 * text. */
void deadlock_explain(struct world *w);

/* deadlock_reached: how far the `n` ranks from `first` have come: the latest time at which one of
 * them ended or stood still [ps]. */
sim_ps deadlock_reached(const struct world *w, int first, int n);

/* deadlock_time: `reached` is the run's time; this process's ranks have waited until then. */
void deadlock_time(struct world *w, sim_ps reached);

#endif
