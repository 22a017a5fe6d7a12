/* joint_revolute.c - revolute joints: a turn about z. Systems of these alone have fast paths of
 * their own (revolute.h). */
#include "dynamics/joint_motion.h"

/* r = E Rz(q), p = t. */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    turn_about_z(b->tree.r, q[0], pose->x.r);
    vec3_copy(pose->x.p, b->tree.p);
}

/* H = [z; 0]; v_J = 0 at the axis, where the body's origin lies, so that the bias has no terms of
 * sliding. */
const struct joint_motion JOINT_DEFINE(revolute) = {
    .pick = {2, 0, 1, 3, 4, 5},
    .place = place,
    .cost = {.place = TURN, .place_trig = 2, .rate = 1, .bias = BIAS, STEPS(1), PICKED(1)},
};
