/* scenario_file.h - a scenario as its file and the command line give it: settings that hold for all
 * runs, axes whose points are combined, and what is left out. Nothing is resolved yet. */
#ifndef PLAN_SCENARIO_FILE_H
#define PLAN_SCENARIO_FILE_H

#include "plan/condition.h"
#include "plan/plan.h"
#include "plan/setting.h"

enum { SCENARIO_MAX_PROGRAMS = 32, SCENARIO_MAX_AXES = 16, SCENARIO_MAX_POINTS = 100000,
       SCENARIO_MAX_CONDITIONS = 16 };

/* One axis of the sweep: at each point several settings change together. */
struct axis {
    const char *key; /* full key, "variant" or "sample" */
    int line;
    bool searched;   /* one of its points is chosen (`optimise:`) */
    int npoint;
    struct setting_list *point; /* (npoint) */
};

struct scenario_program;

struct scenario {
    const char *path, *stem, *dir;
    bool typed;                       /* its programs were named on the command line */
    int nprogram;
    struct scenario_program *program; /* (nprogram) people's own programs (program_file.h) */
    const char *question;
    struct setting_list base; /* of all runs */
    struct setting_list set;  /* --set, after everything else */
    int naxis;
    struct axis axis[SCENARIO_MAX_AXES];
    int repetitions;
    int ncondition;
    struct condition condition[SCENARIO_MAX_CONDITIONS]; /* points that fail one are left out */
    struct plan_search *search; /* NULL: nothing is optimised */
    struct scenario_jobs *jobs; /* what shares the machine (jobs_file.h); NULL: one program */
    struct plan_answer *answer; /* NULL: no sentence is wanted */
    plan_fits *fits;           /* of plan_options */
    struct identity *identity; /* the same */
    int nfigure;
    const char **figure;
};

/* scenario_lists: every list of settings that `s` has: the base, each point of each axis, those of
 * its jobs, --set. A table in `a` into *list; returns how many. */
int scenario_lists(struct scenario *s, struct arena *a, struct setting_list ***list);

/* scenario_file_read: scenario `name` (see data_dir_find) with `o`. Returns false with
 * ERR_NO_INPUT, ERR_DATA or ERR_USAGE. */
bool scenario_file_read(struct scenario *s, const char *name, const struct plan_options *o,
                        struct arena *a, struct err *e);

/* scenario_file_tree: the same from a tree already read, whose keys may be renamed. */
bool scenario_file_tree(struct scenario *s, struct node *root, const char *path,
                        const struct plan_options *o, struct arena *a, struct err *e);

#endif
