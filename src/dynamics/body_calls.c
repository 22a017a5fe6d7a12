/* body_calls.c - what is computed alike for bodies in space and in the plane (body_calls.h). */
#include "dynamics/body_calls.h"

#include <string.h>

#include "dynamics/algebra.h"

/* Bits, not values: -0 and 0 turn frames differently. */
static bool same_numbers(const double *x, const double *y, int n)
{
    return memcmp(x, y, (size_t)n * sizeof *x) == 0;
}

/* Same turning of frames: what every other equality stands on. */
bool bodies_alike(const struct model *m, int i, int j)
{
    if (i == j) return true;
    /* the base has no joint */
    if (i < 0 || j < 0) return false;
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return a->joint == b->joint && same_numbers(a->axis, b->axis, 3) &&
           same_numbers(a->axis2, b->axis2, 3);
}

/* The placement does not matter here: inertias are given in the body's own frame. */
bool bodies_weigh_alike(const struct model *m, int i, int j)
{
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return same_numbers(&a->mass, &b->mass, 1) && same_numbers(a->com, b->com, 3) &&
           same_numbers(a->inertia, b->inertia, 6);
}

/* Everything else that a body's constants depend on; planar joints have no pitch. */
bool bodies_hang_alike(const struct model *m, int i, int j)
{
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return same_numbers(a->placement.quat, b->placement.quat, 4) &&
           same_numbers(a->placement.p, b->placement.p, 3) && a->pitch == b->pitch &&
           a->stiffness == b->stiffness && a->rest == b->rest && a->damping == b->damping;
}

/* Where the body's numbers lie in the model's arrays. */
void body_seat(const struct model *m, int i, struct body *b)
{
    const struct body_def *def = &m->body[i];
    b->parent = def->parent;
    b->joint = def->joint;
    /* counted once here, since every sweep asks for them */
    b->d = joint_nu(def->joint);
    b->nq = joint_nq(def->joint);
    b->q_at = m->q_at[i];
    b->u_at = m->u_at[i];
}

/* Given in the model's own units; rounded once, as all constants are. */
bool joint_springs(const struct model *m, int i, struct joint_spring *s)
{
    const struct body_def *def = &m->body[i];
    s->stiffness = REAL(def->stiffness);
    s->rate_stiffness = s->stiffness; /* q' = u */
    s->rest = REAL(def->rest);
    s->damping = REAL(def->damping);
    return def->stiffness != 0 || def->damping != 0;
}

/* h = H u = [w_J; v_J]. */
void body_rate(const struct body_pose *pose, const real *u, real *h)
{
    screw_zero(h);
    subspace_h(&pose->s, u, h);
}

/* tau -= k (q - q_0) + c u. */
void body_spring(const struct body *b, const real *q, const real *u, real *tau)
{
    if (!b->has_spring) return;
    const struct joint_spring *s = body_spring_of(b);
    tau[0] -= s->stiffness * (q[0] - s->rest) + s->damping * u[0];
}
