/* ground.h - what a run stands on before its ranks go: checked prices, the topology, the places of
 * the ranks. */
#ifndef VP_GROUND_H
#define VP_GROUND_H

#include "machine/placement_jobs.h"
#include "vp/vp.h"

/* ground_make: w->topology of w->machine, from w->scratch, and the places of its ranks in *p; of n
 * jobs, where `job` is not NULL, p[0] .. p[n - 1]. False with ERR_CONFIG. */
bool ground_make(struct world *w, struct placement *p, int n, const struct placement_job *job,
                 struct err *e);

#endif
