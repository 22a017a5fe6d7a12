/* planar_body.h - one body of a planar scene and its local computations: what body.h is for space, in three components.
 *
 * Every body has a planar frame at its own origin (planar_frame): the scene's normal, then x and y. A joint whose axis
 * points against the normal is flipped: its columns are given instead of picked, and q, u, u', tau pass unchanged
 * between model order and here all the same. Names and contracts are those of body.h. */
#ifndef DYNAMICS_PLANAR_BODY_H
#define DYNAMICS_PLANAR_BODY_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "dynamics/subspace.h"
#include "linalg/planar.h"
#include "linalg/real.h"
#include "model/model.h"

struct body {
    int parent;
    enum model_joint joint;
    enum joint_plane plane; /* what the joint does in the plane: all that the functions below ask of it */
    int d, nq;
    int q_at, u_at;
    bool has_spring, flipped;
    struct xform tree;   /* joint frame -> parent's planar frame */
    real m, s[2], ms[2]; /* mass; centre of mass from the origin; first moment */
    real jc, jo;         /* inertia about the normal through the centre of mass, through the origin */
    real per_m, per_jc;  /* their inverses, zero when there are none */
    real frame[9];       /* rows: normal, x, y in the user's body axes */
    real stiffness, rest, damping;
};

/* A body's configuration: its transform to the parent and its subspaces. */
struct body_pose {
    struct xform x;
    struct subspace s;
};

/* What the functions below do for one body, [flop] unless said. */
struct joint_cost {
    int place, place_trig, place_div;
    int rate;
    int bias;
    int h, h_transposed;
    int w, w_transposed;
    struct work subspace;
    struct work qdot, step; /* body_qdot, body_step */
};

/* bodies_make: the constants of all bodies (nbody), in `a`; the scene must be planar, at least nearly. */
const struct body *bodies_make(const struct model *m, struct arena *a);

/* base_motion: acceleration of the base minus gravity (3). */
void base_motion(const struct model *m, const struct state *s, real *a);

/* body_picks: no column of the joint's H and W is ever written. */
static inline bool body_picks(const struct body *b) { return !b->flipped; }

/* body_place, body_subspace, body_rate: as in body.h. */
void body_place(const struct body *b, const real *q, struct body_pose *pose);
void body_subspace(const struct body *b, const real *q, struct subspace *s);
void body_rate(const struct body_pose *pose, const real *u, real *h);

/* body_bias: b (3) as in body.h: the centripetal acceleration of the origin, and 2 w x v_J + w_J x v_J of slides. */
void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h, const real *u,
               real *bias);

/* body_gyro: P (3) from the body's own velocity: the normal is a principal axis as far as work is concerned, so only
 * the centre of mass is pulled, and not about the origin. */
enum {
    BODY_GYRO_FLOP = 3,
    BODY_LOAD_FLOP = 15,
    BODY_SPRING_FLOP = 5,
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

/* body_accelerate: a = Phi f (3): a turn by the moment about the centre of mass, whose own acceleration is f / m. */
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

/* body_inertia_factors: zeroed `shift`, `about` (3 x 3) become those whose product shift about shift^T is I. */
static inline void body_inertia_factors(const struct body *b, real *shift, real *about)
{
    shift[0] = shift[4] = shift[8] = 1;
    shift[1] = -b->s[1], shift[2] = b->s[0];
    about[0] = b->jc;
    about[4] = about[8] = b->m;
}

/* body_load, body_load_flops, body_spring, body_step, body_qdot: as in body.h; of the wrench the part in the plane. */
void body_load(const struct body *b, const double *fext, real *f);
static inline int body_load_flops(const struct body *b)
{
    (void)b;
    return BODY_LOAD_FLOP;
}
void body_spring(const struct body *b, const real *q, const real *u, real *tau);
void body_step(const struct body *b, real *q, const real *u, real h);
void body_qdot(const struct body *b, const real *q, const real *u, real *qd);

/* joint_cost_of: by type, with columns picked; never NULL. body_cost: of a body. */
const struct joint_cost *joint_cost_of(enum model_joint joint);
const struct joint_cost *body_cost(const struct body *b);

#endif
