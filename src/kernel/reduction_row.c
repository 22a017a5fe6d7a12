/* reduction_row.c - one interface row: its memory, and the steps that every reduction is made of
 * (reduction.h). */
#include <math.h>

#include "kernel/reduction.h"

real reduction_condition(int c, const real *before, const real *pivot)
{
    /* Largest ratio of a diagonal element to the pivot that elimination left of it. At 1/eps the
     * pivot has no correct digit. A "not a number" fails the comparison; `broken` tells of it
     * instead. */
    real largest = 0;
    for (int i = 0; i < c; i++) {
        const real growth = before[i] * pivot[i];
        largest = growth > largest ? growth : largest;
    }
    return largest;
}

/* steps: ceil(log2 n). */
static int steps(int n)
{
    int lg = 0;
    while ((1 << lg) < n) lg++;
    return lg;
}

void reduction_carve(struct reduction *s, struct carve *c, const struct kernel_spec *spec,
                     enum solver method, const struct row_layout *layout, int rank, int m,
                     bool keep)
{
    const int largest = layout->largest;
    s->size = layout->interface;
    s->method = method;
    s->hybrid_levels = spec->hybrid_levels;
    s->m = m;
    s->largest = largest;
    s->c = layout->interface[rank];
    s->keep = keep;
    /* A row of the textbook's form has three full blocks; an update is symmetric, with E behind
     * it. */
    const bool textbook = method == SOLVER_PCR;
    const int update = textbook ? 3 * largest * largest + largest * m
                                : block_update_size(largest, m) + largest * largest;
    s->D = CARVE(c, packed_size(largest), real);
    s->r = CARVE(c, largest * m, real);
    s->y = CARVE(c, largest * m, real);
    s->in_a = CARVE(c, update, real);
    s->in_b = CARVE(c, update, real);
    s->out_a = CARVE(c, update, real);
    s->out_b = CARVE(c, update, real);
    s->factor_size = block_factor_size(largest, largest, largest);
    /* Every step of parallel cyclic reduction has another factor; one more for the row that stands
     * alone. */
    s->factor = CARVE(c, s->factor_size * (keep ? steps(layout->nrank) + 1 : 1), real);
}

/* All outgoing numbers become "not a number", so that every rank that depends on them gets one as
 * its answer. The run then ends as failed instead of with a wrong result. */
void reduction_break(struct reduction *s, int nl, int nu)
{
    const real nothing = (real)NAN;
    s->broken = true;
    for (int i = 0; i < s->c * s->m; i++) s->r[i] = s->y[i] = nothing;
    for (int i = 0; i < block_update_size(nl, s->m) + nl * nu; i++) s->out_a[i] = nothing;
    for (int i = 0; i < block_update_size(nu, s->m) + nl * nu; i++) s->out_b[i] = nothing;
}

void reduction_eliminate(struct reduction *s, int slot, int nl, int nu, struct work *w)
{
    real *factor = s->last = s->factor + (s->keep ? slot : 0) * s->factor_size;
    if (!block_row_eliminate(s->c, nl, nu, s->m, s->D, reduction_left(s), reduction_right(s), s->r,
                             factor, s->y, s->out_a, s->out_b, w))
        reduction_break(s, nl, nu);
}

void reduction_finish(struct reduction *s, int slot, struct work *w)
{
    real *factor = s->last = s->factor + (s->keep ? slot : 0) * s->factor_size;
    if (!dense_factor(s->c, s->D, factor, w)) {
        reduction_break(s, 0, 0);
        return;
    }
    reduction_refinish(s, slot, w);
}

void reduction_refinish(struct reduction *s, int slot, struct work *w)
{
    dense_solve(s->c, s->m, s->factor + (s->keep ? slot : 0) * s->factor_size, s->r, w);
}
