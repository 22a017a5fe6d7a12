/* subspace.h - what a joint lets move and what it does not: the orthonormal columns [H W] of the six directions.
 *
 * Most joints' columns are unit vectors for good; then they are picked by number, without arithmetic. */
#ifndef MECH_SUBSPACE_H
#define MECH_SUBSPACE_H

#include <stdbool.h>

#include "linalg/real.h"

/* The motion subspace H (6 x d) and its complement W (6 x c), d + c = 6. */
struct subspace {
    int d, c;
    const signed char *pick; /* (6) non-NULL: column k is unit vector pick[k]; first H's d columns, then W's c */
    real col[36];            /* pick == NULL: column k at col + 6 k */
};

/* subspace_h: y (6) += H x (d). subspace_w: y (6) += W x (c). */
#define subspace_h REAL_NAME(subspace_h)
void subspace_h(const struct subspace *s, const real *x, real *y);
#define subspace_w REAL_NAME(subspace_w)
void subspace_w(const struct subspace *s, const real *x, real *y);

/* subspace_h_transposed: y (d) = H^T x (6). subspace_w_transposed: y (c) = W^T x (6). */
#define subspace_h_transposed REAL_NAME(subspace_h_transposed)
void subspace_h_transposed(const struct subspace *s, const real *x, real *y);
#define subspace_w_transposed REAL_NAME(subspace_w_transposed)
void subspace_w_transposed(const struct subspace *s, const real *x, real *y);

/* subspace_column: column k of [H W] (0 .. 5) in y (6). */
#define subspace_column REAL_NAME(subspace_column)
void subspace_column(const struct subspace *s, int k, real *y);

/* subspace_project: out (rows of A's part x columns of B's part, row-major) = part(A)^T M part(B) for a full 6x6 M.
 *
 *   a, a_w   in   subspace on the left; true: its W, false: its H
 *   b, b_w   in   subspace on the right */
#define subspace_project REAL_NAME(subspace_project)
void subspace_project(const struct subspace *a, bool a_w, const real *m, const struct subspace *b, bool b_w, real *out);

#endif
