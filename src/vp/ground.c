/* ground.c - see ground.h. */
#include "vp/ground.h"

#include "machine/node_use.h"
#include "vp/offload.h"

bool ground_make(struct world *w, struct placement *p, int n, const struct placement_job *job,
                 struct err *e)
{
    const struct machine_spec *m = w->machine;
    if (!node_use_check(m, e) || !offload_check(m, e)) return false;
    w->topology = topology_create(&m->topology, w->scratch, e);
    if (!w->topology) return false;
    /* Jobs all at once: a place that one of them has is none for another. */
    return job ? placement_create_jobs(p, m, w->topology, n, job, w->scratch, e)
               : placement_create(p, m, w->topology, w->nrank, w->scratch, e);
}
