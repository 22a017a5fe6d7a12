/* dense.c - operations on very small dense matrices (dense.h).
 *
 * Columns of right-hand sides are the inner, contiguous dimension, so that compilers turn them into
 * vectors without changing the order of any sum. */
#include "linalg/dense.h"

#include <string.h>

/* account: add a count of which `div` are divisions, and one call. */
static void account(struct work *w, int flops, int div)
{
    w->flop += (uint64_t)(flops - div);
    w->div += (uint64_t)div;
    w->call++;
}

/* L D L^T by rows: each row is finished before the next begins, so that G may be A. */
bool dense_factor(int c, const real *A, real *G, struct work *w)
{
    account(w, dense_factor_flops(c), c);
    real row[8];
    for (int i = 0; i < c; i++) {
        real *g = G + packed_index(i, 0);
        for (int j = 0; j <= i; j++) row[j] = A[packed_index(i, j)];
        /* row_j becomes l_ij d_j, then g_j = l_ij */
        for (int j = 0; j < i; j++) {
            const real *gj = G + packed_index(j, 0);
            for (int k = 0; k < j; k++) row[j] -= row[k] * gj[k];
        }
        real pivot = row[i];
        for (int j = 0; j < i; j++) {
            g[j] = row[j] * G[packed_index(j, j)];
            pivot -= row[j] * g[j];
        }
        /* Not positive definite, or not a number. */
        if (!real_all(pivot > 0)) return false;
        g[i] = 1 / pivot;
    }
    return true;
}

/* B <- L^-1 B with a unit diagonal: rows from the top. */
void dense_forward(int c, int m, const real *G, real *B, struct work *w)
{
    account(w, c * (c - 1) * m, 0);
    for (int i = 1; i < c; i++)
        for (int j = 0; j < i; j++) {
            const real l = G[packed_index(i, j)];
            for (int k = 0; k < m; k++) B[i * m + k] -= l * B[j * m + k];
        }
}

/* The diagonal is stored as its inverse: a product. */
void dense_scale(int c, int m, const real *G, real *B, struct work *w)
{
    w->flop += (uint64_t)(c * m);
    for (int i = 0; i < c; i++) {
        const real d = G[packed_index(i, i)];
        for (int k = 0; k < m; k++) B[i * m + k] *= d;
    }
}

/* B <- L^-T B: rows from the bottom, L read by columns. */
void dense_backward(int c, int m, const real *G, real *B, struct work *w)
{
    account(w, c * (c - 1) * m, 0);
    for (int i = c - 1; i >= 0; i--)
        for (int j = i + 1; j < c; j++) {
            const real l = G[packed_index(j, i)];
            for (int k = 0; k < m; k++) B[i * m + k] -= l * B[j * m + k];
        }
}

void dense_solve(int c, int m, const real *G, real *B, struct work *w)
{
    dense_forward(c, m, G, B, w);
    dense_scale(c, m, G, B, w);
    dense_backward(c, m, G, B, w);
}

/* The loop over rows of B is outside, so that the inner loop runs along contiguous rows of C. The
 * first product is stored, not added to zero. */
void dense_product(int a, int b, int k, const real *A, const real *B, real *C, struct work *w)
{
    account(w, dense_product_flops(a, b, k), 0);
    if (k == 0) memset(C, 0, (size_t)(a * b) * sizeof *C);
    for (int i = 0; i < a; i++)
        for (int l = 0; l < k; l++) {
            const real f = A[i * k + l];
            for (int j = 0; j < b; j++)
                C[i * b + j] = l > 0 ? C[i * b + j] + f * B[l * b + j] : f * B[j];
        }
}

/* The sum over l is the outer loop: A is read along its rows though it enters transposed. */
void dense_product_tn(int a, int b, int k, const real *A, const real *B, real *C, struct work *w)
{
    account(w, dense_product_flops(a, b, k), 0);
    if (k == 0) memset(C, 0, (size_t)(a * b) * sizeof *C);
    for (int l = 0; l < k; l++)
        for (int i = 0; i < a; i++) {
            const real f = A[l * a + i];
            for (int j = 0; j < b; j++)
                C[i * b + j] = l > 0 ? C[i * b + j] + f * B[l * b + j] : f * B[j];
        }
}

/* What a received update costs its receiver (physics 5.2, wr). */
void dense_subtract(int n, real *a, const real *b, struct work *w)
{
    w->flop += (uint64_t)n;
    for (int i = 0; i < n; i++) a[i] -= b[i];
}

#if REAL_LANES == 1 /* where pivots are compared, each scene goes its own way */

/* Gauss-Jordan in place: column k of the matrix becomes column k of the inverse. */
bool dense_invert(int c, real *A, struct work *w)
{
    account(w, 2 * c * c * c, c);
    for (int k = 0; k < c; k++) {
        const real pivot = A[k * c + k];
        /* The first comparison also refuses "not a number". */
        if (!(real_fabs(pivot) > 0) || !__builtin_isfinite(pivot)) return false;
        const real inverse = 1 / pivot;
        /* The pivot's row, then all other rows; their column k starts anew from zero. */
        A[k * c + k] = 1;
        for (int j = 0; j < c; j++) A[k * c + j] *= inverse;
        for (int i = 0; i < c; i++) {
            if (i == k) continue;
            const real f = A[i * c + k];
            A[i * c + k] = 0;
            for (int j = 0; j < c; j++) A[i * c + j] -= f * A[k * c + j];
        }
    }
    return true;
}

/* swap_rows: exchange rows p and q of an (n x m) matrix. Data are moved: the matrices are too small
 * for a table of rows to pay. */
static void swap_rows(real *A, int m, int p, int q)
{
    for (int j = 0; j < m; j++) {
        const real t = A[p * m + j];
        A[p * m + j] = A[q * m + j];
        A[q * m + j] = t;
    }
}

/* Pivoting matters here: the matrices (physics 6.3, U + P22 dI) are neither symmetric nor
 * definite. */
bool dense_solve_general(int n, int m, real *A, real *B, struct work *w)
{
    account(w, 2 * n * n * n / 3 + 2 * n * n * m, n);
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k + 1; i < n; i++)
            if (real_fabs(A[i * n + k]) > real_fabs(A[p * n + k])) p = i;
        if (!(real_fabs(A[p * n + k]) > 0)) return false;
        if (p != k) {
            swap_rows(A, n, k, p);
            swap_rows(B, m, k, p);
        }
        const real inverse = 1 / A[k * n + k];
        for (int i = k + 1; i < n; i++) {
            const real f = A[i * n + k] * inverse;
            for (int j = k + 1; j < n; j++) A[i * n + j] -= f * A[k * n + j];
            for (int j = 0; j < m; j++) B[i * m + j] -= f * B[k * m + j];
        }
        A[k * n + k] = inverse; /* kept for the way back */
    }
    /* Back substitution with the inverse pivots. */
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            for (int j = 0; j < m; j++) B[i * m + j] -= A[i * n + k] * B[k * m + j];
        for (int j = 0; j < m; j++) B[i * m + j] *= A[i * n + i];
    }
    return true;
}

#endif
