/* path.c - see path.h. */
#include "vp/path.h"

uint32_t vp_path_until(struct vp *v, sim_ps time)
{
    struct path_log *p = v->world->path;
    return path_add(p, path_at(p, v->path, time), time, PATH_POLL, v->comm.rank, v->stage, -1, 0);
}

void vp_path(struct vp *v, enum path_cause cause, sim_ps begin, int64_t count)
{
    struct path_log *p = v->world->path;
    if (p)
        v->path = path_add(p, vp_path_until(v, begin), v->clock, cause, v->comm.rank, v->stage, -1,
                           count);
}

void vp_path_work(struct vp *v, sim_ps begin, const struct work *w)
{
    struct path_log *p = v->world->path;
    if (p) v->path = path_add_work(p, vp_path_until(v, begin), v->clock, v->comm.rank, v->stage, w);
}

void vp_path_join(struct vp *v, uint32_t node)
{
    const struct path_log *p = v->world->path;
    if (p && path_time(p, node) > v->clock) v->path = node;
}
