/* server.c - one kernel server for the whole machine (a network daemon, one big lock): every
 * message end passes it, first come first served. */
#include "base/picoseconds.h"
#include "vp/vp.h"

/* An event, so that those who come at one time are served in the order of the queue, by rank. */
static void begin_service(void *subject, uint64_t service, sim_ps now)
{
    struct vp *v = subject;
    struct world *w = v->world;
    v->server_start = now > w->server_free ? now : w->server_free;
    w->server_free = ps_later(v->server_start, (sim_ps)service);
    vp_wake(w, v);
}

/* The caller waits for its turn, and is charged the service time that is returned. */
sim_ps server_pass(struct vp *v, int64_t bytes)
{
    const struct software_cost *s = &v->world->software;
    sim_ps service = s->kernel_time + ps_rounded(s->kernel_byte * (double)bytes);
    sim_at(v->world->sim, v->clock, LANE_SERVER, (uint64_t)v->comm.rank, begin_service, v,
           (uint64_t)service);
    vp_block(v, WAITING_SERVER, NULL);
    vp_wait_until(v, v->server_start, v->clock);
    return service;
}
