/* matching.h - matching in simulated time, for programs with wildcards, tests and probes
 * (comm_match.h).
 *
 * Ranks run ahead of the events. What a receive from one source takes follows from the order of
 * sending alone, so it is bound as soon as both are known, as in mailbox.c. A receive from any
 * source, and a probe, are bound by an event at the later of posting and arrival: all that has
 * arrived by then is known then. */
#ifndef VP_MATCHING_H
#define VP_MATCHING_H

#include <stdbool.h>

#include "vp/vp.h"

/* Messages of one sender that no receive has taken, in the order sent, on their way or here. */
struct source {
    int rank;
    int held; /* of them that fit a receive for which an earlier one must come first */
    struct unmatched *first, *last;
    /* of the taken ones, the one that arrives last: when, its number, and what its receive wanted
     */
    sim_ps latest;
    int64_t latest_id, latest_tag, latest_mask;
};

/* One message that no receive has taken. */
struct unmatched {
    struct message *m; /* NULL: taken, and an event still points here */
    struct source *source;
    struct unmatched *before, *after; /* of its sender, in the order sent */
    struct unmatched *prev, *next;    /* of those whose arrival is known */
    bool known;                       /* its arrival */
    bool due;                         /* an event comes when it arrives */
    bool held;                        /* counted in source->held */
    struct matching *owner;
};

/* A watched request, and when it is complete. */
struct watched {
    sim_ps time;
    struct comm_request *request;
};

/* What matching knows at one rank. */
struct matching {
    struct source **table; /* (capacity, a power of two) by hashed rank; NULL: free */
    int capacity, nsource;
    struct unmatched *first, *last; /* messages whose arrival is known, */
    struct unmatched *fresh;        /* from here on as they became known, before it by arrival */
    struct unmatched *spare;
    int nwild;                   /* posted receives that depend on time */
    uint64_t timer;              /* number of the timer that counts, see poll.c */
    sim_ps until, least;         /* when it will; the earliest that a poll may end */
    sim_ps synced;               /* the last clock for which all arrivals were known */
    sim_ps poll_began, poll_end; /* a series of polls without success: start, end of the last one */
    struct watched
        *heap; /* (heap_capacity) the nheap that are, or will be, complete; first on top */
    int nheap, heap_capacity;
    int nunknown;     /* watched, and not known when it is complete */
    uint32_t nwatch;  /* watched so far */
    sim_ps poll_step; /* how long the last one took */
};

/* matching_create: of one rank, from the run's scratch. */
struct matching *matching_create(struct world *w);

/* matching_announce: m sets out to its receiver; called in the order of sending. */
void matching_announce(struct message *m);

/* matching_deliver: m's arrival is known: now or later. */
void matching_deliver(struct vp *v, struct message *m);

/* matching_post: r joins the posted receives at v's clock. */
void matching_post(struct vp *v, struct comm_request *r);

/* matching_find: the first message, in the order of arrival, that has arrived by `now` and that
 * `r`, posted behind all the others, would take; NULL: none. All arrivals up to `now` must be
 * known. */
struct unmatched *matching_find(struct vp *v, const struct comm_request *r, sim_ps now);

/* matching_take: u's message leaves the unmatched ones; returned. */
struct message *matching_take(struct vp *v, struct unmatched *u);

/* matching_put_back: m, whose arrival is known, is without a receive again. */
void matching_put_back(struct vp *v, struct message *m);

/* matching_leftover: one of the messages that no receive has taken, NULL: there is none. */
const struct message *matching_leftover(const struct vp *v);

/* matching_withdraw: r leaves the posted receives. */
void matching_withdraw(struct vp *v, struct comm_request *r);

/* --- poll.c --- */

/* vp_complete_any, vp_probe, vp_receive_into, vp_cancel: comm_match.h for a virtual processor. */
int vp_complete_any(struct comm *c, int n, struct comm_request *const *r, int block);
int vp_probe(struct comm *c, int src, int64_t tag, int64_t mask, int block,
             struct comm_envelope *out, struct comm_request *take);
void vp_receive_into(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity);
int vp_cancel(struct comm *c, struct comm_request *r);

/* vp_watch, vp_next_complete: likewise (watch.c). request_completion: when an active request is
 * complete, SIM_NEVER: not known yet. */
void vp_watch(struct comm *c, struct comm_request *r);
struct comm_request *vp_next_complete(struct comm *c, int64_t time_ps);
sim_ps request_completion(const struct comm_request *r);

/* --- timer.c --- */

/* timer_set: v, about to block as WAITING_ANY or WAITING_POLL, goes on at `time`, not before now.
 */
void timer_set(struct vp *v, sim_ps time);

/* timer_catch_up: stop until all that has happened by v's clock is known. */
void timer_catch_up(struct vp *v);

/* watched_known: the watched request r is complete at `time`, or will be. */
void watched_known(struct vp *v, struct comm_request *r, sim_ps time);

/* watched_pop: the one that is complete first leaves the heap, which is not empty. */
struct comm_request *watched_pop(struct matching *k);

/* poll_notify: at `time`, now or later, something comes for v, which may be looking out for it. */
void poll_notify(struct vp *v, sim_ps time);

#endif
