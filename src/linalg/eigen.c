/* eigen.c - cyclic Jacobi.
 *
 * For the few constraints of closed loops (physics 7.4): n is small, the eigenvectors are wanted,
 * and Jacobi finds small eigenvalues of a scaled definite matrix to high relative accuracy (Demmel
 * and Veselic 1992), which decides the rank. O(n^3) a sweep, converging quadratically. */
#include "linalg/eigen.h"

#include <stddef.h>

/* Tangent, sine and cosine of the rotation that makes a_pq zero (Golub and Van Loan, section 8.5):
 * of the two angles the smaller one, which makes the iteration converge. */
enum { ROTATION_FLOP = 2 + 3 + 2 + 1, ROTATION_DIV = 3, ROTATION_SQRT = 2 };
static void rotation(real app, real aqq, real apq, real *s, real *c)
{
    real theta = (aqq - app) / (2 * apq);
    real t = 1 / (real_fabs(theta) + real_sqrt(theta * theta + 1));
    if (theta < 0) t = -t;
    *c = 1 / real_sqrt(t * t + 1);
    *s = t * *c;
}

/* Rotate rows/columns at offsets: x <- c x - s y, y <- s x + c y, over n elements with the given
 * stride: 1 for rows, n for columns. */
enum { ROTATE_FLOP = 6 }; /* an element */
static void rotate(int n, real *x, real *y, int stride, real s, real c)
{
    for (int k = 0; k < n; k++) {
        real a = x[k * stride], b = y[k * stride];
        x[k * stride] = c * a - s * b;
        y[k * stride] = s * a + c * b;
    }
}

/* One sweep; returns the number of rotations that were not negligible. */
static int sweep(int n, real *a, real *v, struct work *work)
{
    int done = 0;
    for (int p = 0; p < n - 1; p++)
        for (int q = p + 1; q < n; q++) {
            real apq = a[p * n + q], scale = real_fabs(a[p * n + p]) + real_fabs(a[q * n + q]);
            work->flop += apq == 0 ? 1 : 3;
            /* Negligible: a hundredth of it would not change the sum of the diagonal elements. */
            if (apq == 0 || (scale + real_fabs(apq) * (real)0.01 == scale && scale > 0)) continue;
            real s, c;
            rotation(a[p * n + p], a[q * n + q], apq, &s, &c);
            rotate(n, a + p, a + q, n, s, c);
            rotate(n, a + p * n, a + q * n, 1, s, c);
            if (v) rotate(n, v + p, v + q, n, s, c);
            /* Zero but for rounding: made so, or the test above would see the rest again. */
            a[p * n + q] = a[q * n + p] = 0;
            work->flop += (uint64_t)(ROTATION_FLOP + (v ? 3 : 2) * ROTATE_FLOP * n);
            work->div += ROTATION_DIV;
            work->sqrt += ROTATION_SQRT;
            done++;
        }
    return done;
}

int eigen_symmetric(int n, real *a, real *v, real *w, struct work *done)
{
    int sweeps = 0;
    if (v)
        for (int i = 0; i < n * n; i++) v[i] = i % (n + 1) == 0;
    /* Ends when a sweep had nothing to rotate; 60 sweeps mean numbers that are none. */
    while (sweeps < 60 && sweep(n, a, v, done) > 0) sweeps++;
    for (int i = 0; i < n; i++) w[i] = a[i * n + i];
    return sweeps;
}
