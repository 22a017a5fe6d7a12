/* spring.h - springs of joints whose forces are those at the end of a time step, linearised
 * (physics 9.0), in space and in the plane. */
#ifndef DYNAMICS_SPRING_H
#define DYNAMICS_SPRING_H

#include "dynamics/algebra.h"

/* spring_resistance: s of a body's joint for steps of h; 0: its forces are explicit. */
static inline real spring_resistance(const struct body *b, real h)
{
    const struct joint_spring *s = body_spring_of(b);
    return b->has_spring ? h * (s->damping + h * s->rate_stiffness) : 0;
}

/* spring_force: tau_0 for tau (d), to which body_spring has added the forces at the begin of the
 * step. */
static inline void spring_force(const struct body *b, real h, const real *u, real *tau)
{
    if (b->has_spring && h > 0) tau[0] -= h * body_spring_of(b)->rate_stiffness * u[0];
}

#endif
