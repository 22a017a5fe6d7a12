/* server.c - one kernel server for the whole machine (a network daemon, one big lock): every
 * message end passes it, first come first served. */
#include "base/picoseconds.h"
#include "vp/path.h"
#include "vp/vp.h"

/* A fixed time and a time for each byte, both of machine.software. */
static sim_ps service_time(const struct world *w, int64_t bytes)
{
    return w->software.kernel_time + ps_rounded(w->software.kernel_byte * (double)bytes);
}

/* Whoever finds the server busy is bound by whom it serves: by the moment when that began. */
static void bind_path(struct vp *v, sim_ps now, int64_t bytes)
{
    struct world *w = v->world->whole;
    const int rank = v->comm.rank, stage = v->stage;
    const sim_ps start = v->extra->server_start;
    const uint32_t own = vp_path_until(v, now), other = w->server_path;
    v->path = start > now
                  ? path_join(w->path,
                              path_add(w->path, other, start, PATH_SERVER, w->served_rank,
                                       w->served_stage, -1, w->server_bytes),
                              own, 0, PATH_SERVER, rank, stage)
                  : path_join(w->path, own, other, service_time(w, w->server_bytes), PATH_SERVER,
                              rank, stage);
    w->server_path = v->path;
    w->server_bytes = bytes;
    w->served_rank = v->comm.rank;
    w->served_stage = v->stage;
}

/* An event, so that those who come at one time are served in the order of the queue, by
 * rank. The clock of a rank that runs ahead says nothing about order; the event queue
 * does. */
static void begin_service(void *subject, uint64_t bytes, sim_ps now)
{
    struct vp *v = subject;
    struct world *w = v->world->whole;
    v->extra->server_start = now > w->server_free ? now : w->server_free;
    if (w->path) bind_path(v, now, (int64_t)bytes);
    w->server_free = ps_later(v->extra->server_start, service_time(w, (int64_t)bytes));
    vp_wake(w, v);
}

/* The caller waits for its turn, and is charged the service time that is returned. */
sim_ps server_pass(struct vp *v, int64_t bytes)
{
    sim_at(v->world->sim, v->clock, LANE_SERVER, (uint64_t)v->comm.rank, begin_service, v,
           (uint64_t)bytes);
    vp_block(v, WAITING_SERVER, NULL);
    vp_wait_until(v, v->extra->server_start, v->clock);
    return service_time(v->world, bytes);
}
