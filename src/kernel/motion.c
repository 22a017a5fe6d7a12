/* motion.c - time steps of one rank's joints (motion.h).
 *
 *     semi-implicit Euler   order 1   1 evaluation a step      u += h u', then q += h N(q) u
 *     kick-drift-kick       order 2   1                        h/2 of u', h of q, h/2 of the new u'
 *     Runge-Kutta           order 4   4                        the classical scheme
 *     linearly implicit     order 1   1                        springs as at the step's end
 *
 * No message in here: a step is local, since each rank owns whole joints. physics 9 has errors and
 * limits of stability. */
#include "kernel/motion.h"

#include <math.h>

#include "kernel/dynamics_program.h"
#include "kernel/publish.h"
#include <string.h>

#include "model/model.h"

void motion_carve(struct motion *m, struct carve *c, const struct kernel_job *job, int nq, int nu)
{
    const struct kernel_spec *spec = &job->spec->kernel;
    /* Room only for what the scheme needs: a run without time steps, or with semi-implicit steps,
     * keeps no second copy of the state. */
    const bool rk4 = spec->steps > 0 && spec->step == STEP_RK4,
               kdk = spec->steps > 0 && spec->step == STEP_KDK;
    m->job = job;
    m->nq = nq, m->nu = nu;
    m->q0 = CARVE(c, rk4 ? nq : 0, real);
    m->dq = CARVE(c, rk4 ? nq : 0, real);
    m->qsum = CARVE(c, rk4 ? nq : 0, real);
    m->u0 = CARVE(c, rk4 || kdk ? nu : 0, real);
    m->usum = CARVE(c, rk4 ? nu : 0, real);
    m->a = CARVE(c, kdk ? nu : 0, real);
}

static const struct body *body_of(const struct motion *m, int l)
{
    return &m->body[m->bodies ? m->bodies[l] : m->first + l];
}

/* kick: u += h x. */
static void kick(struct motion *m, const real *x, real h)
{
    for (int i = 0; i < m->nu; i++) m->u[i] += h * x[i];
    m->work->flop += (uint64_t)(2 * m->nu);
}

/* drift: q moves for the time h at constant u; h = 0 normalises. Joint by joint along its group, so
 * that a quaternion stays a rotation (physics 9). */
static void drift(struct motion *m, real h)
{
    int q = 0, u = 0;
    for (int l = 0; l < m->n; l++) {
        const struct body *b = body_of(m, l);
        body_step(b, m->q + q, m->u + u, h);
        q += b->nq, u += b->d;
        work_add(m->work, &body_cost(b)->step);
    }
}

/* slope: dq = N(q) u (physics 1.3): quaternions as plain numbers, for the stages of Runge-Kutta. */
static void slope(struct motion *m)
{
    int q = 0, u = 0;
    for (int l = 0; l < m->n; l++) {
        const struct body *b = body_of(m, l);
        body_qdot(b, m->q + q, m->u + u, m->dq + q);
        q += b->nq, u += b->d;
        work_add(m->work, &body_cost(b)->qdot);
    }
}

/* physics 9: order 1. The new rates move the coordinates, which keeps the energy of an oscillation
 * bounded where explicit Euler makes it grow. */
static void semi_implicit(struct motion *m, real h)
{
    m->evaluate(m->program);
    kick(m, m->ud, h);
    drift(m, h);
}

/* kick_drift_kick: one evaluation a step, at rates predicted with the accelerations before (physics
 * 9). Order 2. */
static void kick_drift_kick(struct motion *m, real h, bool first)
{
    if (first) {
        m->evaluate(m->program);
        memcpy(m->a, m->ud, (size_t)m->nu * sizeof(real));
    }
    const real half = (real)0.5 * h;
    kick(m, m->a, half);
    drift(m, h);
    /* The second kick must start from the rates after the first one; the prediction serves the
     * evaluation only, because accelerations depend on rates. */
    memcpy(m->u0, m->u, (size_t)m->nu * sizeof(real));
    kick(m, m->a, half);
    m->evaluate(m->program);
    memcpy(m->a, m->ud, (size_t)m->nu * sizeof(real));
    memcpy(m->u, m->u0, (size_t)m->nu * sizeof(real));
    kick(m, m->a, half);
    m->work->flop++; /* half */
}

/* runge_kutta: the classical method of order four; y = y0 + h (k1 + 2 k2 + 2 k3 + k4) / 6.
 *
 * part[] is the step from y0 to the point of the next stage; the last one applies to the weighted
 * sum. */
static void runge_kutta(struct motion *m, real h)
{
    static const int weight[4] = {1, 2, 2, 1};
    const real half = (real)0.5 * h, part[4] = {half, half, h, h / 6};
    memcpy(m->q0, m->q, (size_t)m->nq * sizeof(real));
    memcpy(m->u0, m->u, (size_t)m->nu * sizeof(real));
    memset(m->qsum, 0, (size_t)m->nq * sizeof(real));
    memset(m->usum, 0, (size_t)m->nu * sizeof(real));
    for (int stage = 0; stage < 4; stage++) {
        m->evaluate(m->program);
        slope(m);
        for (int i = 0; i < m->nq; i++) m->qsum[i] += (real)weight[stage] * m->dq[i];
        for (int i = 0; i < m->nu; i++) m->usum[i] += (real)weight[stage] * m->ud[i];
        const real *dq = stage < 3 ? m->dq : m->qsum, *du = stage < 3 ? m->ud : m->usum;
        for (int i = 0; i < m->nq; i++) m->q[i] = m->q0[i] + part[stage] * dq[i];
        /* For each number: weight and add, scale and add. */
        for (int i = 0; i < m->nu; i++) m->u[i] = m->u0[i] + part[stage] * du[i];
        m->work->flop += (uint64_t)(4 * (m->nq + m->nu));
    }
    m->work->flop++; /* half */
    m->work->div++;  /* h / 6 */
    /* Stages leave quaternions slightly off the unit sphere; a drift for no time normalises
     * them. */
    drift(m, 0);
}

/* publish_state: own coordinates or rates, body by body in model order. */
static void publish_state(const struct motion *m, bool coordinates, const real *from, int output)
{
    int at = 0;
    for (int l = 0; l < m->n; l++) {
        const struct body *b = body_of(m, l);
        const int n = coordinates ? b->nq : b->d, first = coordinates ? b->q_at : b->u_at;
        publish_reals(m->comm, output, first, n, from + at);
        at += n;
    }
}

static void publish_seen(const struct motion *m)
{
    const int rank = comm_rank(m->comm);
    publish_number(m->comm, OUTPUT_RESIDUAL, rank, m->seen.residual);
    publish_number(m->comm, OUTPUT_RESIDUAL_SCALE, rank, m->seen.scale);
    publish_number(m->comm, OUTPUT_CONDITION, rank, m->seen.condition);
}

void motion_run(struct motion *m)
{
    const struct kernel_spec *spec = &m->job->spec->kernel;
    /* The model counts time in its own unit (seconds for machines, picoseconds for molecules). */
    const real h = (real)(spec->step_size / m->job->model->second);
    for (int k = 0; k < spec->steps; k++) {
        if (spec->step == STEP_RK4) runge_kutta(m, h);
        else if (spec->step == STEP_KDK) kick_drift_kick(m, h, k == 0);
        else semi_implicit(m, h);
    }
    if (spec->steps == 0) {
        m->evaluate(m->program);
    } else {
        publish_state(m, true, m->q, OUTPUT_Q_END);
        publish_state(m, false, m->u, OUTPUT_QD_END);
    }
    publish_seen(m);
}

void motion_watch(struct motion_seen *seen, real residual, real scale, real condition)
{
    const double size = (double)scale, violation = (double)residual * size;
    /* A comparison with "not a number" is false: such a condition replaces any other and then
     * stays. */
    if (!isnan(seen->condition) && !((double)condition <= seen->condition))
        seen->condition = (double)condition;
    if (isnan(seen->residual)) return;
    if (!seen->any) {
        *seen = (struct motion_seen){(double)residual, size, seen->condition, true};
        return;
    }
    /* Violations are compared as absolute sizes, and told relative to the largest scale seen: a
     * ratio from an evaluation at rest, where all terms are small, says nothing about the run. */
    const double before = seen->residual * seen->scale,
                 worst = violation <= before ? before : violation;
    seen->scale = fmax(seen->scale, size);
    seen->residual = seen->scale > 0 ? worst / seen->scale : (double)residual;
}
