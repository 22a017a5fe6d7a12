/* block_row.h - eliminating one row of a symmetric block tridiagonal system in favour of its two
 * neighbours.
 *
 *     L x_a + D x + U x_b = r,   D symmetric positive definite (c x c, packed), L (c x nl), U (c x
 * nu), r (c x m)
 *
 * The one kernel shared by Thomas, cyclic reduction, parallel cyclic reduction and partition: with
 * D = G D' G^T, Y = G^-1 [L U], y = G^-1 r, the neighbours' rows change by
 *
 *     b:  S_b = Y_U^T D'^-1 Y_U,  v_b = Y_U^T D'^-1 y,  E = -Y_U^T D'^-1 Y_L     D_b -= S_b, r_b -=
 * v_b, new L_b = E a:  S_a = Y_L^T D'^-1 Y_L,  v_a = Y_L^T D'^-1 y,  E^T                      D_a
 * -= S_a, r_a -= v_a, new U_a = E^T
 *
 * A size of 0 means that there is no such neighbour, or that it has no unknowns. Blocks are of
 * order 0 to 6. */
#ifndef LINALG_BLOCK_ROW_H
#define LINALG_BLOCK_ROW_H

#include <stdbool.h>

#include "base/work.h"
#include "linalg/dense.h"
#include "linalg/real.h"

enum { BLOCK_MAX = 6, BLOCK_PACKED = 21, BLOCK_FULL = 36 };

/* block_update_size: elements of an update sent to a neighbour of order c, without E. */
static inline int block_update_size(int c, int m) { return packed_size(c) + c * m; }

/* block_factor_size: elements of a stored factor: G packed, then Y (c x (nl+nu)). */
static inline int block_factor_size(int c, int nl, int nu)
{
    return packed_size(c) + c * (nl + nu);
}

/* block_row_eliminate: (G, Y, y) and both updates from (D, L, U, r).
 *
 *   factor   out  G packed, then Y (c x (nl+nu)), rows [Y_L Y_U]
 *   y        out  (c x m) D'^-1 G^-1 r; may not be r
 *   to_a     out  S_a packed, v_a (nl x m), E^T (nl x nu); NULL or unused when nl = 0
 *   to_b     out  S_b packed, v_b (nu x m), E (nu x nl); NULL or unused when nu = 0
 *
 *   Returns  false when D is not positive definite
 *   Cost     factor(c) + triangular(c,m) + for each neighbour n: triangular(c,n) + symmetric(n,c) +
 * product(n,m,c)
 *            + product(nu,nl,c);  c = 5, m = 1: 915 with two neighbours, 385 with one */
bool block_row_eliminate(int c, int nl, int nu, int m, const real *D, const real *L, const real *U,
                         const real *r, real *factor, real *y, real *to_a, real *to_b,
                         struct work *w);

/* block_row_reduce: the part of block_row_eliminate that concerns further right-hand sides, with a
 * stored factor: y = D'^-1 G^-1 r, v_a (nl x m), v_b (nu x m). Cost: triangular(c,m) +
 * product(nl,m,c) + product(nu,m,c). */
void block_row_reduce(int c, int nl, int nu, int m, const real *factor, const real *r, real *y,
                      real *v_a, real *v_b, struct work *w);

/* block_row_resubstitute: y (c x m) of the two above becomes x = G^-T (y - D'^-1 (Y_L x_a + Y_U
 * x_b)), given x_a (nl x m) and x_b (nu x m). Cost: c (c-1) m + product(c,m,nl+nu) + 2 c m, the
 * latter two with neighbours. */
void block_row_resubstitute(int c, int nl, int nu, int m, const real *factor, real *y,
                            const real *x_a, const real *x_b, struct work *w);

#endif
