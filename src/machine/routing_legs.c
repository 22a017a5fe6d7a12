/* routing_legs.c - rules for every topology that follow its own routes: one of them, two through a
 * random node, or the better of both by load.
 *
 * The first leg has the lower classes of channels and the second the upper ones. Either leg by
 * itself is free of circles of waiting, as the topology's routes are, and no packet goes back from
 * the second to the first. A packet that goes straight to its destination is on its second leg. */
#include "machine/routing_internal.h"

static bool legs_create(struct routing *r, struct arena *a, struct err *e)
{
    (void)a;
    const int legs = r->rule == ROUTING_DETERMINISTIC || r->rule == ROUTING_BOOKSIM_MIN ? 1 : 2;
    r->by_load = r->at_source = r->minimal = r->rule == ROUTING_UGAL_L || r->rule == ROUTING_UGAL_G;
    r->max_hops = legs * r->topology->max_hops;
    r->most = 1;
    /* The fixed routes of BookSim's arbitrary networks take any channel and may deadlock. */
    if (r->rule == ROUTING_BOOKSIM_MIN) return routing_needs(r, 1, "", e);
    return routing_needs(r, legs * r->topology->nclass, "the topology's classes for each leg", e);
}

/* Links of the topology's own route, the flits outstanding on all of them, and on its first. */
static int look_ahead(const struct routing *r, const struct routing_view *view, int src, int dst,
                      uint64_t choice, int64_t *all, int64_t *first)
{
    struct route_cursor c = topology_start(r->topology, src, dst, choice);
    struct hop h;
    int n = 0;
    for (; topology_next(r->topology, &c, &h); n++) {
        const int64_t used = routing_used(view, h.link);
        if (n == 0) *first = used;
        *all += used;
    }
    return n;
}

/* UGAL (Singh 2005): minimal if its delay is not above that of the other way: local, the first
 * queue times the number of links; global, the queues of all links. */
static bool minimal_is_better(const struct routing *r, const struct route *p,
                              const struct routing_view *view)
{
    enum { THRESHOLD = 2 }; /* flits in favour of the minimal way */
    int64_t near = 0, far = 0, first_near = 0, first_far = 0, ignored = 0;
    const int direct = look_ahead(r, view, p->source, p->node, p->choice, &near, &first_near),
              there = look_ahead(r, view, p->source, p->via, p->choice, &far, &first_far),
              on = look_ahead(r, view, p->via, p->node, p->choice, &far, &ignored);
    if (r->rule == ROUTING_UGAL_G) return near <= far + THRESHOLD;
    return direct * first_near <= (there + on) * first_far + THRESHOLD;
}

/* At the source: the first leg to the router of a random node, where that is a third router and the
 * rule wants it. */
static void legs_choose(const struct routing *r, struct route *p, const struct routing_view *view)
{
    const struct topology *t = r->topology;
    p->phase = 1;
    if (r->rule != ROUTING_DETERMINISTIC && r->rule != ROUTING_BOOKSIM_MIN) {
        p->via = routing_draw(p, t->nnode);
        const int router = topology_router_of(t, p->via);
        const bool third = router != p->router && router != p->target;
        if (third && !(r->by_load && minimal_is_better(r, p, view))) p->phase = 0;
    }
    p->leg = topology_start(t, p->source, p->phase ? p->node : p->via, p->choice);
}

static int legs_next(const struct routing *r, struct route *p, const struct routing_view *view,
                     struct route_option *option)
{
    const struct topology *t = r->topology;
    const int legs = r->rule == ROUTING_DETERMINISTIC || r->rule == ROUTING_BOOKSIM_MIN ? 1 : 2;
    struct hop h;
    if (p->channel < 0) legs_choose(r, p, view);
    if (!topology_next(t, &p->leg, &h)) {
        if (p->phase == 1) return 0;
        p->phase = 1;
        p->leg = topology_start(t, p->via, p->node, p->choice);
        if (!topology_next(t, &p->leg, &h)) return 0;
    }
    *option = (struct route_option){.link = h.link, .count = r->channels};
    if (r->rule == ROUTING_BOOKSIM_MIN) return 1;
    const int class = legs == 1 ? h.vc_class : p->phase * t->nclass + h.vc_class;
    option->count = routing_class(r, class, legs * t->nclass, &option->first);
    return 1;
}

const struct routing_type routing_leg_types[] = {
    {ROUTING_DETERMINISTIC, 0, legs_create, NULL, legs_next, NULL, ROUTING_BY_MORE},
    {ROUTING_BOOKSIM_MIN, 1 << TOPOLOGY_GRAPH, legs_create, NULL, legs_next, NULL, ROUTING_BY_MORE},
    {ROUTING_VALIANT, 0, legs_create, NULL, legs_next, NULL, ROUTING_BY_MORE},
    {ROUTING_UGAL_L, 0, legs_create, NULL, legs_next, NULL, ROUTING_BY_MORE},
    {ROUTING_UGAL_G, 0, legs_create, NULL, legs_next, NULL, ROUTING_BY_MORE},
    {0, 0, NULL, NULL, NULL, NULL, 0},
};
