/* cholesky.h - dense symmetric positive definite systems of any size. */
#ifndef LINALG_CHOLESKY_H
#define LINALG_CHOLESKY_H

#include <stdbool.h>

#include "base/arena.h"
#include "linalg/real.h"

/* cholesky_factor: the lower triangle of m (n x n, row-major) becomes its factor, in place; false
 * when a pivot is not positive. cholesky_solve: x (n) becomes m^-1 x by that factor. */
bool cholesky_factor(int n, real *m);
void cholesky_solve(int n, const real *m, real *x);

/* cholesky_answer: x (n) becomes m^-1 x; both triangles of m are read, and it is written over;
 * false when a pivot is not positive. In quad precision the factor of double precision is tried,
 * with the residual in quad (Wilkinson 1963; Higham, Accuracy and Stability, chapter 12): the
 * answer is then good to 1e-20 of its largest number, far more than the doubles in which answers
 * leave, for n^2 quad operations a correction instead of n^3 / 3. */
bool cholesky_answer(int n, real *m, real *x, struct arena *scratch);

#endif
