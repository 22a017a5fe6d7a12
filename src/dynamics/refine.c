/* refine.c - how large a correction is (refine.h). */
#include "dynamics/refine.h"

#include <math.h>

double relative_size(int n, const real *x, const real *y)
{
    /* No correction with a number that is none is taken, wherever in it that stands. */
    double a = 0, b = 0;
    for (int i = 0; i < n; i++) {
        const double xi = (double)real_fabs(x[i]), yi = (double)real_fabs(y[i]);
        if (!(xi < INFINITY)) return INFINITY;
        if (xi > a) a = xi;
        if (yi > b) b = yi;
    }
    return b > 0 ? a / b : a > 0 ? 1 : 0;
}
