/* loop_project.c - mass-weighted projection of a state on its loops, physics 7.5. */
#include "dynamics/integrate.h"
#include "dynamics/loops.h"
#include "dynamics/work_count.h"
#include "linalg/least_norm.h"

/* delta (nu) = - M^-1 J^T S^+ x with x = g (position) or rho (velocity) at (q, u). */
static bool correction(struct dynamics *d, const real *q, const real *u, bool position, real *delta,
                       struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    int m = d->model->nrow, n = d->nu;
    struct loops l;
    /* Everything anew: the state has moved since the last step of Newton. */
    dynamics_place(d, q);
    dynamics_velocities(d, u);
    work_count_place(d, w);
    work_count_velocities(d, w);
    loops_take(d, &l, w);
    real *response = TAKE(d->arena, size_product(m, n), real),
         *s = TAKE(d->arena, size_product(m, m), real);
    real *x = TAKE(d->arena, m, real), *reference = TAKE(d->arena, m, real);
    real *room = TAKE(d->arena, size_product(m, m + 2), real);
    /* S and M^-1 J^T come from the same responses; M itself is never formed. */
    bool good = loops_respond(d, &l, response, (size_t)n, s, w);
    for (int k = 0; k < l.nloop; k++)
        for (int i = 0; i < l.pose[k].c; i++)
            x[l.loop[k].row_at + i] = position ? l.pose[k].g[i] : l.pose[k].rho[i];
    loops_reference(d, &l, reference, w);
    /* Redundant constraints are met together (physics 7.4). */
    least_norm_solve(m, reference, s, x, room, w);
    /* Weighted by M: of all corrections the one with the least kinetic energy (physics 7.5). */
    for (int i = 0; i < n; i++) {
        delta[i] = 0;
        for (int k = 0; k < m; k++) delta[i] -= response[(size_t)k * (size_t)n + (size_t)i] * x[k];
    }
    w->flop += 2 * (uint64_t)m * (uint64_t)n;
    arena_release(d->arena, mark);
    return good;
}

/* Newton's method on positions, then velocities, which are linear in u. */
bool loop_project(struct dynamics *d, real *q, real *u, int newton, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct work own = {0};
    real *delta = TAKE(d->arena, d->nu, real);
    bool good = true;
    /* Few are enough: near the loops each doubles the digits. */
    for (int k = 0; k < newton && good; k++) {
        good = correction(d, q, u, true, delta, &own);
        /* A correction is a motion: it moves along the group like a step of length 1. */
        for (int i = 0; i < d->nbody && good; i++)
            body_step(&d->body[i], q + d->body[i].q_at, delta + d->body[i].u_at, 1);
        for (int i = 0; i < d->nbody && good; i++) work_add(&own, &body_cost(&d->body[i])->step);
    }
    good = good && correction(d, q, u, false, delta, &own);
    for (int i = 0; i < d->nu && good; i++) u[i] += delta[i];
    if (good) own.flop += (uint64_t)d->nu;
    if (w) work_add(w, &own);
    arena_release(d->arena, mark);
    return good;
}
