/* rnea.c - recursive Newton-Euler inverse dynamics of trees, physics (2.1)-(2.5). */
#include "dynamics/dynamics.h"
#include "dynamics/revolute.h"
#include "dynamics/work_count.h"

/* Outward at rest: A_i = X^T A_p + H u', F_i = I A - load. */
static void outward_at_rest(struct dynamics *d, const real *ud)
{
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        const struct body_pose *pose = &d->pose[i];
        real carried[6], *a = d->a + 6 * i, *f = d->f + 6 * i;
        /* No velocities: neither bias nor P. Gravity enters at the base (physics 1.6). */
        screw_zero(a);
        subspace_h(&pose->s, ud + b->u_at, a);
        xform_motion(carried, &pose->x, b->parent >= 0 ? d->a + 6 * b->parent : d->base);
        screw_add(a, carried);
        body_force(b, a, f);
        if (d->load) screw_sub(f, d->load + 6 * i);
    }
}

/* Outward: V_i = X^T V_p + H u, A_i = X^T A_p + H u' + b, F_i = I A + P - load. */
static void outward(struct dynamics *d, const real *u, const real *ud)
{
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        const struct body_pose *pose = &d->pose[i];
        real h[6], carried[6], *v = d->v + 6 * i, *a = d->a + 6 * i, *f = d->f + 6 * i;
        /* Only the angular velocity is needed: P and b do without the linear one. */
        body_rate(pose, u + b->u_at, h);
        vec3_copy(v, h);
        if (b->parent >= 0) {
            mat3_mul_vec_transposed(carried, pose->x.r, d->v + 6 * b->parent);
            vec3_add(v, carried);
        }
        /* b first, in place, then H u' and what the parent carries along. */
        body_bias(b, pose, v, h, u + b->u_at, a);
        subspace_h(&pose->s, ud + b->u_at, a);
        xform_motion(carried, &pose->x, b->parent >= 0 ? d->a + 6 * b->parent : d->base);
        screw_add(a, carried);
        body_force(b, a, f);
        /* P reuses the room of what was carried. */
        body_gyro(b, v, carried);
        screw_add(f, carried);
        if (d->load) screw_sub(f, d->load + 6 * i);
    }
}

/* Inward: F_p += X F, tau = H^T F.
 * Leaves first: a body's force is complete before its parent takes it. */
static void inward(struct dynamics *d, real *tau)
{
    for (int i = d->nbody - 1; i >= 0; i--) {
        const struct body *b = &d->body[i];
        const real *f = d->f + 6 * i;
        subspace_h_transposed(&d->pose[i].s, f, tau + b->u_at);
        if (b->parent < 0) continue;
        real g[6];
        xform_force(g, &d->pose[i].x, f);
        screw_add(d->f + 6 * b->parent, g);
    }
}

/* Any joints; the counts follow from the joint types alone. */
void rnea_full(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
               struct work *w)
{
    dynamics_place(d, q);
    if (d->at_rest) outward_at_rest(d, ud);
    else outward(d, u, ud);
    inward(d, tau);
    work_count_rnea(d, w);
}

/* The fast path has the same answer to rounding. */
void rnea(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
          struct work *w)
{
    if (d->revolute) rnea_revolute(d, q, u, ud, tau, w);
    else rnea_full(d, q, u, ud, tau, w);
}
