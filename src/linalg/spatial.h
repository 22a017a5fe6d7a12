/* spatial.h - 6-vectors and structured transforms, inline, in the build's precision; inertias are
 * in inertia.h.
 *
 * A spatial vector is [angular; linear], components in one body's frame, taken at that frame's
 * origin. A transform is a pair (r, p): r turns child components into parent components, p runs
 * from the parent's origin to the child's, in parent components. It moves forces child -> parent;
 * its transpose moves motions parent -> child. The constants
 * *_FLOP are what each function executes (additions and multiplications). */
#ifndef LINALG_SPATIAL_H
#define LINALG_SPATIAL_H

#include "linalg/real.h"
#include "linalg/space.h"
#include "linalg/vec3.h"

/* 12 numbers, 96 bytes in double: this is what scans send. */
struct xform {
    real r[9]; /* (3 x 3) row-major rotation */
    real p[3];
};

enum {
    XFORM_NUMBERS = 12,
    XFORM_FORCE_FLOP = 42,
    XFORM_MOTION_FLOP = 42,
    XFORM_SLIDE_FLOP = 15,
    XFORM_COMPOSE_FLOP = 63,
    XFORM_INVERSE_FLOP = 18,
    SCREW_ADD_FLOP = 6,
    SCREW_DOT_FLOP = 11,
    SCREW_AXPY_FLOP = 12
};

/* screw_copy: y = x. screw_zero: y = 0. screw_add: y += x. screw_sub: y -= x. screw_axpy: y += a x
 * (12 flops). */
static inline void screw_copy(real *y, const real *x)
{
    for (int i = 0; i < 6; i++) y[i] = x[i];
}
static inline void screw_zero(real *y)
{
    for (int i = 0; i < 6; i++) y[i] = REAL(0);
}
static inline void screw_add(real *y, const real *x)
{
    for (int i = 0; i < 6; i++) y[i] += x[i];
}
static inline void screw_sub(real *y, const real *x)
{
    for (int i = 0; i < 6; i++) y[i] -= x[i];
}
static inline void screw_axpy(real *y, real a, const real *x)
{
    for (int i = 0; i < 6; i++) y[i] += a * x[i];
}

/* screw_dot: x^T y. */
static inline real screw_dot(const real *x, const real *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + x[3] * y[3] + x[4] * y[4] + x[5] * y[5];
}

/* xform_identity: (U, 0). */
static inline void xform_identity(struct xform *x)
{
    mat3_identity(x->r);
    vec3_zero(x->p);
}

/* xform_force: y = X f, child -> parent: f' = r f, n' = r n + p x f' (physics of screws; 42 flops).
 * y may be f. */
static inline void xform_force(real *y, const struct xform *x, const real *f)
{
    real g[3], n[3];
    mat3_mul_vec(g, x->r, f + 3);
    mat3_mul_vec(n, x->r, f);
    vec3_cross_add(n, x->p, g);
    vec3_copy(y, n);
    vec3_copy(y + 3, g);
}

/* xform_motion: y = X^T v, parent -> child: w' = r^T w, v' = r^T (v + w x p); 42 flops. y may be
 * v. */
static inline void xform_motion(real *y, const struct xform *x, const real *v)
{
    real t[3];
    vec3_copy(t, v + 3);
    vec3_cross_add(t, v, x->p);
    mat3_mul_vec_transposed(y, x->r, v);
    mat3_mul_vec_transposed(y + 3, x->r, t);
}

/* xform_slide: y = X^T v of a motion v without angular part: v' = r^T v; 15 flops. y may be v. */
static inline void xform_slide(real *y, const struct xform *x, const real *v)
{
    real t[3];
    mat3_mul_vec_transposed(t, x->r, v + 3);
    vec3_zero(y);
    vec3_copy(y + 3, t);
}

/* xform_compose: c = a o b, i.e. X_c = X_a X_b: (ra rb, pa + ra pb); 63 flops. c may be neither a
 * nor b. */
static inline void xform_compose(struct xform *c, const struct xform *a, const struct xform *b)
{
    mat3_mul(c->r, a->r, b->r);
    mat3_mul_vec(c->p, a->r, b->p);
    vec3_add(c->p, a->p);
}

/* xform_factors: zeroed `shift`, `turn` (6 x 6) become those whose product is X as a matrix: [U p~;
 * 0 U] [r 0; 0 r]. */
static inline void xform_factors(const struct xform *x, real *shift, real *turn)
{
    for (int i = 0; i < 6; i++) shift[7 * i] = REAL(1);
    shift[4] = -x->p[2], shift[5] = x->p[1], shift[9] = x->p[2];
    shift[11] = -x->p[0], shift[15] = -x->p[1], shift[16] = x->p[0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) turn[6 * i + j] = turn[6 * (i + 3) + j + 3] = x->r[3 * i + j];
}

/* xform_inverse: y = x^-1 = (r^T, -r^T p). */
static inline void xform_inverse(struct xform *y, const struct xform *x)
{
    real p[3];
    mat3_mul_vec_transposed(p, x->r, x->p);
    mat3_transpose(y->r, x->r);
    vec3_set(y->p, -p[0], -p[1], -p[2]);
}

#endif
