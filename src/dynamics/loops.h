/* loops.h - all loops of a model together: poses, forces on bodies, residuals; for the serial
 * algorithms. */
#ifndef DYNAMICS_LOOPS_H
#define DYNAMICS_LOOPS_H

#include "dynamics/dynamics.h"
#include "dynamics/loop.h"

struct loops {
    int nloop, nrow;
    struct loop *loop;        /* (nloop) */
    struct loop_pose *pose;   /* (nloop) */
};

/* loops_take: the loops of d's model, placed at d's poses and velocities (dynamics_velocities);
 * memory from d->arena, so that a mark taken before gives it back. This and the functions below add
 * what they execute to *w. */
void loops_take(struct dynamics *d, struct loops *l, struct work *w);

/* loops_force: f (nbody x 6) += forces of lambda (nrow) on the bodies. */
void loops_force(const struct loops *l, const real *lambda, real *f, struct work *w);

/* loops_column: f (nbody x 6) += forces of the unit lambda number k. */
void loops_column(const struct loops *l, int k, real *f, struct work *w);

/* loops_residual: r (nrow) from body accelerations a (nbody x 6) and the base's (6; NULL: zero).
 *   homogeneous: without velocity terms and stabilisation. */
void loops_residual(const struct loops *l, const real *a, const real *base, bool homogeneous,
                    real *r, struct work *w);

/* loops_reference: (nrow) diagonal of A_ll = sum of column^T Phi column; for bodies without Phi, 1
 * / mass alone. */
void loops_reference(const struct dynamics *d, const struct loops *l, real *reference,
                     struct work *w);

/* loops_respond: S = J M^-1 J^T (nrow x nrow), symmetric, and the responses M^-1 J^T to unit loop
 * forces (nu), `stride` numbers apart (0: each over the one before); at d's poses. d->a is
 * overwritten. Returns false as aba_response. */
bool loops_respond(struct dynamics *d, const struct loops *l, real *response, size_t stride,
                   real *s, struct work *w);

#endif
