/* planar_closed.c - forward dynamics of planar scenes, with loops through S = J M^-1 J^T, column by
 * column. */
#include <string.h>

#include "dynamics/planar_dynamics.h"
#include "dynamics/planar_loop.h"
#include "dynamics/planar_scene.h"
#include "linalg/least_norm.h"

/* The loops of a scene in its state. */
struct closing {
    int n; /* constraints of all of them */
    struct loop *loop;
    struct loop_pose *pose;
    real *load; /* (nbody x 3) */
};

/* closing_take: places, 14 flops a body, and velocities, 13, then the loops. */
static struct closing closing_take(const struct scene *x, struct arena *scratch, struct work *w)
{
    const struct model *m = x->model;
    struct closing c = {loop_rows(m), TAKE(scratch, m->nloop, struct loop),
                        TAKE(scratch, m->nloop, struct loop_pose),
                        TAKE(scratch, size_product(SPACE, m->nbody), real)};
    struct xform *place = TAKE(scratch, m->nbody + 1, struct xform);
    /* of the base, then of the bodies */
    real *v = TAKE(scratch, size_product(SPACE, m->nbody + 1), real);
    /* The base stands first, so that parents need no special case. */
    xform_identity(&place[0]);
    for (int i = 0; i < m->nbody; i++) {
        const int p = x->body[i].parent + 1;
        real h[SPACE];
        xform_compose(&place[i + 1], &place[p], &x->moving[i].pose.x);
        planar_joint_motion(&x->body[i], x->state->qd + x->body[i].u_at, h);
        xform_motion(v + SPACE * (i + 1), &x->moving[i].pose.x, v + SPACE * p);
        screw_add(v + SPACE * (i + 1), h);
        w->flop += XFORM_COMPOSE_FLOP + XFORM_MOTION_FLOP + SCREW_ADD_FLOP;
    }
    /* With places and velocities of both bodies each loop's terms follow (physics 7.3). */
    loops_make(m, c.loop, TAKE(scratch, m->nrow, int));
    /* Sides of the base stand still at the identity. */
    for (int l = 0; l < m->nloop; l++) {
        const int a = c.loop[l].body_a + 1, b = c.loop[l].body_b + 1;
        loop_place(&c.loop[l], &place[a], &place[b], v + SPACE * a, v + SPACE * b, &c.pose[l]);
        w->flop += (uint64_t)loop_place_flops(&c.loop[l]);
    }
    return c;
}

/* closing_force: load = the loops' forces for lambda (n). */
static void closing_force(const struct scene *x, const struct closing *c, const real *lambda,
                          struct work *w)
{
    /* Loads are made anew for each lambda. */
    memset(c->load, 0, (size_t)(SPACE * x->model->nbody) * sizeof(real));
    for (int side = 0; side < 2 * x->model->nloop; side++) {
        const struct loop *l = &c->loop[side / 2];
        const int body = side % 2 ? l->body_b : l->body_a;
        real column[6 * SPACE];
        if (body < 0) continue;
        /* Equal and opposite on the two bodies: loop_column has the sign. */
        loop_column(&c->pose[side / 2], side % 2, column);
        for (int k = 0; k < l->c; k++)
            screw_axpy(c->load + SPACE * body, lambda[l->row_at + k], column + SPACE * k);
        w->flop += (uint64_t)(l->c * (XFORM_FORCE_FLOP + SCREW_AXPY_FLOP));
    }
}

/* closing_residual: r (n): what the present accelerations leave of the constraints; without terms
 * the linear part. */
static void closing_residual(const struct scene *x, const struct closing *c, real *r,
                             struct work *w)
{
    /* Columns of S are responses to forces alone: the base stands still in them. */
    static const real still[SPACE] = {0};
    for (int l = 0; l < x->model->nloop; l++) {
        const struct loop *loop = &c->loop[l];
        const struct loop_pose *p = &c->pose[l];
        const real *base = x->terms ? x->base : still;
        real a[SPACE], b[SPACE];
        /* Accelerations of both bodies at the loop's frames. */
        xform_motion(a, &p->ta, loop->body_a < 0 ? base : x->moving[loop->body_a].a);
        xform_motion(b, &p->tb, loop->body_b < 0 ? base : x->moving[loop->body_b].a);
        screw_sub(b, a);
        if (x->terms) screw_add(b, p->gamma);
        for (int k = 0; k < loop->c; k++)
            r[loop->row_at + k] = screw_dot(p->w + SPACE * k, b);
        for (int k = 0; k < loop->c && x->terms; k++) r[loop->row_at + k] += p->stabilise[k];
        w->flop += (uint64_t)(2 * XFORM_MOTION_FLOP + (x->terms ? 2 : 1) * SCREW_ADD_FLOP +
                              loop->c * (SCREW_DOT_FLOP + (x->terms ? 1 : 0)));
    }
}

/* closing_reference: what S's rounding scales with: the constraints' own bodies as if they were
 * free. */
static void closing_reference(const struct scene *x, const struct closing *c, real *reference,
                              struct work *w)
{
    for (int k = 0; k < c->n; k++) reference[k] = 0;
    for (int side = 0; side < 2 * x->model->nloop; side++) {
        const struct loop *l = &c->loop[side / 2];
        const int body = side % 2 ? l->body_b : l->body_a;
        real column[6 * SPACE], a[SPACE];
        if (body < 0) continue;
        loop_column(&c->pose[side / 2], side % 2, column);
        for (int k = 0; k < l->c; k++) {
            /* f^T Phi f, its part of the diagonal of A_ll (7.7). A massless body adds nothing. */
            body_accelerate(&x->body[body], column + SPACE * k, a);
            reference[l->row_at + k] += screw_dot(column + SPACE * k, a);
        }
        w->flop +=
            (uint64_t)(l->c * (XFORM_FORCE_FLOP + BODY_ACCELERATE_FLOP + SCREW_DOT_FLOP + 1));
    }
    /* A loop between the base and a massless body has no scale of its own (loops_reference). */
    for (int k = 0; k < c->n; k++)
        if (!(reference[k] > 0)) reference[k] = 1;
}

/* closed_forward: S = J M^-1 J^T column by column, lambda of least norm, then the open scene under
 * the loops' forces; twice, to remove what rounding left. */
static bool closed_forward(struct scene *x, const double *tau, double *ud, struct arena *scratch,
                           struct work *w)
{
    const struct closing c = closing_take(x, scratch, w);
    const int n = c.n;
    real *S = TAKE(scratch, size_product(n, n), real),
         *copy = TAKE(scratch, size_product(n, n), real),
         *room = TAKE(scratch, size_product(n, n + 2), real);
    real *reference = TAKE(scratch, n, real), *lambda = TAKE(scratch, n, real),
         *r = TAKE(scratch, n, real);
    const double *none = TAKE(scratch, x->model->nu, double);
    struct moving *at_rest = TAKE(scratch, x->model->nbody, struct moving), *moving = x->moving;
    /* (7.7) scales by A_ll, not by S: the diagonal of S may be zero but for rounding. */
    closing_reference(x, &c, reference, w);
    /* Same poses, no bias. */
    memcpy(at_rest, moving, (size_t)x->model->nbody * sizeof *at_rest);
    for (int i = 0; i < x->model->nbody; i++) screw_zero(at_rest[i].bias);
    /* The same scene without velocities, wrenches and gravity. */
    struct scene response = *x;
    response.moving = at_rest;
    response.terms = false;
    response.load = c.load;
    screw_zero(response.base);
    bool good = true;
    /* J M^-1 J^T, one unit of force a column, is the S of (7.5). */
    for (int k = 0; k < n && good; k++) {
        for (int j = 0; j < n; j++) r[j] = j == k;
        closing_force(x, &c, r, w);
        good = planar_open_forward(&response, none, ud, w);
        closing_residual(&response, &c, r, w);
        for (int j = 0; j < n; j++) S[j * n + k] = r[j];
    }
    /* Symmetric but for rounding; the solver gets a matrix that is exactly so. */
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            S[i * n + k] = S[k * n + i] = (real)0.5 * (S[i * n + k] + S[k * n + i]);
    w->flop += (uint64_t)(n * (n - 1));
    good = good && planar_open_forward(x, tau, ud, w);
    /* The second pass removes what rounding left of the first. */
    for (int pass = 0; pass < 2 && good; pass++) {
        closing_residual(x, &c, r, w);
        /* The solver overwrites its matrix. */
        for (int k = 0; k < n * n; k++) copy[k] = S[k];
        for (int k = 0; k < n; k++) r[k] = -r[k];
        least_norm_solve(n, reference, copy, r, room, w);
        for (int k = 0; k < n; k++) lambda[k] += r[k];
        w->flop += (uint64_t)n;
        closing_force(x, &c, lambda, w);
        x->load = c.load;
        good = planar_open_forward(x, tau, ud, w);
    }
    return good;
}

/* With or without loops: springs are given forces here. */
bool planar_forward(const struct model *model, const struct state *s, struct arena *scratch,
                    double *qdd, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct scene x = planar_scene_take(model, s, scratch);
    double *tau = TAKE(scratch, model->nu, double);
    for (int k = 0; k < model->nu; k++) tau[k] = s->tau[k];
    for (int i = 0; i < model->nbody; i++) {
        const struct body *b = &x.body[i];
        planar_start(&x, i, w);
        if (!b->has_spring) continue;
        /* -k (q - q0) - c u; only joints of one freedom have springs (model.h). */
        const struct joint_spring *k = body_spring_of(b);
        const real q = (real)s->q[b->q_at], u = (real)s->qd[b->u_at];
        tau[b->u_at] =
            (double)((real)tau[b->u_at] - (k->stiffness * (q - k->rest) + k->damping * u));
        w->flop += BODY_SPRING_FLOP;
    }
    const bool good = model->nloop > 0 ? closed_forward(&x, tau, qdd, scratch, w)
                                       : planar_open_forward(&x, tau, qdd, w);
    arena_release(scratch, mark);
    return good;
}
