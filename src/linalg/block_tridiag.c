/* block_tridiag.c - block Cholesky of a symmetric positive definite block tridiagonal system
 * (block_tridiag.h).
 *
 * With G_i D'_i G_i^T = D_i: M_i = L_i G_{i-1}^-T (in place of L_i), D_i -= M_i D'^-1_{i-1} M_i^T.
 */
#include "linalg/block_tridiag.h"

#include <stddef.h>

/* Every row has room for the largest block: a product instead of a table of places, at the price of
 * memory that small blocks do not use. */
struct block_tridiag block_tridiag_make(struct arena *a, int nrow, const unsigned char *size)
{
    struct block_tridiag t = {.nrow = nrow, .size = size};
    t.D = TAKE(a, size_product(nrow, BLOCK_PACKED), real);
    t.L = TAKE(a, size_product(nrow, BLOCK_FULL), real);
    return t;
}

/* reduce: M = L G^-T in place, D -= M D'^-1 M^T; L is (n x c), G of order c: one step of block
 * Thomas (physics 5.1), row by row of M. */
static void reduce(int n, int c, const real *G, real *L, real *D, struct work *w)
{
    for (int i = 0; i < n; i++) {
        real *row = L + i * c, scaled[BLOCK_MAX];
        for (int k = 0; k < c; k++)
            for (int j = 0; j < k; j++) row[k] -= G[packed_index(k, j)] * row[j];
        for (int k = 0; k < c; k++) scaled[k] = G[packed_index(k, k)] * row[k];
        /* The lower triangle of the symmetric update; an empty neighbour changes nothing. */
        for (int j = 0; j <= i; j++) {
            if (c == 0) continue;
            real sum = scaled[0] * L[j * c];
            for (int k = 1; k < c; k++) sum += scaled[k] * L[j * c + k];
            D[packed_index(i, j)] -= sum;
        }
    }
    w->flop += (uint64_t)(dense_triangular_flops(c, n) + dense_symmetric_flops(n, c) +
                          (c > 0 ? packed_size(n) : 0));
    w->call += 2;
}

/* Serial by nature: row i needs the finished row i - 1. Backward stable (physics 8.4). */
int block_tridiag_factor(struct block_tridiag *t, struct work *w)
{
    for (int i = 0; i < t->nrow; i++) {
        real *D = t->D + (size_t)i * BLOCK_PACKED;
        if (i > 0)
            reduce(t->size[i], t->size[i - 1], D - BLOCK_PACKED, t->L + (size_t)i * BLOCK_FULL, D,
                   w);
        if (!dense_factor(t->size[i], D, D, w)) return i;
    }
    return -1;
}

void block_tridiag_solve(const struct block_tridiag *t, int m, real *x, struct work *w)
{
    const int stride = BLOCK_MAX * m;
    /* z_i = G^-1 (r_i - M_i D'^-1 z_{i-1}), kept as D'^-1 z_i */
    for (int i = 0; i < t->nrow; i++) {
        const int c = t->size[i], n = i > 0 ? t->size[i - 1] : 0;
        const real *G = t->D + (size_t)i * BLOCK_PACKED, *M = t->L + (size_t)i * BLOCK_FULL;
        real *z = x + (size_t)i * stride, *before = z - (i > 0 ? stride : 0);
        for (int k = 0; k < c; k++)
            for (int j = 0; j < n; j++)
                for (int l = 0; l < m; l++) z[k * m + l] -= M[k * n + j] * before[j * m + l];
        w->flop += (uint64_t)(n > 0 ? dense_product_flops(c, m, n) + c * m : 0);
        dense_forward(c, m, G, z, w);
        dense_scale(c, m, G, z, w);
    }
    for (int i = t->nrow - 1; i >= 0; i--) { /* x_i = G^-T (D'^-1 (z_i - M_{i+1}^T x_{i+1})) */
        const int c = t->size[i], n = i + 1 < t->nrow ? t->size[i + 1] : 0;
        const real *G = t->D + (size_t)i * BLOCK_PACKED, *M = t->L + (size_t)(i + 1) * BLOCK_FULL;
        real *z = x + (size_t)i * stride, *after = z + stride;
        for (int k = 0; k < c; k++) {
            const real d = G[packed_index(k, k)];
            for (int l = 0; l < m && n > 0; l++) {
                real sum = M[k] * after[l];
                for (int j = 1; j < n; j++) sum += M[j * c + k] * after[j * m + l];
                z[k * m + l] -= d * sum;
            }
        }
        w->flop += (uint64_t)(n > 0 ? dense_product_flops(c, m, n) + 2 * c * m : 0);
        dense_backward(c, m, G, z, w);
    }
}
