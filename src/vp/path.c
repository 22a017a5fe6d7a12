/* path.c - see path.h.
 *
 * Each rank keeps the node of its clock: what it did last, which in turn refers to what
 * that waited for. A walk back from the end is the critical path. */
#include "vp/path.h"

/* Time that nothing else explains is charged to looking around (PATH_POLL), so that a
 * path has no gaps. */
uint32_t vp_path_until(struct vp *v, sim_ps time)
{
    struct path_log *p = v->world->path;
    return path_add(p, path_at(p, v->path, time), time, PATH_POLL, v->comm.rank, v->stage, -1, 0);
}

void vp_path_record(struct vp *v, enum path_cause cause, sim_ps begin, int64_t count)
{
    v->path = path_add(v->world->path, vp_path_until(v, begin), v->clock, cause, v->comm.rank,
                       v->stage, -1, count);
}

void vp_path_record_work(struct vp *v, sim_ps begin, const struct work *w)
{
    v->path = path_add_work(v->world->path, vp_path_until(v, begin), v->clock, v->comm.rank,
                            v->stage, w);
}

/* What comes later than the clock binds it; what came before has been waited out and
 * binds nothing. */
void vp_path_record_join(struct vp *v, uint32_t node)
{
    struct path_log *p = v->world->path;
    const bool message = path_time(p, node) > v->clock;
    /* Which of the two would have to be later, to bind, is asked for by few. */
    if (!path_keeps_losers(p)) {
        if (message) v->path = node;
        return;
    }
    const uint32_t own = vp_path_until(v, v->clock);
    v->path = message ? path_join(p, node, own, 0, PATH_POLL, v->comm.rank, v->stage)
                      : path_join(p, own, node, 0, PATH_POLL, v->comm.rank, v->stage);
}
