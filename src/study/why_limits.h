/* why_limits.h - how long the run takes on idealised machines, and with its work shared evenly. */
#ifndef STUDY_WHY_LIMITS_H
#define STUDY_WHY_LIMITS_H

#include "study/why.h"

/* why_limits: fill w->limit; w->run is the run of `spec`, with its stages. Workers, quiet, a as for
 * why_study. Returns false as run_campaign. */
bool why_limits(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                struct why *w, struct err *e);

/* why_even: tables in `a` that let every rank compute the mean over the ranks in each stage of `r`;
 * what whole picoseconds leave over is the first ranks'. */
struct balance *why_even(const struct run_result *r, struct arena *a);

#endif
