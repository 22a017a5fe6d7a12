/* differences.h - the derivative of a moving system's state, and how it changes with the state, by
 * finite differences.
 *
 * y = [q, u], y' = [q', u'], n = nq + nu numbers, double precision. The 2 n evaluations of a
 * Jacobian are independent of each other: those of a tree are made several at once where the host
 * has registers for it (lanes_type.h), with the same bits. */
#ifndef DYNAMICS_DIFFERENCES_H
#define DYNAMICS_DIFFERENCES_H

#include "dynamics/dynamics.h"
#include "dynamics/lanes_type.h"

struct differences {
    struct dynamics *d;
    const double *tau;             /* (nu) forces of drives */
    long evaluations, most;        /* of the derivative so far, and how many are allowed */
    double *shifted, *change;      /* (n) each */
    const struct lanes_type *type; /* NULL: one state after the other */
    struct lanes *lanes;
    double *state, *q, *u, *ud; /* (n x width), (nq x width), (nu x width) twice */
};

/* differences_make: for m in s's field, under s's wrenches and tau, which is borrowed; `type` as
 * differences.type, without effect on systems with loops. */
struct differences differences_make(const struct model *m, const struct state *s, long most,
                                    const struct lanes_type *type, struct arena *a);

/* differences_derivative: dy = f(y). differences_jacobian: dfdy (n x n), row i: how dy[i] changes
 * with each y. False: the dynamics break down, or `most` evaluations have been made. */
bool differences_derivative(struct differences *f, const double *y, double *dy);
bool differences_jacobian(struct differences *f, const double *y, double *dfdy);

#endif
