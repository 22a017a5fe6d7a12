/* jobs_file.h - `jobs:` of a scenario: programs that share a machine, each with its settings, its
 * start and its place, and which of them run together. */
#ifndef PLAN_JOBS_FILE_H
#define PLAN_JOBS_FILE_H

#include "plan/scenario_file.h"

/* Which combinations of the jobs are run. */
enum { COMBINE_ALL = 1, COMBINE_ALONE = 2, COMBINE_PAIRS = 4 };

struct scenario_job {
    const char *name;
    int line;
    struct setting_list set; /* its own settings, over those that hold for all */
    double start;            /* [s] */
};

struct scenario_jobs {
    int n, line;
    struct scenario_job job[JOB_MOST]; /* (n) */
    unsigned combine;                  /* COMBINE_*; 0: nobody has said: all together */
    int64_t nplace;                    /* processors that files of places have named so far */
};

/* jobs_file_read: the list `jobs` into s->jobs. jobs_file_combine: the words of `combinations`,
 * `all`, `alone`, `pairs`, of a list or a text. False with ERR_DATA, file and line. */
bool jobs_file_read(struct scenario *s, const struct node *list, struct arena *a, struct err *e);
bool jobs_file_combine(struct scenario *s, const struct node *words, struct arena *a,
                       struct err *e);

/* jobs_file_check: jobs beside the rest of the scenario: nothing is both swept and set by a job,
 * and nothing is optimised. False with ERR_DATA. */
bool jobs_file_check(const struct scenario *s, struct err *e);

/* jobs_file_set: "jobs.NAME.KEY", as of --set, gets the value `text`. False with ERR_DATA. */
bool jobs_file_set(struct scenario *s, const char *key, const char *text, struct arena *a,
                   struct err *e);

#endif
