/* routing_adaptive.c - minimal adaptive rules: any link that leads nearer, chosen by load at the
 * router.
 *
 * On meshes, tori and hypercubes the lowest channels are an escape: they follow the dimension order
 * with classes for rings, are open to every packet, and cannot wait for each other in a circle even
 * when packets come back to them from the other channels (Duato 1993; the tests build the extended
 * graph of dependencies). Elsewhere the class is the number of links behind. */
#include "machine/routing_lattice.h"

/* ---- with an escape ---- */

enum { MESH_ESCAPE = 1, RING_ESCAPE = 2 };

static bool escape_create(struct routing *r, struct arena *a, struct err *e)
{
    struct lattice *g = lattice_create(r, a);
    r->state = g;
    r->max_hops = g->diameter;
    r->escape = g->wraps ? RING_ESCAPE : MESH_ESCAPE;
    r->by_load = r->fits = r->minimal = true;
    return routing_needs(r, r->escape + 1, "escape channels and one that adapts", e);
}

/* Dimension order on the escape channels: of a ring the class by where the packet is, 1 while the
 * edge is still to be passed. Of two equal ways the upper one, so that a packet never turns. */
static struct route_option escape_option(const struct lattice *g, const struct route *p)
{
    const int d = lattice_dimension(g, p->router, p->target, false);
    const int x = lattice_at(g, p->router, d), y = lattice_at(g, p->target, d);
    int way = lattice_way(g, d, x, y);
    if (way < 0) way = p->last >= 0 && p->last / 2 == d ? p->last % 2 : 0;
    return (struct route_option){.link = lattice_link(g, p, d, y, way),
                                 .first = lattice_crosses(g, x, y, way),
                                 .count = 1,
                                 .last = 2 * d + way};
}

/* Every link that leads nearer, with the channels above the escape; the one with the fewest flits
 * outstanding comes first. The escape is the last choice. */
static int escape_next(const struct routing *r, struct route *p, const struct routing_view *view,
                       struct route_option *option)
{
    const struct lattice *g = r->state;
    int n = 0, best = 1;
    int64_t fewest = INT64_MAX;
    if (p->router == p->target) return 0;
    option[n++] = escape_option(g, p);
    for (int d = 0; d < g->ndim; d++) {
        const int x = lattice_at(g, p->router, d), y = lattice_at(g, p->target, d);
        const int way = lattice_way(g, d, x, y);
        for (int w = 0; w < 2 && x != y; w++) {
            if (way >= 0 && way != w) continue;
            option[n] = (struct route_option){.link = lattice_link(g, p, d, y, w),
                                              .first = r->escape,
                                              .count = r->channels - r->escape,
                                              .priority = 1,
                                              .last = 2 * d + w};
            const int64_t used = routing_used(view, option[n].link);
            if (used < fewest) {
                fewest = used;
                best = n;
            }
            n++;
        }
    }
    option[best].priority = 2;
    return n;
}

/* ---- BookSim's ---- */

/* From one router to another, on a torus. */
static struct lattice_step step_between(const struct lattice *g, int from, int to)
{
    const int d = lattice_dimension(g, from, to, false);
    const int x = lattice_at(g, from, d), y = lattice_at(g, to, d);
    const int *link = &g->out[from * g->degree + g->first[d]];
    return (struct lattice_step){
        .link = {link[0], link[1]},
        .crosses = {lattice_crosses(g, x, y, 0), lattice_crosses(g, x, y, 1)},
        .dim = (uint8_t)d,
        .way = (int8_t)lattice_way(g, d, x, y)};
}

static void booksim_keep(struct routing *r, struct arena *a)
{
    struct lattice *g = r->state;
    const int n = g->nrouter;
    if (!g->wraps) return;
    struct lattice_step *step =
        TAKE_FULL(a, size_product((size_t)n, (size_t)n), struct lattice_step, true);
    for (int i = 0; i < n * n; i++)
        if (i / n != i % n) step[i] = step_between(g, i / n, i % n);
    g->step = step;
}

static bool booksim_create(struct routing *r, struct arena *a, struct err *e)
{
    struct lattice *g = lattice_create(r, a);
    r->state = g;
    r->keep = booksim_keep;
    r->max_hops = g->diameter;
    r->escape = g->wraps ? RING_ESCAPE : MESH_ESCAPE;
    r->minimal = true;
    r->most = 2;
    if (g->wraps) return routing_needs(r, 4, "its channel 3 adapts", e);
    return routing_needs(r, 2, "an escape channel and one that adapts", e);
}

/* Mesh: dimension order on channel 0, and on the others for who is not on channel 0 already. The
 * simulator's code names every dimension that leads nearer, but the set that it puts them in keeps
 * one way of each priority: the first, which is that of the lowest dimension. No load is compared.
 */
static int booksim_mesh_next(const struct routing *r, struct route *p,
                             const struct routing_view *view, struct route_option *option)
{
    const struct lattice *g = r->state;
    (void)view;
    if (p->router == p->target) return 0;
    option[0] = escape_option(g, p);
    if (p->channel == 0) return 1;
    option[1] = option[0];
    option[1].first = 1;
    option[1].count = r->channels - 1;
    option[1].priority = 1;
    return 2;
}

/* Torus: channels 0 and 1 by dimension order with the ring's class; channel 3 without, in the
 * lowest dimension alone (as above), and downwards where both ways are equal. On the escape the
 * class is kept in its dimension; from channel 3 it is chosen anew, and of equal ways one by
 * chance. Channel 3 is given to packets behind others, who cannot turn to the escape: a ring of
 * four can lock up (docs/network.md). */
static int booksim_torus_next(const struct routing *r, struct route *p,
                              const struct routing_view *view, struct route_option *option)
{
    const struct lattice *g = r->state;
    const bool escaped = p->channel >= 0 && p->channel < RING_ESCAPE;
    (void)view;
    if (p->router == p->target) return 0;
    const struct lattice_step s = g->step ? g->step[p->router * g->nrouter + p->target]
                                          : step_between(g, p->router, p->target);
    const int d = s.dim;
    const bool straight = escaped && p->last / 2 == d;
    int way = s.way, part = p->part;
    if (straight) way = p->last % 2;
    else if (way < 0) way = !routing_draw(p, 2);
    if (!straight) part = s.crosses[way];
    option[0] = (struct route_option){.link = s.link[way],
                                      .first = part,
                                      .count = 1,
                                      .part = part,
                                      .last = 2 * d + way};
    if (escaped) return 1;
    const int down = s.way != 0;
    option[1] = (struct route_option){.link = s.link[down],
                                      .first = 3,
                                      .count = 1,
                                      .priority = 1,
                                      .last = 2 * d + down};
    return 2;
}

/* ---- by distance, on any topology ---- */

enum { MOST_TABLED = 4096 }; /* routers whose distances are kept, a byte for each two */

struct distances {
    int *first, *out;  /* links that leave router i: out[first[i] .. first[i + 1] - 1] */
    int *end;          /* (nlink) the router that a link leads to */
    uint8_t *distance; /* (nrouter x nrouter) [target, router] */
    int diameter;
};

/* Links by the router that they leave: a counting sort. */
static void leaving_links(struct distances *g, const struct topology *t, struct arena *a)
{
    int from, port;
    g->first = TAKE(a, t->nrouter + 2, int);
    g->out = TAKE(a, t->nlink + 1, int);
    g->end = TAKE(a, t->nlink + 1, int);
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &g->end[l], &port);
        g->first[from + 2]++;
    }
    for (int i = 0; i < t->nrouter; i++) g->first[i + 2] += g->first[i + 1];
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &g->end[l], &port);
        g->out[g->first[from + 1]++] = l;
    }
}

/* Breadth first from every router. Links come in pairs, there and back, so that the distance from
 * the target is that to it. */
static bool measure(struct distances *g, const struct topology *t, struct arena *a)
{
    int *queue = TAKE(a, t->nrouter, int);
    for (int target = 0; target < t->nrouter; target++) {
        uint8_t *row = &g->distance[(size_t)target * (size_t)t->nrouter];
        for (int i = 0; i < t->nrouter; i++) row[i] = UINT8_MAX;
        int done = 0, seen = 0;
        row[target] = 0;
        for (queue[seen++] = target; done < seen; done++) {
            const int at = queue[done];
            for (int i = g->first[at]; i < g->first[at + 1]; i++) {
                const int to = g->end[g->out[i]];
                if (row[to] != UINT8_MAX || row[at] == UINT8_MAX - 1) continue;
                row[to] = (uint8_t)(row[at] + 1);
                queue[seen++] = to;
            }
            if (row[at] > g->diameter) g->diameter = row[at];
        }
        if (seen < t->nrouter) return false;
    }
    return true;
}

static bool distance_create(struct routing *r, struct arena *a, struct err *e)
{
    const struct topology *t = r->topology;
    struct distances *g = TAKE(a, 1, struct distances);
    if (t->nrouter > MOST_TABLED)
        return err_set(e, ERR_CONFIG,
                       "network.routing 'adaptive' on topology '%s' has %d routers; it can keep "
                       "the distances of at most %d",
                       topology_family_name(t->spec->family), t->nrouter, MOST_TABLED);
    leaving_links(g, t, a);
    g->distance = TAKE_FULL(a, size_product((size_t)t->nrouter, (size_t)t->nrouter), uint8_t, true);
    r->state = g;
    if (!measure(g, t, a))
        return err_set(e, ERR_CONFIG, "network.routing 'adaptive': not all routers are joined");
    r->by_load = true;
    r->max_hops = g->diameter;
    return routing_needs(r, g->diameter, "a class for each link of the longest way", e);
}

/* Classes rise with every link, so that no circle of waiting can close. */
static int distance_next(const struct routing *r, struct route *p, const struct routing_view *view,
                         struct route_option *option)
{
    const struct distances *g = r->state;
    const uint8_t *row = &g->distance[(size_t)p->target * (size_t)r->topology->nrouter];
    int n = 0, best = 0;
    int64_t fewest = INT64_MAX;
    if (p->router == p->target) return 0;
    for (int i = g->first[p->router]; i < g->first[p->router + 1]; i++) {
        const int link = g->out[i];
        if (row[g->end[link]] >= row[p->router] || n == ROUTING_MOST_OPTIONS) continue;
        option[n] = (struct route_option){.link = link, .priority = 1};
        option[n].count = routing_class(r, p->hops, g->diameter, &option[n].first);
        const int64_t used = routing_used(view, link);
        if (used < fewest) {
            fewest = used;
            best = n;
        }
        n++;
    }
    option[best].priority = 2;
    return n;
}

enum { MESHES = 1 << TOPOLOGY_MESH | 1 << TOPOLOGY_HYPERCUBE, RINGS = 1 << TOPOLOGY_TORUS };

const struct routing_type routing_adaptive_types[] = {
    {ROUTING_ADAPTIVE, MESHES | RINGS, escape_create, NULL, escape_next, NULL, ROUTING_BY_MORE},
    {ROUTING_BOOKSIM_MIN_ADAPT, MESHES, booksim_create, NULL, booksim_mesh_next, NULL,
     ROUTING_BY_MORE},
    {ROUTING_BOOKSIM_MIN_ADAPT, RINGS, booksim_create, NULL, booksim_torus_next, NULL,
     ROUTING_BY_MORE},
    {ROUTING_ADAPTIVE, 0, distance_create, NULL, distance_next, NULL, ROUTING_BY_MORE},
    {0, 0, NULL, NULL, NULL, NULL, 0},
};
