/* integrate.h - fixed time steps of a whole system, in the build's precision; physics 9.
 *
 * q moves on its group: quaternions by the exponential of u h (semi-implicit, KDK) or normalised
 * after each step (RK4). Joint springs act at every evaluation, the given joint forces are
 * constant. */
#ifndef DYNAMICS_INTEGRATE_H
#define DYNAMICS_INTEGRATE_H

#include <stdbool.h>

#include "dynamics/dynamics.h"
#include "spec/kernel_spec.h"

/* dynamics_forward: ud at (q, u) with springs added to tau: aba, closed_forward when there are
 * loops. */
bool dynamics_forward(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                      struct work *w);

/* implicit_forward: ud that gives velocities at the end of a step of h when spring and damper
 * forces are those at its end, linearised: (M + s) ud = tau - k (q - rest + h q') - c u - xi,
 * s = h c + h^2 k q'/u, physics (9.0); q' = u but for helical joints. Open systems only. Returns
 * false when a pivot is not positive. */
bool implicit_forward(struct dynamics *d, real h, const real *q, const real *u, const real *tau,
                      real *ud, struct work *w);

struct integrator {
    struct dynamics *d;
    enum step_rule rule;
    real h;              /* step [model's time unit] */
    real *q, *u;         /* (nq), (nu) the state; borrowed */
    const real *tau;     /* (nu) borrowed */
    real *a;             /* (nu) KDK: the last acceleration */
    bool has_a;
    long evaluations;
    struct work work;
};

/* integrator_make: to move q, u in place. Memory from d->arena. */
struct integrator integrator_make(struct dynamics *d, enum step_rule rule, real h, real *q, real *u,
                                  const real *tau);

/* integrator_step: one step:
 *   semi-implicit  u += h a(q, u); q += h N(q) u order 1 kdk            u += h/2 a0; q += h N u; a1
 * = a(q, u + h/2 a0); u += h/2 a1; a1 is the next a0    order 2 rk4            the classical
 * Runge-Kutta method on (q, u)                                        order 4 linearly-implicit
 * semi-implicit with a from implicit_forward: stable whatever k and c             order 1 Returns
 * false when the dynamics broke down, or a closed system is to be stepped implicitly. */
bool integrator_step(struct integrator *it);

/* loop_project: put (q, u) back on the loops: `newton` times q += M^-1 J^T S^+ (-g), then u -= M^-1
 * J^T S^+ J u: the nearest state in the sense of kinetic energy. newton = 0 mends velocities alone.
 * Returns false as aba. */
bool loop_project(struct dynamics *d, real *q, real *u, int newton, struct work *w);

#endif
