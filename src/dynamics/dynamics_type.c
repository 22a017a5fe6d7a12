/* dynamics_type.c - this precision's table of serial algorithms, double in and out. */
#include "base/check.h"
#include "dynamics/dynamics.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/revolute.h"
#include "dynamics/work_count.h"
#include "model/model_part.h"

/* A model's numbers in this precision.
 * The state as arrays of `real`; answers go back through to_double. */
struct problem {
    struct dynamics *d;
    real *q, *u, *ud, *tau;
};

/* Inputs are rounded once to this precision; quad sees the doubles exactly. A part of a model has a
 * number for each of its bodies. */
static real *to_real(const struct model *m, struct arena *a, const double *x, int n)
{
    real *y = TAKE(a, n, real);
    const bool whole = model_whole(m);
    for (int i = whole ? 0 : m->first; i < (whole ? n : m->end); i++) y[i] = (real)x[i];
    return y;
}

/* Work arrays, loads and inputs of one call; the caller's mark gives them back. */
static struct problem problem_take(const struct model *m, const struct state *s, struct arena *a,
                                   struct work *w)
{
    struct problem p = {.d = dynamics_take(m, a)};
    dynamics_load(p.d, s);
    /* Turning loads into internal axes is part of the algorithm's cost. */
    work_count_load(p.d, w);
    p.q = to_real(m, a, s->q, m->nq);
    p.u = to_real(m, a, s->qd, m->nu);
    p.ud = to_real(m, a, s->qdd, m->nu);
    p.tau = to_real(m, a, s->tau, m->nu);
    return p;
}

/* Answers leave in double: what a table without types can hold. */
static void to_double(double *y, const real *x, int n)
{
    for (int i = 0; i < n; i++) y[i] = (double)x[i];
}

/* Physics (2.1) to (2.5). */
static void inverse(const struct model *m, const struct state *s, struct arena *scratch,
                    double *tau, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    real *out = TAKE(scratch, m->nu, real);
    /* A state at rest may leave out its velocity terms (model.h). */
    p.d->at_rest = s->at_rest;
    rnea(p.d, p.q, p.u, p.ud, out, w);
    to_double(tau, out, m->nu);
    arena_release(scratch, mark);
}

static bool inverse_part(const struct model *m, const struct state *s,
                         const struct part_ends *ends, struct arena *scratch, double *tau,
                         struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    real *out = TAKE(scratch, m->nu, real);
    CHECK(p.d->revolute && m->is_chain);
    p.d->at_rest = s->at_rest;
    const bool ok = rnea_revolute_part(p.d, p.q, p.u, p.ud, ends, out, w);
    for (int i = m->first; i < m->end; i++) tau[i] = (double)out[i];
    arena_release(scratch, mark);
    return ok;
}

/* A problem that is solved again and again. */
struct held {
    struct problem p;
    real *tau; /* (nu) before they are rounded */
};

static struct held *hold(const struct model *m, const struct state *s, struct arena *a)
{
    struct held *h = TAKE(a, 1, struct held);
    struct work w = {0};
    h->p = problem_take(m, s, a, &w);
    h->p.d->at_rest = s->at_rest;
    h->tau = TAKE(a, m->nu, real);
    return h;
}

/* What inverse does, with other accelerations. */
static void inverse_held(struct held *h, const double *qdd, double *tau)
{
    struct problem *p = &h->p;
    struct work w = {0};
    for (int i = 0; i < p->d->nu; i++) p->ud[i] = (real)qdd[i];
    rnea(p->d, p->q, p->u, p->ud, h->tau, &w);
    to_double(tau, h->tau, p->d->nu);
}

/* Which algorithm; all of them answer the same question. */
static bool solve(struct problem *p, enum forward_method method, real *ud, real *lambda,
                  struct cfa_report *report, struct work *w)
{
    struct dynamics *d = p->d;
    /* It chooses among the others itself. */
    if (method == FORWARD_CFA_ROBUST)
        return forward_robust(d, p->q, p->u, p->tau, ud, lambda, report, w);
    if (method == FORWARD_CFA_PAPER || method == FORWARD_CFA_DIRECT) {
        const struct cfa_options options = {.direct = method == FORWARD_CFA_DIRECT};
        return cfa(d, p->q, p->u, p->tau, &options, ud, lambda, report, w);
    }
    /* Closed systems have one way besides constraint forces. */
    if (d->model->nloop > 0) return closed_forward(d, p->q, p->u, p->tau, ud, lambda, report, w);
    if (method == FORWARD_ABA) return aba(d, p->q, p->u, p->tau, ud, w);
    return crba_forward(d, p->q, p->u, p->tau, method == FORWARD_CRBA_SPARSE, ud, w);
}

/* Springs are given forces here: the state's tau is what drives act with. */
static bool forward(const struct model *m, const struct state *s, enum forward_method method,
                    struct arena *scratch, double *qdd, double *lambda,
                    struct forward_report *report, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    struct cfa_report full = {0};
    /* The constraint forces only if they are asked for. */
    real *ud = TAKE(scratch, m->nu, real), *force = TAKE(scratch, m->nrow, real);
    springs_add(p.d, p.q, p.u, p.tau);
    work_count_springs(p.d, w);
    p.d->at_rest = s->at_rest;
    bool good = solve(&p, method, ud, force, report ? &full : NULL, w);
    if (good) to_double(qdd, ud, m->nu);
    if (good && lambda) to_double(lambda, force, m->nrow);
    /* The robust method refines inside and outside; users want to know how often in all. */
    const int refined = full.inner_done + full.outer_done;
    if (report)
        *report =
            (struct forward_report){full.residual, full.rank, full.nrow, refined, full.fell_back};
    arena_release(scratch, mark);
    return good;
}

/* Articulated bodies: no other way from forces to accelerations goes along a chain. */
static bool forward_part(const struct model *m, const struct state *s,
                         const struct part_ends *ends, struct arena *scratch, double *qdd,
                         bool *found, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    real *out = TAKE(scratch, m->nu, real);
    CHECK(p.d->revolute && m->is_chain);
    springs_add(p.d, p.q, p.u, p.tau);
    work_count_springs(p.d, w);
    p.d->at_rest = s->at_rest;
    const bool ok = aba_revolute_part(p.d, p.q, p.u, p.tau, ends, out, found, w);
    for (int i = m->first; i < m->end; i++) qdd[i] = (double)out[i];
    arena_release(scratch, mark);
    return ok;
}

/* Full and symmetric, (nu x nu), for references. */
static void mass_matrix(const struct model *m, const struct state *s, struct arena *scratch,
                        double *mass, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    real *out = TAKE(scratch, size_product(m->nu, m->nu), real);
    crba(p.d, p.q, out, w);
    to_double(mass, out, m->nu * m->nu);
    arena_release(scratch, mark);
}

/* The joint forces that RNEA leaves behind, from internal [moment; force] to the user's [force;
 * moment]. */
static void wrenches(const struct model *m, const struct state *s, struct arena *scratch,
                     double *wrench)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, NULL);
    real *tau = TAKE(scratch, m->nu, real);
    /* The full form: the fast path keeps no joint forces. */
    rnea_full(p.d, p.q, p.u, p.ud, tau, NULL);
    for (int i = 0; i < m->nbody; i++)
        for (int k = 0; k < 3; k++) {
            const real *turn = p.d->body[i].details->user + 3 * k, *moment = p.d->f + 6 * i,
                       *force = moment + 3;
            wrench[6 * i + k] = (double)vec3_dot(turn, force);
            wrench[6 * i + 3 + k] = (double)vec3_dot(turn, moment);
        }
    arena_release(scratch, mark);
}

/* Poses, velocities and accelerations of all bodies in the base's frame. */
static void kinematics(const struct model *m, const struct state *s, struct arena *scratch,
                       double *pose)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, NULL);
    struct body_motion *x = TAKE(scratch, m->nbody, struct body_motion);
    forward_kinematics(p.d, p.q, p.u, p.ud, x);
    for (int i = 0; i < m->nbody; i++) {
        /* In the order of POSE_NUMBERS: matrix, place, then pairs of linear and angular. */
        double *to = pose + POSE_NUMBERS * (size_t)i;
        to_double(to, x[i].r, 9);
        to_double(to + 9, x[i].p, 3);
        to_double(to + 12, x[i].v, 3);
        to_double(to + 15, x[i].w, 3);
        to_double(to + 18, x[i].a, 3);
        to_double(to + 21, x[i].alpha, 3);
    }
    arena_release(scratch, mark);
}

/* Conserved quantities, for the laws that tests and studies check. */
static void totals(const struct model *m, const struct state *s, struct arena *scratch,
                   struct dynamics_totals *t)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, NULL);
    struct motion_totals x;
    motion_totals_of(p.d, p.q, p.u, &x);
    t->kinetic = (double)x.kinetic;
    t->potential = (double)x.potential;
    t->mass = (double)x.mass;
    to_double(t->linear, x.linear, 3);
    to_double(t->angular, x.angular, 3);
    to_double(t->com, x.com, 3);
    arena_release(scratch, mark);
}

/* Time steps of a whole system; the state is overwritten. */
static bool advance(const struct model *m, struct state *s, enum step_rule rule, double h,
                    int steps, struct arena *scratch, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, w);
    struct integrator it = integrator_make(p.d, rule, (real)h, p.q, p.u, p.tau);
    bool good = true;
    /* As far as it goes: a failed step leaves the state before it. */
    for (int k = 0; k < steps && good; k++) good = integrator_step(&it);
    /* Also after a step that failed: the state of the last good one. */
    to_double(s->q, p.q, m->nq);
    to_double(s->qd, p.u, m->nu);
    if (w) work_add(w, &it.work);
    arena_release(scratch, mark);
    return good;
}

/* How far loops have drifted apart: largest position and velocity error. */
static void drift(const struct model *m, const struct state *s, struct arena *scratch,
                  double *position, double *velocity)
{
    struct arena_mark mark = arena_mark(scratch);
    struct problem p = problem_take(m, s, scratch, NULL);
    real *g = TAKE(scratch, m->nrow, real), *rho = TAKE(scratch, m->nrow, real);
    /* Absolute numbers in the model's units. */
    loop_drift(p.d, p.q, p.u, g, rho);
    *position = *velocity = 0;
    for (int k = 0; k < m->nrow; k++) {
        double a = (double)real_fabs(g[k]), b = (double)real_fabs(rho[k]);
        *position = a > *position ? a : *position;
        *velocity = b > *velocity ? b : *velocity;
    }
    arena_release(scratch, mark);
}

/* One table a precision; dynamics_types.c has them side by side. */
#define dynamics_type_here REAL_NAME(dynamics_type)
extern const struct dynamics_type dynamics_type_here;
const struct dynamics_type dynamics_type_here = {
    .name = REAL_BITS == 32 ? "float" : REAL_BITS == 64 ? "double" : "quad",
    .epsilon = (double)REAL_EPSILON,
    .inverse = inverse,
    .inverse_part = inverse_part,
    .forward_part = forward_part,
    .hold = hold,
    .inverse_held = inverse_held,
    .forward = forward,
    .mass_matrix = mass_matrix,
    .wrenches = wrenches,
    .kinematics = kinematics,
    .totals = totals,
    .advance = advance,
    .drift = drift,
};
