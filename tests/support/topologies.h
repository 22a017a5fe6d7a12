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

enum { TOPOLOGY_FARTHEST = 64, TOPOLOGY_MANY = 8192 };

/* topology_spec_of: a family with its dims; one node on each router, one processor on each. */
struct topology_spec topology_spec_of(enum topology_family f, int ndim, const int *dims);

/* topology_made: the network, memory from a; the test fails when it is refused. topology_refused:
 * the test fails unless it is, with a message that holds `word`. */
struct topology *topology_made(const struct topology_spec *s, struct arena *a);
void topology_refused(const struct topology_spec *s, const char *word);

/* topology_distances: how many nodes are 0, 1, 2, ... links from `node`. topology_loads: how many
 * of the routes between all pairs of nodes use each link. */
void topology_distances(const struct topology *t, int node, int count[TOPOLOGY_FARTHEST]);
void topology_loads(const struct topology *t, int load[TOPOLOGY_MANY]);

#endif
