/* loops.c - all loops of a model together. */
#include "dynamics/loops.h"

/* Transforms of the bodies' internal frames to the base. */
static struct xform *world_poses(struct dynamics *d)
{
    struct xform *x = TAKE(d->arena, d->nbody, struct xform);
    for (int i = 0; i < d->nbody; i++) {
        int p = d->body[i].parent;
        if (p < 0)
            x[i] = d->pose[i].x;
        else
            xform_compose(&x[i], &x[p], &d->pose[i].x);
    }
    return x;
}

void loops_take(struct dynamics *d, struct loops *l)
{
    const struct model *m = d->model;
    real still[6] = {0};
    struct xform base;
    l->nloop = m->nloop;
    l->nrow = m->nrow;
    l->loop = TAKE(d->arena, m->nloop, struct loop);
    l->pose = TAKE(d->arena, m->nloop, struct loop_pose);
    struct xform *x = world_poses(d);
    xform_identity(&base);
    for (int k = 0; k < m->nloop; k++) {
        struct loop *loop = &l->loop[k];
        loop_make(m, k, loop);
        int a = loop->body_a, b = loop->body_b;
        loop_place(loop, a < 0 ? &base : &x[a], b < 0 ? &base : &x[b], a < 0 ? still : d->v + 6 * a,
                   b < 0 ? still : d->v + 6 * b, &l->pose[k]);
    }
}

void loops_force(const struct loops *l, const real *lambda, real *f)
{
    for (int k = 0; k < l->nloop; k++) {
        int a = l->loop[k].body_a, b = l->loop[k].body_b;
        loop_force(&l->pose[k], lambda + l->loop[k].row_at, a < 0 ? NULL : f + 6 * a, b < 0 ? NULL : f + 6 * b);
    }
}

void loops_column(const struct loops *l, int k, real *f)
{
    int n = 0;
    while (n + 1 < l->nloop && l->loop[n + 1].row_at <= k) n++;
    real unit[6] = {0};
    int a = l->loop[n].body_a, b = l->loop[n].body_b;
    unit[k - l->loop[n].row_at] = 1;
    loop_force(&l->pose[n], unit, a < 0 ? NULL : f + 6 * a, b < 0 ? NULL : f + 6 * b);
}

void loops_residual(const struct loops *l, const real *a, const real *base, bool homogeneous, real *r)
{
    static const real still[6] = {0};
    if (!base) base = still;
    for (int k = 0; k < l->nloop; k++) {
        struct loop_pose p = l->pose[k];
        int ba = l->loop[k].body_a, bb = l->loop[k].body_b;
        if (homogeneous) {
            screw_zero(p.gamma);
            screw_zero(p.stabilise);
        }
        loop_residual(&p, ba < 0 ? base : a + 6 * ba, bb < 0 ? base : a + 6 * bb, r + l->loop[k].row_at);
    }
}

/* column^T Phi column of one side. */
static real side_reference(const struct dynamics *d, int body, const real *column)
{
    real a[6];
    if (body < 0) return 0;
    if (d->model->has_phi) {
        sym6_mul(a, &d->body[body].phi, column);
        return screw_dot(a, column);
    }
    real m = d->body[body].m;
    return m > 0 ? vec3_dot(column + 3, column + 3) / m : 0;
}

void loops_reference(const struct dynamics *d, const struct loops *l, real *reference)
{
    for (int k = 0; k < l->nloop; k++) {
        const struct loop *loop = &l->loop[k];
        real a[36], b[36];
        loop_column(&l->pose[k], false, a);
        loop_column(&l->pose[k], true, b);
        for (int i = 0; i < loop->c; i++) {
            real sum = side_reference(d, loop->body_a, a + 6 * i) + side_reference(d, loop->body_b, b + 6 * i);
            reference[loop->row_at + i] = sum > 0 ? sum : 1;
        }
    }
}
