/* joint_slot.c - a ball in a slot and a ball on a plane: any turn, and displacements along one or
 * two directions that are fixed in the joint frame (body.slide). */
#include "dynamics/joint_motion.h"

/* Displacement in the joint frame along the free directions by x (d - 3); SLIDE flops along one,
 * SLIDES along two. */
enum { SLIDE = 3, SLIDES = 9 };
static void slide_by(const struct body *b, const real *x, real *d)
{
    for (int i = 0; i < 3; i++) {
        d[i] = x[0] * b->details->slide[i];
        if (b->d > 4) d[i] += x[1] * b->details->slide[3 + i];
    }
}

/* W and the last columns of H follow the directions seen from the body; COLUMNS flops. */
enum { COLUMNS = 3 * MAT3_VEC_FLOP };
static void columns(const struct body *b, const real *rotation, struct subspace *s)
{
    for (int k = 0; k < 36; k++) s->col[k] = REAL(0);
    for (int k = 0; k < 3; k++) {
        s->col[6 * k + k] = REAL(1); /* any turn */
        /* the free directions come first, then those of W */
        mat3_mul_vec_transposed(s->col + 6 * (3 + k) + 3, rotation, b->details->slide + 3 * k);
    }
}

/* The directions turn with the quaternion: the matrix is made for them alone. */
static void subspace(const struct body *b, const real *q, struct subspace *s)
{
    real rotation[9];
    quaternion_rotation(q, rotation);
    columns(b, rotation, s);
}

/* p = t + E (directions . x). */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    real rotation[9], d[3];
    /* one matrix serves the turn and the directions */
    quaternion_rotation(q, rotation);
    mat3_mul(pose->x.r, b->tree.r, rotation);
    slide_by(b, q + 4, d);
    shift(&b->tree, d[0], d[1], d[2], pose->x.p);
    columns(b, rotation, &pose->s);
}

/* The directions turn back in the body: kappa = -w_J x v_J. */
static void kappa(const struct body_pose *pose, const real *h, const real *u, real *bias)
{
    (void)pose, (void)u;
    vec3_cross_sub(bias + 3, h, h + 3);
}

/* The displacements move by their rates, the quaternion by the angular velocity. */
static void qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    /* first the displacements: there are one or two of them */
    for (int i = 3; i < b->d; i++) qd[1 + i] = u[i];
    quaternion_rate(q, u, qd);
}

/* Turn and displacements do not mix: the directions are fixed in the joint frame. */
static void step(const struct body *b, real *q, const real *u, real h)
{
    quaternion_step(q, u, h);
    for (int i = 3; i < b->d; i++) q[1 + i] += h * u[i];
}

/* H = [U; 0], [0; R^T x] with one free direction or two (physics 1.3); `d` degrees of freedom, of
 * which `free` are displacements, at `slide` flops. */
#define SLIDING_BALL(d, free, slide)                                                               \
    {                                                                                              \
        .slides = true, .subspace = subspace, .place = place, .kappa = kappa, .qdot = qdot,        \
        .step = step,                                                                              \
        .cost = {.subspace = {.flop = QUATERNION + COLUMNS, .div = 1},                             \
                 .place = QUATERNION_PLACE + (slide) + SHIFT + COLUMNS,                            \
                 .place_div = 1,                                                                   \
                 .rate = 12 * (d),                                                                 \
                 .bias = BIAS + SLIDING + VEC3_CROSS_ADD_FLOP,                                     \
                 QUATERNION_STEPS(free),                                                           \
                 DENSE(d)},                                                                        \
    }
const struct joint_motion JOINT_DEFINE(slot) = SLIDING_BALL(4, 1, SLIDE);
const struct joint_motion JOINT_DEFINE(point_plane) = SLIDING_BALL(5, 2, SLIDES);
