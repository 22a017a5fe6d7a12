/* topology_failed.h - a network of which some links and routers do not work. */
#ifndef MACHINE_TOPOLOGY_FAILED_H
#define MACHINE_TOPOLOGY_FAILED_H

#include "machine/topology_internal.h"

/* topology_fail: `t`, which the family has made, becomes the network without what
 * t->spec->failed_link and failed_router name. Routes that meet none of it stay the family's;
 * others go around (topology_failed.c), by up to two classes more.
 *
 *   Memory from a. Returns false with ERR_CONFIG when something named is not there, or a router
 * with nodes cannot be reached any more. */
bool topology_fail(struct topology *t, struct arena *a, struct err *e);

#endif
