/* timer.c - a rank that looks around stops until the events have come to its clock. Of several
 * timers set one after the other the last counts; what comes while one runs may end the look early.
 *
 * Why a timer at all: ranks run ahead of the events, so what a rank sees at its clock is
 * not known until the events have come that far. */
#include "vp/matching.h"

#include <string.h>

static void ring(void *subject, uint64_t argument, sim_ps now)
{
    struct vp *v = subject;
    struct matching *k = v->matching;
    /* A timer that was replaced still rings: its number tells that it does not count,
     * which is cheaper than taking events out of the queue. */
    if (argument != k->timer || (v->waiting_for != WAITING_ANY && v->waiting_for != WAITING_POLL))
        return;
    /* All events before this lane at `now` are done, so what has arrived by now is known. */
    k->synced = now;
    v->waiting_for = WAITING_NOTHING; /* nobody else wakes it again */
    vp_wake(v->world, v);
}

void timer_set(struct vp *v, sim_ps time)
{
    struct matching *k = v->matching;
    k->until = time;
    sim_at(v->world->sim, time, LANE_POLL, (uint64_t)v->comm.rank, ring, v, ++k->timer);
}

/* WAITING_ANY waits for anything new, so it goes on at once and looks for itself.
 * WAITING_POLL has a time in mind: the look ends earlier, not before it has cost what a
 * poll costs, and never in the past. */
void poll_notify(struct vp *v, sim_ps time)
{
    struct matching *k = v->matching;
    if (v->waiting_for == WAITING_ANY) {
        v->waiting_for = WAITING_NOTHING;
        vp_wake(v->world, v);
    }
    if (v->waiting_for != WAITING_POLL || k->least == SIM_NEVER) return;
    const sim_ps now = sim_now(v->world->sim);
    if (time < k->least) time = k->least;
    if (time < now) time = now;
    if (time < k->until) timer_set(v, time);
}

void timer_catch_up(struct vp *v)
{
    struct matching *k = v->matching;
    /* Nothing can come that is not known yet. */
    if (k->synced >= v->clock) return;
    k->least = SIM_NEVER; /* nothing shortens this */
    timer_set(v, v->clock);
    vp_block(v, WAITING_POLL, NULL);
}

/* ---- watched requests whose completion is known: a heap by time, then by the order of watching
 * ---- */

static bool sooner(const struct watched *a, const struct watched *b)
{
    return a->time != b->time ? a->time < b->time : a->request->watch < b->request->watch;
}

void watched_known(struct vp *v, struct comm_request *r, sim_ps time)
{
    struct matching *k = v->matching;
    if (k->nheap == k->heap_capacity) {
        const int capacity = k->heap_capacity ? 2 * k->heap_capacity : 16;
        struct watched *grown = TAKE(v->world->scratch, capacity, struct watched);
        if (k->nheap) memcpy(grown, k->heap, (size_t)k->nheap * sizeof *grown);
        k->heap = grown;
        k->heap_capacity = capacity;
    }
    /* Sifting up and down moves entries, not pairs of entries: a hole travels to where
     * the new one belongs. */
    const struct watched new = {time, r};
    int at = k->nheap++;
    for (; at > 0 && sooner(&new, &k->heap[(at - 1) / 2]); at = (at - 1) / 2)
        k->heap[at] = k->heap[(at - 1) / 2];
    k->heap[at] = new;
}

/* The caller has seen that there is one. */
struct comm_request *watched_pop(struct matching *k)
{
    struct comm_request *first = k->heap[0].request;
    const struct watched last = k->heap[--k->nheap];
    int at = 0;
    for (int child = 1; child < k->nheap; child = 2 * at + 1) {
        if (child + 1 < k->nheap && sooner(&k->heap[child + 1], &k->heap[child])) child++;
        if (!sooner(&k->heap[child], &last)) break;
        k->heap[at] = k->heap[child];
        at = child;
    }
    k->heap[at] = last;
    return first;
}

/* Three may look out for a request: the completion queue, a wait for it alone, a look
 * around. */
void vp_notify(struct vp *v, struct comm_request *r, sim_ps time)
{
    if (r->watch) {
        v->matching->nunknown--;
        watched_known(v, r, time);
    }
    if (v->waiting == r) vp_wake(v->world, v);
    else if (v->matching) poll_notify(v, time);
}
