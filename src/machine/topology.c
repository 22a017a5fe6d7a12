/* topology.c - nodes on routers, and the walk along routes, over all families.
 *
 * Node i hangs on router i / nodes_per_router as its local port i mod nodes_per_router. */
#include "machine/topology.h"

#include <string.h>

#include "base/check.h"
#include "machine/topology_failed.h"
#include "machine/topology_internal.h"

static const struct topology_type *const types[] = {
#define X(constant, word, stem, ndim, routers, traits) [constant] = &topology_##stem,
    TOPOLOGY_LIST(X)
#undef X
};

/* The family checks its own numbers and sets the sizes; what all families share is done here.
 * Everything starts as for a family without classes or random routes. */
struct topology *topology_create(const struct topology_spec *s, struct arena *a, struct err *e)
{
    struct topology *t = TAKE(a, 1, struct topology);
    CHECK((unsigned)s->family < sizeof types / sizeof *types);
    t->spec = s;
    t->type = types[s->family];
    t->nclass = 1;
    t->fixed_routes = true;
    t->nodes_per_router = s->nodes_per_router;
    if (s->nodes_per_router < 1 || s->processors_per_node < 1) {
        err_set(e, ERR_CONFIG,
                "topology %s: nodes_per_router and processors_per_node must be at least 1",
                t->type->name);
        return NULL;
    }
    /* Sets sizes, ports, classes and the longest route, or says why it cannot. */
    if (!t->type->create(t, a, e)) return NULL;
    /* Families whose dims do not count nodes: nodes_per_router on each router. Processors are
     * numbered in an int, so that the product must fit. */
    if (t->nnode == 0) {
        int64_t nnode = (int64_t)t->nrouter * t->nodes_per_router;
        if (nnode > INT32_MAX / s->processors_per_node) {
            err_set(e, ERR_CONFIG, "topology %s: %lld nodes are more than can be numbered",
                    t->type->name, (long long)nnode);
            return NULL;
        }
        t->nnode = (int)nnode;
    }
    if (s->nfailed_link + s->nfailed_router > 0 && !topology_fail(t, TOPOLOGY_KEPT_BYTES, a, e))
        return NULL;
    return t;
}

bool topology_link_works(const struct topology *t, int link)
{
    return !t->type->link_works || t->type->link_works(t, link);
}

bool topology_router_works(const struct topology *t, int router)
{
    return !t->type->router_works || t->type->router_works(t, router);
}

bool topology_whole(const struct topology *t) { return !t->type->link_works; }

/* One node a router is the common case, and a division less on every hop of every message. */
int topology_router_of(const struct topology *t, int node)
{
    return t->nodes_per_router == 1 ? node : node / t->nodes_per_router;
}

/* Behind the ports of links, so that arbitration looks at nodes last. */
int topology_injection_port(const struct topology *t, int node)
{
    return t->nport + node % t->nodes_per_router;
}

/* c.at: the local number of the destination, which some families route by. */
struct route_cursor topology_start(const struct topology *t, int src, int dst, uint64_t choice)
{
    struct route_cursor c = {
        .router = topology_router_of(t, src), .target = topology_router_of(t, dst), .via = -1};
    c.at = dst - c.target * t->nodes_per_router;
    t->type->start(t, choice, &c);
    return c;
}

bool topology_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    return t->type->next(t, c, h);
}

int topology_route(const struct topology *t, int src, int dst, uint64_t choice, struct hop *route)
{
    struct route_cursor c = topology_start(t, src, dst, choice);
    int n = 0;
    struct hop h;
    while (t->type->next(t, &c, &h)) {
        /* A route longer than promised would overrun the caller's array. */
        CHECK(n < t->max_hops);
        route[n++] = h;
    }
    return n;
}

/* By formula where the family has one, else by walking. Random routes: those of choice 0. */
int topology_distance(const struct topology *t, int src, int dst)
{
    if (t->type->distance)
        return t->type->distance(t, topology_router_of(t, src), topology_router_of(t, dst));
    struct route_cursor c = topology_start(t, src, dst, 0);
    struct hop h;
    int n = 0;
    while (t->type->next(t, &c, &h)) n++;
    return n;
}

void topology_link_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    CHECK(link >= 0 && link < t->nlink);
    t->type->ends(t, link, from, to, port);
}

/* No dimension has a rate of its own, and no link of a graph has a share. */
bool topology_uniform(const struct topology *t)
{
    for (int d = 0; d < MACHINE_MAX_DIMS && t->type->rate_dim; d++)
        if (t->spec->dim_bandwidth[d] > 0) return false;
    return !t->type->share || t->spec->nlink_percent == 0;
}

/* Families without dimensions of their own have one length for all: the first one. */
double topology_link_latency(const struct topology *t, int link)
{
    return t->spec->dim_latency[t->type->rate_dim ? t->type->rate_dim(t, link) : 0];
}

/* 0 means: as the machine's link. An unlimited machine link cannot be divided by. */
double topology_link_bandwidth(const struct topology *t, int link, double link_bandwidth)
{
    double own = t->type->rate_dim ? t->spec->dim_bandwidth[t->type->rate_dim(t, link)] : 0;
    if (t->type->share) return t->type->share(t, link);
    return own > 0 && link_bandwidth > 0 ? own / link_bandwidth : 1;
}

/* Counted, then dealt out. */
struct topology_neighbours topology_neighbours(const struct topology *t, struct arena *a)
{
    int *first = TAKE(a, t->nrouter + 1, int), *list = TAKE(a, t->nlink + 1, int), from, to, port;
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &to, &port);
        first[from + 1] += topology_link_works(t, l);
    }
    for (int r = 0; r < t->nrouter; r++) first[r + 1] += first[r];
    int *next = TAKE(a, t->nrouter, int);
    memcpy(next, first, (size_t)t->nrouter * sizeof *next);
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &to, &port);
        if (topology_link_works(t, l)) list[next[from]++] = to;
    }
    return (struct topology_neighbours){first, list};
}

int topology_parts(const struct topology *t, int64_t *size)
{
    return t->type->parts ? t->type->parts(t, size) : 0;
}
