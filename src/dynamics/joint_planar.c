/* joint_planar.c - planar joints: displacements in the plane z = 0 of the joint frame, and a turn
 * about z. */
#include "dynamics/joint_motion.h"

/* r = E Rz(q1), p = t + E (q2, q3, 0). */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    turn_about_z(b->tree.r, q[0], pose->x.r);
    shift(&b->tree, q[1], q[2], REAL(0), pose->x.p);
}

/* The origin's velocity is given in body axes, its place in joint axes. */
static void qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    real sine, cosine;
    (void)b;
    /* (x', y') = Rz(q1) (v_x, v_y) */
    angle_sincos(q[0], &sine, &cosine);
    vec3_set(qd, u[0], cosine * u[1] - sine * u[2], sine * u[1] + cosine * u[2]);
}

/* Half the turn, the displacement along the axes of mid-step, the other half: symmetric in time. */
static void step(const struct body *b, real *q, const real *u, real h)
{
    real rate[3];
    const real half = REAL(0.5) * h;
    q[0] += half * u[0];
    qdot(b, q, u, rate);
    for (int i = 1; i < 3; i++) q[i] += h * rate[i];
    q[0] += half * u[0];
}

/* H = [z; 0], [0; x], [0; y] in body axes. qdot: the rotation of two numbers, 6 flops; step: that,
 * half the step, 2 for each displacement and each half-turn. */
const struct joint_motion JOINT_DEFINE(planar) = {
    .pick = {2, 3, 4, 0, 1, 5},
    .slides = true,
    .place = place,
    .qdot = qdot,
    .step = step,
    .cost = {.place = TURN + SHIFT,
             .place_trig = 2,
             .rate = 3,
             .bias = BIAS + SLIDING,
             .qdot = {.flop = 6, .trig = 2},
             .step = {.flop = 15, .trig = 2},
             PICKED(3)},
};
