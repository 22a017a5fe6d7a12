/* implicit.c - accelerations under linearly implicit joint springs, (M + s) u' = tau_0 - xi,
 * physics (9.0).
 *
 * Articulated bodies with the resistance s in the pivot of each joint. What a joint passes on keeps
 * a part along H, unlike in aba.c: with Y = (H^T I H + s)^-1 (I H)^T, I^a = I - I H Y. */
#include "dynamics/dynamics.h"
#include "dynamics/integrate.h"
#include "dynamics/spring.h"
#include "dynamics/work_count.h"
#include "linalg/dense.h"

/* As struct articulated in aba.c, in body axes throughout. */
struct resisting {
    struct sym6 inertia;
    real p[6];   /* bias force, body axes */
    real y[36];  /* (d x 6) */
    real x[6];   /* (d) (H^T I H + s)^-1 (tau - H^T p) */
};

/* inertia -= u y^T for a product that is symmetric once all columns are subtracted. */
enum { LOWER_FLOP = 42 };
static void lower(struct sym6 *inertia, const real *u, const real *y)
{
    /* Blocks of struct sym6: a and c symmetric, b full. */
    static const signed char row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int e = 0; e < 6; e++) {
        inertia->a[e] -= u[row[e]] * y[column[e]];
        inertia->c[e] -= u[3 + row[e]] * y[3 + column[e]];
    }
    for (int e = 0; e < 9; e++) inertia->b[e] -= u[e / 3] * y[3 + e % 3];
}

/* Eliminate the joint of b; ia, pa: what its parent gets, body axes. */
static bool eliminate(const struct subspace *s, const real *bias, const real *tau,
                      const real *resistance, struct resisting *b, struct sym6 *ia, real *pa,
                      struct work *w)
{
    real h[36], u[36], g[21], t[6];
    struct work small = {0}; /* its calls are part of the body's one */
    *ia = b->inertia;
    screw_copy(pa, b->p);
    /* Q, D and e of (2.6), where D carries the resistance s of (9.0) on its diagonal. */
    for (int k = 0; k < s->d; k++) {
        subspace_column(s, k, h + 6 * k);
        sym6_mul(u + 6 * k, &b->inertia, h + 6 * k);
        for (int j = 0; j <= k; j++) g[packed_index(k, j)] = screw_dot(h + 6 * j, u + 6 * k);
        g[packed_index(k, k)] += resistance[k];
        b->x[k] = tau[k] - screw_dot(h + 6 * k, b->p);
        screw_copy(b->y + 6 * k, u + 6 * k);
        w->flop += (uint64_t)(SYM6_MUL_FLOP + SCREW_DOT_FLOP * (k + 1) + 1 + SCREW_DOT_FLOP + 1);
    }
    /* One factor of D for both right-hand sides: x = D^-1 e and Y = D^-1 Q^T. */
    if (s->d > 0 && !dense_factor(s->d, g, g, &small)) return false;
    if (s->d > 0) dense_solve(s->d, 1, g, b->x, &small);
    if (s->d > 0) dense_solve(s->d, 6, g, b->y, &small);
    for (int k = 0; k < s->d; k++) {
        /* I_a = I - Q Y and p_a = p + Q x + I_a b of (2.6). */
        lower(ia, u + 6 * k, b->y + 6 * k);
        for (int i = 0; i < 6; i++) pa[i] += u[6 * k + i] * b->x[k];
        w->flop += LOWER_FLOP + SCREW_AXPY_FLOP;
    }
    /* b meets what is left of the inertia, so it comes last. */
    sym6_mul(t, ia, bias);
    screw_add(pa, t);
    w->flop += small.flop + SYM6_MUL_FLOP + SCREW_ADD_FLOP;
    w->div += small.div;
    return true;
}

/* (2.7): with Y and x kept, u' is one dot product a freedom. */
static void accelerate(struct dynamics *d, int i, const struct resisting *b, real *ud,
                       struct work *w)
{
    const struct subspace *s = &d->pose[i].s;
    const int parent = d->body[i].parent;
    real *a = d->a + 6 * i;
    xform_motion(a, &d->pose[i].x, parent >= 0 ? d->a + 6 * parent : d->base);
    screw_add(a, d->bias + 6 * i);
    for (int k = 0; k < s->d; k++) ud[k] = b->x[k] - screw_dot(b->y + 6 * k, a);
    subspace_h(s, ud, a);
    w->flop += (uint64_t)(XFORM_MOTION_FLOP + SCREW_ADD_FLOP + s->d * (SCREW_DOT_FLOP + 1) +
                          body_cost(&d->body[i])->h);
}

/* As aba_full, with a resistance in the pivots of sprung joints. */
bool implicit_forward(struct dynamics *d, real h, const real *q, const real *u, const real *tau,
                      real *ud, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct resisting *b = TAKE(d->arena, d->nbody, struct resisting);
    real *given = TAKE(d->arena, d->nu, real), *resistance = TAKE(d->arena, d->nu + 6, real);
    struct work own = {0};
    bool good = true;
    /* tau_0: given forces and springs as they are now. */
    for (int k = 0; k < d->nu; k++) given[k] = tau[k];
    springs_add(d, q, u, given);
    dynamics_place(d, q);
    dynamics_velocities(d, u);
    work_count_place(d, &own);
    work_count_velocities(d, &own);
    work_count_springs(d, &own);
    for (int i = 0; i < d->nbody; i++) {
        const struct body *body = &d->body[i];
        sym6_from_inertia(&b[i].inertia, &body->mass->inertia);
        body_gyro(body, d->v + 6 * i, b[i].p);
        if (d->load) screw_sub(b[i].p, d->load + 6 * i);
        /* physics (9.0): spring and damper at the end of the step. */
        own.call++;
        own.flop += BODY_GYRO_FLOP + (d->load ? SCREW_ADD_FLOP : 0);
        if (!body->has_spring) continue;
        spring_force(body, h, u + body->u_at, given + body->u_at);
        resistance[body->u_at] = spring_resistance(body, h);
        own.flop += 3 + 3; /* less h k u; h (c + h k) */
    }
    /* Tip to base as in aba.c: a spring resists at its own joint and couples no bodies. */
    for (int i = d->nbody - 1; i >= 0 && good; i--) {
        const struct body *body = &d->body[i];
        struct sym6 ia, moved;
        real pa[6];
        good = eliminate(&d->pose[i].s, d->bias + 6 * i, given + body->u_at,
                         resistance + body->u_at, &b[i], &ia, pa, &own);
        if (!good || body->parent < 0) continue;
        /* Handed to the parent as in aba.c. */
        sym6_move(&moved, &d->pose[i].x, &ia);
        sym6_add(&b[body->parent].inertia, &moved);
        xform_force(pa, &d->pose[i].x, pa);
        screw_add(b[body->parent].p, pa);
        own.flop += SYM6_MOVE_FLOP + SYM6_ADD_FLOP + XFORM_FORCE_FLOP + SCREW_ADD_FLOP;
    }
    for (int i = 0; i < d->nbody && good; i++) accelerate(d, i, &b[i], ud + d->body[i].u_at, &own);
    arena_release(d->arena, mark);
    if (w) work_add(w, &own);
    return good;
}
