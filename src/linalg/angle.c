/* angle.c - sines and cosines of many angles at once. */
#include "linalg/angle.h"

void angle_sincos_batch(int n, const real *restrict x, real *restrict s, real *restrict c)
{
    real largest = 0;
    /* One test for all angles, so that the loop below has no branch and becomes vector code. A "not
     * a number" is never larger, and comes out of the loop as one. */
    for (int i = 0; i < n; i++) largest = real_fabs(x[i]) > largest ? real_fabs(x[i]) : largest;
#if REAL_BITS == 64
    if (largest <= ANGLE_REDUCED) {
        for (int i = 0; i < n; i++) angle_sincos_core(x[i], &s[i], &c[i]);
        return;
    }
#endif
    for (int i = 0; i < n; i++) angle_sincos(x[i], &s[i], &c[i]);
}
