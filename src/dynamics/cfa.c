/* cfa.c - the constraint force algorithm, serial, in the paper's and the direct formulation;
 * physics 4, 7, 8.6.
 *
 * One routine does all of it: from the joint and loop forces known so far, accelerations of the
 * bodies taken as free, Y = Phi (P F + loops - P_gyro + load); what these violate, W^T Z and the
 * loops' residual, is answered by more constraint force through the factored system. The first pass
 * is the solution, each further one a refinement. */
#include "dynamics/cfa_system.h"
#include "dynamics/dynamics.h"
#include "dynamics/loops.h"
#include "dynamics/refine.h"
#include "dynamics/work_count.h"
#include "linalg/least_norm.h"

struct cfa_run {
    struct dynamics *d;
    struct cfa_system system;
    struct loops loops;
    real *f;          /* (nbody x 6) joint forces, active and constraint */
    real *lambda;     /* (nrow) */
    real *y;          /* (nbody x 6) accelerations of the bodies under f and lambda */
    real *z;          /* (nbody x 6) W^T Z in the first c of each body */
    real *gyro;       /* (nbody x 6) velocity forces minus loads */
    real *bias;       /* (nu) paper's scheme: joint forces of inverse dynamics at u' = 0 */
    /* with velocity terms, loads and the base's acceleration; false: the response to forces alone
     * */
    bool full;
    /* loops */
    real *response;   /* (nrow x nbody x 6) joint constraint forces answering each unit lambda */
    real *s, *reference;
    int rank;
    struct work work;
};

/* What a body's velocity and load do, where there are such terms at all. */
static bool has_velocities(const struct cfa_run *r) { return r->full && !r->d->at_rest; }
static bool has_gyro(const struct cfa_run *r) { return r->full && (!r->d->at_rest || r->d->load); }

/* y = accelerations of all bodies under r->f and r->lambda. */
static void accelerations(struct cfa_run *r)
{
    struct dynamics *d = r->d;
    struct arena_mark mark = arena_mark(d->arena);
    real *net = TAKE(d->arena, size_product(6, d->nbody), real), t[6];
    for (int i = 0; i < d->nbody; i++) {
        /* Action and reaction: a joint's force on its body, and moved to the parent, against
         * it. */
        screw_copy(net + 6 * i, r->f + 6 * i);
        if (has_gyro(r)) screw_sub(net + 6 * i, r->gyro + 6 * i);
        if (d->body[i].parent < 0) continue;
        xform_force(t, &d->pose[i].x, r->f + 6 * i);
        screw_sub(net + 6 * d->body[i].parent, t);
        r->work.flop += XFORM_FORCE_FLOP + SCREW_ADD_FLOP;
    }
    /* Loop forces are known numbers here; border and answer_loops find them. */
    loops_force(&r->loops, r->lambda, net, &r->work);
    /* Y of (4.8): one product with Phi a body; D is never multiplied out. */
    for (int i = 0; i < d->nbody; i++) body_accelerate(&d->body[i], net + 6 * i, r->y + 6 * i);
    arena_release(d->arena, mark);
    r->work.flop +=
        (uint64_t)d->nbody * (BODY_ACCELERATE_FLOP + (has_gyro(r) ? SCREW_ADD_FLOP : 0));
}

/* Z_i = Y_i - X^T Y_p - b_i. */
static void relative( struct cfa_run *r, int i, real *z)
{
    static const real still[6] = {0};
    struct dynamics *d = r->d;
    int parent = d->body[i].parent;
    /* Z of (4.8): what the joint would have to allow for the two bodies to stay together. */
    xform_motion(z, &d->pose[i].x, parent >= 0 ? r->y + 6 * parent : r->full ? d->base : still);
    for (int k = 0; k < 6; k++) z[k] = r->y[6 * i + k] - z[k];
    if (has_velocities(r)) screw_sub(z, d->bias + 6 * i);
    r->work.flop += XFORM_MOTION_FLOP + SCREW_ADD_FLOP + (has_velocities(r) ? SCREW_ADD_FLOP : 0);
}

/* z = W^T Z of all joints.
 * Zero when every joint holds: W spans what it must not allow. */
static void violations(struct cfa_run *r)
{
    struct dynamics *d = r->d;
    for (int i = 0; i < d->nbody; i++) {
        real z[6];
        relative(r, i, z);
        subspace_w_transposed(&d->pose[i].s, z, r->z + 6 * i);
        r->work.flop += (uint64_t)body_cost(&d->body[i])->w_transposed;
    }
}

/* f += constraint forces that remove z. */
static void answer_joints(struct cfa_run *r)
{
    struct dynamics *d = r->d;
    struct arena_mark mark = arena_mark(d->arena);
    real *x = TAKE(d->arena, size_product(6, d->nbody), real);
    /* A x = -z, as (4.6): A is what constraint forces do to free bodies, seen by the joints. */
    for (int k = 0; k < 6 * d->nbody; k++) r->z[k] = -r->z[k];
    cfa_solve(d, &r->system, r->z, x, &r->work);
    for (int k = 0; k < 6 * d->nbody; k++) r->f[k] += x[k];
    arena_release(d->arena, mark);
    r->work.flop += (uint64_t)d->nbody * SCREW_ADD_FLOP;
}

/* Responses to unit loop forces and S = A_ll - A_tl^T A^-1 A_tl; f, lambda, full are used and
 * restored. */
static void border(struct cfa_run *r)
{
    struct dynamics *d = r->d;
    int m = r->loops.nrow, size = 6 * d->nbody;
    real *f = r->f, *lambda = r->lambda, *column = TAKE(d->arena, m, real);
    bool full = r->full;
    /* (7.5), one solution of the open system a column, without velocity terms: pure responses.
     * Once an evaluation, whatever the passes. */
    r->full = false;
    r->lambda = TAKE(d->arena, m, real);
    for (int k = 0; k < m; k++) {
        r->f = r->response + (size_t)k * (size_t)size;
        for (int i = 0; i < m; i++) r->lambda[i] = i == k;
        /* The second pass is a refinement: S is used for every solution. */
        for (int pass = 0; pass < 2; pass++) {
            accelerations(r);
            violations(r);
            answer_joints(r);
        }
        accelerations(r);
        loops_residual(&r->loops, r->y, NULL, true, column, &r->work);
        for (int i = 0; i < m; i++) r->s[i * m + k] = column[i];
    }
    for (int i = 0; i < m; i++)
        for (int k = 0; k < i; k++)
            r->s[i * m + k] = r->s[k * m + i] = (real)0.5 * (r->s[i * m + k] + r->s[k * m + i]);
    r->work.flop += (uint64_t)(m * (m - 1));
    /* Back to the forces of the caller. */
    r->f = f;
    r->lambda = lambda;
    r->full = full;
    loops_reference(d, &r->loops, r->reference, &r->work);
}

/* lambda and f += what removes the loops' residual; `residual` (nrow) is destroyed. */
static void answer_loops(struct cfa_run *r, real *residual)
{
    struct dynamics *d = r->d;
    int m = r->loops.nrow, size = 6 * d->nbody;
    struct arena_mark mark = arena_mark(d->arena);
    real *s = TAKE(d->arena, size_product(m, m), real),
         *room = TAKE(d->arena, size_product(m, m + 2), real);
    for (int k = 0; k < m * m; k++) s[k] = r->s[k];
    for (int k = 0; k < m; k++) residual[k] = -residual[k];
    /* Redundant loops leave lambda open, not u' (physics 7.4). */
    r->rank = least_norm_solve(m, r->reference, s, residual, room, &r->work);
    for (int k = 0; k < m; k++) {
        r->lambda[k] += residual[k];
        for (int j = 0; j < size; j++)
            r->f[j] += residual[k] * r->response[(size_t)k * (size_t)size + (size_t)j];
    }
    arena_release(d->arena, mark);
    r->work.flop += (uint64_t)m * (uint64_t)(1 + 2 * size);
}

/* One pass of the method. `wanted`: (nrow) homogeneous runs: the residual to reach; NULL: the
 * loops' own. */
static void pass(struct cfa_run *r, const real *wanted)
{
    struct dynamics *d = r->d;
    int m = r->loops.nrow;
    accelerations(r);
    violations(r);
    answer_joints(r);
    /* Open systems are done. */
    if (m == 0) return;
    struct arena_mark mark = arena_mark(d->arena);
    real *residual = TAKE(d->arena, m, real);
    accelerations(r);
    loops_residual(&r->loops, r->y, r->full ? d->base : NULL, !r->full, residual, &r->work);
    for (int k = 0; k < m && wanted; k++) residual[k] -= wanted[k];
    if (wanted) r->work.flop += (uint64_t)m;
    answer_loops(r, residual);
    arena_release(d->arena, mark);
}

/* f = H tau, lambda = 0, then 1 + inner passes; ud = H^T Z. */
static void solve(struct cfa_run *r, const real *tau, const real *wanted, int inner, real *ud)
{
    struct dynamics *d = r->d;
    for (int k = 0; k < 6 * d->nbody; k++) r->f[k] = 0;
    for (int k = 0; k < r->loops.nrow; k++) r->lambda[k] = 0;
    for (int i = 0; i < d->nbody; i++)
        subspace_h(&d->pose[i].s, tau + d->body[i].u_at, r->f + 6 * i);
    /* The first pass solves, the others refine (physics 8.6). */
    for (int k = 0; k <= inner; k++) pass(r, wanted);
    accelerations(r);
    for (int i = 0; i < d->nbody; i++) {
        real z[6];
        relative(r, i, z);
        subspace_h_transposed(&d->pose[i].s, z, ud + d->body[i].u_at);
        r->work.flop +=
            (uint64_t)(body_cost(&d->body[i])->h + body_cost(&d->body[i])->h_transposed);
    }
}

/* more, r->lambda = response to tau + J^T lambda - RNEA(ud): how far ud is from the truth. */
static void correction(struct cfa_run *r, const real *q, const real *u, const real *tau, int inner,
                       const real *ud, const real *lambda, real *more)
{
    struct dynamics *d = r->d;
    struct arena_mark mark = arena_mark(d->arena);
    int m = r->loops.nrow, size = 6 * d->nbody;
    real *rest = TAKE(d->arena, d->nu, real), *given = d->load;
    real *lack = TAKE(d->arena, m, real), *load = TAKE(d->arena, size, real);
    for (int k = 0; k < size; k++) load[k] = given ? given[k] : 0;
    loops_force(&r->loops, lambda, load, &r->work);
    /* The closed system's inverse dynamics, with the loops' forces as loads. */
    d->load = load;
    rnea_full(d, q, u, ud, rest, &r->work);
    d->load = given;
    for (int k = 0; k < d->nu; k++) rest[k] = tau[k] - rest[k];
    r->work.flop += (uint64_t)d->nu;
    loops_residual(&r->loops, d->a, d->base, false, lack, &r->work);
    for (int k = 0; k < m; k++) lack[k] = -lack[k];
    r->full = false;
    solve(r, rest, lack, inner, more);
    arena_release(d->arena, mark);
}

/* Outer refinement while corrections shrink; one that does not is left out. */
static void refine_outer(struct cfa_run *r, const real *q, const real *u, const real *tau,
                         const struct cfa_options *options, real *ud, real *lambda,
                         struct cfa_report *report)
{
    struct dynamics *d = r->d;
    struct arena_mark mark = arena_mark(d->arena);
    real *more = TAKE(d->arena, d->nu, real);
    double before = 1;
    for (int step = 0; step < options->outer; step++) {
        correction(r, q, u, tau, options->inner, ud, lambda, more);
        double size = relative_size(d->nu, more, ud);
        /* Not smaller than the one before: rounding has the last word. */
        if (!(size < before)) {
            if (step == 0) report->correction = size;
            break;
        }
        for (int k = 0; k < d->nu; k++) ud[k] += more[k];
        for (int k = 0; k < r->loops.nrow; k++) lambda[k] += r->lambda[k];
        r->work.flop += (uint64_t)(d->nu + r->loops.nrow);
        report->correction = before = size;
        report->outer_done = step + 1;
        /* Below one unit in the last place nothing is left to correct. */
        if (size <= (double)REAL_EPSILON) break;
    }
    arena_release(d->arena, mark);
}

/* The velocity terms of all bodies.
 * Once an evaluation; refinements have no velocity terms. */
static void velocity_terms(struct cfa_run *r, const real *u)
{
    struct dynamics *d = r->d;
    dynamics_velocities(d, u);
    work_count_velocities(d, &r->work);
    for (int i = 0; i < d->nbody; i++) {
        if (!d->at_rest) body_gyro(&d->body[i], d->v + 6 * i, r->gyro + 6 * i);
        if (d->load) screw_sub(r->gyro + 6 * i, d->load + 6 * i);
    }
    r->work.flop += (uint64_t)d->nbody * ((d->at_rest ? 0 : BODY_GYRO_FLOP) + (d->load ? 6 : 0));
}

/* Memory, poses, velocities, factors. The paper's scheme has its velocity terms from inverse
 * dynamics: bias forces in r->bias (nu). */
static bool prepare(struct cfa_run *r, struct dynamics *d, bool direct, const real *q,
                    const real *u)
{
    int n = d->nbody, m = d->model->nrow;
    r->d = d;
    r->f = TAKE(d->arena, size_product(6, n), real);
    r->y = TAKE(d->arena, size_product(6, n), real);
    r->z = TAKE(d->arena, size_product(6, n), real);
    r->gyro = TAKE(d->arena, size_product(6, n), real);
    r->bias = TAKE(d->arena, d->nu, real);
    /* Inverse dynamics places the bodies itself. */
    if (direct) {
        dynamics_place(d, q);
        work_count_place(d, &r->work);
    } else {
        rnea_full(d, q, u, d->zero, r->bias, &r->work);
    }
    /* Inverse dynamics leaves angular velocities alone; loops need linear ones, too (7.1). */
    if (direct || m > 0) velocity_terms(r, u);
    if (!cfa_factor(d, &r->system, &r->work)) return false;
    loops_take(d, &r->loops, &r->work);
    r->lambda = TAKE(d->arena, m, real);
    /* Room for S and the responses only where there are loops. */
    if (m == 0) return true;
    r->response = TAKE(d->arena, size_product(m, size_product(6, n)), real);
    r->s = TAKE(d->arena, size_product(m, m), real);
    r->reference = TAKE(d->arena, m, real);
    border(r);
    return true;
}

/* (4.3), (4.4): the response of the system at rest to what the bias forces leave of tau. The bias
 * forces grow along the chain, and with them their rounding (physics 8.2). */
static void solve_paper(struct cfa_run *r, const real *tau, int inner, real *ud)
{
    struct dynamics *d = r->d;
    struct arena_mark mark = arena_mark(d->arena);
    real *lack = TAKE(d->arena, r->loops.nrow, real);
    for (int k = 0; k < d->nu; k++) r->bias[k] = tau[k] - r->bias[k];
    r->work.flop += (uint64_t)d->nu;
    loops_residual(&r->loops, d->a, d->base, false, lack, &r->work);
    for (int k = 0; k < r->loops.nrow; k++) lack[k] = -lack[k];
    r->full = false;
    solve(r, r->bias, lack, inner, ud);
    arena_release(d->arena, mark);
}

/* Largest violation of a joint over the largest acceleration.
 * W^T Z in the operator form: it does not share rounding errors with the factors. */
static double residual_of(struct cfa_run *r)
{
    real worst = 0, scale = 0;
    violations(r);
    for (int i = 0; i < r->d->nbody; i++) {
        for (int k = 0; k < r->d->pose[i].s.c; k++)
            worst = real_fabs(r->z[6 * i + k]) > worst ? real_fabs(r->z[6 * i + k]) : worst;
        for (int k = 0; k < 6; k++)
            scale = real_fabs(r->y[6 * i + k]) > scale ? real_fabs(r->y[6 * i + k]) : scale;
    }
    r->work.div += scale > 0;
    return scale > 0 ? (double)(worst / scale) : 0;
}

/* Solution, residual, refinement; massless bodies are refused, since they have no Phi. */
bool cfa(struct dynamics *d, const real *q, const real *u, const real *tau,
         const struct cfa_options *options, real *ud, real *lambda, struct cfa_report *report,
         struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct cfa_run r = {.full = true};
    struct cfa_report own = {.nrow = d->model->nrow};
    bool good = d->model->has_phi && prepare(&r, d, options->direct, q, u);
    if (good) {
        /* The two formulations solve the same system from different right-hand sides (physics
         * 4.2, 4.3). */
        if (options->direct)
            solve(&r, tau, NULL, options->inner, ud);
        else
            solve_paper(&r, tau, options->inner, ud);
        if (report) own.residual = residual_of(&r);
        own.inner_done = options->inner;
        real *sum = TAKE(d->arena, r.loops.nrow, real);
        for (int k = 0; k < r.loops.nrow; k++) sum[k] = r.lambda[k];
        /* Refinements change r.lambda: the sum is kept apart. */
        refine_outer(&r, q, u, tau, options, ud, sum, &own);
        for (int k = 0; k < r.loops.nrow && lambda; k++) lambda[k] = sum[k];
        own.rank = r.rank;
    }
    arena_release(d->arena, mark);
    if (report) *report = own;
    if (w) work_add(w, &r.work);
    return good;
}
