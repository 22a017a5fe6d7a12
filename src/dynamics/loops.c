/* loops.c - all loops of a model together. */
#include "dynamics/loops.h"

/* Transforms of the bodies' internal frames to the base. */
static struct xform *world_poses(struct dynamics *d, struct work *w)
{
    struct xform *x = TAKE(d->arena, d->nbody, struct xform);
    for (int i = 0; i < d->nbody; i++) {
        int p = d->body[i].parent;
        if (p < 0) {
            x[i] = d->pose[i].x;
        } else {
            xform_compose(&x[i], &x[p], &d->pose[i].x);
            w->flop += XFORM_COMPOSE_FLOP;
        }
    }
    return x;
}

void loops_take(struct dynamics *d, struct loops *l, struct work *w)
{
    const struct model *m = d->model;
    real still[6] = {0};
    struct xform base;
    l->nloop = m->nloop;
    l->nrow = m->nrow;
    l->loop = TAKE(d->arena, m->nloop, struct loop);
    l->pose = TAKE(d->arena, m->nloop, struct loop_pose);
    if (m->nloop == 0) return;
    struct xform *x = world_poses(d, w);
    xform_identity(&base);
    for (int k = 0; k < m->nloop; k++) {
        struct loop *loop = &l->loop[k];
        loop_make(m, k, loop);
        int a = loop->body_a, b = loop->body_b;
        loop_place(loop, a < 0 ? &base : &x[a], b < 0 ? &base : &x[b], a < 0 ? still : d->v + 6 * a,
                   b < 0 ? still : d->v + 6 * b, &l->pose[k]);
        w->flop += (uint64_t)loop_place_flops(loop);
    }
}

/* What loop_force executes. */
static int force_flops(const struct loop *l)
{
    return SCREW_AXPY_FLOP * l->c + ((l->body_a >= 0) + (l->body_b >= 0)) * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP);
}

void loops_force(const struct loops *l, const real *lambda, real *f, struct work *w)
{
    for (int k = 0; k < l->nloop; k++) {
        int a = l->loop[k].body_a, b = l->loop[k].body_b;
        loop_force(&l->pose[k], lambda + l->loop[k].row_at, a < 0 ? NULL : f + 6 * a, b < 0 ? NULL : f + 6 * b);
        w->flop += (uint64_t)force_flops(&l->loop[k]);
    }
}

void loops_column(const struct loops *l, int k, real *f, struct work *w)
{
    int n = 0;
    while (n + 1 < l->nloop && l->loop[n + 1].row_at <= k) n++;
    real unit[6] = {0};
    int a = l->loop[n].body_a, b = l->loop[n].body_b;
    unit[k - l->loop[n].row_at] = 1;
    loop_force(&l->pose[n], unit, a < 0 ? NULL : f + 6 * a, b < 0 ? NULL : f + 6 * b);
    w->flop += (uint64_t)force_flops(&l->loop[n]);
}

void loops_residual(const struct loops *l, const real *a, const real *base, bool homogeneous, real *r,
                    struct work *w)
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
        w->flop += (uint64_t)(LOOP_RESIDUAL_FLOP + (SCREW_DOT_FLOP + 1) * p.c);
    }
}

/* column^T Phi column of one side. */
static real side_reference(const struct dynamics *d, int body, const real *column, struct work *w)
{
    real a[6];
    if (body < 0) return 0;
    if (d->model->has_phi) {
        sym6_mul(a, &d->body[body].phi, column);
        w->flop += SYM6_MUL_FLOP + SCREW_DOT_FLOP;
        return screw_dot(a, column);
    }
    real m = d->body[body].m;
    if (!(m > 0)) return 0;
    w->flop += VEC3_DOT_FLOP;
    w->div++;
    return vec3_dot(column + 3, column + 3) / m;
}

void loops_reference(const struct dynamics *d, const struct loops *l, real *reference, struct work *w)
{
    for (int k = 0; k < l->nloop; k++) {
        const struct loop *loop = &l->loop[k];
        real a[36], b[36];
        loop_column(&l->pose[k], false, a);
        loop_column(&l->pose[k], true, b);
        for (int i = 0; i < loop->c; i++) {
            real sum = side_reference(d, loop->body_a, a + 6 * i, w) + side_reference(d, loop->body_b, b + 6 * i, w);
            reference[loop->row_at + i] = sum > 0 ? sum : 1;
        }
        w->flop += (uint64_t)(loop->c * (2 * XFORM_FORCE_FLOP + 1));
    }
}
