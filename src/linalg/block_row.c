/* block_row.c - eliminating one row of a symmetric block tridiagonal system (block_row.h).
 *
 * One text for all sizes, inlined with constant sizes for the common joints: five constraints
 * (revolute, prismatic) and three (spherical), one right-hand side. */
#include "linalg/block_row.h"

#include <stddef.h>

#define INLINE static inline __attribute__((always_inline))

/* forward: B <- L^-1 B, B (c x m), L with a unit diagonal: no division. */
INLINE void forward(const int c, const int m, const real *restrict G, real *restrict B)
{
    for (int i = 1; i < c; i++)
        for (int j = 0; j < i; j++) {
            const real l = G[packed_index(i, j)];
            for (int k = 0; k < m; k++) B[i * m + k] -= l * B[j * m + k];
        }
}

/* factor_block: as dense_factor, without the account; D = G D' G^T, 1/d in place of the
 * diagonal. */
INLINE bool factor_block(const int c, const real *restrict A, real *restrict G)
{
    for (int i = 0; i < c; i++) {
        real row[BLOCK_MAX];
        for (int j = 0; j <= i; j++) row[j] = A[packed_index(i, j)];
        for (int j = 0; j < i; j++)
            for (int k = 0; k < j; k++) row[j] -= row[k] * G[packed_index(j, k)];
        real pivot = row[i];
        for (int j = 0; j < i; j++) {
            const real l = row[j] * G[packed_index(j, j)];
            pivot -= row[j] * l;
            G[packed_index(i, j)] = l;
        }
        /* The comparison also refuses "not a number". */
        if (!(pivot > 0)) return false;
        G[packed_index(i, i)] = 1 / pivot;
    }
    return true;
}

/* products: S = Y_i^T Z_i (packed) and v = Y_i^T y for the `n` columns of Y from `first`; Z = D'^-1
 * Y. Only the lower triangle of S: half the products (physics 5.1). */
INLINE void products(const int c, const int n, const int first, const int width, const int m,
                     const real *restrict Y, const real *restrict Z, const real *restrict y,
                     real *restrict out)
{
    /* S packed, v behind it: as they are sent (block_row.h). */
    real *restrict v = out + packed_size(n);
    for (int i = 0; i < n; i++) {
        real sum[BLOCK_MAX] = {0};
        for (int k = 0; k < c; k++) {
            const real f = Y[k * width + first + i];
            for (int j = 0; j <= i; j++)
                /* The first product is stored: adding it to zero would be one operation more than
                 * the formula has. */
                sum[j] =
                    k > 0 ? sum[j] + f * Z[k * width + first + j] : f * Z[k * width + first + j];
        }
        for (int j = 0; j <= i; j++) out[packed_index(i, j)] = sum[j];
    }
    /* Written out here and again in project below: behind a call gcc 12 makes it 2 % slower. */
    for (int i = 0; i < n; i++)
        for (int l = 0; l < m; l++) {
            real sum = 0;
            for (int k = 0; k < c; k++) {
                const real product = Y[k * width + first + i] * y[k * m + l];
                sum = k > 0 ? sum + product : product;
            }
            v[i * m + l] = sum;
        }
}

/* eliminate: block_row_eliminate without the account.
 *
 * physics (5.1) with L D L^T in place of Cholesky: no square roots, and c divisions instead of one
 * for each element. All neighbours' columns go through one forward substitution, side by side. */
INLINE bool eliminate(const int c, const int nl, const int nu, const int m, const real *restrict D,
                      const real *restrict L, const real *restrict U, const real *restrict r,
                      real *restrict factor, real *restrict y, real *restrict to_a,
                      real *restrict to_b)
{
    const int width = nl + nu;
    real *restrict Y = factor + packed_size(c);
    real Z[BLOCK_MAX * 2 * BLOCK_MAX];
    if (!factor_block(c, D, factor)) return false;
    for (int i = 0; i < c; i++) {
        for (int j = 0; j < nl; j++) Y[i * width + j] = L[i * nl + j];
        for (int j = 0; j < nu; j++) Y[i * width + nl + j] = U[i * nu + j];
        for (int j = 0; j < m; j++) y[i * m + j] = r[i * m + j];
    }
    /* Y = G^-1 [L U], y = G^-1 r; then Z and y scaled by D'^-1. */
    forward(c, width, factor, Y);
    forward(c, m, factor, y);
    for (int i = 0; i < c; i++) {
        const real d = factor[packed_index(i, i)];
        for (int j = 0; j < width; j++) Z[i * width + j] = d * Y[i * width + j];
        for (int j = 0; j < m; j++) y[i * m + j] *= d;
    }
    if (nl > 0) products(c, nl, 0, width, m, Y, Z, y, to_a);
    if (nu > 0) products(c, nu, nl, width, m, Y, Z, y, to_b);
    /* E couples the two neighbours once the row is gone; both need it, one of them transposed. */
    if (nl > 0 && nu > 0) {
        real *restrict E = to_b + block_update_size(nu, m), *restrict transpose =
                                                                to_a + block_update_size(nl, m);
        for (int i = 0; i < nu; i++) {
            real sum[BLOCK_MAX] = {0};
            for (int k = 0; k < c; k++) {
                const real f = Y[k * width + nl + i];
                for (int j = 0; j < nl; j++)
                    sum[j] = k > 0 ? sum[j] - f * Z[k * width + j] : -(f * Z[k * width + j]);
            }
            for (int j = 0; j < nl; j++) {
                E[i * nl + j] = sum[j];
                transpose[j * nu + i] = sum[j];
            }
        }
    }
    return true;
}

/* The common sizes, each a function of its own so that the compiler unrolls it. The order of
 * operations is that of the general text: the results are the same bits. */
#define SIZED(name, c, nl, nu)                                                                     \
    static bool name(const real *D, const real *L, const real *U, const real *r, real *factor,     \
                     real *y, real *to_a, real *to_b)                                              \
    {                                                                                              \
        return eliminate(c, nl, nu, 1, D, L, U, r, factor, y, to_a, to_b);                         \
    }
SIZED(eliminate_555, 5, 5, 5)
SIZED(eliminate_505, 5, 0, 5)
SIZED(eliminate_550, 5, 5, 0)
SIZED(eliminate_333, 3, 3, 3)

/* account: the cost of block_row_eliminate, physics (5.2): w2 with two neighbours, w1 with one; c
 * of the operations are divisions. */
static void account(int c, int nl, int nu, int m, struct work *w)
{
    int flops = dense_factor_flops(c) + dense_triangular_flops(c, m);
    if (nl > 0)
        flops += dense_triangular_flops(c, nl) + dense_symmetric_flops(nl, c) +
                 dense_product_flops(nl, m, c);
    if (nu > 0)
        flops += dense_triangular_flops(c, nu) + dense_symmetric_flops(nu, c) +
                 dense_product_flops(nu, m, c);
    if (nl > 0 && nu > 0) flops += dense_product_flops(nu, nl, c);
    w->flop += (uint64_t)(flops - c);
    w->div += (uint64_t)c;
    w->call += (uint64_t)(2 + 3 * (nl > 0) + 3 * (nu > 0) + (nl > 0 && nu > 0));
}

bool block_row_eliminate(int c, int nl, int nu, int m, const real *D, const real *L, const real *U,
                         const real *r, real *factor, real *y, real *to_a, real *to_b,
                         struct work *w)
{
    account(c, nl, nu, m, w);
    /* Interior, first and last row of a chain of revolute or prismatic joints. */
    if (m == 1 && c == 5) {
        if (nl == 5 && nu == 5) return eliminate_555(D, L, U, r, factor, y, to_a, to_b);
        if (nl == 0 && nu == 5) return eliminate_505(D, L, U, r, factor, y, to_a, to_b);
        if (nl == 5 && nu == 0) return eliminate_550(D, L, U, r, factor, y, to_a, to_b);
    }
    if (m == 1 && c == 3 && nl == 3 && nu == 3)
        return eliminate_333(D, L, U, r, factor, y, to_a, to_b);
    return eliminate(c, nl, nu, m, D, L, U, r, factor, y, to_a, to_b);
}

/* project: v = Y_i^T y for the n columns of Y from `first`. */
static void project(int c, int n, int first, int width, int m, const real *Y, const real *y,
                    real *v)
{
    for (int i = 0; i < n; i++)
        for (int l = 0; l < m; l++) {
            real sum = 0;
            for (int k = 0; k < c; k++) {
                const real product = Y[k * width + first + i] * y[k * m + l];
                sum = k > 0 ? sum + product : product;
            }
            v[i * m + l] = sum;
        }
}

void block_row_reduce(int c, int nl, int nu, int m, const real *factor, const real *r, real *y,
                      real *v_a, real *v_b, struct work *w)
{
    const int width = nl + nu;
    const real *Y = factor + packed_size(c);
    for (int i = 0; i < c * m; i++) y[i] = r[i];
    forward(c, m, factor, y);
    for (int i = 0; i < c; i++)
        for (int j = 0; j < m; j++) y[i * m + j] *= factor[packed_index(i, i)];
    project(c, nl, 0, width, m, Y, y, v_a);
    project(c, nu, nl, width, m, Y, y, v_b);
    w->flop += (uint64_t)(dense_triangular_flops(c, m) + dense_product_flops(nl, m, c) +
                          dense_product_flops(nu, m, c));
    w->call += (uint64_t)(1 + (nl > 0) + (nu > 0));
}

void block_row_resubstitute(int c, int nl, int nu, int m, const real *factor, real *y,
                            const real *x_a, const real *x_b, struct work *w)
{
    const int width = nl + nu;
    const real *Y = factor + packed_size(c);
    /* y - D'^-1 (Y_L x_a + Y_U x_b), then the backward substitution with G^T. */
    for (int i = 0; i < c && width > 0; i++) {
        const real d = factor[packed_index(i, i)];
        for (int l = 0; l < m; l++) {
            real sum = 0;
            for (int j = 0; j < width; j++) {
                const real product =
                    Y[i * width + j] * (j < nl ? x_a[j * m + l] : x_b[(j - nl) * m + l]);
                sum = j > 0 ? sum + product : product;
            }
            y[i * m + l] -= d * sum;
        }
    }
    /* x = G^-T (..): rows from the bottom. */
    for (int i = c - 1; i >= 0; i--)
        for (int j = i + 1; j < c; j++)
            for (int l = 0; l < m; l++) y[i * m + l] -= factor[packed_index(j, i)] * y[j * m + l];
    w->flop += (uint64_t)(c * (c - 1) * m +
                          (width > 0 ? dense_product_flops(c, m, width) + 2 * c * m : 0));
    w->call += (uint64_t)(1 + (nl > 0) + (nu > 0));
}
