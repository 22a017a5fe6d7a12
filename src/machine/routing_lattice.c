/* routing_lattice.c - rules on meshes, tori, hypercubes and HyperX networks that go by dimensions:
 * in order, in either order, through an intermediate router.
 *
 * On a ring the rules of BookSim choose a packet's class when it enters the dimension, 1 if its way
 * passes the edge, and keep it in that dimension: a packet of class 1 goes at most half way round,
 * so that the links of class 1 never wait for each other all around. */
#include "machine/routing_lattice.h"

/* ---- the lattice ---- */

/* Radix and stride of every dimension; a hypercube is a mesh of two routers in each. */
static void lattice_shape(struct lattice *g, const struct topology_spec *s)
{
    const bool cube = s->family == TOPOLOGY_HYPERCUBE;
    int stride = 1;
    g->ndim = cube ? s->dims[0] : s->ndim;
    g->wraps = s->family == TOPOLOGY_TORUS;
    g->direct = !cube && !g->wraps && s->family != TOPOLOGY_MESH;
    for (int d = 0; d < g->ndim; d++) {
        g->radix[d] = cube ? 2 : s->dims[d];
        g->stride[d] = stride;
        g->first[d] = g->degree;
        g->degree += g->direct ? g->radix[d] : 2;
        stride *= g->radix[d];
        g->diameter += g->direct ? 1 : g->wraps ? g->radix[d] / 2 : g->radix[d] - 1;
    }
}

struct lattice *lattice_create(const struct routing *r, struct arena *a)
{
    const struct topology *t = r->topology;
    struct lattice *g = TAKE(a, 1, struct lattice);
    lattice_shape(g, t->spec);
    g->nrouter = t->nrouter;
    /* Coordinates by divisions, once: rules ask for them at every router of every packet. */
    g->at = TAKE(a, size_product((size_t)t->nrouter, (size_t)g->ndim), int);
    for (int i = 0; i < t->nrouter * g->ndim; i++)
        g->at[i] = i / g->ndim / g->stride[i % g->ndim] % g->radix[i % g->ndim];
    g->out = TAKE(a, size_product((size_t)t->nrouter, (size_t)g->degree), int);
    for (int i = 0; i < t->nrouter * g->degree; i++) g->out[i] = -1;
    for (int link = 0; link < t->nlink; link++) {
        int from, to, port;
        topology_link_ends(t, link, &from, &to, &port);
        const int d = lattice_dimension(g, from, to, false);
        /* The links beside a hypercube's own differ in all dimensions or come later. */
        if (to != from + (lattice_at(g, to, d) - lattice_at(g, from, d)) * g->stride[d]) continue;
        /* On a ring of two the ports tell the two links apart: from below, or from above. */
        const int way = g->wraps ? port % 2 == 0 : to < from;
        int *slot =
            &g->out[from * g->degree + g->first[d] + (g->direct ? lattice_at(g, to, d) : way)];
        if (*slot < 0) *slot = link;
        else if (from == 0) g->bundle[d] = link - *slot;
    }
    for (int d = 0; d < g->ndim; d++) g->bundle[d] = g->direct ? g->bundle[d] + 1 : 1;
    return g;
}

/* ---- dimension order ---- */

/* Where the next link depends on both ends alone: neither rings nor bundles. */
static void order_keep(struct routing *r, struct arena *a)
{
    struct lattice *g = r->state;
    const int n = r->topology->nrouter;
    bool single = !g->wraps && g->degree <= UINT8_MAX;
    for (int d = 0; d < g->ndim; d++) single = single && g->bundle[d] == 1;
    for (int descending = 0; single && descending < 2; descending++) {
        uint8_t *slot = TAKE_FULL(a, size_product((size_t)n, (size_t)n), uint8_t, true);
        for (int from = 0; from < n; from++)
            for (int to = 0; to < n; to++) {
                const int d = lattice_dimension(g, from, to, descending);
                if (d < 0) continue;
                const int x = lattice_at(g, from, d), y = lattice_at(g, to, d);
                slot[from * n + to] = (uint8_t)(g->first[d] + (g->direct ? y : y < x));
            }
        g->slot[descending] = slot;
        r->kept = true;
    }
}

/* The one way on to router `to` by order of dimensions. On a ring: straight on in the dimension of
 * the last link, else the shorter way, of equals by chance, and its class. */
static inline void in_order(const struct routing *r, struct route *p, int to, bool descending,
                            struct route_option *o)
{
    const struct lattice *g = r->state;
    if (g->slot[descending]) {
        const int slot = g->slot[descending][p->router * r->topology->nrouter + to];
        *o = (struct route_option){
            .link = g->out[p->router * g->degree + slot], .part = p->part, .last = slot};
        return;
    }
    const int d = lattice_dimension(g, p->router, to, descending);
    const int x = lattice_at(g, p->router, d), y = lattice_at(g, to, d);
    int way, part = p->part;
    if (g->wraps && p->last >= 0 && p->last / 2 == d) {
        way = p->last % 2;
    } else {
        way = lattice_way(g, d, x, y);
        if (way < 0) way = !routing_draw(p, 2);
        part = lattice_crosses(g, x, y, way);
    }
    *o = (struct route_option){
        .link = lattice_link(g, p, d, y, way), .part = part, .last = 2 * d + way};
}

/* The load of its link. */
static int64_t used_in_order(const struct routing *r, struct route *p, int to, bool descending,
                             const struct routing_view *view)
{
    struct route_option o;
    in_order(r, p, to, descending, &o);
    return routing_used(view, o.link);
}

static bool order_create(struct routing *r, struct arena *a, struct err *e)
{
    struct lattice *g = lattice_create(r, a);
    r->state = g;
    r->keep = order_keep;
    r->most = 1;
    r->max_hops = g->diameter;
    r->minimal = true;
    return routing_needs(r, g->wraps ? 2 : 1, "two halves of the ring", e);
}

/* Mesh and HyperX: any channel. Torus: the half of its class. */
static int order_next(const struct routing *r, struct route *p, const struct routing_view *view,
                      struct route_option *option)
{
    const struct lattice *g = r->state;
    (void)view;
    if (p->router == p->target) return 0;
    in_order(r, p, p->target, false, option);
    option->count = r->channels;
    if (g->wraps) option->count = routing_half(r, option->part, &option->first);
    return 1;
}

/* ---- either order ---- */

static bool either_create(struct routing *r, struct arena *a, struct err *e)
{
    struct lattice *g = lattice_create(r, a);
    r->state = g;
    r->keep = order_keep;
    r->most = 1;
    r->max_hops = g->diameter;
    r->minimal = true;
    r->by_load = r->at_source = r->rule == ROUTING_ADAPTIVE_XY_YX;
    return routing_needs(r, 2, "one half for each order of dimensions", e);
}

/* The order is chosen at the source and kept; each has its half of the channels, so that neither
 * waits for the other. phase: 0 ascending, 1 descending. */
static int either_next(const struct routing *r, struct route *p, const struct routing_view *view,
                       struct route_option *option)
{
    if (p->router == p->target) return 0;
    if (p->channel < 0) {
        int64_t up = 0, down = 0;
        if (r->by_load) {
            up = used_in_order(r, p, p->target, false, view);
            down = used_in_order(r, p, p->target, true, view);
        }
        p->phase = up == down ? !routing_draw(p, 2) : up > down;
    }
    in_order(r, p, p->target, p->phase, option);
    option->count = routing_half(r, p->phase, &option->first);
    return 1;
}

/* ---- through an intermediate router ---- */

static bool through_create(struct routing *r, struct arena *a, struct err *e)
{
    struct lattice *g = lattice_create(r, a);
    r->state = g;
    r->keep = order_keep;
    r->most = 1;
    r->max_hops = 2 * g->diameter;
    r->minimal = r->rule == ROUTING_ROMM;
    return routing_needs(r, g->wraps ? 4 : 2, "classes for each leg", e);
}

/* ROMM (Nesson and Johnsson 1995): a router of the box that both ends span, the smaller box on a
 * ring. Valiant: the router of any node. */
static int through_choose(const struct routing *r, struct route *p)
{
    const struct lattice *g = r->state;
    if (r->rule == ROUTING_BOOKSIM_VALIANT)
        return topology_router_of(r->topology, routing_draw(p, r->topology->nnode));
    int via = 0;
    for (int d = 0; d < g->ndim; d++) {
        const int x = lattice_at(g, p->router, d), y = lattice_at(g, p->target, d);
        int way = lattice_way(g, d, x, y), k = g->radix[d];
        if (way < 0) way = routing_draw(p, 2);
        const int span = way ? (x - y + k) % k : (y - x + k) % k;
        const int step = routing_draw(p, span + 1);
        via += (way ? x - step + k : x + step) % k * g->stride[d];
    }
    return via;
}

/* A quarter of the channels: by class on the ring, then by leg. */
static int quarter(const struct routing *r, int part, int leg, int *first)
{
    int n = routing_half(r, part, first), upper = r->channels / 2 / 2, lower = n - upper;
    if (leg) *first += lower;
    return leg ? upper : lower;
}

/* On a HyperX a packet that meets its destination on the first leg is there. */
static int through_next(const struct routing *r, struct route *p, const struct routing_view *view,
                        struct route_option *option)
{
    const struct lattice *g = r->state;
    (void)view;
    if (p->channel < 0) p->via = through_choose(r, p);
    if (p->phase == 0 && (p->router == p->via || (g->direct && p->router == p->target))) {
        p->phase = 1;
        p->last = -1;
    }
    if (p->phase == 1 && p->router == p->target) return 0;
    in_order(r, p, p->phase ? p->target : p->via, false, option);
    option->count = g->wraps ? quarter(r, option->part, p->phase, &option->first)
                             : routing_half(r, p->phase, &option->first);
    return 1;
}

/* ---- UGAL on a flattened butterfly, as BookSim has it ---- */

static int distance(const struct lattice *g, int from, int to)
{
    int n = 0;
    if (g->far) return g->far[from * g->nrouter + to];
    for (int d = 0; d < g->ndim; d++) n += lattice_at(g, from, d) != lattice_at(g, to, d);
    return n;
}

static void butterfly_keep(struct routing *r, struct arena *a)
{
    struct lattice *g = r->state;
    const int n = g->nrouter;
    uint8_t *far = TAKE_FULL(a, size_product((size_t)n, (size_t)n), uint8_t, true);
    order_keep(r, a);
    for (int from = 0; from < n; from++)
        for (int to = 0; to < n; to++) far[from * n + to] = (uint8_t)distance(g, from, to);
    g->far = far;
}

static bool butterfly_create(struct routing *r, struct arena *a, struct err *e)
{
    r->state = lattice_create(r, a);
    r->keep = butterfly_keep;
    r->most = 1;
    r->max_hops = 2 * r->topology->max_hops;
    r->by_load = r->at_source = r->minimal = true;
    return routing_needs(r, 2, "one half for each leg", e);
}

/* Once, at the source: minimal if its queue times its links is at most two flits above that of the
 * other way. The intermediate router differs only in dimensions in which the ends differ. */
static void butterfly_choose(const struct routing *r, struct route *p,
                             const struct routing_view *view)
{
    const struct lattice *g = r->state;
    enum { THRESHOLD = 2 };
    int via = 0;
    for (int d = 0; d < g->ndim; d++) {
        const int x = lattice_at(g, p->router, d);
        const bool same = x == lattice_at(g, p->target, d);
        via += (same ? x : routing_draw(p, g->radix[d])) * g->stride[d];
    }
    p->phase = 1;
    if (via == p->router) return;
    const int64_t near = used_in_order(r, p, p->target, false, view),
                  far = used_in_order(r, p, via, false, view);
    const int there = distance(g, p->router, via) + distance(g, via, p->target);
    if (distance(g, p->router, p->target) * near <= there * far + THRESHOLD) return;
    p->via = via;
    p->phase = 0;
}

static int butterfly_next(const struct routing *r, struct route *p, const struct routing_view *view,
                          struct route_option *option)
{
    if (p->channel < 0 && p->router != p->target) butterfly_choose(r, p, view);
    if (p->phase == 0 && p->router == p->via) p->phase = 1;
    if (p->router == p->target && (p->phase == 1 || p->via < 0)) return 0;
    in_order(r, p, p->phase ? p->target : p->via, false, option);
    option->count = routing_half(r, p->phase, &option->first);
    return 1;
}

enum {
    MESHES = 1 << TOPOLOGY_MESH | 1 << TOPOLOGY_HYPERCUBE,
    GRIDS = MESHES | 1 << TOPOLOGY_TORUS,
    DIRECT = 1 << TOPOLOGY_HYPERX
};

const struct routing_type routing_lattice_types[] = {
    {ROUTING_BOOKSIM_DIM_ORDER, GRIDS | DIRECT, order_create, NULL, order_next, NULL,
     ROUTING_BY_GOAL},
    {ROUTING_XY_YX, MESHES | DIRECT, either_create, NULL, either_next, NULL, ROUTING_BY_ORDER},
    {ROUTING_ADAPTIVE_XY_YX, MESHES | DIRECT, either_create, NULL, either_next, NULL,
     ROUTING_BY_ORDER},
    {ROUTING_ROMM, GRIDS, through_create, NULL, through_next, NULL, ROUTING_BY_LEG},
    {ROUTING_BOOKSIM_VALIANT, GRIDS | DIRECT, through_create, NULL, through_next, NULL,
     ROUTING_BY_LEG},
    {ROUTING_BOOKSIM_UGAL, DIRECT, butterfly_create, NULL, butterfly_next, NULL, ROUTING_BY_LEG},
    {0, 0, NULL, NULL, NULL, NULL, 0},
};
