/* forward_rows.h - one joint's row of the constraint system: which force components are unknown,
 * its blocks and what violates it; private to forward*.c.
 *
 * An ordinary joint has a row for each of its c constraint components, along W. A joint whose
 * spring is stepped implicitly (implicit.h) has one for every component, along [H W]. */
#ifndef KERNEL_FORWARD_ROWS_H
#define KERNEL_FORWARD_ROWS_H

#include "kernel/forward.h"
#include "kernel/implicit.h"

/* forward_body: constants of body i. */
static inline const struct body *forward_body(const struct forward *f, int i)
{
    return &f->chain.shared->body[i];
}

/* forward_subspace: H and W of joint i, own or beside the block. */
static inline const struct subspace *forward_subspace(const struct forward *f, int i)
{
    return i < f->chain.lo ? f->left : &chain_pose(&f->chain, i)->s;
}

/* forward_resistance: s of joint i; 0: an ordinary joint. */
static inline real forward_resistance(const struct forward *f, int i)
{
    return spring_resistance(forward_body(f, i), f->step);
}

/* forward_row_size: components of joint i's force that are unknown. */
static inline int forward_row_size(const struct forward *f, int i)
{
    return forward_resistance(f, i) > 0 ? SPACE : SPACE - forward_body(f, i)->d;
}

/* forward_project: out (row_size(i) x row_size(j)) = Q_i^T M Q_j in the columns of the rows of
 * joints i and j. */
void forward_project(struct forward *f, int i, const real *M, int j, real *out);

/* forward_add_reaction: F += W x for joint i, x (c), or [H W] x (SPACE). */
void forward_add_reaction(struct forward *f, int i, const real *x, real *force);

/* forward_violation: out (row_size(i)): W^T z of own joint i; with a resistance H^T z - s^-1 (tau_0
 * - H^T F) before it, tau_0 being the active forces that the solution began with. Its work is the
 * caller's to count. */
void forward_violation(struct forward *f, int i, const real *z, real *out);

/* forward_violation_flops: of it; with a resistance a division comes on top. */
static inline int forward_violation_flops(const struct forward *f, int i)
{
    const struct joint_cost *cost = body_cost(forward_body(f, i));
    return cost->w_transposed + (forward_resistance(f, i) > 0 ? 2 * cost->h_transposed + 3 : 0);
}

#endif
