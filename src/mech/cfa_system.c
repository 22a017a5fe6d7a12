/* cfa_system.c - factor and solve by elimination of joints, leaves first. */
#include "mech/cfa_system.h"

#include "linalg/dense.h"

/* xw (6 x c) = X W by columns. */
static void moved_columns(const struct body_pose *pose, real *xw)
{
    real column[6];
    for (int k = 0; k < pose->s.c; k++) {
        subspace_column(&pose->s, pose->s.d + k, column);
        xform_force(xw + 6 * k, &pose->x, column);
    }
}

/* S (packed) = W^T Phi W. */
static void project(const struct subspace *s, const struct sym6 *phi, real *out)
{
    real full[36], t[36];
    sym6_expand(full, phi);
    if (s->pick) {
        for (int i = 0; i < s->c; i++)
            for (int j = 0; j <= i; j++) out[packed_index(i, j)] = full[6 * s->pick[s->d + i] + s->pick[s->d + j]];
        return;
    }
    for (int j = 0; j < s->c; j++)
        for (int i = 0; i < 6; i++) t[6 * j + i] = six_dot(full + 6 * i, s->col + 6 * (s->d + j));
    for (int i = 0; i < s->c; i++)
        for (int j = 0; j <= i; j++) out[packed_index(i, j)] = six_dot(s->col + 6 * (s->d + i), t + 6 * j);
}

/* phi -= y^T D^-1 y for y = L^-1 U^T (c x 6): one triangle. */
static void lower(struct sym6 *phi, int c, const real *y, const real *g)
{
    static const signed char row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < c; k++) {
        const real *v = y + 6 * k;
        real inverse = g[packed_index(k, k)], t[6];
        for (int j = 0; j < 6; j++) t[j] = inverse * v[j];
        for (int e = 0; e < 6; e++) {
            phi->a[e] -= t[row[e]] * v[column[e]];
            phi->c[e] -= t[3 + row[e]] * v[3 + column[e]];
        }
        for (int e = 0; e < 9; e++) phi->b[e] -= t[e / 3] * v[3 + e % 3];
    }
}

/* Eliminate joint i; false when its block is not positive definite. */
static bool eliminate(const struct dynamics *d, int i, struct cfa_system *s, struct work *w)
{
    const struct body_pose *pose = &d->pose[i];
    struct cfa_row *row = &s->row[i];
    int c = pose->s.c, parent = d->body[i].parent;
    real xw[36], y[36];
    if (c == 0) return true;
    project(&pose->s, &s->phi[i], row->g);
    if (parent < 0) return dense_factor(c, row->g, row->g, w);
    moved_columns(pose, xw);
    for (int k = 0; k < c; k++) sym6_mul(row->u + 6 * k, &s->phi[parent], xw + 6 * k);
    for (int k = 0; k < c; k++)
        for (int j = 0; j <= k; j++) row->g[packed_index(k, j)] += six_dot(xw + 6 * k, row->u + 6 * j);
    if (!dense_factor(c, row->g, row->g, w)) return false;
    for (int k = 0; k < 6 * c; k++) y[k] = row->u[k];
    dense_forward(c, 6, row->g, y, w);
    lower(&s->phi[parent], c, y, row->g);
    uint64_t n = (uint64_t)c;
    w->flop += n * (XFORM_FORCE_FLOP - 27 + SYM6_MUL_FLOP + 48) + n * (n + 1) / 2 * 12;
    return true;
}

bool cfa_factor(struct dynamics *d, struct cfa_system *s, struct work *w)
{
    s->row = TAKE(d->arena, d->nbody, struct cfa_row);
    s->phi = TAKE(d->arena, d->nbody, struct sym6);
    for (int i = 0; i < d->nbody; i++) s->phi[i] = d->body[i].phi;
    for (int i = d->nbody - 1; i >= 0; i--)
        if (!eliminate(d, i, s, w)) return false;
    return true;
}

/* S_i^-1 U^T v added to z (c). */
static void answer(int c, const struct cfa_row *row, const real *v, real *z, struct work *w)
{
    for (int k = 0; k < c; k++) z[k] = six_dot(row->u + 6 * k, v);
    dense_solve(c, 1, row->g, z, w);
    w->flop += (uint64_t)(11 * c);
}

void cfa_solve(struct dynamics *d, const struct cfa_system *s, real *r, real *x, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    real *beta = TAKE(d->arena, 6 * d->nbody, real); /* accelerations by forces of eliminated joints, then g */
    for (int i = d->nbody - 1; i >= 0; i--) {
        const struct body_pose *pose = &d->pose[i];
        int c = pose->s.c, parent = d->body[i].parent;
        real t[6], z[6];
        if (c == 0) continue;
        six_zero(t);
        six_sub(t, beta + 6 * i);
        if (parent >= 0) {
            real carried[6];
            xform_motion(carried, &pose->x, beta + 6 * parent);
            six_add(t, carried);
        }
        subspace_w_transposed(&pose->s, t, z);
        for (int k = 0; k < c; k++) r[6 * i + k] += z[k];
        dense_solve(c, 1, s->row[i].g, r + 6 * i, w);
        for (int k = 0; k < c && parent >= 0; k++) six_axpy(beta + 6 * parent, -r[6 * i + k], s->row[i].u + 6 * k);
        w->flop += (uint64_t)(6 + c + (parent >= 0 ? XFORM_MOTION_FLOP + 6 + 12 * c : 0));
    }
    for (int k = 0; k < 6 * d->nbody; k++) beta[k] = 0; /* from here g: force on each body's joint not yet spoken for */
    for (int i = 0; i < d->nbody; i++) {
        const struct body_pose *pose = &d->pose[i];
        int c = pose->s.c, parent = d->body[i].parent;
        real *force = x + 6 * i, t[6];
        six_zero(force);
        if (c > 0 && parent >= 0) {
            real z[6];
            answer(c, &s->row[i], beta + 6 * parent, z, w);
            for (int k = 0; k < c; k++) r[6 * i + k] += z[k];
        }
        subspace_w(&pose->s, r + 6 * i, force);
        six_add(beta + 6 * i, force);
        if (parent < 0) continue;
        xform_force(t, &pose->x, force);
        six_sub(beta + 6 * parent, t);
        w->flop += XFORM_FORCE_FLOP + 12;
    }
    arena_release(d->arena, mark);
}
