/* topology_failed.h - a network of which some links and routers do not work. */
#ifndef MACHINE_TOPOLOGY_FAILED_H
#define MACHINE_TOPOLOGY_FAILED_H

#include "machine/topology_internal.h"

/* For ways around: those to 512 targets among 131,072 routers, which is the most. */
#define TOPOLOGY_KEPT_BYTES (INT64_C(1) << 30)

/* topology_fail: `t`, which the family has made, becomes the network without what
 * t->spec->failed_link and failed_router name. Routes that meet none of it stay the family's;
 * others go around (topology_failed.c), by up to two classes more.
 *
 *   Memory from a, at most `kept_bytes` of it for ways around, or those to one target: others are
 * found again. Returns false with ERR_CONFIG when something named is not there, a router with nodes
 * cannot be reached any more, or the network has too many routers or links to look for ways. */
bool topology_fail(struct topology *t, int64_t kept_bytes, struct arena *a, struct err *e);

#endif
