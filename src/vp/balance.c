/* balance.c - see balance.h.
 *
 * Each piece of computing is scaled by target / own of its rank and stage. Pieces are rounded so
 * that their sum is: a rank that has computed c of own has lasted floor(c target / own), so at the
 * end of the stage nothing is missing, in whole picoseconds. */
#include "vp/balance.h"

#include "measure/balance.h"

static int64_t *done_of(struct vp *v, const struct balance **b, int64_t *cell)
{
    const struct world *w = v->world;
    *b = w->record->balance;
    CHECK((*b)->nrank == w->nrank && (*b)->nstage >= w->nstage);
    *cell = (int64_t)v->comm.rank * (*b)->nstage + v->stage;
    return &w->balanced[*cell];
}

/* The product of two times needs more than 64 bits. */
static sim_ps scaled(int64_t done, int64_t target, int64_t own)
{
    return (sim_ps)((__int128)done * target / own);
}

sim_ps vp_balance_cost(struct vp *v, sim_ps cost)
{
    const struct balance *b;
    int64_t cell, *done = done_of(v, &b, &cell);
    const int64_t own = b->own[cell], target = b->target[cell], before = *done;
    if (own == 0) return cost;
    *done += cost;
    return scaled(*done, target, own) - scaled(before, target, own);
}

sim_ps vp_balance_entry(struct vp *v)
{
    const struct balance *b;
    int64_t cell, *done = done_of(v, &b, &cell);
    if (b->own[cell] != 0 || *done != 0) return 0;
    *done = 1; /* entered */
    return b->target[cell];
}
