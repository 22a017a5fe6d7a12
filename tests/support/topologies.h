/* topologies.h - one small network of every family and of every corner of a family, for tests that
 * hold on all. */
#ifndef TESTS_TOPOLOGIES_H
#define TESTS_TOPOLOGIES_H

#include "machine/topology.h"

struct named_topology {
    const char *name;
    struct topology_spec spec;
    bool shortest; /* its routes are shortest paths */
};

/* named_topologies: all of them, *n their number. */
const struct named_topology *named_topologies(int *n);

#endif
