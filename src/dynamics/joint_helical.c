/* joint_helical.c - helical joints: a turn about z that advances along it by `pitch` per radian. */
#include "dynamics/joint_motion.h"

/* H = unit [z; pitch z]; W = unit [-pitch z; z], then the four others: constant, but no unit
 * vectors. */
static void subspace(const struct body *b, const real *q, struct subspace *s)
{
    static const signed char others[4] = {0, 1, 3, 4};
    (void)q;
    for (int k = 0; k < 36; k++) s->col[k] = REAL(0);
    /* the columns of the angle and of the advance along it mix; both have length 1 */
    const real advance = b->details->unit * b->details->pitch;
    s->col[2] = b->details->unit, s->col[5] = advance;
    s->col[6 + 2] = -advance, s->col[6 + 5] = b->details->unit;
    /* nothing else moves */
    for (int k = 0; k < 4; k++) s->col[6 * (2 + k) + others[k]] = REAL(1);
}

/* r = E Rz(q), p = t + pitch q E z; the columns come along, since a pose has them. */
static void place(const struct body *b, const real *q, struct body_pose *pose)
{
    turn_about_z(b->tree.r, q[0], pose->x.r);
    shift_along_z(&b->tree, b->details->pitch * q[0], pose->x.p);
    subspace(b, q, &pose->s);
}

/* The angle turns by less than u, which counts the advance, too. */
static void qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    (void)q;
    qd[0] = b->details->unit * u[0];
}

/* place: 2 flops for pitch q besides; rate and step: a dense column and the unit length. */
const struct joint_motion JOINT_DEFINE(helical) = {
    .slides = true,
    .subspace = subspace,
    .place = place,
    .qdot = qdot,
    .cost = {.subspace = {.flop = 1},
             .place = TURN + SHIFT_ALONG + 2,
             .place_trig = 2,
             .rate = 12,
             .bias = BIAS + SLIDING,
             .qdot = {.flop = 1},
             .step = {.flop = 3},
             DENSE(1)},
};
