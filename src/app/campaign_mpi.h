/* campaign_mpi.h - `mimdsim run --campaign mpi`: what the processes of a job agree upon before and
 * after the runs. */
#ifndef APP_CAMPAIGN_MPI_H
#define APP_CAMPAIGN_MPI_H

#include "app/verb.h"
#include "hosts/hosts.h"
#include "run/run.h"

struct job {
    /* --campaign mpi was given; else this process is alone, and nothing below does anything */
    bool on;
    bool agreed, started; /* the plans are equal; the runs have begun */
    /* processes that did not stay; stderr while the command line is read, -1: not kept */
    int gone, kept;
    struct hosts h;
};

/* job_open: join the job. `campaign`: what stands behind --campaign, NULL: nothing. Processes but
 * the first are silent until job_heard. Returns false with ERR_USAGE, or as hosts_open. */
bool job_open(struct job *j, const char *campaign, struct err *e);

/* job_open_started, job_open_alone: the same in two steps, for verbs that are a job also without a
 * launcher. Before the command line is read, a process that a launcher started joins; afterwards,
 * one that is alone: --help and a wrong option need no MPI. */
bool job_open_started(struct job *j, struct err *e);
bool job_open_alone(struct job *j, struct err *e);

/* job_heard: the command line is read. Only the first process makes remarks from now on. */
void job_heard(struct job *j, struct common *c);

/* job_agree: whether all processes have read the same plan with the same build of this program
 * (`ok`: this one could). False with the error of the first process, or naming a process that
 * differs. */
bool job_agree(struct job *j, const struct plan *p, bool ok, struct err *e);

/* job_run: the runs of the plan, as settled in `run` (p->nrun), by all processes. The first one's
 * levels hold for all. Else as run_campaign_hosts. */
bool job_run(struct job *j, const struct plan *p, struct run_spec *run,
             const struct run_order *order, const bool *skip, const struct common *c,
             run_done_fn *done, void *context, struct err *e);

/* job_spread: the runs of the plan one after the other, each on all processes together
 * (docs/parallel.md): rank 0 hands over results. `begin`, on rank 0, is told of each run before it
 * is made; false ends the job. Called by all. */
typedef bool job_begin_fn(void *context, const struct run_spec *spec);
bool job_spread(struct job *j, const struct plan *p, struct run_spec *run,
                const struct run_order *order, const bool *skip, job_begin_fn *begin,
                run_done_fn *done, void *context, struct err *e);

/* job_end: leave the job. Returns the exit status of this process; `status`: of what it did. */
int job_end(struct job *j, int status);

#endif
