/* joint_spherical.c - spherical joints: any turn about the origin, by a quaternion. */
#include "dynamics/joint_motion.h"

/* r = E R(q), p = t. */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    /* the body's own axes take any direction */
    quaternion_place(b, q, &pose->x);
    vec3_copy(pose->x.p, b->tree.p);
}

/* u is the angular velocity itself; the quaternion follows it. */
static void qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    (void)b;
    quaternion_rate(q, u, qd);
}

/* By the exponential map, exact for constant u. */
static void step(const struct body *b, real *q, const real *u, real h)
{
    (void)b;
    quaternion_step(q, u, h);
}

/* H = [U; 0]: body axes; no v_J at the centre. */
const struct joint_motion JOINT_DEFINE(spherical) = {
    .pick = {0, 1, 2, 3, 4, 5},
    .place = place,
    .qdot = qdot,
    .step = step,
    .cost = {.place = QUATERNION_PLACE,
             .place_div = 1,
             .rate = 3,
             .bias = BIAS,
             QUATERNION_STEPS(0),
             PICKED(3)},
};
