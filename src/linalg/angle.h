/* angle.h - sine and cosine with the same bits on every host: no run-time choice of operations as
 * in a libm.
 *
 * Double: reduction by pi/2 in three pieces (Cody and Waite), then the minimax polynomials of Sun's
 * fdlibm; errors under 1 ulp. Angles beyond ANGLE_REDUCED go to the C library. Other precisions use
 * their library. */
#ifndef LINALG_ANGLE_H
#define LINALG_ANGLE_H

#include "linalg/real.h"

#define ANGLE_REDUCED 1.0e6

#if REAL_BITS == 64

/* angle_sincos_core: branch-free, for |x| <= ANGLE_REDUCED, so that a loop over angles can be
 * vectorised. */
static inline void angle_sincos_core(double x, double *s, double *c)
{
    const double shifter = 6755399441055744.0; /* 1.5 * 2^52: adding it rounds to an integer */
    double n = (x * 6.36619772367581382433e-01 + shifter) - shifter;
    /* y0 + y1 = x - n pi/2; the first two products are exact (33-bit pieces). */
    double t = x - n * 1.57079632673412561417e+00;
    double w = n * 6.07710050630396597660e-11;
    double r = t - w;
    w = n * 2.02226624879595063154e-21 - ((t - r) - w);
    double y0 = r - w, y1 = (r - y0) - w, z = y0 * y0, v = z * y0;
    double p = 8.33333333332248946124e-03 +
               z * (-1.98412698298579493134e-04 +
                    z * (2.75573137070700676789e-06 +
                         z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    double sine = y0 - ((z * (0.5 * y1 - v * p) - y1) - v * -1.66666666666666324348e-01);
    double q =
        z * (4.16666666666666019037e-02 +
             z * (-1.38888888888741095749e-03 +
                  z * (2.48015872894767294178e-05 +
                       z * (-2.75573143513906633035e-07 +
                            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    double half = 0.5 * z, one = 1.0 - half;
    double cosine = one + (((1.0 - one) - half) + (z * q - y0 * y1));
    /* quadrant n mod 4: swap for odd n; signs by arithmetic, exactly: n = 4 k + m, m in -2 .. 2 */
    double m = n - 4.0 * ((n * 0.25 + shifter) - shifter);
    double odd = m * m == 1.0 ? 1.0 : 0.0;
    double sin_sign = (m == -1.0 || m == 2.0 || m == -2.0) ? -1.0 : 1.0;
    double cos_sign = (m == 1.0 || m == 2.0 || m == -2.0) ? -1.0 : 1.0;
    *s = sin_sign * (odd != 0.0 ? cosine : sine);
    *c = cos_sign * (odd != 0.0 ? sine : cosine);
}

#endif

#if REAL_LANES > 1

/* The batch of doubles (angle.c): an angle's bits do not depend on its place among others. */
static inline void angle_sincos_batch(int n, const real *x, real *s, real *c)
{
    void angle_sincos_batch_f64(int, const double *restrict, double *restrict, double *restrict);
    angle_sincos_batch_f64(n * REAL_LANES, (const double *)x, (double *)s, (double *)c);
}
static inline void angle_sincos(real x, real *s, real *c) { angle_sincos_batch(1, &x, s, c); }

#else

/* angle_sincos: *s = sin x, *c = cos x. */
static inline void angle_sincos(real x, real *s, real *c)
{
#if REAL_BITS == 64
    if (x >= -ANGLE_REDUCED && x <= ANGLE_REDUCED) {
        angle_sincos_core(x, s, c);
        return;
    }
#endif
    *s = real_sin(x);
    *c = real_cos(x);
}

/* angle_sincos_batch: s[i], c[i] of x[i], i = 0 .. n-1, in packed registers, the widest that the
 * host has; the same bits as angle_sincos of each. s, c may not overlap x. */
void angle_sincos_batch(int n, const real *restrict x, real *restrict s, real *restrict c);

#endif
#endif
