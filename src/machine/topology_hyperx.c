/* topology_hyperx.c - HyperX networks and flattened butterflies of any dimensions: all routers that
 * differ in one coordinate alone are joined.
 *
 * dims = {S_0, S_1, ...}: router = x0 + S_0 (x1 + S_1 (x2 ...)), nodes_per_router nodes on each. In
 * dimension d every router has topology.bundle[d] cables (default 1) to each of the S_d - 1 others
 * of its line (Ahn et al., "HyperX: topology, routing, and packaging of efficient large-scale
 * networks", SC 2009; with one S and one cable Kim, Dally and Abts' flattened butterfly, ISCA 2007,
 * with one dimension the full mesh).
 *
 * A route mends the coordinates one after the other, the lowest dimension first, with one link for
 * each. A message never returns to a lower dimension, so that one class is free of deadlock. Of a
 * bundle it takes the cable that its ends name: sums of the numbers of the source router and the
 * target node, which spreads neither's messages unevenly.
 *
 * Links: dimension by dimension, in each by the router they leave, then by the other router of the
 * line (less one where above), then by the cable of the bundle. */
#include "base/check.h"
#include "machine/topology_internal.h"

struct hyperx {
    int ndim;
    int radix[MACHINE_MAX_DIMS], stride[MACHINE_MAX_DIMS];
    int bundle[MACHINE_MAX_DIMS];
    int base[MACHINE_MAX_DIMS + 1]; /* first link of each dimension */
    int port[MACHINE_MAX_DIMS];     /* first input port of each dimension */
    int leaving[MACHINE_MAX_DIMS];  /* links of a dimension that leave one router */
};

/* Checked as it grows: dims come from a file, and their product may not fit. */
static bool hyperx_shape(struct hyperx *g, struct topology *t, struct err *e)
{
    const struct topology_spec *s = t->spec;
    int64_t nrouter = 1, nport = 0;
    for (int d = 0; d < s->ndim; d++) {
        if (s->dims[d] < 2)
            return err_set(e, ERR_CONFIG,
                           "topology hyperx: %d routers in dimension %d; expected at least 2",
                           s->dims[d], d);
        g->radix[d] = s->dims[d];
        g->stride[d] = (int)nrouter;
        g->bundle[d] = d < s->nbundle ? s->bundle[d] : 1;
        if (g->bundle[d] < 1)
            return err_set(e, ERR_CONFIG,
                           "topology hyperx: %d cables in dimension %d; expected at least 1",
                           g->bundle[d], d);
        g->port[d] = (int)nport;
        nrouter *= s->dims[d];
        nport += (int64_t)(s->dims[d] - 1) * g->bundle[d];
        /* Ports and links of all routers have to fit an int, and so has what hangs on them. */
        if (nrouter > INT32_MAX || nrouter * (nport + s->nodes_per_router) > INT32_MAX / 2)
            return err_set(e, ERR_CONFIG,
                           "topology hyperx: more routers and links than can be numbered");
        g->leaving[d] = (s->dims[d] - 1) * g->bundle[d];
    }
    t->nrouter = (int)nrouter;
    t->nport = (int)nport;
    for (int d = 0; d < s->ndim; d++) g->base[d + 1] = g->base[d] + t->nrouter * g->leaving[d];
    t->nlink = g->base[s->ndim];
    return true;
}

static bool hyperx_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    struct hyperx *g = TAKE(a, 1, struct hyperx);
    if (s->ndim < 1 || s->ndim > MACHINE_MAX_DIMS)
        return err_set(e, ERR_CONFIG, "topology hyperx: %d dimensions; expected 1 to %d", s->ndim,
                       MACHINE_MAX_DIMS);
    if (s->nbundle > s->ndim)
        return err_set(e, ERR_CONFIG,
                       "topology hyperx: topology.bundle has %d numbers for %d dimensions",
                       s->nbundle, s->ndim);
    g->ndim = s->ndim;
    if (!hyperx_shape(g, t, e)) return false;
    t->state = g;
    t->max_hops = g->ndim;
    return true;
}

/* stage: the dimension to look at next; via: what picks a cable of a bundle. */
static void hyperx_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    (void)choice;
    unsigned node = (unsigned)c->target * (unsigned)t->nodes_per_router + (unsigned)c->at;
    c->stage = 0;
    c->via = (int)(((unsigned)c->router + node) & INT32_MAX);
}

static int coordinate(const struct hyperx *g, int router, int d)
{
    return router / g->stride[d] % g->radix[d];
}

/* Straight to the target's coordinate in the lowest dimension where it differs. */
static bool hyperx_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    const struct hyperx *g = t->state;
    if (c->router == c->target) return false;
    int d = c->stage, from, to;
    for (;; d++) {
        from = coordinate(g, c->router, d);
        to = coordinate(g, c->target, d);
        if (from != to) break;
    }
    /* A line has no link from a router to itself: numbers above it move down by one. */
    int cable = c->via % g->bundle[d];
    h->link = g->base[d] + c->router * g->leaving[d] + (to - (to > from)) * g->bundle[d] + cable;
    h->port = g->port[d] + (from - (from > to)) * g->bundle[d] + cable;
    h->vc_class = 0;
    c->router += (to - from) * g->stride[d];
    c->stage = d + 1;
    return true;
}

/* One link for each coordinate that differs (the Hamming distance). */
static int hyperx_distance(const struct topology *t, int from, int to)
{
    const struct hyperx *g = t->state;
    int hops = 0;
    for (int d = 0; d < g->ndim; d++) hops += coordinate(g, from, d) != coordinate(g, to, d);
    return hops;
}

static int hyperx_rate_dim(const struct topology *t, int link)
{
    const struct hyperx *g = t->state;
    int d = 0;
    while (link >= g->base[d + 1]) d++;
    return d;
}

/* The numbering of the header, backwards. */
static void hyperx_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct hyperx *g = t->state;
    int d = hyperx_rate_dim(t, link), i = link - g->base[d];
    int other = i % g->leaving[d] / g->bundle[d], cable = i % g->bundle[d];
    *from = i / g->leaving[d];
    int x = coordinate(g, *from, d), y = other + (other >= x);
    *to = *from + (y - x) * g->stride[d];
    *port = g->port[d] + (x - (x > y)) * g->bundle[d] + cable;
}

/* Cables that leave m routers of a HyperX of these n dims (rising, `size` routers), where the m
 * come first in the order whose slowest coordinate is the shortest dimension: whole layers and a
 * part of one, which is cut in turn. By Lindsey's theorem (Amer. Math. Monthly 71, 1964) no other m
 * routers have fewer. */
static int64_t layers_cut(const int *dims, int n, int64_t size, int64_t m)
{
    if (n == 0 || m == 0 || m == size) return 0;
    int64_t layer = size / dims[0], full = m / layer, part = m % layer;
    /* A place of the layer is in full or in full + 1 layers of the half. */
    int64_t across =
        part * (full + 1) * (dims[0] - full - 1) + (layer - part) * full * (dims[0] - full);
    return across + layers_cut(dims + 1, n - 1, layer, part);
}

/* The theorem is of one number of cables everywhere. */
static int64_t hyperx_bisection(const struct topology *t)
{
    const struct hyperx *g = t->state;
    int dims[MACHINE_MAX_DIMS];
    for (int d = 0; d < g->ndim; d++) {
        if (g->bundle[d] != g->bundle[0]) return -1;
        int i = d;
        for (; i > 0 && dims[i - 1] > g->radix[d]; i--) dims[i] = dims[i - 1];
        dims[i] = g->radix[d];
    }
    return g->bundle[0] * layers_cut(dims, g->ndim, t->nrouter, t->nrouter / 2);
}

const struct topology_type topology_hyperx = {
    .name = "hyperx",
    .create = hyperx_create,
    .start = hyperx_start,
    .next = hyperx_next,
    .distance = hyperx_distance,
    .ends = hyperx_ends,
    .rate_dim = hyperx_rate_dim,
    .bisection = hyperx_bisection,
    .parts = topology_grid_parts,
};
