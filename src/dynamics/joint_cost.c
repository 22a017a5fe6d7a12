/* joint_cost.c - what the local computations of each joint type execute. */
#include "dynamics/body.h"

/* Columns that are not unit vectors cost 12 flops to expand (screw_axpy), 11 to reduce (screw_dot); a projection of a
 * full matrix costs 66 per column and 11 per entry. */
#define DENSE(d)                                                                                                       \
    .h = 12 * (d), .h_transposed = 11 * (d), .w = 12 * (6 - (d)), .w_transposed = 11 * (6 - (d)),                      \
    .hh = 66 * (d) + 11 * (d) * (d), .hw = 66 * (6 - (d)) + 11 * (d) * (6 - (d)),                                      \
    .ww = 66 * (6 - (d)) + 11 * (6 - (d)) * (6 - (d))
#define PICKED(d) .h = (d), .w = 6 - (d)

/* Matrix of a quaternion: 7 + 1 (scale) + 3 + 9 + 12; turning E about z: 18; product of rotations: 45. */
enum { QUATERNION = 32, TURN = 18, BIAS = 45, SLIDE = 15 };

static const struct joint_cost cost[JOINT_MIXED] = {
    [JOINT_FIXED] = {.bias = BIAS, PICKED(0)},
    [JOINT_REVOLUTE] = {.place = TURN, .place_trig = 2, .rate = 1, .bias = BIAS, PICKED(1)},
    [JOINT_PRISMATIC] = {.place = 6, .rate = 1, .bias = BIAS + 21, PICKED(1)},
    [JOINT_HELICAL] = {.place = TURN + 8, .place_trig = 2, .rate = 12, .bias = BIAS + 21, DENSE(1)},
    [JOINT_CYLINDRICAL] = {.place = TURN + 6, .place_trig = 2, .rate = 2, .bias = BIAS + 21, PICKED(2)},
    [JOINT_UNIVERSAL] = {.place = 36, .place_trig = 4, .rate = 24, .bias = BIAS + 5, DENSE(2)},
    [JOINT_SPHERICAL] = {.place = QUATERNION + 45, .place_div = 1, .rate = 3, .bias = BIAS, PICKED(3)},
    [JOINT_PLANAR] = {.place = TURN + 18, .place_trig = 2, .rate = 3, .bias = BIAS + 21, PICKED(3)},
    [JOINT_SLOT] = {.place = QUATERNION + 45 + 21 + 3 * SLIDE, .place_div = 1, .rate = 48, .bias = BIAS + 33, DENSE(4)},
    [JOINT_POINT_PLANE] =
        {.place = QUATERNION + 45 + 27 + 3 * SLIDE, .place_div = 1, .rate = 60, .bias = BIAS + 33, DENSE(5)},
    [JOINT_FLOATING] = {.place = QUATERNION + 45 + 18, .place_div = 1, .rate = 6, .bias = BIAS + 21, PICKED(6)},
};

const struct joint_cost *joint_cost_of(enum model_joint joint) { return &cost[joint]; }
