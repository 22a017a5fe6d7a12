/* reduction.h - symmetric positive definite block tridiagonal systems spread over the ranks, one
 * interface row per rank.
 *
 * Row k couples to rows k-1 and k+1 of the ranks beside it (linalg/block_row.h). Reduction is by
 * symmetric parallel cyclic reduction (physics 5.3 ii), its textbook form (5.3 i), cyclic reduction
 * (5.2), or some levels of the latter before the former (5.4 d). Sources: Sweet 1977; Hockney and
 * Jesshope 1981.
 *
 * L and U of the current row lie where updates are received (behind S and v), so that they are
 * never copied. */
#ifndef KERNEL_REDUCTION_H
#define KERNEL_REDUCTION_H

#include <stdbool.h>

#include "base/work.h"
#include "comm/comm.h"
#include "kernel/carve.h"
#include "linalg/block_row.h"
#include "linalg/real.h"
#include "spec/kernel_spec.h"

/* How a block tridiagonal system lies on the ranks; read-only, shared by all of them. */
struct row_layout {
    int nrow, nrank;
    int largest;                    /* largest order of a row */
    const int *first;               /* (nrank + 1) first row of each rank; nrow at the end */
    const unsigned char *size;      /* (nrow) orders */
    const unsigned char *interface; /* (nrank) orders of the last row of each rank */
};

struct reduction {
    struct comm *comm;
    const unsigned char *size; /* (nrank) order of every rank's interface row */
    enum solver method;        /* SOLVER_PCR_SYMMETRIC, SOLVER_PCR, SOLVER_CR or SOLVER_CR_PCR */
    int hybrid_levels;
    int m;             /* right-hand sides */
    int c;             /* order of the own row */
    int largest;       /* largest order of any row */
    bool keep;         /* store the factors of every step for further right-hand sides */
    real *D;           /* (c x c, packed) */
    real *r;           /* (c x m) right-hand side, then solution */
    real *in_a, *in_b; /* updates from the left and the right, [S v E] */
    real *out_a, *out_b;
    real *y;         /* (c x m) */
    real *factor;    /* one, or one per step */
    int factor_size; /* elements of one */
    real *last;      /* the factor made last */
    real condition;  /* largest diagonal element of D over its last pivot so far */
    bool broken;     /* a pivot was not positive: answers are not numbers */
};

/* reduction_carve: room for rank `rank`'s interface row with m right-hand sides; keep: see
 * above. */
void reduction_carve(struct reduction *s, struct carve *c, const struct kernel_spec *spec,
                     enum solver method, const struct row_layout *layout, int rank, int m,
                     bool keep);

/* reduction_left, reduction_right: where L (c x c_{k-1}) and U (c x c_{k+1}) are to be put before
 * reduction_run; NULL where there is no such neighbour. */
static inline real *reduction_left(const struct reduction *s)
{
    return s->in_a ? s->in_a + block_update_size(s->c, s->m) : NULL;
}
static inline real *reduction_right(const struct reduction *s)
{
    return s->in_b ? s->in_b + block_update_size(s->c, s->m) : NULL;
}

/* reduction_run: the solution into r. D, L, U are used up. Every rank must call.
 *
 *   w   in/out  work not yet reported
 *
 *   Messages of PCR 2 (P lg P - P + 1) for P = 2^lg; of CR 4 (P - 1) - 2 lg P. Bytes: physics
 * (5.2), 5.3. */
void reduction_run(struct reduction *s, int tag, struct work *w);

/* reduction_rerun: another right-hand side in r (c x m) with the factors kept by reduction_run. */
void reduction_rerun(struct reduction *s, int tag, struct work *w);

/* The reductions themselves; row `k` of `n` lives on rank (k+1) stride - 1. */
void pcr_run(struct reduction *s, int stride, int tag, struct work *w);
void pcr_rerun(struct reduction *s, int stride, int tag, struct work *w);
void pcr_textbook_run(struct reduction *s, int tag, struct work *w);
void cr_run(struct reduction *s, int levels, int tag, struct work *w);
void cr_rerun(struct reduction *s, int levels, int tag, struct work *w);

/* A row of the textbook's form in a message or a buffer: the numbers [L D U r]. */
struct textbook_row {
    /* orders of the row and of its neighbours; 0: none, its block then takes c x c numbers */
    int c, nl, nu;
    real *L, *D, *U, *r; /* full blocks */
};

/* textbook_row_at: the row that begins at `base`. */
struct textbook_row textbook_row_at(real *base, int c, int nl, int nu);

/* textbook_row_fold: the row `v` behind the coupling K (c x v.c) of `row`: alpha = K D_v^-1, D -=
 * alpha back, r -= alpha r_v, next (c x order) = -alpha onward. v's D is destroyed. Returns false
 * when it has no inverse. */
bool textbook_row_fold(struct textbook_row *row, const real *K, struct textbook_row *v,
                       const real *back, const real *onward, int order, real *next, int m,
                       struct work *w);

/* reduction_break: mark the row as broken and spread "not a number" through everything it sends. */
void reduction_break(struct reduction *s, int nl, int nu);

/* reduction_eliminate: eliminate the row in its present state (block_row_eliminate) into factor
 * number `slot`. */
void reduction_eliminate(struct reduction *s, int slot, int nl, int nu, struct work *w);

/* reduction_finish: the row has no neighbours left: factor D into `slot` and r <- D^-1 r. */
void reduction_finish(struct reduction *s, int slot, struct work *w);

/* reduction_condition: largest diagonal element (c) times the inverse pivot that it became: a
 * monitor, which costs the machine nothing. */
real reduction_condition(int c, const real *before, const real *pivot);

/* reduction_refinish: r <- D^-1 r with the factor in `slot`. */
void reduction_refinish(struct reduction *s, int slot, struct work *w);

#endif
