/* why_runs.h - the runs that a study of why.h is made of. */
#ifndef STUDY_WHY_RUNS_H
#define STUDY_WHY_RUNS_H

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "spec/run_spec.h"

/* why_bare: what a study needs of `spec` beside the order of its own: no timelines, no counters of
 * links; its critical path where `path` says so. */
struct run_spec why_bare(const struct run_spec *spec, bool path);

/* why_batch: run n specs; arrays of result[i] are in `a`, without timelines. Returns false as
 * run_campaign. */
bool why_batch(const struct run_spec *spec, int n, int workers, bool quiet, struct arena *a,
               struct run_result *result, struct err *e);

#endif
