/* forward_exact.h - joint forces and the accelerations they give in twice the working precision
 * (physics 8.6); private to forward*.c.
 *
 * Light bodies between heavy ones, and bodies that are nearly points, move by the difference of
 * accelerations many times larger: forces of working precision cannot even represent the answer.
 * Held in twice the digits, corrected through the system as factored in working precision, they
 * converge to it as long as that solution has any correct digit (mixed precision refinement:
 * Wilkinson 1963; Carson and Higham 2018). Bodies enter by mass, centre and inertia about it, not
 * by Phi, whose rounding alone would lose as much. */
#ifndef KERNEL_FORWARD_EXACT_H
#define KERNEL_FORWARD_EXACT_H

#include "kernel/forward.h"

/* What an operation in twice the working precision counts for in working ones: two numbers for one,
 * sums and products without error (Hida, Li, Bailey 2001: 20 to 24). */
enum { TWICE_FLOP = 20 };

/* exact_begin: the present forces of own joints and of those beside the block, as they are in
 * working precision. */
void exact_begin(struct forward *f);

/* exact_force: F (SPACE) of joint i, own or beside the block. */
static inline twice *exact_force(const struct forward *f, int i)
{
    const int lo = f->chain.lo, hi = f->chain.hi;
    return f->exact + SPACE * (i < lo ? hi - lo : i == hi ? hi - lo + 1 : i - lo);
}

/* exact_add: F += x (SPACE) for joint i, own or beside the block. */
static inline void exact_add(struct forward *f, int i, const real *x)
{
    twice *force = exact_force(f, i);
    for (int k = 0; k < SPACE; k++) force[k] += x[k];
    f->chain.work.flop += TWICE_FLOP * SPACE;
}

/* exact_operator_form: z of own bodies (4.8), rounded once, from these forces; f->residual with it.
 * The flags say which terms there are: loads (gain), joint bias accelerations, the base's. */
void exact_operator_form(struct forward *f, bool gain, bool bias, bool base);

#endif
