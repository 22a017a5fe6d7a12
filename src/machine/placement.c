/* placement.c - ranks onto processors: an order of the processors, of which the first nrank are
 * used (placement_order.h). */
#include "machine/placement.h"

#include "base/check.h"
#include "machine/placement_jobs.h"
#include "machine/placement_order.h"

static int64_t working_processors(const struct machine_spec *m, const struct topology *t)
{
    int64_t nodes = 0;
    if (topology_whole(t)) return (int64_t)t->nnode * m->topology.processors_per_node;
    for (int i = 0; i < t->nnode; i++) nodes += placement_works(t, i);
    return nodes * m->topology.processors_per_node;
}

/* One rank a processor: there is no time slicing in this simulator. */
bool placement_create(struct placement *p, const struct machine_spec *m, const struct topology *t,
                      int nrank, struct arena *a, struct err *e)
{
    const struct placement_job all = {NULL, &m->placement, nrank};
    const int64_t nprocessor = (int64_t)t->nnode * m->topology.processors_per_node;
    CHECK(nrank >= 1);
    if (nrank > nprocessor)
        return err_set(e, ERR_CONFIG, "%d ranks do not fit on machine %s with %lld processors",
                       nrank, m->name, (long long)nprocessor);
    int64_t working = working_processors(m, t);
    if (nrank > working)
        return err_set(e, ERR_CONFIG,
                       "%d ranks do not fit on machine %s: %lld of its %lld processors work "
                       "(network.failed)",
                       nrank, m->name, (long long)working, (long long)nprocessor);
    if (!placement_fits(m, e)) return false;
    const enum placement_kind kind = m->placement.kind;
    if (kind == PLACEMENT_LIST || kind == PLACEMENT_RANDOM || kind == PLACEMENT_GROUPS)
        return placement_create_jobs(p, m, t, 1, &all, a, e);
    /* No table of processors: a machine may have millions, of which a run uses a few. */
    const int per_node = m->topology.processors_per_node;
    *p = (struct placement){nrank, TAKE(a, nrank, int), TAKE(a, nrank, int)};
    /* `place` counts all processors in the order, r those that work. */
    int64_t place = 0;
    for (int r = 0; r < nrank; place++) {
        const int64_t processor = placement_processor(m, t, place);
        if (!placement_works(t, (int)(processor / per_node))) continue;
        p->node[r] = (int)(processor / per_node);
        p->processor[r++] = (int)(processor % per_node);
    }
    return true;
}
