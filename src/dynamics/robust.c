/* robust.c - forward dynamics as accurate as the precision gives, by two algorithms. */
#include "dynamics/dynamics.h"
#include "dynamics/refine.h"

enum { ROBUST_OUTER = 12 };

/* ud += M^-1 (tau - RNEA(ud)) by articulated bodies, while corrections shrink. */
static void refine(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                   struct cfa_report *report, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    real *rest = TAKE(d->arena, d->nu, real), *more = TAKE(d->arena, d->nu, real), *given = d->load;
    double before = 1;
    /* As outer refinement of the parallel programs (physics 8.6), with another solver. */
    for (int step = 0; step < ROBUST_OUTER; step++) {
        rnea_full(d, q, u, ud, rest, w);
        for (int k = 0; k < d->nu; k++) rest[k] = tau[k] - rest[k];
        /* The loads are in tau - RNEA already. */
        d->load = NULL;
        bool good = aba_response(d, rest, more, w);
        d->load = given;
        /* Corrections that shrink no more are rounding: the last good answer stays. */
        double size = relative_size(d->nu, more, ud);
        if (!good || !(size < before)) break;
        for (int k = 0; k < d->nu; k++) ud[k] += more[k];
        report->correction = before = size;
        report->outer_done = step + 1;
        if (size <= (double)REAL_EPSILON) break;
    }
    arena_release(d->arena, mark);
}

/* Constraint forces first, since their error shows; articulated bodies where they fail. */
bool forward_robust(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                    real *lambda, struct cfa_report *report, struct work *w)
{
    const struct cfa_options options = {.direct = true, .inner = 1, .outer = ROBUST_OUTER};
    struct cfa_report own;
    /* a last correction under this leaves rounding alone */
    const double enough = 1e6 * (double)REAL_EPSILON;
    bool good = cfa(d, q, u, tau, &options, ud, lambda, &own, w) && own.correction <= enough;
    if (!good) {
        /* Begin anew: what the first method left is worth nothing. */
        own = (struct cfa_report){.nrow = d->model->nrow};
        good = d->model->nloop > 0 ? closed_forward(d, q, u, tau, ud, lambda, &own, w)
                                   : aba_full(d, q, u, tau, ud, w);
        if (good && d->model->nloop == 0) refine(d, q, u, tau, ud, &own, w);
        own.fell_back = true;
    }
    if (report) *report = own;
    return good;
}
