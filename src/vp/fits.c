/* fits.c - whether a machine can be built for its ranks, before any of them exists (world.h). */
#include "spec/job_spec.h"
#include "vp/ground.h"
#include "vp/world_parts.h"

/* The places of all jobs of a set, idle ones too, or those of nrank ranks alone. */
static bool make_places(struct world *w, const struct job_set *jobs, struct err *e)
{
    struct placement_job job[JOB_MOST];
    struct placement place[JOB_MOST];
    for (int i = 0; jobs && i < jobs->n; i++)
        job[i] = (struct placement_job){jobs->job[i]->job.name, &jobs->job[i]->machine.placement,
                                        jobs->job[i]->nrank};
    return ground_make(w, place, jobs ? jobs->n : 1, jobs ? job : NULL, e);
}

/* As a run would begin, and no further. What takes time is counted, since a few bytes of text ask
 * for 10^8 links, or for 100,000 runs: tables of routes before they are made. */
bool world_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs, int64_t *work,
                struct err *e)
{
    if (*work < 0) return true;
    struct world w = {
        .machine = m, .nrank = nrank, .scratch = arena_create(), .sim = sim_create()};
    bool fits = make_places(&w, jobs, e);
    if (fits)
        *work -= (int64_t)nrank + w.topology->nnode + w.topology->nrouter + w.topology->nlink;
    /* auto-tolerance is no level yet. */
    if (fits && *work >= 0 && m->network.level != LEVEL_AUTO_TOLERANCE)
        fits = world_make_network(&w, false, e);
    sim_destroy(w.sim);
    arena_destroy(w.scratch);
    return fits;
}
