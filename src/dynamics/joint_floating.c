/* joint_floating.c - floating bodies: any displacement and any turn. H has the linear columns
 * first, as u does. */
#include "dynamics/joint_motion.h"

/* r = E R(quaternion), p = t + E (x, y, z). */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    quaternion_place(b, q + 3, &pose->x);
    shift(&b->tree, q[0], q[1], q[2], pose->x.p);
}

/* The origin's velocity is given in body axes, its place in joint axes. */
static void qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    real rotation[9];
    (void)b;
    /* p' = R v */
    quaternion_rotation(q + 3, rotation);
    mat3_mul_vec(qd, rotation, u);
    /* c' = 1/2 c (0, w) */
    quaternion_rate(q + 3, u + 3, qd + 3);
}

/* Half the turn, the displacement along the axes of mid-step, the other half: symmetric in time. */
static void step(const struct body *b, real *q, const real *u, real h)
{
    real rate[7];
    const real half = REAL(0.5) * h;
    quaternion_step(q + 3, u + 3, half);
    qdot(b, q, u, rate);
    for (int i = 0; i < 3; i++) q[i] += h * rate[i];
    quaternion_step(q + 3, u + 3, half);
}

/* qdot: the matrix, its product with a vector, the quaternion's rate. */
enum { RATES = QUATERNION + MAT3_VEC_FLOP + QUATERNION_RATE };
/* step: qdot once, two half-turns, three displacements, half the step. */
const struct joint_motion JOINT_DEFINE(floating) = {
    .pick = {3, 4, 5, 0, 1, 2},
    .slides = true,
    .place = place,
    .qdot = qdot,
    .step = step,
    .cost = {.place = QUATERNION_PLACE + SHIFT,
             .place_div = 1,
             .rate = 6,
             .bias = BIAS + SLIDING,
             .qdot = {.flop = RATES, .div = 1},
             .step = {.flop = 1 + RATES + 6 + 2 * QUATERNION_STEP, .div = 5, .sqrt = 4, .trig = 4},
             PICKED(6)},
};
