/* forward_form.h - joint forces of a block and of the joints beside it, and the operator form of
 * the constraints (physics 4.8); private to forward*.c.
 *
 *     y_i = Phi_i (F_i - X_{i+1} F_{i+1} - P_i + Fext_i),  z_i = y_i - X_i^T y_{i-1} - b_i
 *
 * H^T z = u', W^T z = 0: the accelerations, and what the constraints are violated by. D is never
 * multiplied out. */
#ifndef KERNEL_FORWARD_FORM_H
#define KERNEL_FORWARD_FORM_H

#include "kernel/forward_rows.h"

/* forward_has_left, forward_has_right: whether bodies lo-1 and hi exist. */
static inline bool forward_has_left(const struct forward *f) { return f->chain.lo > 0; }
static inline bool forward_has_right(const struct forward *f) { return f->chain.hi < f->chain.n; }

/* forward_begin_forces: F = H x of own joints and, by messages, of those beside the block.
 *
 *   x     in  own joints: active forces, borrowed until the solution is over (f->active)
 *   gain  the gain of body lo-1 comes along (physics 4.5, step 4) */
void forward_begin_forces(struct forward *f, const real *x, bool gain);

/* forward_add_reactions: F += W FS of own joints and of both neighbours, after a solution. */
void forward_add_reactions(struct forward *f);

/* forward_body_acceleration: y (SPACE) = Phi_i (force - X_{i+1} next + gain); next, gain NULL:
 * none. */
void forward_body_acceleration(struct forward *f, int i, const real *force, const real *next,
                               const real *gain, real *y);

/* forward_force_above: F (SPACE) of joint i + 1; NULL: there is none. */
const real *forward_force_above(struct forward *f, int i);

/* forward_operator_form: z of own bodies into f->z; without `terms` the velocity terms, the
 * external forces and the base are left out. Notes the residual. */
void forward_operator_form(struct forward *f, bool terms);

/* forward_right_hand_side: r = - what the joints' rows are violated by, into the rows of
 * f->blocks. */
void forward_right_hand_side(struct forward *f);

#endif
