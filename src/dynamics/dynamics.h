/* dynamics.h - serial rigid-body dynamics of trees and closed chains, in the build's precision.
 *
 * A `struct dynamics` holds one model's constants and work arrays; functions take coordinates in
 * model order (model.h). Everything is body-local: no function's accuracy depends on where the base
 * is or how fast it moves. Work is counted by formula from the number of bodies of each joint type.
 * Sources: Featherstone, Rigid Body Dynamics Algorithms, chapters 5-7; the constraint force
 * algorithm after Fijany, Sharf and D'Eleuterio (1995). */
#ifndef DYNAMICS_DYNAMICS_H
#define DYNAMICS_DYNAMICS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "dynamics/body.h"
#include "linalg/real.h"
#include "model/model.h"

enum { DYNAMICS_SCRATCH = 64 };

struct revolute;              /* compact constants of a body on a revolute joint: revolute.h */

struct dynamics {
    const struct model *model;
    int nbody, nu;
    const struct body *body;  /* (nbody) constants */
    /* (nbody) the same, compact, when all joints are revolute; else NULL */
    struct revolute *revolute;
    struct body_pose *pose;   /* (nbody) of the last dynamics_place */
    /* (nbody x 6) velocity, acceleration, joint force on the body by its parent */
    real *v, *a, *f;
    real *bias;               /* (nbody x 6) b of physics (1.9) */
    /* (nbody x 6) external wrenches of the last dynamics_load, internal axes; or NULL */
    real *load;
    /* velocities are zero: v and bias are never written, their terms left out */
    bool at_rest;
    real base[6];             /* acceleration of the base minus gravity, [angular; linear] */
    real *zero;               /* (nu) zeros */
    real *scratch;            /* (nbody x DYNAMICS_SCRATCH) of the fast paths */
    struct arena *arena;      /* borrowed: scratch */
};

/* dynamics_take: constants and work arrays for m, in `a`, which also gives scratch. */
struct dynamics *dynamics_take(const struct model *m, struct arena *a);

/* dynamics_load: set base acceleration and external wrenches from a state; copied. */
void dynamics_load(struct dynamics *d, const struct state *s);

/* dynamics_place: transforms and subspaces of all bodies at q (nq), in d->pose. */
void dynamics_place(struct dynamics *d, const real *q);

/* dynamics_world: transforms of all bodies' internal frames to the base (nbody), at the poses; in
 * d's arena. w may be NULL. */
struct xform *dynamics_world(struct dynamics *d, struct work *w);

/* dynamics_velocities: d->v (linear part too) and d->bias of all bodies at (q, u); after
 * dynamics_place. */
void dynamics_velocities(struct dynamics *d, const real *u);

/* rnea: joint forces tau (nu) that give accelerations ud (nu) at (q, u): Newton-Euler, physics
 * (2.1)-(2.5). Springs are not considered: tau is what actuators and springs supply together.
 *
 *   rnea_full also leaves velocities (angular only), accelerations and joint forces in d->v, a, f,
 * internal axes. */
void rnea(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
          struct work *w);
void rnea_full(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
               struct work *w);

/* aba: accelerations ud (nu) from joint forces tau (nu), articulated bodies, physics (2.6), (2.7);
 * massless bodies allowed. Returns false when an articulated inertia is singular along its
 * joint. */
bool aba(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
         struct work *w);

/* aba_full: as aba, by the general code whatever the joints; leaves accelerations in d->a.
 * aba_response: the same at d's present poses without velocity terms and base acceleration: M^-1
 * (tau + loads). */
bool aba_full(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
              struct work *w);
bool aba_response(struct dynamics *d, const real *tau, real *ud, struct work *w);

/* crba: mass matrix (nu x nu, row-major, both triangles) at q. */
void crba(struct dynamics *d, const real *q, real *mass, struct work *w);

/* crba_forward: ud from tau through the mass matrix. sparse: use the tree's zero pattern (L^T L
 * along paths to the root); otherwise dense Cholesky. Returns false when a pivot is not
 * positive. */
bool crba_forward(struct dynamics *d, const real *q, const real *u, const real *tau, bool sparse,
                  real *ud, struct work *w);

/* The constraint force algorithm's variants. */
struct cfa_options {
    bool direct;              /* physics 4.3; false: the paper's 4.2 */
    /* refinements, physics 8.6; at most this many outer ones, fewer when they end to help */
    int inner, outer;
};

struct cfa_report {
    double residual;          /* largest |W^T Z| of the answer over the largest acceleration */
    double correction;        /* last outer correction over the answer, 0 without one */
    int rank, nrow;           /* of the loops' constraint matrix; nrow - rank are redundant */
    /* corrections applied to the first solution; outer corrections applied */
    int inner_done, outer_done;
    bool fell_back;           /* forward_robust: articulated bodies had to solve it */
};

/* cfa: ud from tau by block elimination from leaves to root of the constraint forces' system (block
 * Thomas for a chain), trees, floating bases and loops included (bordered system, least norm).
 * lambda (nrow) gets the loop forces on body b [rows as the loop's], NULL if not wanted.
 *
 *   Returns false when a pivot is not positive definite (e: massless bodies, breakdown) */
bool cfa(struct dynamics *d, const real *q, const real *u, const real *tau,
         const struct cfa_options *options, real *ud, real *lambda, struct cfa_report *report,
         struct work *w);

/* forward_robust: the most accurate way: cfa direct with refinements; where light bodies between
 * heavy ones, or bodies without Phi, make that break down or not converge, articulated bodies with
 * the same outer refinement. */
bool forward_robust(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                    real *lambda, struct cfa_report *report, struct work *w);

/* closed_forward: ud of a closed system through the articulated-body algorithm: M^-1 J^T column by
 * column; the second, independent way to loops. lambda (nrow) may be NULL. Returns false as aba. */
bool closed_forward(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                    real *lambda, struct cfa_report *report, struct work *w);

/* springs_add: tau (nu) += spring and damper forces at (q, u). */
void springs_add(struct dynamics *d, const real *q, const real *u, real *tau);

/* What can be measured of a motion; world = base frame axes. */
struct motion_totals {
    real kinetic, potential;  /* energy; potential = - sum m g . c + springs */
    real linear[3], angular[3]; /* momentum, about the base's origin */
    real mass, com[3];
};

/* motion_totals_of: energy, momentum and centre of mass at (q, u). */
void motion_totals_of(struct dynamics *d, const real *q, const real *u, struct motion_totals *t);

/* Where a body is and how it moves, user's body axes, world components. */
struct body_motion {
    real r[9], p[3];          /* body -> world; origin */
    real v[3], w[3];          /* of the origin; angular */
    real a[3], alpha[3];      /* classical acceleration of the origin without gravity; angular */
};

/* forward_kinematics: of all bodies (nbody) at (q, u, ud). */
void forward_kinematics(struct dynamics *d, const real *q, const real *u, const real *ud,
                        struct body_motion *out);

/* loop_drift: the loops' violation: g (nrow) position, rho (nrow) velocity, at (q, u). Either may
 * be NULL. */
void loop_drift(struct dynamics *d, const real *q, const real *u, real *g, real *rho);

#endif
