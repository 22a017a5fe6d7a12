/* topology_shared.c - families without a shape: crossbar, bus and full mesh.
 *
 * A crossbar is one router that holds every node: nothing is shared but injection and ejection. A
 * bus is the same with one link, from the router to itself, that every message crosses. */
#include "base/check.h"
#include "machine/topology_internal.h"

/* All nodes hang on one router; a bus has one link, from it to itself. */
static bool single_router(struct topology *t, int nlink, struct err *e)
{
    int64_t nnode = (int64_t)t->spec->dims[0] * t->spec->nodes_per_router;
    if (t->spec->dims[0] < 1 || nnode > INT32_MAX)
        return err_set(e, ERR_CONFIG, "topology %s: %d x %d nodes; expected 1 to %d", t->type->name,
                       t->spec->dims[0], t->spec->nodes_per_router, INT32_MAX);
    t->nrouter = 1;
    t->nnode = t->nodes_per_router = (int)nnode;
    t->nlink = t->nport = t->max_hops = nlink;
    return true;
}

/* Nothing is shared but the ports: the ideal network of closed forms (physics 10.1). */
static bool crossbar_create(struct topology *t, struct arena *a, struct err *e)
{
    (void)a;
    return single_router(t, 0, e);
}

static void crossbar_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)choice;
    c->left = t->nlink; /* 0: straight through; bus: once over it */
}

/* One step over the bus, none on a crossbar. */
static bool crossbar_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    (void)t;
    if (c->left == 0) return false;
    c->left = 0;
    *h = (struct hop){0, 0, 0};
    return true;
}

static int crossbar_distance(const struct topology *t, int from, int to)
{
    (void)from;
    (void)to;
    return t->nlink;
}

static void crossbar_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    (void)t;
    *from = *to = *port = link; /* the bus is link 0, router 0, port 0 */
}

static bool bus_create(struct topology *t, struct arena *a, struct err *e)
{
    (void)a;
    return single_router(t, 1, e);
}

/* full mesh: the link from router r to q has number r (n-1) + q, less one where q > r */
static bool full_mesh_create(struct topology *t, struct arena *a, struct err *e)
{
    (void)a;
    int64_t n = t->spec->dims[0];
    /* n (n - 1) links must be numbered in an int. */
    if (n < 1 || n > 40000)
        return err_set(e, ERR_CONFIG, "topology full-mesh: %d routers; expected 1 to 40000",
                       t->spec->dims[0]);
    t->nrouter = (int)n;
    t->nlink = (int)(n * (n - 1));
    t->nport = (int)n - 1;
    t->max_hops = n > 1;
    return true;
}

/* Every route is one link or none. */
static void full_mesh_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)t;
    (void)choice;
    (void)c;
}

static bool full_mesh_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    if (c->router == c->target) return false;
    /* A router has no link to itself: numbers above it move down by one. */
    h->link = c->router * (t->nrouter - 1) + c->target - (c->target > c->router);
    h->port = c->router - (c->router > c->target);
    h->vc_class = 0;
    c->router = c->target;
    return true;
}

static int full_mesh_distance(const struct topology *t, int from, int to)
{
    (void)t;
    return from != to;
}

static void full_mesh_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    int n = t->nrouter - 1;
    *from = link / n;
    *to = link % n + (link % n >= *from);
    *port = *from - (*from > *to);
}

/* Every router of one half has a cable to every one of the other. */
static int64_t full_mesh_bisection(const struct topology *t)
{
    return (int64_t)(t->nrouter / 2) * (t->nrouter - t->nrouter / 2);
}

const struct topology_type topology_crossbar = {
    .name = "crossbar",
    .create = crossbar_create,
    .start = crossbar_start,
    .next = crossbar_next,
    .distance = crossbar_distance,
    .ends = crossbar_ends,
};
const struct topology_type topology_bus = {
    .name = "bus",
    .create = bus_create,
    .start = crossbar_start,
    .next = crossbar_next,
    .distance = crossbar_distance,
    .ends = crossbar_ends,
};
const struct topology_type topology_full_mesh = {
    .name = "full-mesh",
    .create = full_mesh_create,
    .start = full_mesh_start,
    .next = full_mesh_next,
    .distance = full_mesh_distance,
    .ends = full_mesh_ends,
    .bisection = full_mesh_bisection,
};
