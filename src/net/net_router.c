/* net_router.c - what happens at the routers of net_router.h: heads come to the front, find their
 * way on and own channels.
 *
 * The times are those of levels packet and flit (docs/network.md): a head is at the next port a hop
 * latency after it crossed the last one, the setup of the router is its alone, and a flit needs the
 * credit of the flit a buffer's size earlier. A router is looked at when something can happen in
 * it: then all that asks at this instant is served together (net_router_allocate.c). */
#include "net/net_router_gather.h"
#include "net/net_router_lane.h"

/* An event that an earlier one overtook is still to come. */
void router_post(struct routers *g, int r, sim_ps at)
{
    struct router *o = &g->router[r];
    const struct net *n = g->fabric.net;
    const uint64_t number = (uint64_t)n->nresource + (uint64_t)r;
    sim_ps *place = NULL;
    if (at == sim_now(n->sim)) {
        const uint64_t again = (uint64_t)n->topology->nrouter + (uint64_t)r;
        o->second = true;
        sim_at(n->sim, at, ROUTER_LANE_AGAIN, number, g->look, g, again);
        return;
    }
    for (int i = 0; i < ROUTER_POSTED; i++) {
        if (o->posted[i] == at + 1) return;
        if (o->posted[i] == 0) place = &o->posted[i];
    }
    if (place) *place = at + 1;
    sim_at(n->sim, at, NET_LANE_ARBITRATE, number, g->look, g, (uint64_t)r);
}

/* ---- ways on ---- */

/* The ways on of v's front into v->option, where there may be more than a lane has memory for, by
 * way of a list on the stack. Returns how many. */
static __attribute__((noinline)) int options_find(struct routers *g, struct lane *v)
{
    const struct routing_view view = {router_used, g};
    struct route_option option[ROUTING_MOST_OPTIONS];
    const int n = routing_next(g->routing, &v->front->worm->route, &view, option);
    if (n > v->room) {
        v->room = n;
        v->option = TAKE(g->fabric.net->arena, n, struct route_option);
    }
    for (int i = 0; i < n; i++) v->option[i] = option[i];
    return n;
}

void router_route(struct routers *g, struct lane *v)
{
    const struct routing_view view = {router_used, g};
    const bool looks = router_looks(g, v);
    struct route *way = &v->front->worm->route;
    const int n = g->few ? routing_next(g->routing, way, &view, v->option) : options_find(g, v);
    const struct route_option *o = v->option;
    int first = 0, count;
    v->noption = (int16_t)n;
    if (n == 0) {
        count = routing_eject(g->routing, way, &first);
        v->way = g->sink + way->node;
    } else {
        first = o->first;
        count = o->count;
        v->way = net_resource(g->fabric.net, o->link);
    }
    v->first = (int16_t)first;
    v->count = (int16_t)count;
    const struct port *p = &g->port[v->way];
    v->ways = router_bit(p->out);
    for (int i = 1; i < n; i++) v->ways |= router_bit(g->port[router_out(g, v, &v->option[i])].out);
    /* What the look at it will ask of. */
    if (p->lane) __builtin_prefetch(&p->lane[first]);
    v->state = LANE_ASKING;
    if (looks) v->due += g->setup;
}

/* ---- credits ---- */

/* Flits in the lanes, and those that left so short a time ago that their credits are not back. What
 * is known already to be sent later does not count. */
int64_t router_used(const void *of, int link)
{
    const struct routers *g = of;
    const struct fabric *f = &g->fabric;
    const struct port *p = &g->port[net_resource(f->net, link)];
    const sim_ps late = f->net->credit + p->wire;
    const sim_ps sent = g->now + f->net->tau - f->net->setup + p->wire;
    int64_t used = 0;
    const bool home = p->passed + late <= g->now; /* all credits of what left */
    for (int i = 0; p->lane && i < f->nchannel; i++) {
        const struct lane *v = &p->lane[i];
        if (home && v->in == v->out) continue;
        used += v->in - v->out;
        for (int64_t k = v->out - 1; k >= 0 && k >= v->out - g->ring; k--) {
            if (v->stay[k & g->ring].go + late <= g->now) break;
            used++;
        }
        for (int64_t k = v->in - 1; k >= 0 && k >= v->in - g->ring; k--) {
            if (v->stay[k & g->ring].come < sent) break;
            used--;
        }
    }
    return used;
}

/* ---- channels ---- */

/* The worm of v's front stands in lane `out` from its head on, so that flits of different worms
 * never mix in a FIFO. */
void router_own(struct routers *g, struct lane *v, struct lane *out)
{
    struct leg *l = v->front, *m = router_leg(g, l->worm, out);
    const int p = out->port;
    l->ahead = m;
    m->ask = v->due;
    v->state = LANE_SENDING;
    v->ways = router_bit(out->of->out);
    if (net_is_ejection(g->fabric.net, p)) return;
    const struct route_option *o = v->option;
    /* Of several options that lead over this channel the first one is as good as any. */
    while (router_out(g, v, o) != p || out->channel < o->first ||
           out->channel >= o->first + o->count)
        o++;
    routing_take(g->routing, &l->worm->route, o, out->channel);
}
