/* trajectory.h - reference trajectories by the GNU Scientific Library's steppers, explicit and
 * implicit, in double.
 *
 * y = [q, u]; quaternions are integrated as four numbers and normalised at the end of each call.
 * Implicit steppers get the Jacobian by finite differences (2 n evaluations); they are for small
 * systems. */
#ifndef DYNAMICS_TRAJECTORY_H
#define DYNAMICS_TRAJECTORY_H

#include "base/arena.h"
#include "base/err.h"
#include "model/model.h"

struct trajectory_options {
    const char *stepper;     /* one of trajectory_steppers */
    /* absolute and relative, per step; with fixed steps: of the implicit equations */
    double tolerance;
    /* so many equal steps, whatever their error; 0: as many as the tolerance asks for */
    long fixed_steps;
    double first_step;       /* [model's time]; 0: a thousandth of the duration */
    long most_evaluations;   /* 0: ten million */
};

struct trajectory_report {
    long steps, evaluations; /* of this call; evaluations include those of Jacobians */
};

/* trajectory_advance: move s (q, qd) by `duration` under s->tau, springs, gravity and s->fext;
 * loops included.
 *
 *   Returns false with ERR_USAGE for an unknown stepper (the nearest name is told), ERR_CHECK when
 * the duration is no positive number, the step size vanishes, evaluations run out, the dynamics
 * break down, a fixed step fails or the end is no number; s is then as it was. Without a joint that
 * moves: true, at once. */
bool trajectory_advance(const struct model *m, struct state *s, double duration,
                        const struct trajectory_options *options, struct arena *scratch,
                        struct trajectory_report *report, struct err *e);

/* trajectory_steppers: their names, NULL-terminated: rk2 rk4 rkf45 rkck rk8pd msadams, implicit
 * rk1imp rk2imp rk4imp bsimp msbdf. */
const char *const *trajectory_steppers(void);

#endif
