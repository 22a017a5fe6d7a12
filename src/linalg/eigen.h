/* eigen.h - eigenvalues and vectors of small symmetric matrices by cyclic Jacobi rotations.
 *
 * Slow but as accurate as the matrix allows, and the same bits everywhere; for orders up to a few
 * dozen. Source: Golub and Van Loan, Matrix Computations, section 8.5. */
#ifndef LINALG_EIGEN_H
#define LINALG_EIGEN_H

#include "base/work.h"
#include "linalg/real.h"

/* eigen_symmetric: A = V diag(w) V^T.
 *
 *   n  in   order, >= 0
 *   a  in   (n x n) row-major, symmetric; destroyed
 *   v  out  (n x n) eigenvectors in columns; NULL: not wanted
 *   w  out  (n) eigenvalues, not sorted
 *
 *   Returns the number of sweeps (usually 4 to 8; it stops at 60). Cost about 6 n^3 flops a sweep;
 * what the rotations that were needed took is added to *done */
int eigen_symmetric(int n, real *a, real *v, real *w, struct work *done);

#endif
