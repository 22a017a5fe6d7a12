/* inertia.h - inertias of rigid bodies and symmetric 6x6 matrices, inline, in the build's
 * precision.
 *
 * Conventions as in spatial.h; accelerations are classical (of the frame's origin). */
#ifndef LINALG_INERTIA_H
#define LINALG_INERTIA_H

#include "linalg/spatial.h"

/* A rigid body about its frame's origin: mass, first moment m s, rotational inertia J - m s~ s~
 * (vec3.h order). */
struct inertia {
    real m, ms[3], j[6];
};

/* A symmetric 6x6 [a b; b^T c]: articulated inertias, inverse inertias. 21 numbers, symmetric by
 * construction. */
struct sym6 {
    real a[6]; /* angular-angular, symmetric */
    real b[9]; /* (3 x 3) angular-linear */
    real c[6]; /* linear-linear, symmetric */
};

enum {
    INERTIA_MUL_FLOP = 42,
    INERTIA_GYRO_FLOP = 42,
    SYM6_MUL_FLOP = 66,
    SYM6_ADD_FLOP = 21,
    SYM6_MOVE_FLOP = 324 /* 75 + 75 + 90 rotate, 36 + 48 shift */
};

/* inertia_mul: f = I v for a rigid body: n = J w + ms x v, f = m v + w x ms; 42 flops. f may not be
 * v. */
static inline void inertia_mul(real *f, const struct inertia *in, const real *v)
{
    sym3_mul_vec(f, in->j, v);
    vec3_cross_add(f, in->ms, v + 3);
    vec3_scale(f + 3, in->m, v + 3);
    vec3_cross_add(f + 3, v, in->ms);
}

/* inertia_gyro: velocity-dependent force with classical acceleration: P = [w x J w; w x (w x ms)];
 * 42 flops.
 *
 *   w   in   (3) angular velocity
 *   f   out  (6) */
static inline void inertia_gyro(real *f, const struct inertia *in, const real *w)
{
    real t[3];
    sym3_mul_vec(t, in->j, w);
    vec3_cross(f, w, t);
    vec3_cross(t, w, in->ms);
    vec3_cross(f + 3, w, t);
}

/* inertia_move: *y = X I X^T, the body's inertia in the parent frame. inertia_add: *y += *x. */
enum { INERTIA_MOVE_FLOP = 123, INERTIA_ADD_FLOP = 10 };
static inline void inertia_move(struct inertia *y, const struct xform *x, const struct inertia *in)
{
    /* J' = r J r^T - [h~ p~ + p~ h~] - m p~ p~ with h = r ms; written through g = 2 h + m p: p~ g~
     * symmetrised. */
    real h[3], g[3];
    const real *p = x->p;
    sym3_rotate(y->j, x->r, in->j);
    mat3_mul_vec(h, x->r, in->ms);
    y->m = in->m;
    for (int i = 0; i < 3; i++) {
        real mp = in->m * p[i];
        y->ms[i] = h[i] + mp;
        g[i] = h[i] + h[i] + mp;
    }
    real hxy = h[0] * p[1] + y->ms[1] * p[0], hxz = h[0] * p[2] + y->ms[2] * p[0],
         hyz = h[1] * p[2] + y->ms[2] * p[1];
    real xx = p[0] * g[0], yy = p[1] * g[1], zz = p[2] * g[2];
    y->j[0] += yy + zz, y->j[3] += xx + zz, y->j[5] += xx + yy;
    y->j[1] -= hxy, y->j[2] -= hxz, y->j[4] -= hyz;
}
static inline void inertia_add(struct inertia *y, const struct inertia *x)
{
    y->m += x->m;
    vec3_add(y->ms, x->ms);
    for (int i = 0; i < 6; i++) y->j[i] += x->j[i];
}

/* sym6_mul: y = S x; 66 flops. y may not be x. */
static inline void sym6_mul(real *y, const struct sym6 *s, const real *x)
{
    real t[3];
    sym3_mul_vec(y, s->a, x);
    mat3_mul_vec(t, s->b, x + 3);
    vec3_add(y, t);
    mat3_mul_vec_transposed(y + 3, s->b, x);
    sym3_mul_vec(t, s->c, x + 3);
    vec3_add(y + 3, t);
}

/* sym6_from_inertia: the 6x6 [J, ms~; -ms~, m U]. */
static inline void sym6_from_inertia(struct sym6 *s, const struct inertia *in)
{
    for (int i = 0; i < 6; i++) s->a[i] = in->j[i], s->c[i] = REAL(0);
    mat3_skew(s->b, in->ms);
    s->c[0] = s->c[3] = s->c[5] = in->m;
}

/* sym6_expand: the full matrix, (6 x 6) row-major. */
static inline void sym6_expand(real *m, const struct sym6 *s)
{
    static const signed char at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            m[6 * i + j] = s->a[at[3 * i + j]];
            m[6 * i + 3 + j] = m[6 * (3 + j) + i] = s->b[3 * i + j];
            m[6 * (3 + i) + 3 + j] = s->c[at[3 * i + j]];
        }
}

/* sym6_add: *y += *x, 21 flops. */
static inline void sym6_add(struct sym6 *y, const struct sym6 *x)
{
    for (int i = 0; i < 6; i++) y->a[i] += x->a[i], y->c[i] += x->c[i];
    for (int i = 0; i < 9; i++) y->b[i] += x->b[i];
}

/* mat3_add_skew_mul_sym3: d = b + p~ C for a symmetric C; 36 flops. d may not be b. */
static inline void mat3_add_skew_mul_sym3(real *d, const real *b, const real *p, const real *c)
{
    d[0] = b[0] + (p[1] * c[2] - p[2] * c[1]), d[1] = b[1] + (p[1] * c[4] - p[2] * c[3]);
    d[2] = b[2] + (p[1] * c[5] - p[2] * c[4]), d[3] = b[3] + (p[2] * c[0] - p[0] * c[2]);
    d[4] = b[4] + (p[2] * c[1] - p[0] * c[4]), d[5] = b[5] + (p[2] * c[2] - p[0] * c[5]);
    d[6] = b[6] + (p[0] * c[1] - p[1] * c[0]), d[7] = b[7] + (p[0] * c[3] - p[1] * c[1]);
    d[8] = b[8] + (p[0] * c[4] - p[1] * c[2]);
}

/* sym6_move: *y = X S X^T, from the child frame to the parent frame; y may not be s.
 *
 *   Rotate the three blocks, then shift: b' = b + p~ c, a' = a - b' p~ + p~ b^T (symmetric). */
static inline void sym6_move(struct sym6 *y, const struct xform *x, const struct sym6 *s)
{
    real t[9], b[9];
    const real *p = x->p;
    sym3_rotate(y->a, x->r, s->a);
    sym3_rotate(y->c, x->r, s->c);
    mat3_mul(t, x->r, s->b);
    mat3_mul_transposed(b, t, x->r);
    const real *c = y->c;
    real *d = y->b;
    mat3_add_skew_mul_sym3(d, b, p, c);
    y->a[0] += (d[2] * p[1] - d[1] * p[2]) + (p[1] * b[2] - p[2] * b[1]);
    y->a[1] += (d[0] * p[2] - d[2] * p[0]) + (p[1] * b[5] - p[2] * b[4]);
    y->a[2] += (d[1] * p[0] - d[0] * p[1]) + (p[1] * b[8] - p[2] * b[7]);
    y->a[3] += (d[3] * p[2] - d[5] * p[0]) + (p[2] * b[3] - p[0] * b[5]);
    y->a[4] += (d[4] * p[0] - d[3] * p[1]) + (p[2] * b[6] - p[0] * b[8]);
    y->a[5] += (d[7] * p[0] - d[6] * p[1]) + (p[0] * b[7] - p[1] * b[6]);
}

#endif
