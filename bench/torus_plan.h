/* torus_plan.h - the main scenario on a T3E torus of any size, for measuring programs. */
#ifndef BENCH_TORUS_PLAN_H
#define BENCH_TORUS_PLAN_H

#include <stdbool.h>

#include "plan/plan.h"

/* torus_plan_read: scenario speedup-t3e with n = P = nrank (a power of two) at network level
 * `level`, on a torus with as many processors and dimensions as equal as they can be; run[0] of *p
 * is the point. Returns false as plan_read. */
bool torus_plan_read(struct plan *p, int nrank, const char *level, struct err *e);

#endif
