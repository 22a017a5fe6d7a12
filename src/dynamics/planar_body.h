/* planar_body.h - one body of a planar scene and its local computations: what body.h is for space,
 * in three components.
 *
 * Every body has a planar frame at its own origin (planar_frame): the scene's normal, then x and y.
 * A joint whose axis points against the normal is flipped: its columns are given instead of picked,
 * and q, u, u', tau pass unchanged between model order and here all the same. Names and contracts
 * are those of body_calls.h and body.h. */
#ifndef DYNAMICS_PLANAR_BODY_H
#define DYNAMICS_PLANAR_BODY_H

#include "dynamics/body_calls.h"

struct body {
    int parent;
    enum model_joint joint;
    /* what the joint does in the plane: all that the functions below ask of it */
    enum joint_plane plane;
    int d, nq;
    int q_at, u_at;
    bool has_spring, flipped;
    struct xform tree;   /* joint frame -> parent's planar frame */
    real m, s[2], ms[2]; /* mass; centre of mass from the origin; first moment */
    /* inertia about the normal through the centre of mass, through the origin */
    real jc, jo;
    real per_m, per_jc;  /* their inverses, zero when there are none */
    real frame[9];       /* rows: normal, x, y in the user's body axes */
    struct joint_spring spring;
};

/* body_spring_of: as in body.h. */
static inline const struct joint_spring *body_spring_of(const struct body *b)
{
    return &b->spring;
}

/* body_gyro: P (3) from the body's own velocity: the normal is a principal axis as far as work is
 * concerned, so only the centre of mass is pulled, and not about the origin. */
enum {
    BODY_GYRO_FLOP = 3,
    BODY_LOAD_FLOP = 15,
    BODY_FORCE_FLOP = 11,
    BODY_ACCELERATE_FLOP = 11,
    BODY_PHI_FLOP = 7,
    BODY_SHARE_FLOP = 160 /* of a balanced partition: sweeps, assembly */
};
static inline void body_gyro(const struct body *b, const real *w, real *f)
{
    const real pull = -(w[0] * w[0]);
    f[0] = 0;
    f[1] = pull * b->ms[0];
    f[2] = pull * b->ms[1];
}

/* body_force: f = I a (3); BODY_FORCE_FLOP. */
static inline void body_force(const struct body *b, const real *a, real *f)
{
    f[1] = b->m * (a[1] - a[0] * b->s[1]);
    f[2] = b->m * (a[2] + a[0] * b->s[0]);
    f[0] = b->jc * a[0] + (b->s[0] * f[2] - b->s[1] * f[1]);
}

/* body_accelerate: a = Phi f (3): a turn by the moment about the centre of mass, whose own
 * acceleration is f / m. */
static inline void body_accelerate(const struct body *b, const real *f, real *a)
{
    const real turn = b->per_jc * (f[0] - (b->s[0] * f[2] - b->s[1] * f[1]));
    a[1] = b->per_m * f[1] + turn * b->s[1];
    a[2] = b->per_m * f[2] - turn * b->s[0];
    a[0] = turn;
}

/* body_phi: Phi as a full matrix (3 x 3). */
static inline void body_phi(const struct body *b, real *phi)
{
    const real x = b->s[0] * b->per_jc, y = b->s[1] * b->per_jc;
    phi[0] = b->per_jc;
    phi[1] = phi[3] = y;
    phi[2] = phi[6] = -x;
    phi[4] = b->per_m + y * b->s[1];
    phi[5] = phi[7] = -(x * b->s[1]);
    phi[8] = b->per_m + x * b->s[0];
}

/* body_inertia_factors: zeroed `shift`, `about` (3 x 3) become those whose product shift about
 * shift^T is I. */
static inline void body_inertia_factors(const struct body *b, real *shift, real *about)
{
    shift[0] = shift[4] = shift[8] = 1;
    shift[1] = -b->s[1], shift[2] = b->s[0];
    about[0] = b->jc;
    about[4] = about[8] = b->m;
}

/* body_load_flops: what body_load executes with a wrench. */
static inline int body_load_flops(const struct body *b)
{
    (void)b;
    return BODY_LOAD_FLOP;
}

#endif
