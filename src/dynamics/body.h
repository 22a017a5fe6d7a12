/* body.h - one body's constants and its local computations in the build's precision: all that a kernel needs.
 *
 * Internally a body's frame is turned so that its joint's axis is z (universal: axes x, y), spatial order is
 * [angular; linear], accelerations are classical. The constants are made once, in quad precision, and rounded once.
 * Columns of H are ordered as u (a floating joint's H therefore is a permutation: linear first), so q, u, u', tau
 * pass unchanged between model order and here. H and its complement W are orthonormal.
 * Work: the functions do not count; joint_cost_of has what each does for a joint type. What is different for each type
 * stands in a file of its own (joint_motion.h). */
#ifndef DYNAMICS_BODY_H
#define DYNAMICS_BODY_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "dynamics/subspace.h"
#include "linalg/inertia.h"
#include "linalg/real.h"
#include "linalg/spatial.h"
#include "model/model.h"

struct body {
    int parent;
    enum model_joint joint;
    int d, nq;              /* degrees of freedom; stored coordinates */
    int q_at, u_at;         /* first of each in the model's arrays */
    bool has_spring, turned;/* turned: the internal frame differs from the user's */
    struct xform tree;      /* (E, t): joint frame -> parent's body frame, internal axes */
    real pitch, unit;       /* JOINT_PITCH: advance per radian and 1 / sqrt(1 + pitch^2) */
    real m, s[3];           /* mass; centre of mass from the origin */
    real jc[6];             /* inertia about the centre of mass */
    struct inertia inertia; /* about the origin */
    struct sym6 phi;        /* inverse of the 6x6 inertia; zero when it has none */
    real user[9];           /* user's body axes = user * internal axes */
    real slide[9];          /* JOINT_AS_IT_LIES: rows: own axes in the joint frame, the free directions first */
    real stiffness, rest, damping;
};

/* A body's configuration: its transform to the parent and its subspaces. */
struct body_pose {
    struct xform x;
    struct subspace s;
};

/* What the functions below do for one body of a joint type, [flop] unless said. */
struct joint_cost {
    int place, place_trig, place_div; /* body_place */
    int rate;                         /* body_rate */
    int bias;                         /* body_bias */
    int h, h_transposed;              /* subspace_h, subspace_h_transposed */
    int w, w_transposed;              /* subspace_w, subspace_w_transposed */
    int hh, hw, ww;                   /* subspace_project of a symmetric 6x6 on H,H / H,W / W,W */
    struct work subspace;             /* body_subspace */
    struct work qdot, step;           /* body_qdot, body_step */
};

/* bodies_make: the constants of m's bodies (nbody): in double the model's own, made by model_finish; otherwise made in
 * `a`. Bodies equal to their predecessor cost nothing. */
const struct body *bodies_make(const struct model *m, struct arena *a);

/* body_picks: no column of the joint's H and W is ever written: all of them are unit vectors for good. joint_pick: the
 * numbers of these unit vectors for a joint type, H's then W's (6); NULL: they are none. */
bool body_picks(const struct body *b);
const signed char *joint_pick(enum model_joint joint);

/* base_motion: acceleration of the base minus gravity (6), [angular; linear]. */
void base_motion(const struct model *m, const struct state *s, real *a);

/* body_place: transform and subspaces of a body at coordinates q (nq). x = tree o joint(q). */
void body_place(const struct body *b, const real *q, struct body_pose *pose);

/* body_subspace: H and W alone, for a neighbour's joint; needs q only where columns move. */
void body_subspace(const struct body *b, const real *q, struct subspace *s);

/* body_rate: h = H u (6), the joint's relative velocity. */
void body_rate(const struct body_pose *pose, const real *u, real *h);

/* body_bias: b (6), acceleration of the joint at u' = 0 seen from the parent's: physics (1.9), with kappa.
 *
 *   v   in   (>= 3) the body's own angular velocity
 *   h   in   (6) H u from body_rate
 *   u   in   (d) */
void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h, const real *u,
               real *bias);

/* body_gyro: P (6), velocity-dependent force, from the body's own angular velocity w (3). BODY_GYRO_FLOP. */
enum { BODY_GYRO_FLOP = 57, BODY_LOAD_FLOP = 30, BODY_SPRING_FLOP = 5, BODY_FORCE_FLOP = 42 };
static inline void body_gyro(const struct body *b, const real *w, real *f)
{
    /* [w x Jc w + s x g; g], g = m w x (w x s): about the centre of mass, so a distant origin costs no digits. */
    real t[3];
    vec3_cross(t, w, b->s);
    vec3_cross(t, w, t);
    vec3_scale(f + 3, b->m, t);
    sym3_mul_vec(t, b->jc, w);
    vec3_cross(f, w, t);
    vec3_cross_add(f, b->s, f + 3);
}

/* body_force: f = I a (6) for the classical acceleration a; BODY_FORCE_FLOP. */
static inline void body_force(const struct body *b, const real *a, real *f)
{
    real t[3];
    vec3_copy(t, a + 3);
    vec3_cross_add(t, a, b->s);
    vec3_scale(f + 3, b->m, t);
    sym3_mul_vec(f, b->jc, a);
    vec3_cross_add(f, b->s, f + 3);
}

/* body_accelerate: a = Phi f (6); the body must have a Phi (model.has_phi). body_phi: Phi as a full matrix (6 x 6). */
enum {
    BODY_ACCELERATE_FLOP = SYM6_MUL_FLOP,
    BODY_PHI_FLOP = 0,
    BODY_SHARE_FLOP = 900 /* of a balanced partition: sweeps, assembly */
};
static inline void body_accelerate(const struct body *b, const real *f, real *a) { sym6_mul(a, &b->phi, f); }
static inline void body_phi(const struct body *b, real *phi) { sym6_expand(phi, &b->phi); }

/* body_inertia_factors: zeroed `shift`, `about` (6 x 6) become those whose product shift about shift^T is I. */
void body_inertia_factors(const struct body *b, real *shift, real *about);

/* body_load: the external wrench on body i in internal axes and order, from the user's [force; moment] in `fext`
 * (6); zero when fext is NULL. body_load_flops: what it executes with one. */
void body_load(const struct body *b, const double *fext, real *f);
static inline int body_load_flops(const struct body *b) { return b->turned ? BODY_LOAD_FLOP : 0; }

/* body_spring: tau (d) += forces of the joint's spring and damper; nothing without has_spring. */
void body_spring(const struct body *b, const real *q, const real *u, real *tau);

/* body_step: coordinates after the time h at constant u, in place: rotations by the exponential map, displacements in
 * moving axes along those of mid-step. Symmetric in time, exact for one-degree joints; quaternions stay normalised. */
void body_step(const struct body *b, real *q, const real *u, real h);

/* body_qdot: qd (nq) = N(q) u, the derivative of the stored coordinates. */
void body_qdot(const struct body *b, const real *q, const real *u, real *qd);

/* joint_cost_of: by type, never NULL; the same in every precision. body_cost: of a body. */
const struct joint_cost *joint_cost_of(enum model_joint joint);
static inline const struct joint_cost *body_cost(const struct body *b) { return joint_cost_of(b->joint); }

#endif
