/* clock.c - a virtual processor's clock: when it stops, waits and goes on, and what the timeline
 * keeps of it. */
#include <string.h>

#include "vp/vp.h"

/* A ring of as many places as ranks is enough, as each rank is woken at most once before it goes
 * on. First come, first served: the order in which the host runs ranks is fixed, and so are
 * digests. */
void vp_wake(struct world *w, struct vp *v)
{
    w = w->whole;
    int at = w->ready_head + w->ready_count++;
    CHECK(w->ready_count <= w->nown);
    w->ready[at >= w->nown ? at - w->nown : at] = v;
}

/* The state is kept for reports of deadlocks: whoever blocks is found with what it waits
 * for. Control returns to the loop in world.c. */
void vp_block(struct vp *v, enum waiting_for what, struct comm_request *r)
{
    v->waiting_for = what;
    v->waiting = r;
    fiber_leave(v->fiber);
    v->waiting_for = WAITING_NOTHING;
    v->waiting = NULL;
}

/* The first rank that would pass the end of time is the one that is told. The loop stops,
 * so the fiber is never entered again; its stack is freed with the run. */
void vp_time_out(struct vp *v)
{
    struct world *whole = v->world->whole;
    if (!whole->late) whole->late = v;
    whole->stopped = true;
    for (;;) vp_block(v, WAITING_NOTHING, NULL);
}

void vp_wait_until(struct vp *v, sim_ps time, sim_ps uncontended)
{
    if (time <= v->clock) return;
    /* The wait is cut in two: what would have passed on an empty machine is wait, the
     * rest is contention (docs/network.md). Both are within [clock, time], whatever the
     * caller says. */
    sim_ps free_of_others = uncontended < v->clock ? v->clock
                            : uncontended > time   ? time
                                                   : uncontended;
    vp_stage_time(v)->wait_ps += free_of_others - v->clock;
    vp_stage_time(v)->contention_ps += time - free_of_others;
    vp_advance(v, time);
}

void vp_span(struct vp *v, enum span_kind kind, sim_ps begin, sim_ps end, int peer, int64_t bytes,
             int64_t message)
{
    struct world *w = v->world;
    struct run_result *r = w->result;
    /* Spans without a length show nothing, but ends of messages draw arrows. */
    if (begin == end && message < 0) return;
    /* The result's arena never frees, so arrays that doubled leave as much behind as they
     * hold. */
    if (r->nspan == w->span_capacity) {
        int64_t capacity = w->span_capacity ? 2 * w->span_capacity : 4096;
        struct span *grown = TAKE(w->arena, capacity, struct span);
        if (r->nspan) memcpy(grown, r->span, (size_t)r->nspan * sizeof *grown);
        r->span = grown;
        w->span_capacity = capacity;
    }
    r->span[r->nspan++] = (struct span){.rank = v->comm.rank,
                                        .stage = v->stage,
                                        .kind = kind,
                                        .begin_ps = begin - w->start,
                                        .end_ps = end - w->start,
                                        .peer = peer,
                                        .bytes = bytes,
                                        .message = message};
}
