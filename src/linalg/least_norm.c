/* least_norm.c - by scaling and eigenvalues: physics (7.7).
 *
 * Scaled by the reference (the diagonal of A_ll), not by the diagonal of S: S is a difference,
 * whose own diagonal may be nothing but rounding error, and scaling by that would make noise look
 * like full rank. */
#include "linalg/least_norm.h"

#include "linalg/eigen.h"

/* Eigenvalues below this share of the largest are redundant constraints. */
#if REAL_BITS == 32
static const real tolerance = 1e-4f;
#else
static const real tolerance = (real)1e-10;
#endif

int least_norm_solve(int n, const real *reference, real *s, real *r, real *scratch, struct work *w)
{
    real *v = scratch, *value = v + n * n, *y = value + n, largest = 1;
    int rank = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            s[i * n + j] /= real_sqrt(reference[i]) * real_sqrt(reference[j]);
    /* V^T (d S d) V = diag(value). */
    eigen_symmetric(n, s, v, value, w);
    /* At least 1, the size of a scaled matrix without cancellation. */
    for (int k = 0; k < n; k++) largest = value[k] > largest ? value[k] : largest;
    for (int i = 0; i < n; i++) r[i] /= real_sqrt(reference[i]);
    for (int k = 0; k < n; k++) {
        y[k] = 0;
        /* A redundant direction: its component of the solution is zero, which makes the norm
         * least. */
        if (!(value[k] > tolerance * largest)) continue;
        for (int i = 0; i < n; i++) y[k] += v[i * n + k] * r[i];
        y[k] /= value[k];
        rank++;
    }
    for (int i = 0; i < n; i++) {
        /* Back to the original variables: lambda = d V y. */
        r[i] = 0;
        for (int k = 0; k < n; k++) r[i] += v[i * n + k] * y[k];
        r[i] /= real_sqrt(reference[i]);
    }
    uint64_t m = (uint64_t)n;
    w->flop += m * m + m + 2 * m * (uint64_t)rank + 2 * m * m; /* scaling, comparing, y, x */
    w->div += m * m + 2 * m + (uint64_t)rank;
    w->sqrt += 2 * m * m + 2 * m;
    w->call++;
    return rank;
}
