/* loops.c - all loops of a model together. */
#include "dynamics/loops.h"

/* Placed once an evaluation: forces, columns and residuals share poses and velocity terms. */
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
    struct xform *x = dynamics_world(d, w);
    /* The base is a body at rest in its own frame. */
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
    return SCREW_AXPY_FLOP * l->c +
           ((l->body_a >= 0) + (l->body_b >= 0)) * (XFORM_FORCE_FLOP + SCREW_ADD_FLOP);
}

/* On a loop's two bodies alone; the base takes any force. */
void loops_force(const struct loops *l, const real *lambda, real *f, struct work *w)
{
    for (int k = 0; k < l->nloop; k++) {
        int a = l->loop[k].body_a, b = l->loop[k].body_b;
        loop_force(&l->pose[k], lambda + l->loop[k].row_at, a < 0 ? NULL : f + 6 * a,
                   b < 0 ? NULL : f + 6 * b);
        w->flop += (uint64_t)force_flops(&l->loop[k]);
    }
}

/* A unit force in one constraint is two wrenches. */
void loops_column(const struct loops *l, int k, real *f, struct work *w)
{
    int n = 0;
    /* The loop that constraint k belongs to. */
    while (n + 1 < l->nloop && l->loop[n + 1].row_at <= k) n++;
    real unit[6] = {0};
    int a = l->loop[n].body_a, b = l->loop[n].body_b;
    unit[k - l->loop[n].row_at] = 1;
    loop_force(&l->pose[n], unit, a < 0 ? NULL : f + 6 * a, b < 0 ? NULL : f + 6 * b);
    w->flop += (uint64_t)force_flops(&l->loop[n]);
}

/* Zero when the loops hold at these accelerations. */
void loops_residual(const struct loops *l, const real *a, const real *base, bool homogeneous,
                    real *r, struct work *w)
{
    static const real still[6] = {0};
    if (!base) base = still;
    for (int k = 0; k < l->nloop; k++) {
        struct loop_pose p = l->pose[k];
        int ba = l->loop[k].body_a, bb = l->loop[k].body_b;
        /* Responses to forces alone have no velocity terms (7.2). */
        if (homogeneous) {
            screw_zero(p.gamma);
            screw_zero(p.stabilise);
        }
        loop_residual(&p, ba < 0 ? base : a + 6 * ba, bb < 0 ? base : a + 6 * bb,
                      r + l->loop[k].row_at);
        w->flop += (uint64_t)(LOOP_RESIDUAL_FLOP + (SCREW_DOT_FLOP + 1) * p.c);
    }
}

/* column^T Phi column of one side.
 * A body's part of the diagonal of A_ll: what the constraint would feel if its joints were
 * cut. */
static real side_reference(const struct dynamics *d, int body, const real *column, struct work *w)
{
    real a[6];
    if (body < 0) return 0;
    if (d->model->has_phi) {
        sym6_mul(a, &d->body[body].mass->phi, column);
        w->flop += SYM6_MUL_FLOP + SCREW_DOT_FLOP;
        return screw_dot(a, column);
    }
    /* Point masses have no Phi; their mass still gives the right order of magnitude. */
    real m = d->body[body].mass->inertia.m;
    if (!(m > 0)) return 0;
    w->flop += VEC3_DOT_FLOP;
    w->div++;
    /* f^T f / m, as if all of the mass were at the origin. */
    return vec3_dot(column + 3, column + 3) / m;
}

/* What S's rounding is measured by (physics 7.7). */
void loops_reference(const struct dynamics *d, const struct loops *l, real *reference,
                     struct work *w)
{
    for (int k = 0; k < l->nloop; k++) {
        const struct loop *loop = &l->loop[k];
        real a[36], b[36];
        loop_column(&l->pose[k], false, a);
        loop_column(&l->pose[k], true, b);
        for (int i = 0; i < loop->c; i++) {
            real sum = side_reference(d, loop->body_a, a + 6 * i, w) +
                       side_reference(d, loop->body_b, b + 6 * i, w);
            /* A loop between massless bodies has no scale of its own. */
            reference[loop->row_at + i] = sum > 0 ? sum : 1;
        }
        w->flop += (uint64_t)(loop->c * (2 * XFORM_FORCE_FLOP + 1));
    }
}

bool loops_respond(struct dynamics *d, const struct loops *l, real *response, size_t stride,
                   real *s, struct work *w)
{
    const int m = l->nrow;
    struct arena_mark mark = arena_mark(d->arena);
    real *load = TAKE(d->arena, size_product(6, d->nbody), real), *column = TAKE(d->arena, m, real);
    real *given = d->load;
    bool good = true;
    /* Column k: accelerations of the loops' frames under a unit force in constraint k (physics
     * 7.2), which is a load on its two bodies and nothing else. */
    d->load = load;
    for (int k = 0; k < m && good; k++) {
        for (int i = 0; i < 6 * d->nbody; i++) load[i] = 0;
        loops_column(l, k, load, w);
        good = aba_response(d, d->zero, response + (size_t)k * stride, w);
        loops_residual(l, d->a, NULL, true, column, w);
        for (int i = 0; i < m; i++) s[i * m + k] = column[i];
    }
    d->load = given;
    /* Symmetric but for rounding; the mean keeps the solver's matrix exactly so. */
    for (int i = 0; i < m; i++)
        for (int k = 0; k < i; k++)
            s[i * m + k] = s[k * m + i] = (real)0.5 * (s[i * m + k] + s[k * m + i]);
    w->flop += (uint64_t)(m * (m - 1));
    arena_release(d->arena, mark);
    return good;
}
