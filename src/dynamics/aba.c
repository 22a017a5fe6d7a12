/* aba.c - articulated bodies for every joint type, physics (2.6), (2.7).
 *
 * In the orthonormal columns [H W] of the joint, eliminating it leaves S = I_ww - I_wh I_hh^-1
 * I_hw; then I^a = W S W^T exactly, with nothing along H, and p^a = H tau + W (...). That keeps
 * symmetry and the exact zeros. */
#include "dynamics/dynamics.h"
#include "dynamics/revolute.h"
#include "dynamics/work_count.h"
#include "linalg/dense.h"

/* A body's articulated quantities in joint coordinates: first d along H, then c along W. */
struct articulated {
    struct sym6 inertia;  /* body axes, of the body and its absorbed children */
    real p[6];            /* bias force, body axes */
    real g[21];           /* factor of I_hh, packed */
    real wh[36];          /* (c x d) I_wh */
    real e[6];            /* (d) tau - H^T p, then I_hh^-1 of it */
};

/* Lower triangle of [H W]^T I [H W] (full 6x6 out), H^T p and W^T p in order. */
static void to_joint_axes(const struct subspace *s, const struct articulated *b, real *m, real *p)
{
    real full[36], t[36];
    sym6_expand(full, &b->inertia);
    /* Unit columns: the matrix in joint axes is a permutation of that in body axes. */
    if (s->pick) {
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) m[6 * i + j] = full[6 * s->pick[i] + s->pick[j]];
            p[i] = b->p[s->pick[i]];
        }
        return;
    }
    /* Otherwise two products with the orthonormal [H W], of which the second is symmetric. */
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++) t[6 * j + i] = screw_dot(full + 6 * i, s->col + 6 * j);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j <= i; j++)
            m[6 * i + j] = m[6 * j + i] = screw_dot(s->col + 6 * i, t + 6 * j);
        p[i] = screw_dot(s->col + 6 * i, b->p);
    }
}

/* A (symmetric 6x6) = W S W^T for S (c x c). */
static void from_joint_axes(const struct subspace *s, const real *schur, struct sym6 *out)
{
    /* Where entry (r, k) of the full matrix lies among the 21 of struct sym6: its blocks a,
     * b, c. */
    static const signed char at[6][6] = {{0, 1, 2, 6, 7, 8},      {1, 3, 4, 9, 10, 11},
                                         {2, 4, 5, 12, 13, 14},   {6, 9, 12, 15, 16, 17},
                                         {7, 10, 13, 16, 18, 19}, {8, 11, 14, 17, 19, 20}};
    real *flat[21];
    for (int k = 0; k < 6; k++) flat[k] = &out->a[k], flat[15 + k] = &out->c[k];
    for (int k = 0; k < 9; k++) flat[6 + k] = &out->b[k];
    for (int k = 0; k < 21; k++) *flat[k] = REAL(0);
    for (int i = 0; i < s->c; i++) {
        /* W has unit columns: rows and columns of S only move to their places. */
        if (s->pick) {
            for (int j = 0; j <= i; j++)
                *flat[at[s->pick[s->d + i]][s->pick[s->d + j]]] = schur[6 * i + j];
            continue;
        }
        for (int j = 0; j < s->c; j++)
            for (int r = 0; r < 6; r++)
                for (int k = r; k < 6; k++)
                    *flat[at[r][k]] +=
                        s->col[6 * (s->d + i) + r] * schur[6 * i + j] * s->col[6 * (s->d + j) + k];
    }
}

/* Eliminate the joint: factors and e stay in b; ia, pa are what the parent gets (body axes). bias
 * NULL: none. */
static bool eliminate(const struct subspace *s, const real *bias, const real *tau,
                      struct articulated *b, struct sym6 *ia, real *pa)
{
    int d = s->d, c = s->c;
    real m[36], p[6], y[36], schur[36], along_w[6];
    struct work uncounted = {0};
    /* I_hh, I_wh and e = tau - H^T p, apart for the way back. */
    to_joint_axes(s, b, m, p);
    for (int i = 0; i < d; i++) {
        for (int j = 0; j <= i; j++) b->g[packed_index(i, j)] = m[6 * i + j];
        for (int j = 0; j < c; j++) y[c * i + j] = b->wh[d * j + i] = m[6 * i + d + j];
        b->e[i] = tau[i] - p[i];
    }
    /* Not positive definite: nothing resists along H (massless bodies), and u' is not
     * determined. */
    if (d > 0 && !dense_factor(d, b->g, b->g, &uncounted)) return false;
    if (d > 0) dense_solve(d, 1, b->g, b->e, &uncounted);
    if (d > 0) dense_forward(d, c, b->g, y, &uncounted);
    /* S = I_ww - y^T D^-1 y, one triangle computed */
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) {
            real sum = m[6 * (d + i) + d + j];
            for (int k = 0; k < d; k++)
                sum -= y[c * k + i] * b->g[packed_index(k, k)] * y[c * k + j];
            schur[6 * i + j] = schur[6 * j + i] = sum;
        }
    from_joint_axes(s, schur, ia);
    for (int i = 0; i < c; i++) {
        along_w[i] = p[d + i];
        for (int k = 0; k < d; k++) along_w[i] += b->wh[d * i + k] * b->e[k];
    }
    /* p^a = H tau + W (p_w + I_wh I_hh^-1 e): along H the joint force itself is handed on. */
    screw_zero(pa);
    subspace_h(s, tau, pa);
    subspace_w(s, along_w, pa);
    if (bias) {
        real t[6];
        sym6_mul(t, ia, bias);
        screw_add(pa, t);
    }
    return true;
}

/* moving: with velocity terms.
 * The body alone: its own inertia, P less the loads (1.10). */
static void start(const struct dynamics *d, int i, bool moving, struct articulated *b)
{
    sym6_from_inertia(&b->inertia, &d->body[i].mass->inertia);
    screw_zero(b->p);
    if (moving && !d->at_rest) body_gyro(&d->body[i], d->v + 6 * i, b->p);
    if (d->load) screw_sub(b->p, d->load + 6 * i);
}

/* u' = I_hh^-1 (e - I_hw a_w) - a_h, and the body's acceleration. */
static void accelerate(struct dynamics *d, int i, bool moving, const struct articulated *b,
                       real *ud)
{
    static const real still[6] = {0};
    const struct subspace *s = &d->pose[i].s;
    int parent = d->body[i].parent;
    real *a = d->a + 6 * i, h[6], w[6], z[6];
    struct work uncounted = {0};
    /* What the body would do if its joint did not give way. */
    xform_motion(a, &d->pose[i].x, parent >= 0 ? d->a + 6 * parent : moving ? d->base : still);
    if (moving && !d->at_rest) screw_add(a, d->bias + 6 * i);
    subspace_h_transposed(s, a, h);
    subspace_w_transposed(s, a, w);
    for (int k = 0; k < s->d; k++) {
        z[k] = REAL(0);
        for (int j = 0; j < s->c; j++) z[k] += b->wh[s->d * j + k] * w[j];
    }
    if (s->d > 0) dense_solve(s->d, 1, b->g, z, &uncounted);
    /* the acceleration along H comes from the forces alone: no digit is lost to what moves along */
    for (int k = 0; k < s->d; k++) {
        z[k] = b->e[k] - z[k];
        ud[k] = z[k] - h[k];
    }
    screw_zero(a);
    subspace_w(s, w, a);
    subspace_h(s, z, a);
}

/* The three sweeps at d's poses and, if moving, velocities.
 * Tip to base, then base to tip: O(n) whatever the tree. */
static bool sweep(struct dynamics *d, bool moving, const real *tau, real *ud)
{
    const bool biased = moving && !d->at_rest;
    struct arena_mark mark = arena_mark(d->arena);
    struct articulated *b = TAKE(d->arena, d->nbody, struct articulated);
    bool good = true;
    for (int i = 0; i < d->nbody; i++) start(d, i, moving, &b[i]);
    for (int i = d->nbody - 1; i >= 0 && good; i--) {
        const struct body *body = &d->body[i];
        struct sym6 ia, moved;
        real pa[6];
        good = eliminate(&d->pose[i].s, biased ? d->bias + 6 * i : NULL, tau + body->u_at, &b[i],
                         &ia, pa);
        if (!good || body->parent < 0) continue;
        sym6_move(&moved, &d->pose[i].x, &ia);
        sym6_add(&b[body->parent].inertia, &moved);
        xform_force(pa, &d->pose[i].x, pa);
        screw_add(b[body->parent].p, pa);
    }
    for (int i = 0; i < d->nbody && good; i++)
        accelerate(d, i, moving, &b[i], ud + d->body[i].u_at);
    arena_release(d->arena, mark);
    return good;
}

/* The general case: any joints, at rest or in motion. */
bool aba_full(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
              struct work *w)
{
    dynamics_place(d, q);
    dynamics_velocities(d, u);
    work_count_place(d, w);
    work_count_velocities(d, w);
    work_count_aba(d, true, w);
    return sweep(d, true, tau, ud);
}

/* At the poses of the last call: what forces alone do, without gravity and velocities. */
bool aba_response(struct dynamics *d, const real *tau, real *ud, struct work *w)
{
    work_count_aba(d, false, w);
    return sweep(d, false, tau, ud);
}

/* All-revolute systems have a faster text of their own. */
bool aba(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
         struct work *w)
{
    return d->revolute ? aba_revolute(d, q, u, tau, ud, w) : aba_full(d, q, u, tau, ud, w);
}
