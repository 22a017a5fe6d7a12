/* block_tridiag.h - symmetric positive definite block tridiagonal systems and their serial
 * solution.
 *
 *     L[i] x[i-1] + D[i] x[i] + L[i+1]^T x[i+1] = r[i],   i = 0 .. nrow-1
 *
 * Blocks have orders 0 to 6, row by row; every row takes the same room, so that row i is found
 * without a table. */
#ifndef LINALG_BLOCK_TRIDIAG_H
#define LINALG_BLOCK_TRIDIAG_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/work.h"
#include "linalg/block_row.h"
#include "linalg/real.h"

struct block_tridiag {
    int nrow;
    const unsigned char *size; /* (nrow) orders c_i, borrowed */
    real *D;                   /* (nrow x BLOCK_PACKED) packed c_i x c_i; after factoring G_i */
    /* (nrow x BLOCK_FULL) c_i x c_{i-1}; after factoring L_i G_{i-1}^-T (without D') */
    real *L;
};

/* block_tridiag_make: a zero system in the arena; `size` (nrow) is borrowed. */
struct block_tridiag block_tridiag_make(struct arena *a, int nrow, const unsigned char *size);

/* block_tridiag_factor: block Cholesky (block Thomas), in place.
 *
 *   Returns  the index of the first row whose pivot block is not positive definite, -1 if all went
 * well Cost     per row factor(c) + triangular(c,c') + symmetric(c',c) + c'(c'+1)/2, c' the order
 * of the next row */
int block_tridiag_factor(struct block_tridiag *t, struct work *w);

/* block_tridiag_solve: with the factor, x (nrow x 6 m) from r: row i has its c_i x m elements
 * (row-major) at 6 m i. In place. Cost: per row and right-hand side 2 c^2 + 4 c c' (c = 5: 150;
 * with the factor 480). */
void block_tridiag_solve(const struct block_tridiag *t, int m, real *x, struct work *w);

#endif
