/* call.h - what each run of a plan is called: the name that was given, or the machine with what was
 * changed of it. */
#ifndef PLAN_CALL_H
#define PLAN_CALL_H

#include "base/arena.h"
#include "plan/setting.h"

/* What is remembered from run to run; begins as zeros with the arena. */
struct calls {
    struct arena *arena;
    const char *last; /* the name of the run before: thousands of runs share one */
};

/* The settings of one axis of the sweep at the point of a run. */
struct call_point {
    bool swept; /* the axis has other points, too */
    int n;
    const struct setting *at; /* (n) */
};

/* call_run: fill run->called, after machine_changes_note. A given name (run->label) holds for all
 * points of a sweep, so what the sweep changes of the machine is added to it: no two machines share
 * a name.
 *
 *   file   in  the machine as its file has it: what a machine that is not shipped is compared with
 *   point  in  (npoint) the settings of each axis; an axis that gives a name itself has named what
 * it changes */
void call_run(struct calls *c, struct run_spec *run, const struct machine_spec *file,
              const struct call_point *point, int npoint);

#endif
