/* joint_universal.c - universal joints: turns about x, fixed in the joint frame, and about y, fixed
 * in the body. */
#include "dynamics/joint_motion.h"

/* H = [(cos b, 0, sin b); 0], [y; 0]; W = [(-sin b, 0, cos b); 0], [0; U]. b: the second angle. */
static void columns(real sine, real cosine, struct subspace *s)
{
    for (int k = 0; k < 36; k++) s->col[k] = REAL(0);
    /* the first axis as the body sees it, the second one, and what is orthogonal to both */
    s->col[0] = cosine, s->col[2] = sine;
    s->col[6 + 1] = REAL(1);
    s->col[12] = -sine, s->col[14] = cosine;
    for (int k = 3; k < 6; k++) s->col[6 * k + k] = REAL(1);
}

/* The columns depend on the second angle alone. */
static void subspace(const struct body *b, const real *q, struct subspace *s)
{
    real sine, cosine;
    (void)b;
    angle_sincos(q[1], &sine, &cosine);
    columns(sine, cosine, s);
}

/* r = E Rx(alpha) Ry(beta). */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    const real *e = b->tree.r;
    real sa, ca, sb, cb, *r = pose->x.r;
    angle_sincos(q[0], &sa, &ca);
    angle_sincos(q[1], &sb, &cb);
    /* row by row: the turn about x mixes y and z, the turn about y then x and z */
    for (int i = 0; i < 3; i++) {
        real x = e[3 * i], y = ca * e[3 * i + 1] + sa * e[3 * i + 2],
             z = ca * e[3 * i + 2] - sa * e[3 * i + 1];
        r[3 * i] = cb * x - sb * z;
        r[3 * i + 1] = y;
        r[3 * i + 2] = cb * z + sb * x;
    }
    vec3_copy(pose->x.p, b->tree.p);
    columns(sb, cb, &pose->s);
}

/* The first axis turns in the body as the second angle does: (-sin b, 0, cos b) alpha' beta'. */
static void kappa(const struct body_pose *pose, const real *h, const real *u, real *bias)
{
    (void)h;
    real rate = u[0] * u[1];
    bias[0] -= pose->s.col[2] * rate;
    bias[2] += pose->s.col[0] * rate;
}

/* place: two turns of three rows, 6 flops each; kappa: 5. No v_J: the axes meet in the origin. */
const struct joint_motion JOINT_DEFINE(universal) = {
    .subspace = subspace,
    .place = place,
    .kappa = kappa,
    .cost = {.subspace = {.trig = 2},
             .place = 36,
             .place_trig = 4,
             .rate = 24,
             .bias = BIAS + 5,
             STEPS(2),
             DENSE(2)},
};
