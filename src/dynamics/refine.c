/* refine.c - how large a correction is (refine.h). */
#include "dynamics/refine.h"

double relative_size(int n, const real *x, const real *y)
{
    /* Not-a-number fails the first comparison and stays the largest: no correction with one is
     * taken. */
    double a = 0, b = 0;
    for (int i = 0; i < n; i++) {
        double xi = (double)real_fabs(x[i]), yi = (double)real_fabs(y[i]);
        if (!(xi <= a)) a = xi;
        if (yi > b) b = yi;
    }
    return b > 0 ? a / b : a > 0 ? 1 : 0;
}
