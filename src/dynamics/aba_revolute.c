/* aba_revolute.c - articulated bodies for all-revolute systems, 629 flops a body.
 *
 * The articulated inertia [A B; B^T C] is symmetric by storage. After its joint is eliminated, row
 * z of A and B is zero exactly, and so is the force p along it but for tau: none of that is
 * computed. */
#include "dynamics/dynamics_table.h"
#include "dynamics/revolute.h"
#include "linalg/angle.h"

/* Per body, from the first outward sweep to the last. */
struct link {
    real r[9];                 /* body -> parent */
    real bx, by, bl[3];        /* bias acceleration b: angular x, y; linear */
    real a[6], b[9], c[6];     /* articulated inertia */
    real n[3], f[3];           /* its bias force p */
    real kx, ky, kl[3];        /* row z of the inertia without its diagonal, over the diagonal */
    real ez;                   /* (tau - p_z) / diagonal */
};

/* Motion for the sweeps: angular velocity first, acceleration at last. */
struct motion {
    real w[3];
    real v[3];
};

/* Velocity, bias acceleration and velocity force of one body. */
enum {
    START_FLOP = MAT3_VEC_FLOP + 2 + 1 + 2 * VEC3_CROSS_FLOP + MAT3_VEC_FLOP + 2 * VEC3_CROSS_FLOP +
                 VEC3_SCALE_FLOP + SYM3_VEC_FLOP + VEC3_CROSS_FLOP + VEC3_CROSS_ADD_FLOP
};
static inline void start(const struct revolute *b, real u, const real *wp, real *w, struct link *l)
{
    real t[3], g[3];
    mat3_mul_vec_transposed(w, l->r, wp);
    l->bx = w[1] * u, l->by = -w[0] * u;
    w[2] += u;
    /* b of (1.9); a turn has v_J = 0. The centripetal part is formed in parent axes, where the
     * joint's place is a constant. */
    vec3_cross(t, wp, b->t);
    vec3_cross(t, wp, t);
    mat3_mul_vec_transposed(l->bl, l->r, t);
    /* force m w x (w x s); moment w x Jc w + s x force, with w x Jc w = - w x S w */
    vec3_cross(g, w, b->s);
    vec3_cross(g, w, g);
    vec3_scale(l->f, b->m, g);
    sym3_mul_vec(t, b->second, w);
    vec3_cross(l->n, t, w);
    vec3_cross_add(l->n, b->s, l->f);
}

/* The rigid body's inertia. */
enum { RIGID_FLOP = 3 + 6 + 3 + 6 };
/* About the origin from second moments: half the products of a general inertia. */
static inline void rigid(const struct revolute *b, struct link *l)
{
    const real *s = b->s, *S = b->second;
    real m = b->m, x = m * s[0], y = m * s[1], z = m * s[2];
    real mxx = S[0] + x * s[0], myy = S[3] + y * s[1], mzz = S[5] + z * s[2];
    l->a[0] = myy + mzz, l->a[3] = mxx + mzz, l->a[5] = mxx + myy;
    l->a[1] = -(S[1] + x * s[1]), l->a[2] = -(S[2] + x * s[2]), l->a[4] = -(S[4] + y * s[2]);
    l->b[0] = l->b[4] = l->b[8] = REAL(0);
    l->b[1] = -z, l->b[2] = y, l->b[3] = z, l->b[5] = -x, l->b[6] = -y, l->b[7] = x;
    l->c[0] = l->c[3] = l->c[5] = m;
    l->c[1] = l->c[2] = l->c[4] = REAL(0);
}

/* Eliminate the joint: I - I H D^-1 H^T I in place (rows x, y only), p + I^a b + I H D^-1 e in n
 * (x, y), f. At rest b is zero. */
enum {
    ELIMINATE_AT_REST_FLOP = 1 + 5 + 1 + 6 + 12 + 12 + 10,
    ELIMINATE_FLOP = ELIMINATE_AT_REST_FLOP + 5 * 10
};
static inline bool eliminate(struct link *l, bool at_rest, real tau)
{
    real *a = l->a, *b = l->b, *c = l->c, d = a[5];
    if (!real_all(d > 0)) return false;
    /* (2.6) with H = z: D is one number, Q is row z of the inertia. One division, then products. */
    real inverse = 1 / d, e = tau - l->n[2];
    real kx = a[2] * inverse, ky = a[4] * inverse, k0 = b[6] * inverse, k1 = b[7] * inverse,
         k2 = b[8] * inverse;
    l->kx = kx, l->ky = ky, l->kl[0] = k0, l->kl[1] = k1, l->kl[2] = k2;
    l->ez = e * inverse;
    /* Q D^-1 Q^T lowers what is not in row z; that row is zero now, and nobody reads it. */
    a[0] -= kx * a[2], a[1] -= kx * a[4], a[3] -= ky * a[4];
    for (int j = 0; j < 3; j++) b[j] -= kx * b[6 + j], b[3 + j] -= ky * b[6 + j];
    c[0] -= k0 * b[6], c[1] -= k0 * b[7], c[2] -= k0 * b[8];
    c[3] -= k1 * b[7], c[4] -= k1 * b[8], c[5] -= k2 * b[8];
    /* No bias: e alone reaches the parent. */
    if (at_rest) {
        l->n[0] += kx * e, l->n[1] += ky * e, l->n[2] = tau;
        l->f[0] += k0 * e, l->f[1] += k1 * e, l->f[2] += k2 * e;
        return true;
    }
    const real *bl = l->bl;
    real bx = l->bx, by = l->by;
    l->n[0] += kx * e + (a[0] * bx + a[1] * by + b[0] * bl[0] + b[1] * bl[1] + b[2] * bl[2]);
    l->n[1] += ky * e + (a[1] * bx + a[3] * by + b[3] * bl[0] + b[4] * bl[1] + b[5] * bl[2]);
    l->n[2] = tau;
    l->f[0] += k0 * e + (b[0] * bx + b[3] * by + c[0] * bl[0] + c[1] * bl[1] + c[2] * bl[2]);
    l->f[1] += k1 * e + (b[1] * bx + b[4] * by + c[1] * bl[0] + c[3] * bl[1] + c[4] * bl[2]);
    l->f[2] += k2 * e + (b[2] * bx + b[5] * by + c[2] * bl[0] + c[4] * bl[1] + c[5] * bl[2]);
    return true;
}

/* Rotated blocks of the eliminated inertia, in parent axes: ra = r A r^T, rb = r B r^T, rc = r C
 * r^T. */
enum { ROTATE_FLOP = 18 + 18 + 27 + MAT3_MUL_FLOP + SYM3_ROTATE_FLOP };
static inline void rotate(const struct link *l, real *restrict ra, real *restrict rb,
                          real *restrict rc)
{
    const real *r = l->r, *a = l->a, *b = l->b, *c = l->c;
    real t[9];
    for (int i = 0; i < 3; i++) {
        const real *row = r + 3 * i;
        t[2 * i] = row[0] * a[0] + row[1] * a[1];
        t[2 * i + 1] = row[0] * a[1] + row[1] * a[3];
    }
    ra[0] = t[0] * r[0] + t[1] * r[1], ra[1] = t[0] * r[3] + t[1] * r[4],
    ra[2] = t[0] * r[6] + t[1] * r[7];
    ra[3] = t[2] * r[3] + t[3] * r[4], ra[4] = t[2] * r[6] + t[3] * r[7],
    ra[5] = t[4] * r[6] + t[5] * r[7];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) t[3 * i + j] = r[3 * i] * b[j] + r[3 * i + 1] * b[3 + j];
    mat3_mul_transposed(rb, t, r);
    sym3_rotate(rc, r, c);
}

/* Parent's inertia and force += those of the eliminated child, moved by (r, t). */
enum {
    HAND_DOWN_FLOP = ROTATE_FLOP + 36 + 3 * 7 + 3 * 9 + 9 + 6 + 2 * MAT3_VEC_FLOP +
                     2 * VEC3_ADD_FLOP + VEC3_CROSS_ADD_FLOP
};
static inline void hand_down(const struct revolute *body, const struct link *l, struct link *parent)
{
    real ra[6], b[9], c[6], d[9], f[3], n[3];
    const real *p = body->t;
    rotate(l, ra, b, c);
    /* shift: d = b + p~ c, A' = A - d p~ + p~ b^T */
    mat3_add_skew_mul_sym3(d, b, p, c);
    real *a = parent->a;
    a[0] += ra[0] + ((d[2] + b[2]) * p[1] - (d[1] + b[1]) * p[2]);
    a[1] += ra[1] + ((d[0] * p[2] - d[2] * p[0]) + (p[1] * b[5] - p[2] * b[4]));
    a[2] += ra[2] + ((d[1] * p[0] - d[0] * p[1]) + (p[1] * b[8] - p[2] * b[7]));
    a[3] += ra[3] + ((d[3] + b[3]) * p[2] - (d[5] + b[5]) * p[0]);
    a[4] += ra[4] + ((d[4] * p[0] - d[3] * p[1]) + (p[2] * b[6] - p[0] * b[8]));
    a[5] += ra[5] + ((d[7] + b[7]) * p[0] - (d[6] + b[6]) * p[1]);
    for (int i = 0; i < 9; i++) parent->b[i] += d[i];
    for (int i = 0; i < 6; i++) parent->c[i] += c[i];
    /* X F of physics 1.2: the lever arm acts on the force in parent axes. */
    mat3_mul_vec(f, l->r, l->f);
    mat3_mul_vec(n, l->r, l->n);
    vec3_add(parent->f, f);
    vec3_cross_add(n, p, f);
    vec3_add(parent->n, n);
}

/* u' of one body and its acceleration from its parent's. */
enum {
    ACCELERATE_AT_REST_FLOP = VEC3_CROSS_ADD_FLOP + 2 * MAT3_VEC_FLOP + 10 + 1,
    ACCELERATE_FLOP = ACCELERATE_AT_REST_FLOP + VEC3_ADD_FLOP + 2
};
static inline real accelerate(const struct revolute *body, const struct link *l, bool at_rest,
                              const struct motion *p, struct motion *m)
{
    real al[3], v[3];
    vec3_copy(v, p->v);
    vec3_cross_add(v, p->w, body->t);
    mat3_mul_vec_transposed(al, l->r, p->w);
    mat3_mul_vec_transposed(v, l->r, v);
    if (!at_rest) {
        vec3_add(v, l->bl);
        al[0] += l->bx, al[1] += l->by;
    }
    /* (2.7). Q_z / D is 1, so z is the whole acceleration about the axis, and u' is what the
     * parent does not bring along. */
    real z = l->ez - (l->kx * al[0] + l->ky * al[1] +
                      (l->kl[0] * v[0] + l->kl[1] * v[1] + l->kl[2] * v[2]));
    vec3_set(m->w, al[0], al[1], z);
    vec3_copy(m->v, v);
    return z - al[2];
}

/* What the sweeps write, from the first body that is here on. */
struct sweep {
    real *sine, *cosine;
    struct link *link;
    struct motion *motion; /* velocities outward, then accelerations */
};

static struct sweep sweep_of(struct dynamics *d)
{
    const int n = d->model->end - d->model->first;
    struct sweep s = {.sine = d->scratch, .cosine = d->scratch + n};
    s.link = (struct link *)(s.cosine + n);
    s.motion = (struct motion *)(s.link + n);
    return s;
}

/* All angles in one loop that compilers turn into vectors. */
static void angles(const struct dynamics *d, const struct sweep *s, const real *q)
{
    const int first = d->model->first;
    angle_sincos_batch(d->model->end - first, q + first, s->sine, s->cosine);
}

/* The three sweeps are called with a constant `at_rest`, so that each case is compiled alone: no
 * branch on it stands in the loops. `before`: how the base moves, or the body before a part. */

/* Base to tip: velocities, rigid bodies and their forces. */
static inline void outward(struct dynamics *d, const struct sweep *s, bool at_rest,
                           const struct motion *before, const real *u)
{
    const int first = d->model->first, end = d->model->end;
    for (int i = first; i < end; i++) {
        const struct revolute *b = &d->revolute[i];
        struct link *l = &s->link[i - first];
        mat3_turn_z(l->r, b->e, s->sine[i - first], s->cosine[i - first]);
        if (at_rest) {
            vec3_zero(l->n), vec3_zero(l->f);
        } else {
            const struct motion *p = b->parent < first ? before : &s->motion[b->parent - first];
            start(b, u[i], p->w, s->motion[i - first].w, l);
        }
        rigid(b, l);
        if (d->load) {
            vec3_sub(l->n, d->load + 6 * i);
            vec3_sub(l->f, d->load + 6 * i + 3);
        }
    }
}

/* Tip to base: a body has all its children's parts before it gives way itself. */
static inline bool inward(struct dynamics *d, const struct sweep *s, bool at_rest, const real *tau)
{
    const int first = d->model->first;
    for (int i = d->model->end - 1; i >= first; i--) {
        const struct revolute *b = &d->revolute[i];
        struct link *l = &s->link[i - first];
        if (!eliminate(l, at_rest, tau[i])) return false;
        if (b->parent >= first) hand_down(b, l, &s->link[b->parent - first]);
    }
    return true;
}

/* Base to tip; `before` contains -g (physics 1.6). */
static inline void accelerations(struct dynamics *d, const struct sweep *s, bool at_rest,
                                 const struct motion *before, real *ud)
{
    const int first = d->model->first, end = d->model->end;
    for (int i = first; i < end; i++) {
        const struct revolute *b = &d->revolute[i];
        const struct motion *p = b->parent < first ? before : &s->motion[b->parent - first];
        ud[i] = accelerate(b, &s->link[i - first], at_rest, p, &s->motion[i - first]);
    }
}

static const struct motion still; /* the base does not turn */

static struct motion base_of(const struct dynamics *d)
{
    struct motion base;
    vec3_copy(base.w, d->base);
    vec3_copy(base.v, d->base + 3);
    return base;
}

static inline bool sweep(struct dynamics *d, bool at_rest, const real *q, const real *u,
                         const real *tau, real *ud)
{
    const struct sweep s = sweep_of(d);
    const struct motion base = base_of(d);
    angles(d, &s, q);
    outward(d, &s, at_rest, &still, u);
    if (!inward(d, &s, at_rest, tau)) return false;
    accelerations(d, &s, at_rest, &base, ud);
    return true;
}

static void count(const struct dynamics *d, struct work *w)
{
    const int body = MAT3_TURN_FLOP + RIGID_FLOP + (d->load ? SCREW_ADD_FLOP : 0);
    const int moving = d->at_rest ? ELIMINATE_AT_REST_FLOP + ACCELERATE_AT_REST_FLOP
                                  : START_FLOP + ELIMINATE_FLOP + ACCELERATE_FLOP;
    revolute_count(
        d, (struct revolute_cost){.body = body + moving, .child = HAND_DOWN_FLOP, .div = 1}, w);
}

bool aba_revolute(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                  struct work *w)
{
    count(d, w);
    return d->at_rest ? sweep(d, true, q, u, tau, ud) : sweep(d, false, q, u, tau, ud);
}

/* --- a part of a chain ------------------------------------------------------------------------ */

#if REAL_LANES == 1 /* neighbours hand over numbers of one state */

/* What crosses an end: motions; what hand_down adds to a parent's inertia and force. */
enum { VELOCITY_NUMBERS = 3, ACCELERATION_NUMBERS = 6, HANDED_NUMBERS = 6 + 9 + 6 + 3 + 3 };

/* As numbers of a link and back, in one order. */
static void handed_numbers(struct link *l, real *number[HANDED_NUMBERS])
{
    int n = 0;
    for (int k = 0; k < 6; k++) number[n++] = &l->a[k], number[n++] = &l->c[k];
    for (int k = 0; k < 9; k++) number[n++] = &l->b[k];
    for (int k = 0; k < 3; k++) number[n++] = &l->n[k], number[n++] = &l->f[k];
}

static bool give_inertia(const struct part_ends *ends, const struct revolute *b,
                         const struct link *l)
{
    struct link handed = {.ez = 0};
    real *number[HANDED_NUMBERS];
    double x[HANDED_NUMBERS];
    hand_down(b, l, &handed);
    handed_numbers(&handed, number);
    for (int k = 0; k < HANDED_NUMBERS; k++) x[k] = (double)*number[k];
    return ends->give(ends->context, false, x, HANDED_NUMBERS);
}

static bool take_inertia(const struct part_ends *ends, struct link *parent)
{
    real *number[HANDED_NUMBERS];
    double x[HANDED_NUMBERS];
    if (!ends->take(ends->context, true, x, HANDED_NUMBERS)) return false;
    handed_numbers(parent, number);
    for (int k = 0; k < HANDED_NUMBERS; k++) *number[k] += (real)x[k];
    return true;
}

/* `n`: of a velocity the angular part, of an acceleration both. */
static bool take_motion(const struct part_ends *ends, struct motion *m, int n)
{
    double x[ACCELERATION_NUMBERS];
    if (!ends->take(ends->context, false, x, n)) return false;
    for (int k = 0; k < 3; k++) m->w[k] = (real)x[k];
    for (int k = 3; k < n; k++) m->v[k - 3] = (real)x[k];
    return true;
}

static bool give_motion(const struct part_ends *ends, const struct motion *m, int n)
{
    double x[ACCELERATION_NUMBERS];
    for (int k = 0; k < 3; k++) x[k] = (double)m->w[k];
    for (int k = 3; k < n; k++) x[k] = (double)m->v[k - 3];
    return ends->give(ends->context, true, x, n);
}

/* A joint that gives no way is told at the end: the neighbours wait for numbers, of whatever
 * worth. */
static inline bool part(struct dynamics *d, bool at_rest, const real *q, const real *u,
                        const real *tau, const struct part_ends *ends, real *ud, bool *found)
{
    const struct model *m = d->model;
    const bool has_before = m->first > 0, has_after = m->end < m->nbody;
    const struct sweep s = sweep_of(d);
    const int last = m->end - 1 - m->first;
    struct motion before = still;
    angles(d, &s, q); /* while the others are not yet here */
    if (!at_rest && has_before && !take_motion(ends, &before, VELOCITY_NUMBERS)) return false;
    outward(d, &s, at_rest, &before, u);
    if (!at_rest && has_after && !give_motion(ends, &s.motion[last], VELOCITY_NUMBERS))
        return false;
    if (has_after && !take_inertia(ends, &s.link[last])) return false;
    *found = inward(d, &s, at_rest, tau);
    if (has_before && !give_inertia(ends, &d->revolute[m->first], s.link)) return false;
    before = base_of(d);
    if (has_before && !take_motion(ends, &before, ACCELERATION_NUMBERS)) return false;
    accelerations(d, &s, at_rest, &before, ud);
    return !has_after || give_motion(ends, &s.motion[last], ACCELERATION_NUMBERS);
}

bool aba_revolute_part(struct dynamics *d, const real *q, const real *u, const real *tau,
                       const struct part_ends *ends, real *ud, bool *found, struct work *w)
{
    count(d, w);
    return d->at_rest ? part(d, true, q, u, tau, ends, ud, found)
                      : part(d, false, q, u, tau, ends, ud, found);
}

#endif
