/* body.h - one body's constants and its local computations in the build's precision: all that a
 * kernel needs.
 *
 * Internally a body's frame is turned so that its joint's axis is z (universal: axes x, y), spatial
 * order is [angular; linear], accelerations are classical. The constants are made once, in quad
 * precision, and rounded once. Columns of H are ordered as u (a floating joint's H therefore is a
 * permutation: linear first), so q, u, u', tau pass unchanged between model order and here. H and
 * its complement W are orthonormal. What is different for each joint type stands in a file of its
 * own (joint_motion.h). */
#ifndef DYNAMICS_BODY_H
#define DYNAMICS_BODY_H

#include "dynamics/body_calls.h"
#include "linalg/inertia.h"

/* What a body weighs. */
struct body_mass {
    real s[3];              /* centre of mass from the origin */
    real jc[6];             /* inertia about the centre of mass */
    struct inertia inertia; /* about the origin; the mass */
    struct sym6 phi;        /* inverse of the 6x6 inertia; zero when it has none */
};

/* What few joints ask for. */
struct body_details {
    real pitch, unit; /* JOINT_PITCH: advance per radian and 1 / sqrt(1 + pitch^2) */
    real user[9];     /* user's body axes = user * internal axes */
    /* JOINT_AS_IT_LIES: rows: own axes in the joint frame, the free directions first */
    real slide[9];
    struct joint_spring spring;
};

/* Chains have a body for each of a million ranks, most of them alike: these share what they
 * weigh and their details. */
struct body {
    int parent;
    enum model_joint joint;
    int d, nq;              /* degrees of freedom; stored coordinates */
    int q_at, u_at;         /* first of each in the model's arrays */
    bool has_spring, turned;/* turned: the internal frame differs from the user's */
    struct xform tree;      /* (E, t): joint frame -> parent's body frame, internal axes */
    const struct body_mass *mass;
    const struct body_details *details;
};

/* body_spring_of: what body_spring computes with; zeros where there is none. */
static inline const struct joint_spring *body_spring_of(const struct body *b)
{
    return &b->details->spring;
}

/* joint_pick: the unit vectors that are H's and W's columns for a joint type (6); NULL: they are
 * none. */
const signed char *joint_pick(enum model_joint joint);

/* body_gyro: P (6), velocity-dependent force, from the body's own angular velocity w (3).
 * BODY_GYRO_FLOP. */
enum { BODY_GYRO_FLOP = 57, BODY_LOAD_FLOP = 30, BODY_FORCE_FLOP = 42 };
static inline void body_gyro(const struct body *b, const real *w, real *f)
{
    /* [w x Jc w + s x g; g], g = m w x (w x s): about the centre of mass, so a distant origin costs
     * no digits. */
    const struct body_mass *mass = b->mass;
    real t[3];
    vec3_cross(t, w, mass->s);
    vec3_cross(t, w, t);
    vec3_scale(f + 3, mass->inertia.m, t);
    sym3_mul_vec(t, mass->jc, w);
    vec3_cross(f, w, t);
    vec3_cross_add(f, mass->s, f + 3);
}

/* body_force: f = I a (6) for the classical acceleration a; BODY_FORCE_FLOP. */
static inline void body_force(const struct body *b, const real *a, real *f)
{
    const struct body_mass *mass = b->mass;
    real t[3];
    vec3_copy(t, a + 3);
    vec3_cross_add(t, a, mass->s);
    vec3_scale(f + 3, mass->inertia.m, t);
    sym3_mul_vec(f, mass->jc, a);
    vec3_cross_add(f, mass->s, f + 3);
}

/* body_accelerate: a = Phi f (6); the body must have a Phi (model.has_phi). body_phi: Phi as a full
 * matrix (6 x 6). */
enum {
    BODY_ACCELERATE_FLOP = SYM6_MUL_FLOP,
    BODY_PHI_FLOP = 0,
    BODY_SHARE_FLOP = 900 /* of a balanced partition: sweeps, assembly */
};
static inline void body_accelerate(const struct body *b, const real *f, real *a)
{
    sym6_mul(a, &b->mass->phi, f);
}
static inline void body_phi(const struct body *b, real *phi) { sym6_expand(phi, &b->mass->phi); }

/* body_inertia_factors: zeroed `shift`, `about` (6 x 6) become those whose product shift about
 * shift^T is I. */
void body_inertia_factors(const struct body *b, real *shift, real *about);

/* body_load_flops: what body_load executes with a wrench. */
static inline int body_load_flops(const struct body *b) { return b->turned ? BODY_LOAD_FLOP : 0; }

#endif
