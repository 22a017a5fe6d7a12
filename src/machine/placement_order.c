/* placement_order.c - the orders in which ranks fill a machine: see placement_order.h.
 *
 * Processors are numbered node by node. An order of routers (linear, snake, Gray) becomes one of
 * nodes and then of processors: block fills a node before the next, cyclic deals one processor of
 * every node in turn. */
#include "machine/placement_order.h"

/* Router number `i` along a path through the grid that only steps to neighbours: every second line
 * runs backwards. rest[d] is the number of the line of dimension d, whose parity is its
 * direction. */
static int snake_router(const struct topology_spec *s, int i)
{
    int router = 0, stride = 1, rest[MACHINE_MAX_DIMS];
    for (int d = 0; d < s->ndim; d++) {
        rest[d] = i;
        i /= s->dims[d];
    }
    for (int d = 0; d < s->ndim; d++) {
        int k = s->dims[d], x = rest[d] % k, line = rest[d] / k;
        router += (line % 2 ? k - 1 - x : x) * stride;
        stride *= k;
    }
    return router;
}

/* Binary reflected Gray code: neighbours in the order differ in one bit, hence are neighbours in
 * the cube. */
static int ordered_router(const struct machine_spec *m, int i)
{
    switch (m->placement.kind) {
    case PLACEMENT_SNAKE:
        return snake_router(&m->topology, i);
    case PLACEMENT_GRAY:
        return i ^ i >> 1;
    default:
        return i;
    }
}

/* Orders that need a shape are refused on others, instead of meaning something else there. */
bool placement_fits(const struct machine_spec *m, struct err *e)
{
    enum topology_family f = m->topology.family;
    if (m->placement.kind == PLACEMENT_SNAKE && !topology_has(f, TOPOLOGY_GRID))
        return err_set(e, ERR_CONFIG, "placement.kind snake needs a torus or a mesh, not a %s",
                       topology_family_name(f));
    if (m->placement.kind == PLACEMENT_GRAY && !topology_has(f, TOPOLOGY_CUBE))
        return err_set(e, ERR_CONFIG, "placement.kind gray needs a hypercube, not a %s",
                       topology_family_name(f));
    return true;
}

/* Nodes of a router that does not work are not there. */
bool placement_works(const struct topology *t, int node)
{
    return topology_router_works(t, topology_router_of(t, node));
}

/* Block: places 0 .. k-1 on the first node. Cyclic: place i on node i mod nodes. Several nodes on a
 * router stay together. */
int64_t placement_processor(const struct machine_spec *m, const struct topology *t, int64_t at)
{
    const int per_node = m->topology.processors_per_node, npr = t->nodes_per_router;
    const bool block = m->placement.spread == SPREAD_BLOCK;
    const int i = (int)(block ? at / per_node : at % t->nnode),
              processor = (int)(block ? at % per_node : at / t->nnode);
    const int node = npr == 1 ? ordered_router(m, i) : ordered_router(m, i / npr) * npr + i % npr;
    return (int64_t)node * per_node + processor;
}
