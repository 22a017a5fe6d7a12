/* task.h - what a run computes, whatever machine it is for: its identity without machine, level,
 * seed and records. */
#ifndef SPEC_TASK_H
#define SPEC_TASK_H

#include "base/arena.h"
#include "spec/run_spec.h"

/* task_of: a copy of `run` that two runs have in common when their ranks do the same: its
 * config_hash and config_text (in `a`) are those of the task. */
struct run_spec task_of(const struct run_spec *run, struct arena *a);

#endif
