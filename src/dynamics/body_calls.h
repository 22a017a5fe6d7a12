/* body_calls.h - what is asked of a body in space and in the plane alike: its pose, its local
 * computations, and what they cost.
 *
 * struct body itself, and what is computed inline, is in body.h for six components and in
 * planar_body.h for three. The functions do not count: joint_cost has what each does. */
#ifndef DYNAMICS_BODY_CALLS_H
#define DYNAMICS_BODY_CALLS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "dynamics/subspace.h"
#include "linalg/screw.h"
#include "model/model.h"

struct body;

/* A joint's spring and damper; zeros where there are none. */
struct joint_spring {
    real stiffness, rest, damping;
    real rate_stiffness; /* k q' / u: what the spring's force loses in time for each u */
};

/* A body's configuration: its transform to the parent and its subspaces. */
struct body_pose {
    struct xform x;
    struct subspace s;
};

/* What the functions below do for one body, [flop] unless said. */
struct joint_cost {
    int place, place_trig, place_div; /* body_place */
    int rate;                         /* body_rate */
    int bias;                         /* body_bias */
    int h, h_transposed;              /* subspace_h, subspace_h_transposed */
    int w, w_transposed;              /* subspace_w, subspace_w_transposed */
    /* in space: subspace_project of a symmetric 6x6 on H,H / H,W / W,W */
    int hh, hw, ww;
    struct work subspace;             /* body_subspace */
    struct work qdot, step;           /* body_qdot, body_step */
};

/* joint_cost_of: by type, with columns picked where they can be; never NULL; the same in every
 * precision. body_cost: of a body. */
const struct joint_cost *joint_cost_of(enum model_joint joint);
const struct joint_cost *body_cost(const struct body *b);

/* bodies_make: the constants of m's bodies (nbody), of those that are here; equal neighbours cost
 * nothing. In space and in double they are the model's own, made by system_prepare; otherwise made
 * in `a`. A scene in the plane must be planar, at least nearly. */
const struct body *bodies_make(const struct model *m, struct arena *a);

/* bodies_alike: whether bodies i and j of m have the same joint and axes (-1: the base). */
bool bodies_alike(const struct model *m, int i, int j);

/* bodies_weigh_alike: whether they have the same mass, centre of mass and inertia;
 * bodies_hang_alike: the same placement, pitch and spring. */
bool bodies_weigh_alike(const struct model *m, int i, int j);
bool bodies_hang_alike(const struct model *m, int i, int j);

/* body_seat: where body i of m hangs, which differs between otherwise equal bodies; joint_springs:
 * its spring and damper. False: it has none. */
void body_seat(const struct model *m, int i, struct body *b);
bool joint_springs(const struct model *m, int i, struct joint_spring *s);

/* base_motion: acceleration of the base minus gravity (SPACE). */
void base_motion(const struct model *m, const struct state *s, real *a);

/* body_picks: no column of the joint's H and W is ever written: all of them are unit vectors for
 * good. */
bool body_picks(const struct body *b);

/* body_place: transform and subspaces of a body at coordinates q (nq). x = tree o joint(q). */
void body_place(const struct body *b, const real *q, struct body_pose *pose);

/* body_subspace: H and W alone, for a neighbour's joint; needs q only where columns move. */
void body_subspace(const struct body *b, const real *q, struct subspace *s);

/* body_rate: h = H u (SPACE), the joint's relative velocity. */
void body_rate(const struct body_pose *pose, const real *u, real *h);

/* body_bias: b (SPACE), acceleration of the joint at u' = 0 seen from the parent's: physics (1.9),
 * with kappa.
 *
 *   v   in   the body's own angular velocity first
 *   h   in   (SPACE) H u from body_rate
 *   u   in   (d) */
void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h,
               const real *u, real *bias);

/* body_load: the external wrench on the body (SPACE) in internal axes and order, from the user's
 * [force; moment] in `fext` (6); zero when fext is NULL; in the plane the part that acts there. */
void body_load(const struct body *b, const double *fext, real *f);

/* body_spring: tau (d) += forces of the joint's spring and damper; nothing without has_spring.
 * BODY_SPRING_FLOP. */
enum { BODY_SPRING_FLOP = 5 };
void body_spring(const struct body *b, const real *q, const real *u, real *tau);

/* body_step: coordinates after the time h at constant u, in place: rotations by the exponential
 * map, displacements in moving axes along those of mid-step. Symmetric in time, exact for
 * one-degree joints; quaternions stay normalised. */
void body_step(const struct body *b, real *q, const real *u, real h);

/* body_qdot: qd (nq) = N(q) u, the derivative of the stored coordinates. */
void body_qdot(const struct body *b, const real *q, const real *u, real *qd);

#endif
