/* reduction.c - which reduction solves the interface rows, and how well conditioned they were
 * (reduction.h). */
#include "kernel/reduction.h"

/* diagonal: of a packed matrix of order c. */
static void diagonal(int c, const real *D, real *d)
{
    for (int i = 0; i < c; i++) d[i] = D[packed_index(i, i)];
}

void reduction_run(struct reduction *s, int tag, struct work *w)
{
    real before[BLOCK_MAX], pivot[BLOCK_MAX];
    diagonal(s->c, s->D, before);
    /* Levels beyond log2 P do not exist: 32 means cyclic reduction down to the last row. */
    if (s->method == SOLVER_PCR) pcr_textbook_run(s, tag, w);
    else if (s->method == SOLVER_PCR_SYMMETRIC) pcr_run(s, 1, tag, w);
    else cr_run(s, s->method == SOLVER_CR_PCR ? s->hybrid_levels : 32, tag, w);
    /* Growth of the condition: what the diagonal was before the reduction, times the last inverse
     * pivot. */
    diagonal(s->c, s->last, pivot);
    const real condition = reduction_condition(s->c, before, pivot);
    if (condition > s->condition) s->condition = condition;
}

void reduction_rerun(struct reduction *s, int tag, struct work *w)
{
    if (s->method == SOLVER_PCR_SYMMETRIC) pcr_rerun(s, 1, tag, w);
    else cr_rerun(s, s->method == SOLVER_CR_PCR ? s->hybrid_levels : 32, tag, w);
}
