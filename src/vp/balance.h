/* balance.h - computing that lasts as long as a table says (measure/balance.h), for runs of a world
 * that has one: world->record->balance. */
#ifndef VP_BALANCE_H
#define VP_BALANCE_H

#include "vp/vp.h"

/* vp_balance_cost: what computing of `cost` [ps] lasts in v's stage, of which it has computed
 * w->balanced[] before. */
sim_ps vp_balance_cost(struct vp *v, sim_ps cost);

/* vp_balance_entry: what v computes on entering its stage, where it counts nothing of its own; once
 * in a run. */
sim_ps vp_balance_entry(struct vp *v);

#endif
