/* placement.h - which rank lives on which processor of which node. */
#ifndef MACHINE_PLACEMENT_H
#define MACHINE_PLACEMENT_H

#include "base/arena.h"
#include "base/err.h"
#include "machine/topology.h"

struct placement {
    int nrank;
    int *node;      /* (nrank) node of each rank */
    int *processor; /* (nrank) processor within its node */
};

/* placement_create: place `nrank` ranks on the machine's processors, memory from `a`.
 * Returns false with ERR_CONFIG when there are more ranks than processors or a list is wrong. */
bool placement_create(struct placement *p, const struct machine_spec *m, const struct topology *t,
                      int nrank, struct arena *a, struct err *e);

#endif
