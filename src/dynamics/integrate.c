/* integrate.c - fixed time steps. */
#include "dynamics/integrate.h"

#include "dynamics/loops.h"
#include "dynamics/work_count.h"

/* Forces that users give, springs on top. */
bool dynamics_forward(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                      struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    real *sum = TAKE(d->arena, d->nu, real);
    for (int k = 0; k < d->nu; k++) sum[k] = tau[k];
    /* Spring forces at the present state: explicit, however stiff. */
    springs_add(d, q, u, sum);
    work_count_springs(d, w);
    bool good = d->model->nloop > 0 ? closed_forward(d, q, u, sum, ud, NULL, NULL, w)
                                    : aba(d, q, u, sum, ud, w);
    arena_release(d->arena, mark);
    return good;
}

/* The accelerations persist between steps: kick-drift-kick begins where it ended. */
struct integrator integrator_make(struct dynamics *d, enum step_rule rule, real h, real *q, real *u,
                                  const real *tau)
{
    return (struct integrator){.d = d, .rule = rule, .h = h, .q = q, .u = u, .tau = tau,
                               .a = TAKE(d->arena, d->nu, real)};
}

/* One evaluation of the right-hand side, counted. */
static bool accelerate(struct integrator *it, const real *q, const real *u, real *a)
{
    it->evaluations++;
    return dynamics_forward(it->d, q, u, it->tau, a, &it->work);
}

/* q += h N u for every joint, on the group. */
static void drift(struct integrator *it)
{
    for (int i = 0; i < it->d->nbody; i++) {
        const struct body *b = &it->d->body[i];
        body_step(b, it->q + b->q_at, it->u + b->u_at, it->h);
        work_add(&it->work, &body_cost(b)->step);
    }
}

/* y = x + h k. */
static void combine(struct integrator *it, int n, const real *x, real h, const real *k, real *y)
{
    for (int i = 0; i < n; i++) y[i] = x[i] + h * k[i];
    it->work.flop += 2 * (uint64_t)n;
}

/* Order 1, symplectic: new rates move the coordinates (physics 9). */
static bool step_semi_implicit(struct integrator *it)
{
    if (!accelerate(it, it->q, it->u, it->a)) return false;
    /* u += h a, then q with the new u. */
    combine(it, it->d->nu, it->u, it->h, it->a, it->u);
    drift(it);
    return true;
}

/* Springs at the end of the step, to first order: stable however stiff (physics 9.0). */
static bool step_linearly_implicit(struct integrator *it)
{
    it->evaluations++;
    /* The linearised spring is in the tree's sweeps; loops have no such form here. */
    if (it->d->model->nloop > 0 ||
        !implicit_forward(it->d, it->h, it->q, it->u, it->tau, it->a, &it->work))
        return false;
    combine(it, it->d->nu, it->u, it->h, it->a, it->u);
    drift(it);
    return true;
}

/* Order 2, symmetric in time but for the predicted rates (physics 9). */
static bool step_kdk(struct integrator *it)
{
    int n = it->d->nu;
    const real half = (real)0.5 * it->h;
    /* The second kick of the last step left this acceleration: one evaluation a step. */
    if (!it->has_a && !accelerate(it, it->q, it->u, it->a)) return false;
    struct arena_mark mark = arena_mark(it->d->arena);
    real *predicted = TAKE(it->d->arena, n, real);
    combine(it, n, it->u, half, it->a, it->u);
    drift(it);
    /* Rates act on accelerations, too: a prediction of the full step's. */
    combine(it, n, it->u, half, it->a, predicted);
    it->work.flop++; /* half */
    bool good = accelerate(it, it->q, predicted, it->a);
    combine(it, n, it->u, half, it->a, it->u);
    it->has_a = true;
    arena_release(it->d->arena, mark);
    return good;
}

/* Derivative of the state: qd = N(q) u, a. */
static bool derive(struct integrator *it, const real *q, const real *u, real *qd, real *a)
{
    for (int i = 0; i < it->d->nbody; i++) {
        const struct body *b = &it->d->body[i];
        body_qdot(b, q + b->q_at, u + b->u_at, qd + b->q_at);
        work_add(&it->work, &body_cost(b)->qdot);
    }
    return accelerate(it, q, u, a);
}

/* Quaternions of all joints to length 1. */
static void normalise(struct integrator *it)
{
    /* Drift off the unit sphere is an error of fourth order; normalising it away keeps the
     * rotation. */
    for (int i = 0; i < it->d->nbody; i++) {
        const struct body *b = &it->d->body[i];
        const int quaternion = joint_quaternion(b->joint);
        if (quaternion < 0) continue;
        real *c = it->q + b->q_at + quaternion;
        real scale = 1 / real_sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
        for (int k = 0; k < 4; k++) c[k] *= scale;
        work_add(&it->work, &(struct work){.flop = 7 + 4, .div = 1, .sqrt = 1});
    }
}

/* Classical Runge-Kutta on plain numbers: order 4, no symmetry (physics 9). */
static bool step_rk4(struct integrator *it)
{
    const struct model *m = it->d->model;
    int nq = m->nq, nu = m->nu;
    struct arena_mark mark = arena_mark(it->d->arena);
    real *q = TAKE(it->d->arena, nq, real), *u = TAKE(it->d->arena, nu, real);
    real *kq = TAKE(it->d->arena, nq, real), *ku = TAKE(it->d->arena, nu, real);
    real *sq = TAKE(it->d->arena, nq, real), *su = TAKE(it->d->arena, nu, real);
    static const real at[4] = {0, (real)0.5, (real)0.5, 1}, weight[4] = {1, 2, 2, 1};
    bool good = true;
    /* Stage s starts from the derivatives of the stage before. */
    for (int s = 0; s < 4 && good; s++) {
        /* at[0] is 0: the first stage is the state itself. */
        const real h = at[s] * it->h;
        combine(it, nq, it->q, h, kq, q);
        combine(it, nu, it->u, h, ku, u);
        it->work.flop++;
        good = derive(it, q, u, kq, ku);
        combine(it, nq, sq, weight[s], kq, sq);
        combine(it, nu, su, weight[s], ku, su);
    }
    /* The weighted sum of the four, from the step's beginning. */
    const real sixth = it->h / 6;
    combine(it, nq, it->q, sixth, sq, it->q);
    combine(it, nu, it->u, sixth, su, it->u);
    it->work.div++;
    normalise(it);
    arena_release(it->d->arena, mark);
    return good;
}

/* One rule a step; changing it between steps is allowed. */
bool integrator_step(struct integrator *it)
{
    switch (it->rule) {
    case STEP_KDK: return step_kdk(it);
    case STEP_RK4: return step_rk4(it);
    case STEP_LINEARLY_IMPLICIT: return step_linearly_implicit(it);
    case STEP_SEMI_IMPLICIT: break;
    }
    return step_semi_implicit(it);
}
