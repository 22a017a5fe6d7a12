/* expand_parts.h - what expand.c, expand_point.c and expand_jobs.c share: a plan while it grows. */
#ifndef PLAN_EXPAND_PARTS_H
#define PLAN_EXPAND_PARTS_H

#include "plan/call.h"
#include "plan/expand.h"
#include "plan/jobs_file.h"
#include "plan/machine_changes.h"
#include "spec/identity.h"

/* What holds for all runs on one machine. */
struct start {
    const char *name; /* as it was asked for */
    struct run_spec run; /* machine and base settings applied */
    struct machine_spec file; /* the machine as its file has it */
    struct machine_file whole; /* with where each value comes from */
    struct start *next; /* the one that was made before */
};

/* What a plan keeps, so that a point can be made again with other settings. */
struct plan_memory {
    const struct scenario *scenario;
    struct start *starts;
    struct start **start_of; /* (nrun) on which machine each run is */
};

enum { EXPAND_LISTS = SCENARIO_MAX_AXES + 3 }; /* of settings that act at one point */

/* The answer of plan_options.fits for the point before. */
struct asked {
    struct machine_spec machine;
    int nrank; /* 0: nobody has asked yet, or of jobs */
    bool fits;
    struct err why;
};

struct expansion {
    struct plan *plan;
    const struct scenario *scenario;
    struct err *err;
    struct start *starts; /* made so far, newest first */
    struct start *present; /* of the present point */
    int point[SCENARIO_MAX_AXES]; /* where each axis stands */
    const struct setting_list *job; /* the settings of the job that is made, NULL: there are none */
    const struct err *room; /* why its jobs do not fit together, NULL: they do */
    struct run_spec *run;         /* the plan's */
    struct identity *identity;    /* the scenario's, or of our own (identity_or_own) */
    struct machine_changes changes; /* of the machines seen so far */
    struct calls calls;             /* what runs are called */
    size_t text_bytes;              /* settings of all runs so far, as texts */
    struct asked asked;
    int64_t work; /* left of EXPAND_WORK */
};

/* expand_lists: the settings of the present point in the order in which they act; how many
 * lists. */
int expand_lists(const struct expansion *x, const struct setting_list *list[EXPAND_LISTS]);

/* expand_fits: whether machine m of the present point can be built for nrank ranks, or the jobs
 * (NULL: there is one program); false with the reason and its place. */
bool expand_fits(struct expansion *x, const struct machine_spec *m, int nrank,
                 const struct job_set *jobs, struct err *e);

/* expand_spec: the settings of the present point, with those of x->job, in *run: not yet named or
 * identified. False with x->err. expand_finish: conditions, name, files, identity; 1: made, 0: left
 * out, -1: failed. */
bool expand_spec(struct expansion *x, struct run_spec *run);
int expand_finish(struct expansion *x, struct run_spec *run);

/* expand_path: the model's file of *run, found and digested, unless it was before. False with
 * x->err. */
bool expand_path(struct expansion *x, struct run_spec *run);

/* expand_jobs: the runs of the present point of a scenario with jobs, into run
 * (expand_jobs_runs): one for each job of each combination. Returns how many, -1 with x->err. */
int expand_jobs(struct expansion *x, struct run_spec *run);
int64_t expand_jobs_runs(const struct scenario_jobs *jobs);

#endif
