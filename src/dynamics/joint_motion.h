/* joint_motion.h - what a joint type's own file says of it, and the pieces that such files share.
 *
 * joint_STEM.c defines `joint_STEM` (JOINT_DEFINE), joint.c chooses it by the body's joint type.
 * The contracts are those of the body_ functions in body.h; `cost` is what they execute in this
 * file's text, and tests count it. */
#ifndef DYNAMICS_JOINT_MOTION_H
#define DYNAMICS_JOINT_MOTION_H

#include "dynamics/body.h"
#include "linalg/angle.h"

struct joint_motion {
    /* columns of [H W], unit vectors for good, in the order of u; not with `subspace` */
    signed char pick[6];
    bool slides;         /* v_J is not zero: body_bias has 2 w x v_J + w_J x v_J */
    /* H and W where they are no unit vectors or move: s->col at q; NULL: pick */
    void (*subspace)(const struct body *b, const real *q, struct subspace *s);
    /* pose->x, and pose->s.col with `subspace` */
    void (*place)(const struct body *b, const real *q, struct body_pose *pose);
    /* bias += kappa, acceleration by the motion of H's columns in the body; NULL: they stand
     * still */
    void (*kappa)(const struct body_pose *pose, const real *h, const real *u, real *bias);
    /* coordinates' rates; NULL: u as it is */
    void (*qdot)(const struct body *b, const real *q, const real *u, real *qd);
    /* a step in time; NULL: q += h qd, exact where rates are constant */
    void (*step)(const struct body *b, real *q, const real *u, real h);
    struct joint_cost cost;
};

/* JOINT_DEFINE: `const struct joint_motion JOINT_DEFINE(stem) = {...}` in this precision. */
#define JOINT_DEFINE(stem) REAL_NAME(joint_##stem)
#define DECLARE(constant, word, stem, coordinates, plane, traits)                                  \
    extern const struct joint_motion JOINT_DEFINE(stem);
JOINT_LIST(DECLARE)
#undef DECLARE

/* Columns that are not unit vectors cost 12 flops to expand (screw_axpy), 11 to reduce (screw_dot);
 * a projection of a full matrix costs 66 per column and 11 per entry. */
#define DENSE(d)                                                                                   \
    .h = 12 * (d), .h_transposed = 11 * (d), .w = 12 * (6 - (d)), .w_transposed = 11 * (6 - (d)),  \
    .hh = 66 * (d) + 11 * (d) * (d), .hw = 66 * (6 - (d)) + 11 * (d) * (6 - (d)),                  \
    .ww = 66 * (6 - (d)) + 11 * (6 - (d)) * (6 - (d))
#define PICKED(d) .h = (d), .w = 6 - (d)

/* body_bias: 3 + 15 + 27 flops, of a joint that slides 6 + 12 besides. */
enum { BIAS = 45, SLIDING = 18 };

/* Coordinates that move by rates as they are: 2 flops each besides the rates. */
#define STEPS(n) .step = {.flop = 2 * (n)}

/* turn_about_z: r = E Rz(theta); TURN flops, sine and cosine. */
enum { TURN = MAT3_TURN_FLOP };
static inline void turn_about_z(const real *e, real theta, real *r)
{
    real s, c;
    angle_sincos(theta, &s, &c);
    mat3_turn_z(r, e, s, c);
}

/* shift: p = t + E (x, y, z); SHIFT flops. */
enum { SHIFT = 18 };
static inline void shift(const struct xform *tree, real x, real y, real z, real *p)
{
    real d[3] = {x, y, z};
    mat3_mul_vec(p, tree->r, d);
    vec3_add(p, tree->p);
}

/* shift_along_z: p = t + x E z; SHIFT_ALONG flops. */
enum { SHIFT_ALONG = 6 };
static inline void shift_along_z(const struct xform *tree, real x, real *p)
{
    for (int i = 0; i < 3; i++) p[i] = tree->p[i] + x * tree->r[3 * i + 2];
}

/* quaternion_rotation: of x y z w, evaluated as if it were normalised; QUATERNION flops (7 length,
 * 3 + 9 products, 12) and a division. */
enum { QUATERNION = 31 };
static inline void quaternion_rotation(const real *q, real *r)
{
    real x = q[0], y = q[1], z = q[2], w = q[3];
    real f = 2 / (x * x + y * y + z * z + w * w);
    real fx = f * x, fy = f * y, fz = f * z;
    real xx = fx * x, yy = fy * y, zz = fz * z, xy = fx * y, xz = fx * z, yz = fy * z, wx = fx * w,
         wy = fy * w, wz = fz * w;
    r[0] = 1 - (yy + zz), r[1] = xy - wz, r[2] = xz + wy;
    r[3] = xy + wz, r[4] = 1 - (xx + zz), r[5] = yz - wx;
    r[6] = xz - wy, r[7] = yz + wx, r[8] = 1 - (xx + yy);
}

/* quaternion_place: r = E R; QUATERNION_PLACE flops and a division. */
enum { QUATERNION_PLACE = QUATERNION + MAT3_MUL_FLOP };
static inline void quaternion_place(const struct body *b, const real *quat, struct xform *x)
{
    real rotation[9];
    quaternion_rotation(quat, rotation);
    mat3_mul(x->r, b->tree.r, rotation);
}

/* quaternion_rate: c' = 1/2 c (0, w); QUATERNION_RATE flops. */
enum { QUATERNION_RATE = 24 };
static inline void quaternion_rate(const real *c, const real *w, real *cd)
{
    real half = REAL(0.5);
    cd[0] = half * (c[3] * w[0] + c[1] * w[2] - c[2] * w[1]);
    cd[1] = half * (c[3] * w[1] + c[2] * w[0] - c[0] * w[2]);
    cd[2] = half * (c[3] * w[2] + c[0] * w[1] - c[1] * w[0]);
    cd[3] = -half * (c[0] * w[0] + c[1] * w[1] + c[2] * w[2]);
}

/* quaternion_step: c <- c exp(h w / 2), normalised; QUATERNION_STEP flops (5 length, 2 + 3, 28
 * product, 7 length, 4), two divisions, two roots, sine and cosine. */
enum { QUATERNION_STEP = 49 };
static inline void quaternion_step(real *c, const real *w, real h)
{
    const real norm = vec3_norm(w), half = REAL(0.5) * h;
    real s, k;
    angle_sincos(half * norm, &s, &k);
    real f = real_where(norm > 0, s / norm, half);
    real x = f * w[0], y = f * w[1], z = f * w[2];
    real n[4] = {
        c[0] * k + c[3] * x + c[1] * z - c[2] * y, c[1] * k + c[3] * y + c[2] * x - c[0] * z,
        c[2] * k + c[3] * z + c[0] * y - c[1] * x, c[3] * k - c[0] * x - c[1] * y - c[2] * z};
    real scale = 1 / real_sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
    for (int i = 0; i < 4; i++) c[i] = scale * n[i];
}
/* A quaternion's rate and step, and those of n displacements after it. */
#define QUATERNION_STEPS(n)                                                                        \
    .qdot = {.flop = QUATERNION_RATE},                                                             \
    .step = {.flop = QUATERNION_STEP + 2 * (n), .div = 2, .sqrt = 2, .trig = 2}

#endif
