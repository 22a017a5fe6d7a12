/* timer.c - a rank that looks around stops until the events have come to its clock. Of several timers
 * set one after the other the last counts; what comes while one runs may end the look early. */
#include "vp/matching.h"

static void ring(void *subject, uint64_t argument, sim_ps now)
{
    struct vp *v = subject;
    struct matching *k = v->matching;
    if (argument != k->timer || (v->waiting_for != WAITING_ANY && v->waiting_for != WAITING_POLL))
        return;
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
    if (k->synced >= v->clock) return;
    k->least = SIM_NEVER; /* nothing shortens this */
    timer_set(v, v->clock);
    vp_block(v, WAITING_POLL, NULL);
}

void vp_notify(struct vp *v, const struct comm_request *r, sim_ps time)
{
    if (v->waiting == r) vp_wake(v->world, v);
    else if (v->matching) poll_notify(v, time);
}
