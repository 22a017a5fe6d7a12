/* dense.h - operations on very small dense matrices, each adding what it did to the caller's
 * account.
 *
 * Matrices are row-major and contiguous; symmetric ones are packed by rows of the lower triangle
 * (packed_index). Factors are L D L^T with L unit lower triangular: packed like the matrix, 1/d_i
 * in place of the diagonal. That needs no square root and c divisions, and its operation count is
 * exactly the c(c+1)(2c+1)/6 of Cholesky's.
 *
 * Counts (one add, mul or div each):
 *     factor(c) = c(c+1)(2c+1)/6     triangular(c,m) = m c^2     product(a,b,k) = a b (2k-1)
 *     symmetric product(c,k) = c(c+1)/2 (2k-1) */
#ifndef LINALG_DENSE_H
#define LINALG_DENSE_H

#include <stdbool.h>

#include "base/work.h"
#include "linalg/real.h"

/* packed_index: place of element (i, j), i >= j, of a packed symmetric or lower triangular
 * matrix. */
static inline int packed_index(int i, int j) { return i * (i + 1) / 2 + j; }

/* packed_size: number of stored elements of a packed matrix of order c. */
static inline int packed_size(int c) { return c * (c + 1) / 2; }

/* Operation counts of the small operators, for estimates and accounts. */
static inline int dense_factor_flops(int c) { return c * (c + 1) * (2 * c + 1) / 6; }
static inline int dense_triangular_flops(int c, int m) { return m * c * c; }
static inline int dense_product_flops(int a, int b, int k)
{
    return k > 0 ? a * b * (2 * k - 1) : 0;
}
static inline int dense_symmetric_flops(int c, int k)
{
    return k > 0 ? c * (c + 1) / 2 * (2 * k - 1) : 0;
}

/* dense_factor: G = factor of the symmetric positive definite A, both packed of order c; G may be
 * A.
 *
 *   Returns  false when a pivot is not positive; G is then unusable
 *   Cost     factor(c), c of them divisions, one call */
bool dense_factor(int c, const real *A, real *G, struct work *w);

/* dense_forward: B <- L^-1 B, in place; B is (c x m). Cost: with dense_scale triangular(c,m). One
 * call. */
void dense_forward(int c, int m, const real *G, real *B, struct work *w);

/* dense_scale: B <- D^-1 B, in place; B is (c x m). Cost: c m. */
void dense_scale(int c, int m, const real *G, real *B, struct work *w);

/* dense_backward: B <- L^-T B, in place; B is (c x m). Cost: c (c-1) m. One call. */
void dense_backward(int c, int m, const real *G, real *B, struct work *w);

/* dense_solve: B <- A^-1 B with the factor G of A; B is (c x m). Cost: 2 triangular(c,m) - c m. */
void dense_solve(int c, int m, const real *G, real *B, struct work *w);

/* dense_product: C = A B; A (a x k), B (k x b), C (a x b) distinct from both. Cost: product(a,b,k).
 * One call. */
void dense_product(int a, int b, int k, const real *A, const real *B, real *C, struct work *w);

/* dense_product_tn: C = A^T B; A (k x a), B (k x b), C (a x b). Cost: product(a,b,k). One call. */
void dense_product_tn(int a, int b, int k, const real *A, const real *B, real *C, struct work *w);

/* dense_subtract: a <- a - b, n elements. Cost: n. */
void dense_subtract(int n, real *a, const real *b, struct work *w);

/* dense_invert: A <- A^-1 in place, any A (c x c) whose leading minors do not vanish (Gauss-Jordan
 * without interchanges, safe for positive definite A).
 *
 *   Returns  false when a pivot is zero or not finite
 *   Cost     2 c^3, c of them divisions, as a general inverse is charged; one call */
bool dense_invert(int c, real *A, struct work *w);

/* dense_solve_general: B <- A^-1 B by elimination with partial pivoting; A (n x n) is destroyed, B
 * (n x m).
 *
 *   Returns  false when A is singular to working precision
 *   Cost     2/3 n^3 + 2 n^2 m, rounded down, n of them divisions; one call */
bool dense_solve_general(int n, int m, real *A, real *B, struct work *w);

#endif
