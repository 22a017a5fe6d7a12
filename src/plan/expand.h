/* expand.h - a scenario's settings combined into the runs of a plan. */
#ifndef PLAN_EXPAND_H
#define PLAN_EXPAND_H

#include "plan/machine_file.h"
#include "plan/plan.h"
#include "plan/scenario_file.h"

/* What plan_options.fits may build for one plan: a second of it at most, but for graphs by
 * chance. */
enum { EXPAND_WORK = 1 << 24 };

/* expand_runs: fill p->run: every point of the axes' cross product, the first axis slowest,
 * repetitions fastest. Returns false with ERR_NO_INPUT, ERR_DATA or ERR_CONFIG. */
bool expand_runs(struct plan *p, const struct scenario *s, struct err *e);

/* expand_machine: the file of the machine of run `index`, with where each value comes from. */
struct machine_file *expand_machine(const struct plan *p, int index);

/* expand_unused: fill p->unused: settings of the scenario and the command line that act in no
 * run. */
void expand_unused(struct plan *p, struct scenario *s);

#endif
