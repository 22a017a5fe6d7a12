/* jobs.h - several jobs on one machine at once: each with its own ranks, stages, barrier and
 * result, all with one network and one simulated time.
 *
 * Each job is a world (vp.h) of its own ranks, numbered from 0, so that a program sees nothing of
 * the others; what the machine has once (network, events, the ring of ranks that can go on, the
 * kernel server) belongs to one more world, the whole. Times of a result count from the job's own
 * start: a job that nobody disturbs has the times, and the digests of its ranks, that it has alone.
 */
#ifndef VP_JOBS_H
#define VP_JOBS_H

#include "vp/world.h"

struct world_job {
    const char *name;             /* for messages */
    const struct world_load *load; /* NULL: it only keeps its processors, and its number */
    int nrank;
    const struct placement_spec *placement; /* on what the jobs before it have left */
    int64_t start_ps;             /* when its ranks begin */
    uint64_t seed;                /* of its noise */
    const struct record_spec *record; /* neither path nor balance */
    struct arena *arena;          /* of its result's arrays */
    struct run_result *out;       /* as of world_run */
};

/* world_run_jobs: run n jobs (at most JOB_MOST) on machine `m`, whose own placement does not
 * matter, to the end of all. `seed`: of the background traffic; `scratch` as in world_load.
 *
 *   When one job fails, or waits for ever, no other has a result: RUN_FAILED, and its text names
 * that job. Returns false only for ERR_CONFIG or ERR_INTERNAL. */
bool world_run_jobs(const struct machine_spec *m, const struct world_job *job, int n,
                    uint64_t seed, struct run_heartbeat *heartbeat, struct arena *scratch,
                    struct err *e);

#endif
