/* joint_fixed.c - fixed joints: the body moves with its parent. */
#include "dynamics/joint_motion.h"

/* X = (E, t). */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    (void)q;
    pose->x = b->tree;
}

/* H has no columns, W has all. */
const struct joint_motion JOINT_DEFINE(fixed) = {
    .pick = {0, 1, 2, 3, 4, 5}, .place = place, .cost = {.bias = BIAS, PICKED(0)},
};
