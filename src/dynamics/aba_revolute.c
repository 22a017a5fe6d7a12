/* aba_revolute.c - articulated bodies for all-revolute systems, 629 flops a body.
 *
 * The articulated inertia [A B; B^T C] is symmetric by storage. After its joint is eliminated, row
 * z of A and B is zero exactly, and so is the force p along it but for tau: none of that is
 * computed. */
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

/* The three sweeps. Called with a constant `at_rest`, so that each case is compiled alone. */
static inline bool sweep(struct dynamics *d, bool at_rest, const real *q, const real *u,
                         const real *tau, real *ud)
{
    int n = d->nbody;
    real *sine = d->scratch, *cosine = sine + n;
    struct link *link = (struct link *)(cosine + n);
    struct motion *motion = (struct motion *)(link + n), base;
    /* The base does not turn. */
    vec3_zero(base.w);
    /* All angles in one loop that compilers turn into vectors. */
    angle_sincos_batch(n, q, sine, cosine);
    for (int i = 0; i < n; i++) {
        const struct revolute *b = &d->revolute[i];
        struct link *l = &link[i];
        mat3_turn_z(l->r, b->e, sine[i], cosine[i]);
        if (at_rest) vec3_zero(l->n), vec3_zero(l->f);
        else start(b, u[i], b->parent < 0 ? base.w : motion[b->parent].w, motion[i].w, l);
        rigid(b, l);
        if (d->load) {
            vec3_sub(l->n, d->load + 6 * i);
            vec3_sub(l->f, d->load + 6 * i + 3);
        }
    }
    /* Tip to base: a body has all its children's parts before it gives way itself. */
    for (int i = n - 1; i >= 0; i--) {
        const struct revolute *b = &d->revolute[i];
        if (!eliminate(&link[i], at_rest, tau[i])) return false;
        if (b->parent >= 0) hand_down(b, &link[i], &link[b->parent]);
    }
    /* From here on `motion` holds accelerations, and that of the base contains -g (physics 1.6). */
    vec3_copy(base.w, d->base);
    vec3_copy(base.v, d->base + 3);
    for (int i = 0; i < n; i++) {
        const struct revolute *b = &d->revolute[i];
        ud[i] = accelerate(b, &link[i], at_rest, b->parent < 0 ? &base : &motion[b->parent],
                           &motion[i]);
    }
    return true;
}

/* The rest state is compiled apart: no branch on it stands in the sweeps. */
bool aba_revolute(struct dynamics *d, const real *q, const real *u, const real *tau, real *ud,
                  struct work *w)
{
    const int body = MAT3_TURN_FLOP + RIGID_FLOP + (d->load ? SCREW_ADD_FLOP : 0);
    const int moving = d->at_rest ? ELIMINATE_AT_REST_FLOP + ACCELERATE_AT_REST_FLOP
                                  : START_FLOP + ELIMINATE_FLOP + ACCELERATE_FLOP;
    revolute_count(
        d, (struct revolute_cost){.body = body + moving, .child = HAND_DOWN_FLOP, .div = 1}, w);
    return d->at_rest ? sweep(d, true, q, u, tau, ud) : sweep(d, false, q, u, tau, ud);
}
