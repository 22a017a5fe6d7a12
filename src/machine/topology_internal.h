/* topology_internal.h - what a topology family provides to topology.c.
 *
 * A route is walked by a cursor, so that nobody needs to hold a whole route of a large machine. */
#ifndef MACHINE_TOPOLOGY_INTERNAL_H
#define MACHINE_TOPOLOGY_INTERNAL_H

#include "machine/topology.h"

struct topology_type {
    const char *name;
    /* fill nrouter, nlink, nclass, nport, max_hops and state of *t from t->spec; memory from a */
    bool (*create)(struct topology *t, struct arena *a, struct err *e);
    /* prepare the walk; set already: router, target, via (-1), and at: local number of the
     * destination node */
    void (*start)(const struct topology *t, uint64_t choice, struct route_cursor *c);
    /* one step into *h; false when the walk is over */
    bool (*next)(const struct topology *t, struct route_cursor *c, struct hop *h);
    int (*distance)(const struct topology *t, int from, int to); /* routers; NULL: walk and count */
    void (*ends)(const struct topology *t, int link, int *from, int *to, int *port);
    /* which dim_bandwidth holds for it; NULL: none */
    int (*rate_dim)(const struct topology *t, int link);
    double (*share)(const struct topology *t, int link); /* of the link rate; NULL: 1 */
    /* NULL: all do */
    bool (*link_works)(const struct topology *t, int link);
    bool (*router_works)(const struct topology *t, int router);
    /* topology_parts; NULL: there are none */
    int (*parts)(const struct topology *t, int64_t *size);
    /* cables between two halves of the nodes, -1: no closed form for these numbers; NULL: never */
    int64_t (*bisection)(const struct topology *t);
};

/* topology_grid_parts: `parts` of families whose routers have coordinates: lines, planes and so on.
 * topology_group_parts: of those whose dims begin with nodes and routers: groups. */
int topology_grid_parts(const struct topology *t, int64_t *size);
int topology_group_parts(const struct topology *t, int64_t *size);

/* Every family's own. */
#define X(constant, word, stem, ndim, routers, traits)                                             \
    extern const struct topology_type topology_##stem;
TOPOLOGY_LIST(X)
#undef X

#endif
