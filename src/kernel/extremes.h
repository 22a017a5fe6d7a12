/* extremes.h - the largest numbers of all ranks, known to all: decisions that must be the same
 * everywhere. */
#ifndef KERNEL_EXTREMES_H
#define KERNEL_EXTREMES_H

#include <stdbool.h>

#include "comm/comm.h"
#include "linalg/real.h"

/* largest_size: the larger of `so_far` and the magnitudes of x (n); infinite when one is not a
 * number. */
real largest_size(real so_far, int n, const real *x);

/* largest_everywhere: x[i] = the largest x[i] of all ranks, i < n <= 4, by dissemination in
 * ceil(log2 P) rounds (a maximum may be counted twice). Every rank must call. */
void largest_everywhere(struct comm *c, int tag, int n, real *x);

/* The course of outer refinement (physics 8.6): it is worth while the constraints are not met to
 * nearly all digits, and goes on while corrections shrink. */
struct refinement {
    real before; /* size of the last correction over that of the answer; 1 before the first */
};

/* refinement_begin: false when `residual` of the worst rank is so small that inverse dynamics,
 * whose scans round each force on its own, would rather add errors than remove any. An infinite
 * residual says that it tells nothing. */
bool refinement_begin(struct refinement *r, struct comm *c, int tag, real residual);

/* refinement_run: at most `most` corrections of the solution whose residual and scale these are.
 *
 *   sees      in   the residual tells whether the answer needs a correction; false: it has to be
 * tried correct   in   one correction of `solver`; false: it would not have made the answer better
 *   residual  in out  of the answer; afterwards the smaller of it and of the last correction
 *   scale     in out  of the answer; corrections have scales of their own, so it is put back
 *
 *   Returns the number of corrections. Every rank must call. */
int refinement_run(struct comm *c, int tag, int most, bool sees, real *residual, real *scale,
                   bool (*correct)(void *solver, struct refinement *course), void *solver);

/* refinement_accept: whether the correction (n of each rank) to the answer is smaller than the one
 * before it. */
bool refinement_accept(struct refinement *r, struct comm *c, int tag, int n, const real *correction,
                       const real *answer);

#endif
