/* rank_stack.h - the stacks of built-in programs' ranks: how large they are, and what becomes of a
 * run whose rank needs more. */
#ifndef RUN_RANK_STACK_H
#define RUN_RANK_STACK_H

#include "base/err.h"
#include "vp/world.h"

/* The environment variable that says how large; it acts on no result. */
#define RANK_STACK_VARIABLE "MIMDSIM_STACK"

/* rank_stack_set: stacks of `load`, whose program is a built-in one, as MIMDSIM_STACK says ("256
 * KiB", 4 KiB to 1 GiB), else as usual; a rank that needs more ends the process with a sentence:
 * in a worker of a campaign by crash_told, so that its parent stores the run as failed; elsewhere
 * on standard error, with the status of ERR_DEADLOCK, as the program cannot go on. Returns false
 * with ERR_USAGE for a variable that is no size. */
bool rank_stack_set(struct world_load *load, struct err *e);

#endif
