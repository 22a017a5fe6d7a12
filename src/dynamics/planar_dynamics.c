/* planar_dynamics.c - Newton-Euler and articulated bodies with three components
 * (planar_dynamics.h).
 *
 * A body's velocity is its rate about the normal alone. Joint k's column of H is the normal or the
 * x axis, with a sign for flipped joints; what is about the joint is kept in these axes, so that no
 * column is ever multiplied. */
#include "dynamics/planar_dynamics.h"

#include <string.h>

#include "dynamics/planar_scene.h"

/* Everything of one call, from the caller's scratch. */
struct scene planar_scene_take(const struct model *m, const struct state *s, struct arena *scratch)
{
    struct scene x = {
        m, s, bodies_make(m, scratch), TAKE(scratch, m->nbody, struct moving), {0}, NULL, true};
    base_motion(m, s, x.base);
    return x;
}

/* x about the normal or across a flipped joint's x axis. */
static real turned(const struct body *b, real x) { return b->flipped ? -x : x; }

/* The joint's velocity (or acceleration) from its rates: about the normal and along x, y. Signs
 * cost nothing. */
void planar_joint_motion(const struct body *b, const double *u, real *h)
{
    screw_zero(h);
    switch (b->plane) {
    case PLANE_TURNS:
        h[0] = turned(b, (real)u[0]);
        break;
    case PLANE_SLIDES:
        h[1] = (real)u[0];
        break;
    case PLANE_MOVES:
        h[0] = turned(b, (real)u[0]), h[1] = (real)u[1], h[2] = turned(b, (real)u[2]);
        break;
    default:
        break;
    }
}

/* And back: y = H^T x. */
static void joint_part(const struct body *b, const real *x, double *y)
{
    switch (b->plane) {
    case PLANE_TURNS:
        y[0] = (double)turned(b, x[0]);
        break;
    case PLANE_SLIDES:
        y[0] = (double)x[1];
        break;
    case PLANE_MOVES:
        y[0] = (double)turned(b, x[0]), y[1] = (double)x[1], y[2] = (double)turned(b, x[2]);
        break;
    default:
        break;
    }
}

/* a += what planar_joint_motion found, d flops.
 * By kinds, so that zeros are not added. */
static void joint_add(const struct body *b, const real *h, real *a)
{
    if (b->plane == PLANE_MOVES) screw_add(a, h);
    else if (b->plane == PLANE_SLIDES) a[1] += h[1];
    else if (b->d > 0) a[0] += h[0];
}

static bool slides(const struct body *b)
{
    return b->plane == PLANE_SLIDES || b->plane == PLANE_MOVES;
}

/* Place, rate, and bias = the joint's acceleration by the parent's turning and its own sliding:
 * where the parent moves 1 flop, and 1, 2 and 6 for the centripetal part; 5 for slides. */
void planar_start(const struct scene *x, int i, struct work *w)
{
    const struct body *b = &x->body[i];
    struct moving *m = &x->moving[i];
    const struct xform *t = &m->pose.x;
    const real turning = b->parent < 0 ? 0 : x->moving[b->parent].w;
    real q[3] = {0}, h[SPACE];
    /* The model's doubles, rounded as everywhere in this precision. */
    for (int k = 0; k < b->nq; k++) q[k] = (real)x->state->q[b->q_at + k];
    body_place(b, q, &m->pose);
    screw_zero(m->bias);
    w->flop += (uint64_t)joint_cost_of(b->joint)->place;
    w->trig += (uint64_t)joint_cost_of(b->joint)->place_trig;
    w->call++;
    m->w = 0;
    if (x->state->at_rest) return;
    planar_joint_motion(b, x->state->qd + b->u_at, h);
    m->w = h[0];
    /* Centripetal acceleration of the joint by the parent's turning, in own axes. */
    if (b->parent >= 0) {
        const real square = turning * turning, px = -(square * t->p[0]), py = -(square * t->p[1]);
        m->w += turning;
        m->bias[1] = t->c * px + t->s * py;
        m->bias[2] = t->c * py - t->s * px;
        w->flop += 1 + 1 + 2 + 6;
    }
    if (!slides(b)) return;
    /* 2 w* + w_J: the parent's rate and the own one. */
    const real twice = turning + m->w;
    m->bias[1] -= twice * h[2];
    m->bias[2] += twice * h[1];
    w->flop += 5;
}

/* pull: f = P - Fext: centripetal force of the centre of mass, 3 flops, less the wrench, 15 + 3,
 * less the loops' forces; without the terms the last alone. */
static void pull(const struct scene *x, int i, struct work *w)
{
    const struct body *b = &x->body[i];
    struct moving *m = &x->moving[i];
    screw_zero(m->f);
    /* P of physics 1.5. */
    if (x->terms && !x->state->at_rest) {
        body_gyro(b, &m->w, m->f);
        w->flop += BODY_GYRO_FLOP;
    }
    if (x->load) {
        screw_sub(m->f, x->load + SPACE * i);
        w->flop += SCREW_ADD_FLOP;
    }
    /* A response to loop forces has no wrenches. */
    if (!x->terms || !x->state->fext) return;
    real load[SPACE];
    body_load(b, x->state->fext + 6 * i, load);
    screw_sub(m->f, load);
    w->flop += BODY_LOAD_FLOP + SCREW_ADD_FLOP;
}

/* physics (2.1) to (2.5) in three components. */
void planar_inverse(const struct model *model, const struct state *s, struct arena *scratch,
                    double *tau, struct work *w)
{
    struct arena_mark mark = arena_mark(scratch);
    const struct scene x = planar_scene_take(model, s, scratch);
    for (int i = 0; i < model->nbody; i++) {
        const struct body *b = &x.body[i];
        struct moving *m = &x.moving[i];
        real h[SPACE], moved[SPACE], inertial[SPACE];
        planar_start(&x, i, w);
        planar_joint_motion(b, s->qdd + b->u_at, h);
        /* (2.2): the parent's acceleration, b and H u'. */
        xform_motion(moved, &m->pose.x, b->parent < 0 ? x.base : x.moving[b->parent].a);
        screw_copy(m->a, moved);
        m->a[1] += m->bias[1], m->a[2] += m->bias[2];
        joint_add(b, h, m->a);
        pull(&x, i, w);
        body_force(b, m->a, inertial);
        screw_add(m->f, inertial);
        /* the bias has no part about the normal, and a joint's columns are unit vectors */
        w->flop += (uint64_t)(XFORM_MOTION_FLOP + 2 + b->d + BODY_FORCE_FLOP + SCREW_ADD_FLOP);
    }
    for (int i = model->nbody - 1; i >= 0; i--) {
        const struct body *b = &x.body[i];
        real moved[SPACE];
        /* (2.5), then (2.4): all children have added their forces by now. */
        joint_part(b, x.moving[i].f, tau + b->u_at);
        if (b->parent < 0) continue;
        xform_force(moved, &x.moving[i].pose.x, x.moving[i].f);
        screw_add(x.moving[b->parent].f, moved);
        w->flop += XFORM_FORCE_FLOP + SCREW_ADD_FLOP;
    }
    arena_release(scratch, mark);
}

/* y = S x; 15 flops.
 * S by its six numbers, in the order of struct moving. */
static void symmetric_multiply(const real *s, const real *x, real *y)
{
    y[0] = s[0] * x[0] + s[1] * x[1] + s[2] * x[2];
    y[1] = s[1] * x[0] + s[3] * x[1] + s[4] * x[2];
    y[2] = s[2] * x[0] + s[4] * x[1] + s[5] * x[2];
}

/* into += X S X^T. Rotating the linear block: C - t [s, -c; -c, -s]-wise with t = s (xx - yy) + 2 c
 * xy, 10 flops; the mixed part, 6; shifting by (-py, px), 8 + 6; adding, 6. `bare`: S has a linear
 * block alone: 10 + 6 + 3 + 6. */
static void hand_inertia(const struct xform *x, const real *s, bool bare, real *into,
                         struct work *w)
{
    /* With xx - (s t) and yy + (s t) the trace stays as it was: 10 flops, where r C r^T takes
     * 21. */
    const real t = x->s * (s[3] - s[5]) + (x->c + x->c) * s[4];
    const real st = x->s * t, xx = s[3] - st, yy = s[5] + st, xy = x->c * t - s[4], jx = -x->p[1],
               jy = x->p[0];
    real shifted_x = xx * jx + xy * jy, shifted_y = xy * jx + yy * jy;
    /* Eliminating a turn empties the row of the normal: no moment, no mixed part. */
    if (bare) {
        into[0] += jx * shifted_x + jy * shifted_y;
    } else {
        const real bx = x->c * s[1] - x->s * s[2], by = x->s * s[1] + x->c * s[2];
        shifted_x = bx + shifted_x, shifted_y = by + shifted_y;
        into[0] += s[0] + (jx * (bx + shifted_x) + jy * (by + shifted_y));
    }
    into[1] += shifted_x;
    into[2] += shifted_y;
    into[3] += xx;
    into[4] += xy;
    into[5] += yy;
    w->flop += bare ? 10 + 6 + 3 + 6 : 10 + 6 + 8 + 6 + 6;
}

/* The body's own inertia.
 * physics 1.5 about the body's origin. */
static void rigid(const struct body *b, real *s)
{
    s[0] = b->jo;
    s[1] = -b->ms[1];
    s[2] = b->ms[0];
    s[3] = s[5] = b->m;
    s[4] = 0;
}

/* Joint of one degree of freedom along axis k: what is left of the inertia and of the bias force
 * when it gives way. False: nothing resists there. */
static bool give_way(struct moving *m, int k, real tau, real *left, struct work *w)
{
    static const signed char row[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}},
                             others[2][2] = {{1, 2}, {0, 2}};
    const real *s = m->inertia, d = s[row[k][k]];
    /* The two components that stay. */
    const int i = others[k][0], j = others[k][1];
    if (!(d > 0)) return false;
    /* physics (2.6) for one column: D is a number. */
    m->per = 1 / d;
    m->rest = tau - m->f[k];
    const real gi = s[row[i][k]] * m->per, gj = s[row[j][k]] * m->per;
    for (int n = 0; n < 6; n++) left[n] = 0;
    left[row[i][i]] = s[row[i][i]] - gi * s[row[i][k]];
    left[row[i][j]] = s[row[i][j]] - gi * s[row[j][k]];
    left[row[j][j]] = s[row[j][j]] - gj * s[row[j][k]];
    /* p + S' b + g rest; along the joint the joint force itself */
    const real bi = m->bias[i], bj = m->bias[j];
    m->f[i] += (left[row[i][i]] * bi + left[row[i][j]] * bj) + gi * m->rest;
    m->f[j] += (left[row[i][j]] * bi + left[row[j][j]] * bj) + gj * m->rest;
    m->f[k] = tau;
    w->div += 1;
    w->flop += 1 + 2 + 6 + 12;
    return true;
}

/* articulate: body i gives way along its joint and hands the rest to its parent. On a joint of
 * three degrees of freedom nothing is left but the joint force, and the way back needs the bias
 * force as it was. */
static bool articulate(const struct scene *x, int i, const double *tau, struct work *w)
{
    const struct body *b = &x->body[i];
    struct moving *m = &x->moving[i], *parent = b->parent < 0 ? NULL : &x->moving[b->parent];
    real left[6], moved[SPACE], force[SPACE], shifted[SPACE];
    planar_joint_motion(b, tau, force);
    switch (b->plane) {
    case PLANE_TURNS:
        if (!give_way(m, 0, force[0], left, w)) return false;
        break;
    case PLANE_SLIDES:
        if (!give_way(m, 1, force[1], left, w)) return false;
        break;
    case PLANE_MOVES:
        break;
    default:
        /* A fixed joint does not give way: I_a = I_A and p_a = p + I_a b of (2.6). */
        for (int k = 0; k < 6; k++) left[k] = m->inertia[k];
        symmetric_multiply(left, m->bias, shifted);
        screw_add(m->f, shifted);
        w->flop += 15 + SCREW_ADD_FLOP;
    }
    /* Nobody asks for what reaches the base. */
    if (!parent) return true;
    if (b->plane != PLANE_MOVES)
        hand_inertia(&m->pose.x, left, b->plane == PLANE_TURNS, parent->inertia, w);
    xform_force(moved, &m->pose.x, b->plane == PLANE_MOVES ? force : m->f);
    screw_add(parent->f, moved);
    w->flop += XFORM_FORCE_FLOP + SCREW_ADD_FLOP;
    return true;
}

/* y = S^-1 x by elimination in order; 25 flops, 3 divisions. False: not positive definite. */
static bool symmetric_solve(const real *s, const real *x, real *y, struct work *w)
{
    /* L D L^T of a 3x3, written out. */
    if (!(s[0] > 0)) return false;
    const real d0 = 1 / s[0], l1 = s[1] * d0, l2 = s[2] * d0, m11 = s[3] - l1 * s[1],
               m21 = s[4] - l2 * s[1];
    if (!(m11 > 0)) return false;
    const real d1 = 1 / m11, l21 = m21 * d1, m22 = s[5] - l2 * s[2] - l21 * m21;
    if (!(m22 > 0)) return false;
    const real y1 = x[1] - l1 * x[0], y2 = x[2] - l2 * x[0] - l21 * y1;
    y[2] = y2 / m22;
    y[1] = y1 * d1 - l21 * y[2];
    y[0] = x[0] * d0 - l1 * y[1] - l2 * y[2];
    w->div += 3;
    w->flop += 11 + 6 + 8;
    return true;
}

/* accelerate: body i from its parent. */
static bool accelerate(const struct scene *x, int i, const double *tau, double *ud, struct work *w)
{
    static const signed char row[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    const struct body *b = &x->body[i];
    struct moving *m = &x->moving[i];
    real carried[SPACE], force[SPACE];
    xform_motion(carried, &m->pose.x, b->parent < 0 ? x->base : x->moving[b->parent].a);
    carried[1] += m->bias[1], carried[2] += m->bias[2];
    screw_copy(m->a, carried);
    w->flop += XFORM_MOTION_FLOP + 2;
    /* Three degrees of freedom: the joint force alone decides. */
    if (b->plane == PLANE_MOVES) {
        real own[SPACE];
        planar_joint_motion(b, tau, force);
        screw_sub(force, m->f);
        if (!symmetric_solve(m->inertia, force, own, w)) return false;
        screw_sub(own, carried);
        joint_part(b, own, ud);
        screw_add(m->a, own);
        w->flop += 3 * SCREW_ADD_FLOP;
    } else if (b->d == 1) {
        const int k = b->plane == PLANE_TURNS ? 0 : 1;
        /* (2.7): u' = D^-1 (e - Q^T a). `inertia` is still I_A, and Q its row k. */
        real along = m->inertia[row[k][0]] * carried[0], y[SPACE] = {0};
        for (int j = 1; j < 3; j++) along += m->inertia[row[k][j]] * carried[j];
        y[k] = m->per * (m->rest - along);
        joint_part(b, y, ud);
        m->a[k] += y[k];
        w->flop += 5 + 2 + 1;
    }
    return true;
}

/* planar_open_forward: accelerations of the scene cut open, with x's loads and terms; the bodies
 * have been started. */
bool planar_open_forward(const struct scene *x, const double *tau, double *ud, struct work *w)
{
    bool good = true;
    /* Each body alone; then inertias and bias forces tip to base, accelerations base to tip. */
    for (int i = 0; i < x->model->nbody; i++) {
        pull(x, i, w);
        rigid(&x->body[i], x->moving[i].inertia);
    }
    for (int i = x->model->nbody - 1; i >= 0 && good; i--)
        good = articulate(x, i, tau + x->body[i].u_at, w);
    for (int i = 0; i < x->model->nbody && good; i++)
        good = accelerate(x, i, tau + x->body[i].u_at, ud + x->body[i].u_at, w);
    return good;
}
