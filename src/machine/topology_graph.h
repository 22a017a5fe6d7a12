/* topology_graph.h - networks whose cables are listed one by one, by a file or by a generator. */
#ifndef MACHINE_TOPOLOGY_GRAPH_H
#define MACHINE_TOPOLOGY_GRAPH_H

#include "machine/topology_internal.h"

/* Parallel cables between two routers, each with a link there and one back. */
struct graph_cable {
    int a, b;        /* routers */
    int there, back; /* rate of the links a to b and b to a [% of the link rate] */
    int weight;      /* what a route over it counts, >= 1 */
    int parallel;    /* how many there are, >= 1 */
};

/* graph_build: links, ports, classes and the longest route of *t, and its state for the functions
 * below.
 *
 *   nrouter  in  routers 0 .. nrouter - 1
 *   cable    in  (ncable) no two of the same routers; may be freed afterwards
 *
 *   Memory from a. Returns false with ERR_CONFIG when not all routers can be reached. */
bool graph_build(struct topology *t, int nrouter, const struct graph_cable *cable, int ncable,
                 struct arena *a, struct err *e);

/* graph_start, graph_next, graph_ends, graph_share: as struct topology_type wants them, of shortest
 * paths: the least sum of weights, of equal ones by the lowest-numbered neighbour. */
void graph_start(const struct topology *t, uint64_t choice, struct route_cursor *c);
bool graph_next(const struct topology *t, struct route_cursor *c, struct hop *h);
void graph_ends(const struct topology *t, int link, int *from, int *to, int *port);
double graph_share(const struct topology *t, int link);

#endif
