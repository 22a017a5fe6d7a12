/* crba_revolute.c - mass matrix of all-revolute systems: composites locally, products in common
 * axes.
 *
 * Composite inertias and F_i = I^c z stay in body axes, where they are accurate. Then F_i, taken to
 * the base's axes and to a common origin (that of body 0), meets all ancestors' axes S_j = [z; o x
 * z] without any further transform: 11 flops a pair, in packed registers for a chain. */
#include "dynamics/revolute.h"
#include "linalg/angle.h"

/* Per body: pose in common axes. Columns of S as separate arrays for the chain's rows. */
struct axes {
    int n;
    real *s[6];          /* (n) each: components of z and o x z */
    struct xform *x;     /* (n) body -> parent */
    struct xform *world; /* (n) body -> base, origin relative to body 0's */
    struct inertia *composite;
};

/* Laid out in the scratch of struct dynamics: no allocation in a call. */
static struct axes axes_in(struct dynamics *d)
{
    struct axes a = {.n = d->nbody};
    real *room = d->scratch;
    for (int k = 0; k < 6; k++) a.s[k] = room + (size_t)k * (size_t)a.n;
    a.x = (struct xform *)(room + 6 * (size_t)a.n);
    a.world = a.x + a.n;
    a.composite = (struct inertia *)(a.world + a.n);
    return a;
}

/* Transforms, axes, and each body's own inertia. */
enum { OUTWARD_FLOP = MAT3_TURN_FLOP + VEC3_CROSS_FLOP, OUTWARD_ROOT_FLOP = 3 };
static void outward(struct dynamics *d, const real *q, struct axes *a)
{
    real *sine = d->scratch + 45 * (size_t)a->n, *cosine = sine + a->n;
    angle_sincos_batch(a->n, q, sine, cosine);
    for (int i = 0; i < a->n; i++) {
        const struct revolute *b = &d->revolute[i];
        struct xform *x = &a->x[i], *w = &a->world[i];
        mat3_turn_z(x->r, b->e, sine[i], cosine[i]);
        vec3_copy(x->p, b->t);
        if (b->parent >= 0) {
            xform_compose(w, &a->world[b->parent], x);
        } else {
            *w = *x;
            /* Differences of places alone: a scene far from the origin keeps its digits. */
            vec3_sub(w->p, d->revolute[0].t);
        }
        /* S = [z; o x z]: what the joint moves, seen from the common origin. */
        real z[3] = {w->r[2], w->r[5], w->r[8]}, v[3];
        vec3_cross(v, w->p, z);
        for (int k = 0; k < 3; k++) a->s[k][i] = z[k], a->s[3 + k][i] = v[k];
        a->composite[i] = d->body[i].mass->inertia;
    }
}

/* F = I^c z in common axes about the common origin. */
enum { FORCE_FLOP = 2 * MAT3_VEC_FLOP + VEC3_CROSS_ADD_FLOP };
static void force_of(const struct axes *a, int i, real *n, real *f)
{
    const struct inertia *in = &a->composite[i];
    /* Column z of the composite's matrix: moments, then forces; no product at all. */
    const real local[6] = {in->j[2], in->j[4], in->j[5], -in->ms[1], in->ms[0], 0};
    mat3_mul_vec(n, a->world[i].r, local);
    mat3_mul_vec(f, a->world[i].r, local + 3);
    vec3_cross_add(n, a->world[i].p, f);
}

/* Row i of a chain up to the diagonal, in packed registers. */
enum { PAIR_FLOP = 11 };
/* All ancestors of a chain's body are contiguous: the loop has no branches. */
static void chain_row(const struct axes *a, int i, const real *n, const real *f, real *restrict row)
{
    const real *x = a->s[0], *y = a->s[1], *z = a->s[2], *u = a->s[3], *v = a->s[4], *w = a->s[5];
    const real n0 = n[0], n1 = n[1], n2 = n[2], f0 = f[0], f1 = f[1], f2 = f[2];
    for (int j = 0; j < i; j++)
        row[j] = (n0 * x[j] + n1 * y[j] + n2 * z[j]) + (f0 * u[j] + f1 * v[j] + f2 * w[j]);
}

/* Entries on the path to the root, both triangles. */
static void tree_row(const struct dynamics *d, const struct axes *a, int i, const real *n,
                     const real *f, real *mass)
{
    /* Ancestors of a tree's body are anywhere. */
    size_t size = (size_t)a->n;
    for (int j = d->revolute[i].parent; j >= 0; j = d->revolute[j].parent) {
        real m = (n[0] * a->s[0][j] + n[1] * a->s[1][j] + n[2] * a->s[2][j]) +
                 (f[0] * a->s[3][j] + f[1] * a->s[4][j] + f[2] * a->s[5][j]);
        mass[(size_t)i * size + (size_t)j] = m;
        mass[(size_t)j * size + (size_t)i] = m;
    }
}

/* Upper triangle from the lower: eight rows at a time, so that a cache line is written whole. */
static void mirror(int n, real *mass)
{
    enum { TILE = 8 };
    for (int i0 = 0; i0 < n; i0 += TILE) {
        int end = i0 + TILE < n ? i0 + TILE : n;
        for (int j = 0; j < end - 1; j++)
            for (int i = i0 > j ? i0 : j + 1; i < end; i++)
                mass[(size_t)j * (size_t)n + (size_t)i] = mass[(size_t)i * (size_t)n + (size_t)j];
    }
}

/* What crba_revolute executes. */
static void count(const struct dynamics *d, struct work *w)
{
    const int child = XFORM_COMPOSE_FLOP + FORCE_FLOP + INERTIA_MOVE_FLOP + INERTIA_ADD_FLOP;
    if (!w) return;
    revolute_count(d, (struct revolute_cost){.body = OUTWARD_FLOP, .child = child}, w);
    for (int i = 0; i < d->nbody; i++) {
        if (d->revolute[i].parent < 0) w->flop += OUTWARD_ROOT_FLOP;
        for (int j = d->revolute[i].parent; j >= 0; j = d->revolute[j].parent) w->flop += PAIR_FLOP;
    }
}

/* One sweep to the base: each body's composite is complete when its row is made. */
void crba_revolute(struct dynamics *d, const real *q, real *mass, struct work *w)
{
    count(d, w);
    struct axes a = axes_in(d);
    size_t n = (size_t)a.n;
    bool chain = d->model->is_chain;
    outward(d, q, &a);
    for (size_t k = 0; k < n * n && !chain; k++) mass[k] = 0;
    for (int i = a.n - 1; i >= 0; i--) {
        real moment[3], force[3];
        struct inertia moved;
        int parent = d->revolute[i].parent;
        mass[(size_t)i * n + (size_t)i] = a.composite[i].j[5];
        if (parent < 0) continue;
        force_of(&a, i, moment, force);
        if (chain)
            chain_row(&a, i, moment, force, mass + (size_t)i * n);
        else
            tree_row(d, &a, i, moment, force, mass);
        /* Composites move from joint to joint in body axes, never through the common origin. */
        inertia_move(&moved, &a.x[i], &a.composite[i]);
        inertia_add(&a.composite[parent], &moved);
    }
    if (chain) mirror(a.n, mass);
}
