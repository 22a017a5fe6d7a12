/* closed.c - forward dynamics of closed systems through articulated bodies: S = J M^-1 J^T column
 * by column. */
#include "dynamics/dynamics.h"
#include "dynamics/loops.h"
#include "linalg/least_norm.h"

/* d->load = the given loads (NULL: none), copied to `sum` for more to be added. Returns the array
 * to put back. Loop forces are loads of their bodies, so that open algorithms serve closed
 * systems. */
static real *with_loads(struct dynamics *d, const real *given, real *sum)
{
    real *before = d->load;
    for (int k = 0; k < 6 * d->nbody; k++) sum[k] = given ? given[k] : 0;
    d->load = sum;
    return before;
}

/* One pass: what the loops still lack at `ud`'s accelerations in d->a becomes more lambda. */
static bool correct(struct dynamics *d, const struct loops *l, const real *s, const real *reference,
                    real *lambda, int *rank, struct work *w)
{
    int m = l->nrow;
    real *copy = TAKE(d->arena, size_product(m, m), real), *r = TAKE(d->arena, m, real);
    real *room = TAKE(d->arena, size_product(m, m + 2), real);
    /* S lambda = -r in the least-norm sense: loops may be redundant (physics 7.4). */
    loops_residual(l, d->a, d->base, false, r, w);
    for (int k = 0; k < m * m; k++) copy[k] = s[k];
    for (int k = 0; k < m; k++) r[k] = -r[k];
    *rank = least_norm_solve(m, reference, copy, r, room, w);
    for (int k = 0; k < m; k++) lambda[k] += r[k];
    w->flop += (uint64_t)m;
    return true;
}

/* Largest |residual| over the largest acceleration of a body.
 * The same measure as the parallel programs report. */
static double worst_of(struct dynamics *d, const struct loops *l, const real *r)
{
    real worst = 0, scale = 0;
    for (int k = 0; k < l->nrow; k++) worst = real_fabs(r[k]) > worst ? real_fabs(r[k]) : worst;
    for (int k = 0; k < 6 * d->nbody; k++)
        scale = real_fabs(d->a[k]) > scale ? real_fabs(d->a[k]) : scale;
    return scale > 0 ? (double)(worst / scale) : 0;
}

/* Open system, S, then lambda twice: once to solve, once to remove rounding. */
bool closed_forward(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                    real *lambda, struct cfa_report *report, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct work own = {0};
    struct loops l;
    bool good = aba_full(d, q, u, tau, ud, &own);
    int rank = 0, m = d->model->nrow;
    real *given = d->load;
    loops_take(d, &l, &own);
    real *s = TAKE(d->arena, size_product(m, m), real);
    real *reference = TAKE(d->arena, m, real), *x = TAKE(d->arena, m, real);
    real *load = TAKE(d->arena, size_product(6, d->nbody), real),
         *first = TAKE(d->arena, d->nu, real);
    real *a = TAKE(d->arena, size_product(6, d->nbody), real);
    /* loops_respond overwrites the accelerations, whose residual is wanted first. */
    for (int k = 0; k < 6 * d->nbody; k++) a[k] = d->a[k];
    good = good && loops_respond(d, &l, first, 0, s, &own);
    loops_reference(d, &l, reference, &own);
    for (int k = 0; k < 6 * d->nbody; k++) d->a[k] = a[k];
    for (int pass = 0; pass < 2 && good; pass++) { /* the second removes what rounding left */
        correct(d, &l, s, reference, x, &rank, &own);
        with_loads(d, given, load);
        loops_force(&l, x, load, &own);
        good = aba_full(d, q, u, tau, ud, &own);
        d->load = given;
    }
    /* What is left over of the constraints, relative to the accelerations. */
    if (good && report) {
        loops_residual(&l, d->a, d->base, false, reference, &own);
        own.div++; /* of worst_of */
        *report =
            (struct cfa_report){.residual = worst_of(d, &l, reference), .rank = rank, .nrow = m};
    }
    for (int k = 0; k < m && lambda; k++) lambda[k] = x[k];
    arena_release(d->arena, mark);
    if (w) work_add(w, &own);
    return good;
}
