/* angle.c - sines and cosines of many angles at once, in wide registers where the host has them.
 *
 * Four angles are one vector, in two registers of two doubles or in one of four: it is compiled for
 * both, and one is chosen where it runs. Every element sees the operations of angle_sincos_core in
 * the same order, none of them contracted, so the bits depend neither on the choice nor on the
 * place of an angle among the others. */
#include "linalg/angle.h"

#if REAL_BITS == 64

#include <stdint.h>
#include <string.h>

#include "base/processor.h"

enum { LANES = 4 };
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t masks __attribute__((vector_size(8 * LANES)));

/* a where the mask is set, b elsewhere: by bits, so that nothing is rounded. */
#define SELECT(mask, a, b) ((lanes)(((masks)(a) & (mask)) | ((masks)(b) & ~(mask))))

/* angle_sincos_core of four angles. Always inline: the caller decides for which registers. */
static inline __attribute__((always_inline)) void sincos_four(const double *from, double *to_s,
                                                              double *to_c)
{
    const double shifter = 6755399441055744.0; /* 1.5 * 2^52: adding it rounds to an integer */
    lanes x;
    memcpy(&x, from, sizeof x);
    /* The reduction by pi/2 in three pieces. */
    const lanes n = (x * 6.36619772367581382433e-01 + shifter) - shifter;
    const lanes t = x - n * 1.57079632673412561417e+00;
    lanes w = n * 6.07710050630396597660e-11;
    const lanes r = t - w;
    w = n * 2.02226624879595063154e-21 - ((t - r) - w);
    const lanes y0 = r - w, y1 = (r - y0) - w, z = y0 * y0, v = z * y0;
    /* Both polynomials for all: which one is wanted differs from lane to lane. */
    const lanes p = 8.33333333332248946124e-03 +
                    z * (-1.98412698298579493134e-04 +
                         z * (2.75573137070700676789e-06 +
                              z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    const lanes sine = y0 - ((z * (0.5 * y1 - v * p) - y1) - v * -1.66666666666666324348e-01);
    const lanes q =
        z * (4.16666666666666019037e-02 +
             z * (-1.38888888888741095749e-03 +
                  z * (2.48015872894767294178e-05 +
                       z * (-2.75573143513906633035e-07 +
                            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    const lanes half = 0.5 * z, one = 1.0 - half;
    const lanes cosine = one + (((1.0 - one) - half) + (z * q - y0 * y1));
    /* The quadrant: swapped where it is odd, signs by arithmetic. */
    const lanes m = n - 4.0 * ((n * 0.25 + shifter) - shifter);
    const lanes plus = {1, 1, 1, 1}, minus = -plus;
    const masks odd = m * m == 1.0, opposite = (m == 2.0) | (m == -2.0);
    const lanes s = SELECT((m == -1.0) | opposite, minus, plus) * SELECT(odd, cosine, sine);
    const lanes c = SELECT((m == 1.0) | opposite, minus, plus) * SELECT(odd, sine, cosine);
    memcpy(to_s, &s, sizeof s);
    memcpy(to_c, &c, sizeof c);
}

/* Whole vectors; the last one overlaps the one before it, whose results it makes again. n >= LANES.
 */
#define SINCOS_ALL(n, x, s, c)                                                                     \
    for (int i = 0; i + LANES < n; i += LANES) sincos_four(&x[i], &s[i], &c[i]);                   \
    sincos_four(&x[n - LANES], &s[n - LANES], &c[n - LANES])

typedef void sincos_fn(int n, const double *restrict x, double *restrict s, double *restrict c);

/* What every host of this kind has: two doubles on x86-64. */
static void sincos_usual(int n, const double *restrict x, double *restrict s, double *restrict c)
{
    SINCOS_ALL(n, x, s, c);
}

#ifdef __x86_64__
__attribute__((target("avx2"))) static void sincos_avx2(int n, const double *restrict x,
                                                        double *restrict s, double *restrict c)
{
    SINCOS_ALL(n, x, s, c);
}
#endif

/* The widest that this host has; a look at what the start of the program found out. */
static sincos_fn *widest(void)
{
#ifdef __x86_64__
    if (processor_has_avx2()) return sincos_avx2;
#endif
    return sincos_usual;
}

#endif

void angle_sincos_batch(int n, const real *restrict x, real *restrict s, real *restrict c)
{
    real largest = 0;
    /* One test for all angles, so that vectors have no branch. A "not a number" is never larger,
     * and comes out as one. */
    for (int i = 0; i < n; i++) largest = real_fabs(x[i]) > largest ? real_fabs(x[i]) : largest;
#if REAL_BITS == 64
    if (largest <= ANGLE_REDUCED && n >= LANES) {
        widest()(n, x, s, c);
        return;
    }
#endif
    for (int i = 0; i < n; i++) angle_sincos(x[i], &s[i], &c[i]);
}
