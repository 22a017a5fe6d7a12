/* crba.c - composite rigid bodies: the mass matrix, and forward dynamics through it, physics
 * 2.3. */
#include "dynamics/dynamics.h"
#include "dynamics/revolute.h"
#include "dynamics/work_count.h"
#include "linalg/cholesky.h"

/* Composite inertias (nbody), tip to base.
 * A composite is all that hangs at a joint, taken as one rigid body (physics 2.3). */
static void composites(const struct dynamics *d, struct inertia *c)
{
    for (int i = 0; i < d->nbody; i++) c[i] = d->body[i].mass->inertia;
    for (int i = d->nbody - 1; i >= 0; i--) {
        /* Leaves first, so that each is complete when it is handed down. */
        struct inertia moved;
        if (d->body[i].parent < 0) continue;
        inertia_move(&moved, &d->pose[i].x, &c[i]);
        inertia_add(&c[d->body[i].parent], &moved);
    }
}

/* Rows of body i: its own block, then the walk to the root with f = X f for each of its columns. */
static void fill_rows(const struct dynamics *d, int i, const struct inertia *composite, real *mass)
{
    const struct body *b = &d->body[i];
    real f[36], block[6], h[6];
    /* Own block: H^T I^c H. */
    for (int k = 0; k < b->d; k++) {
        subspace_column(&d->pose[i].s, k, h);
        inertia_mul(f + 6 * k, composite, h);
        subspace_h_transposed(&d->pose[i].s, f + 6 * k, block);
        for (int r = 0; r < b->d; r++) mass[(size_t)(b->u_at + k) * d->nu + b->u_at + r] = block[r];
    }
    /* one triangle decides */
    for (int k = 0; k < b->d; k++)
        for (int r = 0; r < k; r++)
            mass[(size_t)(b->u_at + r) * d->nu + b->u_at + k] =
                mass[(size_t)(b->u_at + k) * d->nu + b->u_at + r];
    /* The force I^c H u' is felt by every ancestor's joint: one transform a step of the walk. */
    for (int j = i; d->body[j].parent >= 0;) {
        const struct body *p = &d->body[d->body[j].parent];
        for (int k = 0; k < b->d; k++) {
            xform_force(f + 6 * k, &d->pose[j].x, f + 6 * k);
            subspace_h_transposed(&d->pose[d->body[j].parent].s, f + 6 * k, block);
            for (int r = 0; r < p->d; r++) {
                mass[(size_t)(b->u_at + k) * d->nu + p->u_at + r] = block[r];
                mass[(size_t)(p->u_at + r) * d->nu + b->u_at + k] = block[r];
            }
        }
        j = d->body[j].parent;
    }
}

/* Entries of bodies that are not ancestors of each other stay zero. */
void crba(struct dynamics *d, const real *q, real *mass, struct work *w)
{
    if (d->revolute) {
        crba_revolute(d, q, mass, w);
        return;
    }
    work_count_crba(d, w);
    struct arena_mark mark = arena_mark(d->arena);
    struct inertia *c = TAKE(d->arena, d->nbody, struct inertia);
    dynamics_place(d, q);
    composites(d, c);
    for (size_t k = 0; k < (size_t)d->nu * (size_t)d->nu; k++) mass[k] = 0;
    for (int i = 0; i < d->nbody; i++) fill_rows(d, i, &c[i], mass);
    arena_release(d->arena, mark);
}

/* The velocity before u-index k on the path to the root (-1: none), for L^T D L along the tree
 * (Featherstone 8.3). M has entries between a joint and its ancestors alone, and L^T D L keeps
 * that. */
static void path_of(const struct dynamics *d, int *up)
{
    for (int i = 0; i < d->nbody; i++) {
        const struct body *b = &d->body[i];
        int p = b->parent;
        /* Fixed joints have no velocity: the path leads past them. */
        while (p >= 0 && d->body[p].d == 0) p = d->body[p].parent;
        int before = p >= 0 ? d->body[p].u_at + d->body[p].d - 1 : -1;
        for (int k = 0; k < b->d; k++) up[b->u_at + k] = k == 0 ? before : b->u_at + k - 1;
    }
}

/* M = L^T D L in place, nonzeros on paths to the root alone; counts operations. */
static bool sparse_factor(int n, const int *up, real *m, struct work *w)
{
    for (int k = n - 1; k >= 0; k--) {
        real pivot = m[(size_t)k * n + k];
        if (!(pivot > 0)) return false;
        /* Eliminating from the leaves fills nothing in: only ancestors of k are touched. */
        for (int i = up[k]; i >= 0; i = up[i]) {
            real a = m[(size_t)k * n + i] / pivot;
            w->div++;
            for (int j = i; j >= 0; j = up[j]) {
                m[(size_t)i * n + j] -= a * m[(size_t)k * n + j];
                w->flop += 2;
            }
            m[(size_t)k * n + i] = a;
        }
    }
    return true;
}

/* L^T y = x from the leaves, then D, then L from the root. */
static void sparse_solve(int n, const int *up, const real *m, real *x, struct work *w)
{
    for (int i = n - 1; i >= 0; i--)
        for (int j = up[i]; j >= 0; j = up[j]) x[j] -= m[(size_t)i * n + j] * x[i], w->flop += 2;
    for (int i = 0; i < n; i++) {
        x[i] /= m[(size_t)i * n + i];
        w->div++;
        for (int j = up[i]; j >= 0; j = up[j]) x[i] -= m[(size_t)i * n + j] * x[j], w->flop += 2;
    }
}

/* M u' = tau - xi; xi is inverse dynamics at u' = 0. */
bool crba_forward(struct dynamics *d, const real *q, const real *u, const real *tau, bool sparse,
                  real *ud, struct work *w)
{
    struct arena_mark mark = arena_mark(d->arena);
    struct work own = {0};
    int n = d->nu;
    real *mass = TAKE_FULL(d->arena, size_product(n, n), real, true), *x = TAKE(d->arena, n, real);
    bool good;
    /* The bias forces, which the fast path has, too. */
    rnea(d, q, u, d->zero, x, w);
    crba(d, q, mass, w);
    for (int i = 0; i < n; i++) x[i] = tau[i] - x[i];
    /* Depth squared times n operations instead of n cubed. */
    if (sparse) {
        int *up = TAKE(d->arena, n, int);
        path_of(d, up);
        good = sparse_factor(n, up, mass, &own);
        if (good) sparse_solve(n, up, mass, x, &own);
    } else {
        /* The baseline that ignores the tree. */
        good = cholesky_answer(n, mass, x, d->arena);
        /* Counted by formula: the inner loops would cost more to count than to run. */
        uint64_t m = (uint64_t)n;
        own.flop = m * (m + 1) * (2 * m + 1) / 6 - m * (m + 1) / 2 + 2 * m * (m - 1);
        own.div = m * (m - 1) / 2 + 2 * m;
        own.sqrt = m;
    }
    if (good)
        for (int i = 0; i < n; i++) ud[i] = x[i];
    arena_release(d->arena, mark);
    if (w) work_add(w, &own);
    if (w) w->flop += (uint64_t)n;
    return good;
}
