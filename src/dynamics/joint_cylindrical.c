/* joint_cylindrical.c - cylindrical joints: a turn about z and a displacement along it. */
#include "dynamics/joint_motion.h"

/* r = E Rz(q1), p = t + q2 E z. */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    turn_about_z(b->tree.r, q[0], pose->x.r);
    /* the displacement is along the axis of the turn, so that their order does not matter */
    shift_along_z(&b->tree, q[1], pose->x.p);
}

/* H = [z; 0], [0; z]: z is the same direction in joint frame and body. */
const struct joint_motion JOINT_DEFINE(cylindrical) = {
    .pick = {2, 5, 0, 1, 3, 4},
    .slides = true,
    .place = place,
    .cost = {.place = TURN + SHIFT_ALONG,
             .place_trig = 2,
             .rate = 2,
             .bias = BIAS + SLIDING,
             STEPS(2),
             PICKED(2)},
};
