/* subspace.h - what a joint lets move and what it does not: the orthonormal columns [H W] of all
 * directions.
 *
 * Most joints' columns are unit vectors for good; then they are picked by number, without
 * arithmetic. */
#ifndef DYNAMICS_SUBSPACE_H
#define DYNAMICS_SUBSPACE_H

#include <stdbool.h>

#include "linalg/space.h"

/* The motion subspace H (SPACE x d) and its complement W (SPACE x c), d + c = SPACE. */
struct subspace {
    int d, c;
    /* (SPACE) non-NULL: column k is unit vector pick[k]; first H's d columns, then W's c */
    const signed char *pick;
    real col[SQUARE];           /* pick == NULL: column k at col + SPACE k */
};

/* subspace_h: y (SPACE) += H x (d). subspace_w: y (SPACE) += W x (c). */
void subspace_h(const struct subspace *s, const real *x, real *y);
void subspace_w(const struct subspace *s, const real *x, real *y);

/* subspace_h_transposed: y (d) = H^T x (SPACE). subspace_w_transposed: y (c) = W^T x (SPACE). */
void subspace_h_transposed(const struct subspace *s, const real *x, real *y);
void subspace_w_transposed(const struct subspace *s, const real *x, real *y);

/* subspace_column: column k of [H W] in y (SPACE). */
void subspace_column(const struct subspace *s, int k, real *y);

/* subspace_project: out (rows of A's part x columns of B's part, row-major) = part(A)^T M part(B)
 * for a full square M.
 *
 *   a, a_w   in   subspace on the left; true: its W, false: its H
 *   b, b_w   in   subspace on the right */
void subspace_project(const struct subspace *a, bool a_w, const real *m, const struct subspace *b,
                      bool b_w, real *out);

#endif
