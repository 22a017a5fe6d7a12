/* fits.c - whether a machine can be built for its ranks, and what memory it takes, before any of
 * them exists (world.h). */
#include "spec/job_spec.h"
#include "vp/ground.h"
#include "vp/world_parts.h"

/* The places of all jobs of a set, idle ones too, or w's own of nrank ranks alone. */
static bool make_places(struct world *w, const struct job_set *jobs, struct err *e)
{
    struct placement_job job[JOB_MOST];
    struct placement place[JOB_MOST];
    for (int i = 0; jobs && i < jobs->n; i++)
        job[i] = (struct placement_job){jobs->job[i]->job.name, &jobs->job[i]->machine.placement,
                                        jobs->job[i]->nrank};
    if (!jobs) return ground_make(w, &w->placement, 1, NULL, e);
    return ground_make(w, place, jobs->n, job, e);
}

/* A machine without a run. */
static struct world bare(const struct machine_spec *m, int nrank)
{
    return (struct world){
        .machine = m, .nrank = nrank, .scratch = arena_create(), .sim = sim_create()};
}

static void bare_end(struct world *w)
{
    sim_destroy(w->sim);
    arena_destroy(w->scratch);
}

/* What takes time is counted, since a few bytes of text ask for 10^8 links, or for 100,000 runs:
 * tables of routes before they are made. False: no more may be built. */
static bool work_left(const struct world *w, int64_t *work)
{
    *work -= (int64_t)w->nrank + w->topology->nnode + w->topology->nrouter + w->topology->nlink;
    return *work >= 0;
}

/* As a run would begin, and no further. */
bool world_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs, int64_t *work,
                struct err *e)
{
    if (*work < 0) return true;
    struct world w = bare(m, nrank);
    bool fits = make_places(&w, jobs, e);
    /* auto-tolerance is no level yet. */
    if (fits && work_left(&w, work) && m->network.level != LEVEL_AUTO_TOLERANCE)
        fits = world_make_network(&w, false, e);
    bare_end(&w);
    return fits;
}

double world_memory(const struct machine_spec *m, int nrank, double messages, bool links,
                    int64_t *work)
{
    if (*work < 0 || m->network.level == LEVEL_AUTO_TOLERANCE) return 0;
    struct world w = bare(m, nrank);
    struct err ignored;
    double bytes = 0;
    err_clear(&ignored);
    if (make_places(&w, NULL, &ignored) && work_left(&w, work)) {
        /* Filled when they are made, unlike those of the network. */
        const size_t filled = arena_peak(w.scratch), before = arena_used(w.scratch);
        if (world_make_network(&w, links, &ignored))
            bytes = (double)filled + net_memory(w.net, arena_used(w.scratch) - before,
                                                w.placement.node, nrank, messages);
    }
    bare_end(&w);
    return bytes;
}
