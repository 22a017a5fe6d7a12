/* planar.h - 3-vectors of the plane and its transforms, inline: what spatial.h is for space.
 *
 * A vector is [about the normal; x, y], components in one body's planar frame, taken at that
 * frame's origin. A transform is a turn by the angle with cosine c and sine s, and p from the
 * parent's origin to the child's, in parent components. Names and contracts are those of spatial.h,
 * so that programs written for both spaces compile with either. */
#ifndef LINALG_PLANAR_H
#define LINALG_PLANAR_H

#include "linalg/real.h"
#include "linalg/space.h"

/* 4 numbers, 32 bytes in double: this is what scans send. */
struct xform {
    real c, s;
    real p[2];
};

enum {
    XFORM_NUMBERS = 4,
    XFORM_FORCE_FLOP = 10,
    XFORM_MOTION_FLOP = 10,
    XFORM_SLIDE_FLOP = 6,
    XFORM_COMPOSE_FLOP = 14,
    SCREW_ADD_FLOP = 3,
    SCREW_DOT_FLOP = 5,
    SCREW_AXPY_FLOP = 6
};

/* screw_copy: y = x. screw_zero: y = 0. screw_add: y += x. screw_sub: y -= x. screw_axpy: y += a
 * x. */
static inline void screw_copy(real *y, const real *x) { y[0] = x[0], y[1] = x[1], y[2] = x[2]; }
static inline void screw_zero(real *y) { y[0] = y[1] = y[2] = 0; }
static inline void screw_add(real *y, const real *x) { y[0] += x[0], y[1] += x[1], y[2] += x[2]; }
static inline void screw_sub(real *y, const real *x) { y[0] -= x[0], y[1] -= x[1], y[2] -= x[2]; }
static inline void screw_axpy(real *y, real a, const real *x)
{
    y[0] += a * x[0], y[1] += a * x[1], y[2] += a * x[2];
}

/* screw_dot: x^T y. */
static inline real screw_dot(const real *x, const real *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/* xform_identity: no turn, no shift. */
static inline void xform_identity(struct xform *x) { *x = (struct xform){.c = 1}; }

/* xform_force: y = X f, child -> parent: f' = r f, n' = n + p x f'; 6 + 4 flops. y may be f. */
static inline void xform_force(real *y, const struct xform *x, const real *f)
{
    const real fx = x->c * f[1] - x->s * f[2], fy = x->s * f[1] + x->c * f[2];
    y[0] = f[0] + (x->p[0] * fy - x->p[1] * fx);
    y[1] = fx;
    y[2] = fy;
}

/* xform_motion: y = X^T v, parent -> child: w' = w, v' = r^T (v + w x p); 4 + 6 flops. y may be
 * v. */
static inline void xform_motion(real *y, const struct xform *x, const real *v)
{
    const real vx = v[1] - v[0] * x->p[1], vy = v[2] + v[0] * x->p[0];
    y[0] = v[0];
    y[1] = x->c * vx + x->s * vy;
    y[2] = x->c * vy - x->s * vx;
}

/* xform_slide: y = X^T v of a motion v without angular part: v' = r^T v; 6 flops. y may be v. */
static inline void xform_slide(real *y, const struct xform *x, const real *v)
{
    const real vx = v[1], vy = v[2];
    y[0] = 0;
    y[1] = x->c * vx + x->s * vy;
    y[2] = x->c * vy - x->s * vx;
}

/* xform_shift: p (2) = r (a, b) + the transform's own p; 8 flops. */
static inline void xform_shift(const struct xform *x, real a, real b, real *p)
{
    p[0] = x->p[0] + (x->c * a - x->s * b);
    p[1] = x->p[1] + (x->s * a + x->c * b);
}

/* xform_compose: c = a o b, i.e. X_c = X_a X_b; 6 + 8 flops. c may be neither a nor b. */
static inline void xform_compose(struct xform *c, const struct xform *a, const struct xform *b)
{
    c->c = a->c * b->c - a->s * b->s;
    c->s = a->s * b->c + a->c * b->s;
    xform_shift(a, b->p[0], b->p[1], c->p);
}

/* xform_factors: zeroed `shift`, `turn` (3 x 3) become those whose product is X as a matrix. */
static inline void xform_factors(const struct xform *x, real *shift, real *turn)
{
    shift[0] = shift[4] = shift[8] = turn[0] = 1;
    shift[1] = -x->p[1], shift[2] = x->p[0];
    turn[4] = turn[8] = x->c;
    turn[5] = -x->s, turn[7] = x->s;
}

#endif
