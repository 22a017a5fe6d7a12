/* placement.c - ranks onto processors: an order of the processors, of which the first nrank are
 * used.
 *
 * Processors are numbered node by node. An order of routers (linear, snake, Gray) becomes one of
 * nodes and then of processors: block fills a node before the next, cyclic deals one processor of
 * every node in turn. */
#include "machine/placement.h"

#include "base/check.h"
#include "base/random.h"

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
static bool kind_fits(const struct machine_spec *m, struct err *e)
{
    enum topology_family f = m->topology.family;
    if (m->placement.kind == PLACEMENT_SNAKE && !topology_has(f, TOPOLOGY_GRID))
        return err_set(e, ERR_CONFIG, "placement snake needs a torus or a mesh");
    if (m->placement.kind == PLACEMENT_GRAY && !topology_has(f, TOPOLOGY_CUBE))
        return err_set(e, ERR_CONFIG, "placement gray needs a hypercube");
    return true;
}

/* Nodes of a router that does not work are not there. */
static bool node_works(const struct topology *t, int node)
{
    return topology_router_works(t, topology_router_of(t, node));
}

static int64_t working_processors(const struct machine_spec *m, const struct topology *t)
{
    int64_t nodes = 0;
    if (topology_whole(t)) return (int64_t)t->nnode * m->topology.processors_per_node;
    for (int i = 0; i < t->nnode; i++) nodes += node_works(t, i);
    return nodes * m->topology.processors_per_node;
}

static void put(struct placement *p, int rank, int64_t processor, int per_node)
{
    p->node[rank] = (int)(processor / per_node);
    p->processor[rank] = (int)(processor % per_node);
}

/* Block: ranks 0 .. k-1 on the first node. Cyclic: rank r on node r mod nodes. Several nodes on a
 * router stay together. */
static void place_in_order(struct placement *p, const struct machine_spec *m,
                           const struct topology *t)
{
    int per_node = m->topology.processors_per_node, npr = t->nodes_per_router;
    /* `place` counts all processors in the order, r those that work. */
    for (int r = 0, place = 0; r < p->nrank; place++) {
        bool block = m->placement.spread == SPREAD_BLOCK;
        int i = block ? place / per_node : place % t->nnode,
            processor = block ? place % per_node : place / t->nnode;
        int node = npr == 1 ? ordered_router(m, i) : ordered_router(m, i / npr) * npr + i % npr;
        if (node_works(t, node)) put(p, r++, (int64_t)node * per_node + processor, per_node);
    }
}

/* Drawn from the processors that work. */
static void place_randomly(struct placement *p, const struct machine_spec *m,
                           const struct topology *t, int64_t nprocessor, struct arena *a)
{
    struct random g = random_make(m->placement.seed, 0x706c616365, 0); /* "place" */
    struct arena_mark mark = arena_mark(a);
    int64_t *all = TAKE(a, nprocessor, int64_t);
    int64_t n = 0;
    for (int64_t i = 0; i < nprocessor; i++)
        if (node_works(t, (int)(i / m->topology.processors_per_node))) all[n++] = i;
    nprocessor = n;
    for (int r = 0; r < p->nrank; r++) { /* Fisher and Yates, as far as needed */
        int64_t j = r + (int64_t)random_below(&g, (uint64_t)(nprocessor - r)), other = all[j];
        all[j] = all[r];
        all[r] = other;
        put(p, r, other, m->topology.processors_per_node);
    }
    arena_release(a, mark);
}

/* The list may name more processors than there are ranks; none twice. */
static bool place_by_list(struct placement *p, const struct machine_spec *m,
                          const struct topology *t, int64_t nprocessor, struct arena *a,
                          struct err *e)
{
    const struct placement_spec *s = &m->placement;
    if (s->nlist < p->nrank)
        return err_set(e, ERR_CONFIG, "placement list names %d processors for %d ranks", s->nlist,
                       p->nrank);
    struct arena_mark mark = arena_mark(a);
    /* Who sits where, so that a processor named twice is told with both ranks. */
    int *taken = TAKE(a, nprocessor, int); /* 1 + rank */
    bool ok = true;
    for (int r = 0; ok && r < p->nrank; r++) {
        int processor = s->list[r];
        if (processor < 0 || processor >= nprocessor)
            ok = err_set(e, ERR_CONFIG,
                         "placement list: processor %d of rank %d; expected 0 to %lld", processor,
                         r, (long long)nprocessor - 1);
        else if (taken[processor])
            ok = err_set(e, ERR_CONFIG, "placement list: ranks %d and %d on processor %d",
                         taken[processor] - 1, r, processor);
        else if (!node_works(t, processor / m->topology.processors_per_node))
            ok = err_set(e, ERR_CONFIG,
                         "placement list: processor %d of rank %d hangs on router %d, which "
                         "network.failed.routers names",
                         processor, r,
                         topology_router_of(t, processor / m->topology.processors_per_node));
        else taken[processor] = r + 1;
        if (ok) put(p, r, processor, m->topology.processors_per_node);
    }
    arena_release(a, mark);
    return ok;
}

/* One rank a processor: there is no time slicing in this simulator. */
bool placement_create(struct placement *p, const struct machine_spec *m, const struct topology *t,
                      int nrank, struct arena *a, struct err *e)
{
    int64_t nprocessor = (int64_t)t->nnode * m->topology.processors_per_node;
    CHECK(nrank >= 1);
    if (nrank > nprocessor)
        return err_set(e, ERR_CONFIG, "%d ranks do not fit on machine %s with %lld processors",
                       nrank, m->name, (long long)nprocessor);
    int64_t working = working_processors(m, t);
    if (nrank > working)
        return err_set(e, ERR_CONFIG,
                       "%d ranks do not fit on machine %s: %lld of its %lld processors work "
                       "(network.failed)",
                       nrank, m->name, (long long)working, (long long)nprocessor);
    if (!kind_fits(m, e)) return false;
    *p = (struct placement){nrank, TAKE(a, nrank, int), TAKE(a, nrank, int)};
    switch (m->placement.kind) {
    case PLACEMENT_LIST:
        return place_by_list(p, m, t, nprocessor, a, e);
    case PLACEMENT_RANDOM:
        place_randomly(p, m, t, nprocessor, a);
        return true;
    default:
        place_in_order(p, m, t);
        return true;
    }
}
