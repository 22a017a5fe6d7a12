/* joint.c - motion of a body by its joint's type: transform, subspace, bias, a step along the group
 * (physics 1.3).
 *
 * What the types do differently stands in their own files (joint_motion.h); here is what is
 * common. */
#include "dynamics/body.h"

#include "dynamics/joint_motion.h"

/* A pointer a type: a file that lacks its joint_STEM does not link. */
static const struct joint_motion *const motion_of[JOINT_MIXED] = {
#define ROW(constant, word, stem, coordinates, plane, traits) [constant] = &JOINT_DEFINE(stem),
    JOINT_LIST(ROW)
#undef ROW
};

/* Costs stand beside the text that executes them, in the type's own file. */
const struct joint_cost *joint_cost_of(enum model_joint joint) { return &motion_of[joint]->cost; }

const struct joint_cost *body_cost(const struct body *b) { return joint_cost_of(b->joint); }

/* Whoever has no function for its columns has unit vectors. */
bool body_picks(const struct body *b) { return !motion_of[b->joint]->subspace; }

/* For whoever needs the numbers without a body, as planar scenes do. */
const signed char *joint_pick(enum model_joint joint)
{
    return motion_of[joint]->subspace ? NULL : motion_of[joint]->pick;
}

void body_subspace(const struct body *b, const real *q, struct subspace *s)
{
    /* picked columns are numbers, not arithmetic: only the others are filled in */
    s->d = b->d;
    s->c = 6 - b->d;
    s->pick = joint_pick(b->joint);
    if (!s->pick) motion_of[b->joint]->subspace(b, q, s);
}

void body_place(const struct body *b, const real *q, struct body_pose *pose)
{
    /* the type's own function fills the columns, too, since both want the same sines */
    pose->s.d = b->d;
    pose->s.c = 6 - b->d;
    pose->s.pick = joint_pick(b->joint);
    motion_of[b->joint]->place(b, q, pose);
}

void body_bias(const struct body *b, const struct body_pose *pose, const real *v, const real *h,
               const real *u, real *bias)
{
    const struct joint_motion *motion = motion_of[b->joint];
    real w[3], p[3], t[3];
    /* physics (1.9): w* = w - w_J, p* = r^T p */
    for (int i = 0; i < 3; i++) w[i] = v[i] - h[i];
    mat3_mul_vec_transposed(p, pose->x.r, pose->x.p);
    /* what every joint has: [w* x w_J; w* x (w* x p*)] */
    vec3_cross(bias, w, h);
    vec3_cross(t, w, p);
    vec3_cross(bias + 3, w, t);
    if (motion->slides) { /* 2 w* x v_J + w_J x v_J, in one product */
        for (int i = 0; i < 3; i++) t[i] = w[i] + w[i] + h[i];
        vec3_cross_add(bias + 3, t, h + 3);
    }
    /* H's own motion in the body, of universal joints and slots */
    if (motion->kappa) motion->kappa(pose, h, u, bias);
}

void body_qdot(const struct body *b, const real *q, const real *u, real *qd)
{
    const struct joint_motion *motion = motion_of[b->joint];
    if (motion->qdot) {
        motion->qdot(b, q, u, qd);
        return;
    }
    /* most coordinates are their rates' integrals */
    for (int i = 0; i < b->d; i++) qd[i] = u[i];
}

void body_step(const struct body *b, real *q, const real *u, real h)
{
    const struct joint_motion *motion = motion_of[b->joint];
    /* along the group where coordinates are none of a vector space */
    if (motion->step) {
        motion->step(b, q, u, h);
        return;
    }
    /* exact for coordinates whose rates are constant; all types of this kind have at most six */
    real rate[6];
    body_qdot(b, q, u, rate);
    for (int i = 0; i < b->nq; i++) q[i] += h * rate[i];
}
