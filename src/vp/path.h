/* path.h - how virtual processors record what binds their clocks (measure/path.h). All without
 * effect unless the world has a path log. */
#ifndef VP_PATH_H
#define VP_PATH_H

#include "measure/path.h"
#include "vp/vp.h"

/* vp_path_until: the node of v's path at `time`, which is not later than its clock. The world has a
 * path log. */
uint32_t vp_path_until(struct vp *v, sim_ps time);

/* vp_path_record, vp_path_record_work, vp_path_record_join: what the functions below do where the
 * world has a path log; these are for runs that record, so they need not be fast. */
void vp_path_record(struct vp *v, enum path_cause cause, sim_ps begin, int64_t count);
void vp_path_record_work(struct vp *v, sim_ps begin, const struct work *w);
void vp_path_record_join(struct vp *v, uint32_t node);

/* vp_path: what v did from `begin` until now becomes part of its path; `count` as in path_step.
 * Time before `begin` that nobody has explained was spent on looking around. Inline, as are the two
 * below: each message passes here three times, and nearly every run records nothing. */
static inline void vp_path(struct vp *v, enum path_cause cause, sim_ps begin, int64_t count)
{
    if (__builtin_expect(v->world->path != NULL, 0)) vp_path_record(v, cause, begin, count);
}

/* vp_path_work: the same for counted computing. */
static inline void vp_path_work(struct vp *v, sim_ps begin, const struct work *w)
{
    if (__builtin_expect(v->world->path != NULL, 0)) vp_path_record_work(v, begin, w);
}

/* vp_path_join: v waits for something whose time has node `node`; it binds when it is later than
 * v's clock, so call it before the wait. */
static inline void vp_path_join(struct vp *v, uint32_t node)
{
    if (__builtin_expect(v->world->path != NULL, 0)) vp_path_record_join(v, node);
}

#endif
