/* vec3.h - vectors of three, 3x3 matrices (row-major) and symmetric 3x3 matrices (six numbers) of
 * `real`.
 *
 * A symmetric matrix is stored as xx, xy, xz, yy, yz, zz. Outputs come first and may not overlap
 * inputs unless the comment allows it. Each operation's flops are in the constant under it. */
#ifndef LINALG_VEC3_H
#define LINALG_VEC3_H

#include "linalg/real.h"

/* vec3_set: y = (a, b, c). vec3_zero: y = 0. vec3_copy: y = x. */
static inline void vec3_set(real *y, real a, real b, real c) { y[0] = a, y[1] = b, y[2] = c; }
static inline void vec3_zero(real *y) { y[0] = y[1] = y[2] = REAL(0); }
static inline void vec3_copy(real *y, const real *x) { y[0] = x[0], y[1] = x[1], y[2] = x[2]; }

/* vec3_add: y += x. vec3_sub: y -= x. vec3_scale: y = a x; y may be x. */
enum { VEC3_ADD_FLOP = 3, VEC3_SCALE_FLOP = 3, VEC3_DOT_FLOP = 5, VEC3_CROSS_FLOP = 9 };
static inline void vec3_add(real *y, const real *x) { y[0] += x[0], y[1] += x[1], y[2] += x[2]; }
static inline void vec3_sub(real *y, const real *x) { y[0] -= x[0], y[1] -= x[1], y[2] -= x[2]; }
static inline void vec3_scale(real *y, real a, const real *x)
{
    y[0] = a * x[0], y[1] = a * x[1], y[2] = a * x[2];
}

/* vec3_dot: x . y. vec3_norm: |x|. */
static inline real vec3_dot(const real *x, const real *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
static inline real vec3_norm(const real *x) { return real_sqrt(vec3_dot(x, x)); }

/* vec3_cross: z = x x y; z may be x or y. */
static inline void vec3_cross(real *z, const real *x, const real *y)
{
    real a = x[1] * y[2] - x[2] * y[1], b = x[2] * y[0] - x[0] * y[2],
         c = x[0] * y[1] - x[1] * y[0];
    vec3_set(z, a, b, c);
}

/* vec3_cross_add: z += x x y. vec3_cross_sub: z -= x x y. 12 flops each. */
enum { VEC3_CROSS_ADD_FLOP = 12 };
static inline void vec3_cross_add(real *z, const real *x, const real *y)
{
    z[0] += x[1] * y[2] - x[2] * y[1];
    z[1] += x[2] * y[0] - x[0] * y[2];
    z[2] += x[0] * y[1] - x[1] * y[0];
}
static inline void vec3_cross_sub(real *z, const real *x, const real *y)
{
    z[0] -= x[1] * y[2] - x[2] * y[1];
    z[1] -= x[2] * y[0] - x[0] * y[2];
    z[2] -= x[0] * y[1] - x[1] * y[0];
}

/* mat3_mul_vec: y = M x; y may be x. mat3_mul_vec_transposed: y = M^T x; y may be x. 15 flops
 * each. */
enum { MAT3_VEC_FLOP = 15, MAT3_MUL_FLOP = 45 };
static inline void mat3_mul_vec(real *y, const real *m, const real *x)
{
    real a = m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
    real b = m[3] * x[0] + m[4] * x[1] + m[5] * x[2];
    real c = m[6] * x[0] + m[7] * x[1] + m[8] * x[2];
    vec3_set(y, a, b, c);
}
static inline void mat3_mul_vec_transposed(real *y, const real *m, const real *x)
{
    real a = m[0] * x[0] + m[3] * x[1] + m[6] * x[2];
    real b = m[1] * x[0] + m[4] * x[1] + m[7] * x[2];
    real c = m[2] * x[0] + m[5] * x[1] + m[8] * x[2];
    vec3_set(y, a, b, c);
}

/* mat3_mul: C = A B. mat3_mul_transposed: C = A B^T. mat3_transposed_mul: C = A^T B. 45 flops
 * each. */
static inline void mat3_mul(real *c, const real *a, const real *b)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}
static inline void mat3_mul_transposed(real *c, const real *a, const real *b)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[3 * i + j] =
                a[3 * i] * b[3 * j] + a[3 * i + 1] * b[3 * j + 1] + a[3 * i + 2] * b[3 * j + 2];
}
static inline void mat3_transposed_mul(real *c, const real *a, const real *b)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[3 * i + j] = a[i] * b[j] + a[3 + i] * b[3 + j] + a[6 + i] * b[6 + j];
}

/* mat3_turn_z: r = E Rz for the turn's sine and cosine; MAT3_TURN_FLOP. */
enum { MAT3_TURN_FLOP = 18 };
static inline void mat3_turn_z(real *restrict r, const real *restrict e, real s, real c)
{
    for (int i = 0; i < 9; i += 3) {
        r[i] = c * e[i] + s * e[i + 1];
        r[i + 1] = c * e[i + 1] - s * e[i];
        r[i + 2] = e[i + 2];
    }
}

/* mat3_transpose: y = x^T. mat3_identity: y = U. mat3_skew: y = x~, so that y z = x x z. */
static inline void mat3_transpose(real *y, const real *x)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) y[3 * i + j] = x[3 * j + i];
}
static inline void mat3_identity(real *y)
{
    for (int i = 0; i < 9; i++) y[i] = REAL(i % 4 == 0);
}
static inline void mat3_skew(real *y, const real *x)
{
    y[0] = REAL(0), y[1] = -x[2], y[2] = x[1];
    y[3] = x[2], y[4] = REAL(0), y[5] = -x[0];
    y[6] = -x[1], y[7] = x[0], y[8] = REAL(0);
}

/* sym3_mul_vec: y = S x; y may be x. 15 flops. */
enum { SYM3_VEC_FLOP = 15 };
static inline void sym3_mul_vec(real *y, const real *s, const real *x)
{
    real a = s[0] * x[0] + s[1] * x[1] + s[2] * x[2];
    real b = s[1] * x[0] + s[3] * x[1] + s[4] * x[2];
    real c = s[2] * x[0] + s[4] * x[1] + s[5] * x[2];
    vec3_set(y, a, b, c);
}

/* sym3_expand: the full 3x3 of S. sym3_from_mat3: the upper triangle of M. */
static inline void sym3_expand(real *m, const real *s)
{
    m[0] = s[0], m[1] = m[3] = s[1], m[2] = m[6] = s[2];
    m[4] = s[3], m[5] = m[7] = s[4], m[8] = s[5];
}
static inline void sym3_from_mat3(real *s, const real *m)
{
    s[0] = m[0], s[1] = m[1], s[2] = m[2], s[3] = m[4], s[4] = m[5], s[5] = m[8];
}

/* sym3_rotate: S' = R S R^T, 45 + 30 flops. */
enum { SYM3_ROTATE_FLOP = 75 };
static inline void sym3_rotate(real *y, const real *r, const real *s)
{
    real m[9], full[9];
    sym3_expand(full, s);
    mat3_mul(m, r, full);
    y[0] = m[0] * r[0] + m[1] * r[1] + m[2] * r[2];
    y[1] = m[0] * r[3] + m[1] * r[4] + m[2] * r[5];
    y[2] = m[0] * r[6] + m[1] * r[7] + m[2] * r[8];
    y[3] = m[3] * r[3] + m[4] * r[4] + m[5] * r[5];
    y[4] = m[3] * r[6] + m[4] * r[7] + m[5] * r[8];
    y[5] = m[6] * r[6] + m[7] * r[7] + m[8] * r[8];
}

#endif
