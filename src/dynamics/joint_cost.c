/* joint_cost.c - what the local computations of each joint type execute. */
#include "dynamics/body.h"

/* Columns that are not unit vectors cost 12 flops to expand (screw_axpy), 11 to reduce (screw_dot); a projection of a
 * full matrix costs 66 per column and 11 per entry. */
#define DENSE(d)                                                                                                       \
    .h = 12 * (d), .h_transposed = 11 * (d), .w = 12 * (6 - (d)), .w_transposed = 11 * (6 - (d)),                      \
    .hh = 66 * (d) + 11 * (d) * (d), .hw = 66 * (6 - (d)) + 11 * (d) * (6 - (d)),                                      \
    .ww = 66 * (6 - (d)) + 11 * (6 - (d)) * (6 - (d))
#define PICKED(d) .h = (d), .w = 6 - (d)

/* Matrix of a quaternion: 7 (length), 3 + 9 (products), 12; turning E about z: 18; product of rotations: 45. Bias: 3 +
 * 15 + 27, that of a joint that slides 6 + 12 besides. */
enum { QUATERNION = 31, TURN = 18, BIAS = 45, SLIDING = 18, SLIDE = 15 };

/* Coordinates that move by rates as they are; 2 flops each besides the rates. */
#define STEPS(n) .step = {.flop = 2 * (n)}
/* A quaternion's rate, and its turn by a rotation vector: 5 (length) + 2 + 3 + 28 (product) + 7 (length) + 4. */
enum { QUATERNION_RATE = 24, QUATERNION_STEP = 49 };
#define QUATERNION_STEPS(n)                                                                                            \
    .qdot = {.flop = QUATERNION_RATE}, .step = {.flop = QUATERNION_STEP + 2 * (n), .div = 2, .sqrt = 2, .trig = 2}

static const struct joint_cost cost[JOINT_MIXED] = {
    [JOINT_FIXED] = {.bias = BIAS, PICKED(0)},
    [JOINT_REVOLUTE] = {.place = TURN, .place_trig = 2, .rate = 1, .bias = BIAS, STEPS(1), PICKED(1)},
    [JOINT_PRISMATIC] = {.place = 6, .rate = 1, .bias = BIAS + SLIDING, STEPS(1), PICKED(1)},
    [JOINT_HELICAL] = {.subspace = {.flop = 1},
                       .place = TURN + 8,
                       .place_trig = 2,
                       .rate = 12,
                       .bias = BIAS + SLIDING,
                       .qdot = {.flop = 1},
                       .step = {.flop = 3},
                       DENSE(1)},
    [JOINT_CYLINDRICAL] = {.place = TURN + 6, .place_trig = 2, .rate = 2, .bias = BIAS + SLIDING, STEPS(2), PICKED(2)},
    [JOINT_UNIVERSAL] =
        {.subspace = {.trig = 2}, .place = 36, .place_trig = 4, .rate = 24, .bias = BIAS + 5, STEPS(2), DENSE(2)},
    [JOINT_SPHERICAL] =
        {.place = QUATERNION + 45, .place_div = 1, .rate = 3, .bias = BIAS, QUATERNION_STEPS(0), PICKED(3)},
    [JOINT_PLANAR] = {.place = TURN + 18,
                      .place_trig = 2,
                      .rate = 3,
                      .bias = BIAS + SLIDING,
                      .qdot = {.flop = 6, .trig = 2},
                      .step = {.flop = 15, .trig = 2},
                      PICKED(3)},
    [JOINT_SLOT] = {.subspace = {.flop = QUATERNION + 45, .div = 1},
                    .place = QUATERNION + 45 + 21 + 3 * SLIDE,
                    .place_div = 1,
                    .rate = 48,
                    .bias = BIAS + SLIDING + 12,
                    QUATERNION_STEPS(1),
                    DENSE(4)},
    [JOINT_POINT_PLANE] = {.subspace = {.flop = QUATERNION + 45, .div = 1},
                           .place = QUATERNION + 45 + 27 + 3 * SLIDE,
                           .place_div = 1,
                           .rate = 60,
                           .bias = BIAS + SLIDING + 12,
                           QUATERNION_STEPS(2),
                           DENSE(5)},
    [JOINT_FLOATING] = {.place = QUATERNION + 45 + 18,
                        .place_div = 1,
                        .rate = 6,
                        .bias = BIAS + SLIDING,
                        .qdot = {.flop = QUATERNION + 15 + QUATERNION_RATE, .div = 1},
                        .step = {.flop = 1 + QUATERNION + 15 + QUATERNION_RATE + 6 + 2 * QUATERNION_STEP,
                                 .div = 5,
                                 .sqrt = 4,
                                 .trig = 4},
                        PICKED(6)},
};

const struct joint_cost *joint_cost_of(enum model_joint joint) { return &cost[joint]; }
