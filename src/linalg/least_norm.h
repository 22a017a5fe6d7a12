/* least_norm.h - solution of smallest norm of a small symmetric positive semidefinite system, with
 * its rank. */
#ifndef LINALG_LEAST_NORM_H
#define LINALG_LEAST_NORM_H

#include "base/work.h"
#include "linalg/real.h"

/* least_norm_solve: x of smallest (scaled) norm that satisfies S x = r as far as S's range goes.
 *
 *   n          in       order, >= 0
 *   reference  in       (n) positive: what S's rounding errors scale with, the diagonal of the
 * block that S was reduced from. Never diag S itself, which may vanish s          in       (n x n)
 * row-major, symmetric; destroyed r          in/out   (n) right-hand side in, x out scratch scratch
 * (n x n + 2 n)
 *
 * With d = reference^-1/2, eigenvalues of diag(d) S diag(d) above 1e-10 max(largest, 1) count (1e-4
 * in float). Returns their number. Cost: the Jacobi rotations done, added to w. */
int least_norm_solve(int n, const real *reference, real *s, real *r, real *scratch, struct work *w);

#endif
