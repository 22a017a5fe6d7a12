/* blocks.h - block tridiagonal systems whose rows lie in contiguous blocks on the ranks.
 *
 * Rank k owns rows lo .. hi-1. Rows but the last are eliminated locally (substructuring,
 * physics 5.4 a), leaving one interface row per rank for a reduction; with one row per rank nothing
 * is left to eliminate. Or all rows take part in the reduction (5.4 b), or rank 0 gathers and
 * solves everything (block Thomas). */
#ifndef KERNEL_BLOCKS_H
#define KERNEL_BLOCKS_H

#include <stdbool.h>

#include "kernel/reduction.h"
#include "linalg/block_tridiag.h"

/* Buffers of a reduction in which all rows take part. What rows send and receive lies one row
 * behind the other. */
struct blocks_rows {
    bool used, textbook;
    struct work *work;
    real *out_a, *out_b, *in_a, *in_b; /* for and from the rows at -d (a) and +d (b) */
    int *out_a_at, *out_b_at;          /* (rows + 1) where each own row's part begins */
    int *in_a_at, *in_b_at;
    real **L, **U; /* (rows) present couplings */
    real *spare;   /* textbook: the rows of the next step */
};

/* The memory carved may be used for something else before blocks_solve: nothing in it is kept until
 * then. */
struct blocks {
    struct comm *comm;
    const struct row_layout *layout;
    const unsigned char *size; /* (nrow of the whole system) orders */
    int nrow, lo, hi;          /* rows in all; own rows */
    int m;                     /* right-hand sides */
    int d_stride, l_stride, r_stride, factor_stride;
    /* own rows: packed; coupling to the row before; right-hand side, then solution */
    real *D, *L, *r;
    real *factor;    /* of the rows eliminated locally */
    real *message;   /* [S, dD, dr] */
    real *left;      /* (c x m) solution of the row before lo, after blocks_solve */
    bool keep;
    bool broken;                /* a local pivot was not positive */
    struct reduction reduction; /* of the interface row */
    struct blocks_rows rows;    /* all rows take part in the reduction: its buffers */
    struct block_tridiag whole; /* SOLVER_THOMAS, rank 0: the whole system */
    real *x, *gathered;         /* and its solution (nrow x 6 m); messages of rows */
};

/* row_owner: the rank that owns row i. */
static inline int row_owner(const struct row_layout *l, int i)
{
    int low = 0, high = l->nrank;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (l->first[middle] <= i) low = middle;
        else high = middle;
    }
    return low;
}

/* blocks_carve: room for rank `rank`'s rows with m right-hand sides; keep: further ones will
 * follow. */
void blocks_carve(struct blocks *b, struct carve *c, const struct kernel_spec *spec,
                  const struct row_layout *layout, int rank, int m, bool keep);

/* blocks_row_D, _L, _r: where the parts of own row i go before blocks_solve: D packed, L (c_i x
 * c_{i-1}), r (c_i x m). */
static inline real *blocks_row_D(const struct blocks *b, int i)
{
    return b->D + (i - b->lo) * b->d_stride;
}
static inline real *blocks_row_L(const struct blocks *b, int i)
{
    return b->L + (i - b->lo) * b->l_stride;
}
static inline real *blocks_row_r(const struct blocks *b, int i)
{
    return b->r + (i - b->lo) * b->r_stride;
}

/* blocks_solve: the solution into the rows' r and into `left`; D and L are used up. Every rank must
 * call.
 *
 *   Messages beside the reduction's: one to the left (8 c^2 bytes for one row, with the Schur
 * complement of more rows), one with the interface solution to the right. */
void blocks_solve(struct blocks *b, struct work *w);

/* blocks_resolve: another right-hand side in the rows' r, with the factors of blocks_solve
 * (keep). */
void blocks_resolve(struct blocks *b, struct work *w);

/* blocks_rows_solve: SOLVER_PCR, SOLVER_PCR_SYMMETRIC with several rows on some rank: all rows are
 * reduced; `again`: further right-hand sides with kept factors (symmetric only). blocks_rows_carve:
 * room for it. */
void blocks_rows_solve(struct blocks *b, bool again, struct work *w);
void blocks_rows_carve(struct blocks *b, struct carve *c);

/* blocks_serial_solve: SOLVER_THOMAS: gather to rank 0, solve, scatter. */
void blocks_serial_solve(struct blocks *b, bool again, struct work *w);

/* blocks_serial_carve: room for it: the whole system on rank 0. */
void blocks_serial_carve(struct blocks *b, struct carve *c, int rank);

#endif
