/* joint_prismatic.c - prismatic joints: a displacement along z. */
#include "dynamics/joint_motion.h"

/* r = E, p = t + q E z. */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    for (int i = 0; i < 9; i++) pose->x.r[i] = b->tree.r[i];
    shift_along_z(&b->tree, q[0], pose->x.p);
}

/* H = [0; z], fixed in the body, since nothing turns. */
const struct joint_motion JOINT_DEFINE(prismatic) = {
    .pick = {5, 0, 1, 2, 3, 4},
    .slides = true,
    .place = place,
    .cost = {.place = SHIFT_ALONG, .rate = 1, .bias = BIAS + SLIDING, STEPS(1), PICKED(1)},
};
