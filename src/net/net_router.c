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
    sim_ps *place = NULL;
    for (int i = 0; i < ROUTER_POSTED; i++) {
        if (o->posted[i] == at + 1) return;
        if (o->posted[i] == 0) place = &o->posted[i];
    }
    if (place) *place = at + 1;
    const unsigned lane = at == sim_now(n->sim) ? ROUTER_LANE_AGAIN : NET_LANE_ARBITRATE;
    sim_at(n->sim, at, lane, (uint64_t)n->nresource + (uint64_t)r, g->look, g, (uint64_t)r);
}

/* ---- fronts ---- */

static void busy_enter(struct routers *g, struct lane *v)
{
    struct lane **list = &g->router[v->of->to].busy;
    if (v->busy_link) return;
    v->busy = *list;
    if (v->busy) v->busy->busy_link = &v->busy;
    *list = v;
    v->busy_link = list;
}

static void busy_leave(struct lane *v)
{
    if (!v->busy_link) return;
    *v->busy_link = v->busy;
    if (v->busy) v->busy->busy_link = v->busy_link;
    v->busy_link = NULL;
}

/* The ways on of v's front into v->option; of rules that may have many by way of a list on the
 * stack. Returns how many. */
static int options_find(struct routers *g, struct lane *v)
{
    const struct routing_view view = {router_used, g};
    struct route *way = &v->front->worm->route;
    struct route_option option[ROUTING_MOST_OPTIONS];
    if (g->routing->most <= v->room) return routing_next(g->routing, way, &view, v->option);
    const int n = routing_next(g->routing, way, &view, option);
    if (n > v->room) {
        v->room = n;
        v->option = TAKE(g->fabric.net->arena, n, struct route_option);
    }
    for (int i = 0; i < n; i++) v->option[i] = option[i];
    return n;
}

void router_route(struct routers *g, struct lane *v)
{
    const bool looks = router_looks(g, v);
    const int n = options_find(g, v);
    int first = 0, count;
    v->noption = (int16_t)n;
    if (n == 0) count = routing_eject(g->routing, &v->front->worm->route, &first);
    else count = router_channels(v, v->option, &first);
    v->first = (int16_t)first;
    v->count = (int16_t)count;
    v->way = router_out(g, v, n == 0 ? NULL : v->option);
    const struct port *p = &g->port[v->way];
    v->ways = router_bit(p->out);
    for (int i = 1; i < n; i++)
        v->ways |= router_bit(g->port[router_out(g, v, &v->option[i])].out);
    /* What the look at it will ask of. */
    if (p->lane) __builtin_prefetch(&p->lane[first]);
    v->state = LANE_ASKING;
    if (looks) v->due += g->setup;
}

/* The head of v's front is there, or on its way: it is routed when it is there and the tail ahead
 * of it has gone; then it asks. Where load does not matter the way is found at once, which saves an
 * event and tells others early. */
void router_front_comes(struct routers *g, struct lane *v)
{
    const struct port *p = v->of;
    v->due = router_later(v->front->first + g->reach + p->wire, v->left);
    if (router_looks(g, v)) {
        v->state = LANE_ROUTING;
    } else {
        v->due += g->setup;
        router_route(g, v);
    }
    busy_enter(g, v);
    router_wake(g, p->to, v->due);
}

void router_front(struct routers *g, struct lane *v)
{
    if (v->front && v->front->sent > 0) {
        router_front_comes(g, v);
        return;
    }
    v->state = LANE_IDLE;
    busy_leave(v);
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
