/* placement_jobs.h - several jobs on the processors of one machine: each has its own way to choose
 * among those that are left. */
#ifndef MACHINE_PLACEMENT_JOBS_H
#define MACHINE_PLACEMENT_JOBS_H

#include "machine/placement.h"

struct placement_job {
    const char *name; /* for messages; NULL: there is one job, and messages need no name */
    const struct placement_spec *spec;
    int nrank;
};

/* placement_create_jobs: p[i] for each of the n jobs, memory from `a`.
 *
 * Lists are served first, since they say which processors they want; then the others in their
 * order. `linear`, `snake` and `gray` take the first free processors along their order, `random`
 * draws from the free ones, `groups` takes the smallest part of the network that has room for the
 * whole job (placement_groups). A job alone lies where placement_create puts it.
 *
 * Processors of routers that do not work are nobody's. Returns false with ERR_CONFIG when there are
 * too few processors, two jobs name the same one, or a list is wrong. */
bool placement_create_jobs(struct placement *p, const struct machine_spec *m,
                           const struct topology *t, int n, const struct placement_job *job,
                           struct arena *a, struct err *e);

/* placement_groups: sizes of the parts that a network consists of, in nodes, rising, the whole
 * machine last; parts are blocks of consecutive nodes. Routers; of grids lines, planes and so on;
 * sub-cubes; sub-trees; groups of a dragonfly. Into size (PLACEMENT_LEVELS); returns how many. */
enum { PLACEMENT_LEVELS = TOPOLOGY_PARTS + 2 };
int placement_groups(const struct topology *t, int64_t *size);

#endif
