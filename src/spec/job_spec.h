/* job_spec.h - several jobs on one machine: which of them a run tells of, and what is beside it. */
#ifndef SPEC_JOB_SPEC_H
#define SPEC_JOB_SPEC_H

#include <stdbool.h>

#include "base/arena.h"

struct identity;
struct run_spec;

enum { JOB_MOST = 64, JOB_NAME = 32, JOB_BESIDE = 160 }; /* jobs of a set, bytes of names */

/* Settings of a run; all but `start` are made by the plan. */
struct job_spec {
    char name[JOB_NAME]; /* of the job that the run tells of; "": the machine has one program */
    int number;          /* its place in the set, from 1; 0: none */
    char beside[JOB_BESIDE]; /* names of the others that run, joined by " + "; "": it runs alone */
    char set[17]; /* digest of all jobs with their places, whoever of them runs, and the machine */
    double start; /* when it begins [s] */
};

/* All jobs of one scenario at one point of its sweep, and which of them run. The jobs' own specs
 * are those of their programs alone: of the machine they have their placement, and neither labels
 * nor records. */
struct job_set {
    int n;
    const struct run_spec *const *job; /* (n) borrowed */
    const bool *idle;        /* (n) it keeps its processors and does not run; borrowed */
    const char *const *text; /* (n) its settings that differ from defaults, as lines; borrowed */
};

/* job_alone: `run` as a member of a set: what says nothing of its program and its place has its
 * default. */
struct run_spec job_alone(const struct run_spec *run);

/* job_set_lines: the settings of all jobs but number `own` (from 1) as lines
 * "jobs.NUMBER.KEY = VALUE", and "jobs.NUMBER.idle = true", appended: what identifies a run beside
 * others. */
struct text;
void job_set_lines(const struct job_set *s, int own, struct text *out);

/* job_set_digest: 16 digits in hex that tell sets apart by their jobs and by `machine`, the
 * settings of the machine as lines; `idle` does not count. */
void job_set_digest(const struct job_set *s, const char *machine, char digest[17]);

#endif
