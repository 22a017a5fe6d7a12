/* routing_dragonfly.c - dragonflies as BookSim routes them: minimal, or UGAL with the intermediate
 * node drawn from the whole system and one comparison at the source.
 *
 * The channel is the order of a packet's stages: on the way to the intermediate router, then up to
 * the global link that leads to the destination's group, then from there on. Channels only rise. */
#include "machine/routing_internal.h"
#include "machine/topology_internal.h"

enum { BIAS = 30, MINIMAL_CHANNELS = 2, UGAL_CHANNELS = 3 };

/* The topology's next link from a router to another, where it does not depend on where the way
 * began: with one link between two groups. */
static void dragonfly_keep(struct routing *r, struct arena *a)
{
    const struct topology *t = r->topology;
    const int *dims = t->spec->dims, n = t->nrouter, groups = n / dims[1];
    if (dims[1] * dims[2] / (groups - 1) > 1) return;
    int *next = TAKE_FULL(a, size_product((size_t)n, (size_t)n), int, true);
    for (int from = 0; from < n; from++)
        for (int to = 0; to < n; to++) {
            struct route_cursor c = topology_start(t, from * dims[0], to * dims[0], 0);
            struct hop h;
            if (topology_next(t, &c, &h)) next[from * n + to] = h.link;
        }
    r->state = next;
    r->kept = true;
}

static bool dragonfly_create(struct routing *r, struct arena *a, struct err *e)
{
    (void)a;
    const bool ugal = r->rule == ROUTING_BOOKSIM_UGAL;
    /* Its channels are those of minimal legs: a third group on the way would close a circle. */
    if (!r->topology->fixed_routes)
        return err_set(e, ERR_CONFIG,
                       "network.routing '%s' is not for topology 'dragonfly' with "
                       "topology.routing 'valiant'",
                       routing_rule_name(r->rule));
    r->by_load = r->at_source = ugal;
    r->fixed = true;
    r->keep = dragonfly_keep;
    r->most = 1;
    r->max_hops = (ugal ? 2 : 1) * r->topology->max_hops;
    return routing_needs(r, ugal ? UGAL_CHANNELS : MINIMAL_CHANNELS, "a channel for each stage", e);
}

/* Into the network over one channel, drawn by chance. */
static int dragonfly_inject(const struct routing *r, struct route *p, int *first)
{
    *first = routing_draw(p, r->channels);
    return 1;
}

static int group_of(const struct routing *r, int router)
{
    return router / r->topology->spec->dims[1];
}

static int64_t first_queue(const struct routing *r, const struct routing_view *view, int src,
                           int dst)
{
    const int *next = r->state;
    const int from = topology_router_of(r->topology, src),
              to = topology_router_of(r->topology, dst);
    if (next) return from == to ? 0 : routing_used(view, next[from * r->topology->nrouter + to]);
    struct route_cursor c = topology_start(r->topology, src, dst, 0);
    struct hop h;
    return topology_next(r->topology, &c, &h) ? routing_used(view, h.link) : 0;
}

/* part: the stage of UGAL: 0 to the intermediate router, 1 to the global link, 2 after it and
 * inside a group. The queue of the minimal way may be twice the other's and BIAS flits longer. */
static void ugal_choose(const struct routing *r, struct route *p, const struct routing_view *view)
{
    p->part = 2;
    if (group_of(r, p->router) == group_of(r, p->target)) return;
    p->part = 1;
    p->via = routing_draw(p, r->topology->nnode);
    if (group_of(r, topology_router_of(r->topology, p->via)) == group_of(r, p->router)) return;
    const int64_t near = first_queue(r, view, p->source, p->node),
                  far = first_queue(r, view, p->source, p->via);
    if (near > 2 * far + BIAS) p->part = 0;
}

/* The topology's next link for p, -1: it is there. `fresh`: a leg of its way begins. */
static int leg_next(const struct routing *r, struct route *p, bool fresh, bool aside)
{
    const struct topology *t = r->topology;
    const int *next = r->state;
    struct hop h;
    if (next) {
        const int to = aside ? topology_router_of(t, p->via) : p->target;
        return p->router == to ? -1 : next[p->router * t->nrouter + to];
    }
    if (fresh)
        p->leg =
            topology_start(t, p->channel < 0 ? p->source : p->via, aside ? p->via : p->node, 0);
    return topology_next(t, &p->leg, &h) ? h.link : -1;
}

static int dragonfly_next(const struct routing *r, struct route *p, const struct routing_view *view,
                          struct route_option *option)
{
    const struct topology *t = r->topology;
    const bool ugal = r->rule == ROUTING_BOOKSIM_UGAL;
    bool fresh = p->channel < 0;
    if (fresh && ugal) ugal_choose(r, p, view);
    if (ugal && p->part == 0 && p->router == topology_router_of(t, p->via)) {
        p->part = 1;
        fresh = true;
    }
    const int link = leg_next(r, p, fresh, ugal && p->part == 0);
    if (link < 0) return 0;
    /* A global link ends the stage: dim 1 of a dragonfly's links. */
    const bool global = t->type->rate_dim(t, link) == 1;
    const int last = ugal ? 2 : 1, part = global && !(ugal && p->part == 0) ? last : p->part;
    *option = (struct route_option){.link = link, .first = part, .count = 1, .part = part};
    return 1;
}

/* Out of the network over the channel of its stage, which is that of the simulator's code. */
static int dragonfly_eject(const struct routing *r, const struct route *p, int *first)
{
    (void)r;
    *first = p->part;
    return 1;
}

enum { DRAGONFLIES = 1 << TOPOLOGY_DRAGONFLY };

const struct routing_type routing_dragonfly_types[] = {
    {ROUTING_BOOKSIM_MIN, DRAGONFLIES, dragonfly_create, dragonfly_inject, dragonfly_next,
     dragonfly_eject, ROUTING_BY_STAGE},
    {ROUTING_BOOKSIM_UGAL, DRAGONFLIES, dragonfly_create, dragonfly_inject, dragonfly_next,
     dragonfly_eject, ROUTING_BY_STAGE},
    {0, 0, NULL, NULL, NULL, NULL, 0},
};
