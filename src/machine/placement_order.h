/* placement_order.h - the processors of a machine one after the other, as its placement has
 * them. */
#ifndef MACHINE_PLACEMENT_ORDER_H
#define MACHINE_PLACEMENT_ORDER_H

#include "base/err.h"
#include "machine/topology.h"

/* placement_works: whether node `node` hangs on a router that works (network.failed). */
bool placement_works(const struct topology *t, int node);

/* placement_processor: number `at` of the machine's processors in the order of its placement.
 * placement_fits: whether that order exists on its network, else ERR_CONFIG. */
int64_t placement_processor(const struct machine_spec *m, const struct topology *t, int64_t at);
bool placement_fits(const struct machine_spec *m, struct err *e);

#endif
