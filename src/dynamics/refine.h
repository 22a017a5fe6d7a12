/* refine.h - outer refinement: what inverse dynamics finds missing is solved for again. */
#ifndef DYNAMICS_REFINE_H
#define DYNAMICS_REFINE_H

#include "linalg/real.h"

/* relative_size: max |x| / max |y| of n numbers; 1 when y is 0 and x is not, infinite when x is not
 * finite. */
double relative_size(int n, const real *x, const real *y);

#endif
