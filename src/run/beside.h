/* beside.h - a run beside other jobs: all programs of its set on one machine, and what comes of its
 * own. */
#ifndef RUN_BESIDE_H
#define RUN_BESIDE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "program/program.h"

/* beside_attempts: the ranks of `r`, an opened program whose spec has jobs, with the other jobs
 * that run, again while one of the programs asks for it. The others' programs are opened and closed
 * here.
 *
 *   scratch  in   memory of the ranks' workspaces; world: of the machine
 *   out      out  as of run_attempts: of r alone, with its arrays in `a`
 *
 *   Returns false as run_one; what makes another job impossible is told with its name. */
bool beside_attempts(struct program_run *r, struct arena *scratch, struct arena *world,
                     struct arena *a, struct run_result *out, struct err *e);

#endif
