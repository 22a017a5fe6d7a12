/* campaign_hosts.h - one campaign on the processes of a job: the first deals out runs, all of them
 * make runs.
 *
 * Each process makes its runs in worker processes of its own, so a crash of a run costs that run,
 * as on one host. A process that goes, where the launcher lets the others live, costs nothing: its
 * runs are made by another one. */
#ifndef RUN_CAMPAIGN_HOSTS_H
#define RUN_CAMPAIGN_HOSTS_H

#include "hosts/hosts.h"
#include "run/run.h"

/* run_campaign_hosts: as run_campaign, by all processes of the job `h`, `workers` runs at a time on
 * each. All call it with equal specs and orders; `skip`, `done` and what is returned matter on the
 * first process (rank 0) alone. Results are handed over as they come, not in plan order, so that
 * little is lost when the job is killed.
 *
 *   gone  out  how many processes did not stay to the end; with any, the job cannot end in order
 * (hosts.h, abort)
 *
 * Returns false as run_campaign; on other processes also when the first one has gone. */
bool run_campaign_hosts(const struct hosts *h, const struct run_spec *spec,
                        const struct run_order *order, int nspec, const bool *skip, int workers,
                        bool quiet, run_done_fn *done, void *context, int *gone, struct err *e);

#endif
