/* net_router.c - what happens at the routers of net_router.h: heads come to the front, find their
 * way on, and flits cross from lane to lane.
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

/* The sender upstream of port p may have room: a router, or a node. */
static void upstream_wake(struct routers *g, int p, sim_ps at)
{
    const struct port *o = &g->port[p];
    if (o->from >= 0) router_wake(g, o->from, at);
    else packet_wake(&g->fabric, p, router_later(at, g->fabric.resource[p].free));
}

/* ---- fronts ---- */

static void busy_enter(struct routers *g, struct lane *v)
{
    struct lane **list = &g->router[g->port[v->port].to].busy;
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

void router_route(struct routers *g, struct lane *v)
{
    struct route_option option[ROUTING_MOST_OPTIONS];
    const struct routing_view view = {router_used, g};
    const bool looks = router_looks(g, v);
    const int n = routing_next(g->routing, &v->front->worm->route, &view, option);
    if (n > v->room) {
        v->room = n;
        v->option = TAKE(g->fabric.net->arena, n, struct route_option);
    }
    for (int i = 0; i < n; i++) v->option[i] = option[i];
    v->noption = n;
    if (n == 0) v->out_count = routing_eject(g->routing, &v->front->worm->route, &v->out_first);
    v->state = LANE_ASKING;
    if (looks) v->due += g->fabric.net->setup;
}

/* A head is routed when it is there and the tail ahead of it has gone; then it asks. Where load
 * does not matter the way is found at once, which saves an event and tells others early. */
void router_front(struct routers *g, struct lane *v)
{
    const struct net *n = g->fabric.net;
    const struct leg *l = v->front;
    v->state = LANE_IDLE;
    if (!l || l->sent == 0) {
        busy_leave(v);
        return;
    }
    const struct port *p = &g->port[v->port];
    v->state = LANE_ROUTING;
    v->due = router_later(l->first + n->tau - n->setup + p->wire, v->left);
    if (!router_looks(g, v)) {
        v->due += n->setup;
        router_route(g, v);
    }
    busy_enter(g, v);
    router_wake(g, p->to, v->due);
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
    for (int i = 0; p->lane && i < f->nchannel; i++) {
        const struct lane *v = &p->lane[i];
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

/* ---- moving on ---- */

/* The worm of v's front stands in lane `out` from its head on, so that flits of different worms
 * never mix in a FIFO. */
void router_own(struct routers *g, struct lane *v, struct lane *out)
{
    struct leg *l = v->front, *m = router_leg(g, l->worm, out);
    const int p = out->port;
    l->ahead = m;
    m->ask = v->due;
    v->state = LANE_SENDING;
    if (net_is_ejection(g->fabric.net, p)) return;
    const struct route_option *o = v->option;
    /* Of several options that lead over this channel the first one is as good as any. */
    while (router_out(g, v, o) != p || out->channel < o->first ||
           out->channel >= o->first + o->count)
        o++;
    routing_take(g->routing, &l->worm->route, o, out->channel);
}

/* Whether a head at router r may want a channel that is free from `at` on: none does that comes
 * later. */
static bool somebody_asks(const struct routers *g, int r, sim_ps at)
{
    const struct lane *w = g->router[r].busy;
    if (!g->spares) return w != NULL;
    while (w && (w->state == LANE_SENDING || w->due > at)) w = w->busy;
    return w != NULL;
}

/* The tail of v's front crosses port p: the channel is free for the next, v has a new front, and at
 * the end of the way the message may be complete. */
static void tail_sent(struct routers *g, struct lane *v, struct leg *m, sim_ps tail, sim_ps flit)
{
    struct fabric *f = &g->fabric;
    struct worm *w = m->worm;
    struct flight *s = w->flight;
    struct leg *l = v->front;
    struct lane *out = &g->port[m->port].lane[m->channel];
    const bool last = net_is_ejection(f->net, m->port);
    /* From its tail on the next packet may own the channel, at a time that may lie ahead. */
    out->owner = NULL;
    out->free = ps_later(tail, flit + f->net->allocation);
    net_account(f->net, m->port, s->m, w->index == 0, w->index == 0 ? s->m->bytes : 0,
                w->flits * flit, m->first - m->ask);
    /* The packet behind it comes to the front a flit after the tail. */
    v->left = ps_later(tail, flit);
    v->front = l->behind;
    router_leg_return(g, l);
    router_front(g, v);
    /* Others may want the channel. */
    const int r = g->port[v->port].to;
    if (somebody_asks(g, r, out->free)) router_wake(g, r, out->free);
    if (!last) return;
    /* The message is there with the last tail of its packets. */
    if (++s->ejected == s->npacket)
        packet_deliver_at(f, s, ps_later(tail, net_end(f->net, s->m->bytes)));
    router_leg_return(g, m);
    router_worm_return(g, w);
}

/* Flits arrive in the lane behind port p. */
static void flits_arrive(struct routers *g, struct leg *m, struct lane *out, int32_t flits,
                         sim_ps now)
{
    const struct net *n = g->fabric.net;
    const struct port *p = &g->port[m->port];
    /* The setup part of the hop latency is the head's alone; router_front adds it. */
    const sim_ps there = now + n->tau - n->setup + p->wire;
    const bool head = m->sent == flits;
    for (int32_t j = 0; j < flits; j++) out->stay[out->in++ & g->ring].come = there + j * p->flit;
    if (out->front != m) return;
    if (head) router_front(g, out);
    else if (out->state == LANE_SENDING) router_wake(g, p->to, there);
}

/* When lane w may first compete with v, which sends over port out: never before it has a flit, and
 * where it goes elsewhere, not before its next packet. */
static sim_ps competes(const struct routers *g, const struct lane *v, const struct lane *w, int out,
                       sim_ps now)
{
    const struct net *n = g->fabric.net;
    int32_t left = w->front->worm->flits;
    bool meets = w->port == v->port;
    if (w->state == LANE_ROUTING) return w->due;
    if (w->state == LANE_SENDING) {
        const struct leg *m = w->front->ahead;
        left -= m->sent;
        if (meets || m->port == out)
            return w->out < w->in ? w->stay[w->out & g->ring].come : now + n->tau - n->setup;
    } else {
        for (int i = 0; (i == 0 || i < w->noption) && !meets; i++)
            meets = router_out(g, w, w->noption > 0 ? &w->option[i] : NULL) == out;
        if (meets) return w->due;
    }
    return router_later(now, w->due) + left * g->fabric.fastest + n->setup;
}

/* Until when nobody can dispute v's way over port out: a head that is not yet under way to this
 * router asks no sooner than a hop latency from now. */
static sim_ps undisputed(const struct routers *g, const struct lane *v, int out, sim_ps now)
{
    sim_ps until = now + g->fabric.net->tau;
    /* A rule that looks at the room in a lane must not see what is yet to come. */
    if (g->whole || g->routing->fits) return now;
    for (const struct lane *w = g->router[g->port[v->port].to].busy; w && until > now; w = w->busy)
        if (w != v) until = router_sooner(until, competes(g, v, w, out, now));
    return until;
}

/* What moves at once crosses at `now`. Returns when its tail has. */
static sim_ps cross(struct routers *g, struct lane *v, struct leg *m, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct port *in = &g->port[v->port], *p = &g->port[m->port];
    const int32_t flits = router_unit(g, m->worm);
    if (m->sent == 0) m->first = now;
    m->sent += flits;
    /* A fast port cannot outrun a slow one before it. */
    sim_ps tail = now + (flits - 1) * p->flit;
    if (g->whole) tail = router_later(tail, v->front->tail + f->net->tau + in->wire);
    m->tail = tail;
    g->port[m->port].free = in->passed = ps_later(tail, p->flit);
    for (int32_t j = 0; j < flits; j++) v->stay[v->out++ & g->ring].go = now + j * p->flit;
    if (!net_is_ejection(f->net, m->port)) flits_arrive(g, m, &p->lane[m->channel], flits, now);
    return tail;
}

/* After its first flit at `now`, further ones of v's front over m into out, at times that are
 * known: until when nobody can dispute the way. Alone they win, and turns move on. Returns when the
 * last one crosses. */
static sim_ps train(struct routers *g, struct lane *v, struct leg *m, struct lane *out, sim_ps now)
{
    const struct net *n = g->fabric.net;
    struct port *in = &g->port[v->port], *p = &g->port[m->port];
    const bool sink = net_is_ejection(n, m->port);
    const sim_ps way = n->tau - n->setup + p->wire, until = undisputed(g, v, m->port, now);
    sim_ps last = now;
    for (int i = 1; i < ROUTER_AHEAD && m->sent < m->worm->flits && v->out < v->in; i++) {
        sim_ps at = router_later(v->stay[v->out & g->ring].come, last + p->flit);
        if (at < until && !sink) at = router_room(g, out, 1, at);
        if (at >= until) break;
        v->stay[v->out++ & g->ring].go = last = at;
        if (!sink) out->stay[out->in++ & g->ring].come = at + way;
        m->sent++;
    }
    if (last == now) return now;
    /* Alone at both sides of the switch it would have won every round. */
    p->grant = in->in + 1;
    in->accept = p->out + 1;
    m->tail = last;
    g->port[m->port].free = in->passed = ps_later(last, p->flit);
    return last;
}

void router_send(struct routers *g, struct lane *v, sim_ps now)
{
    struct leg *m = v->front->ahead;
    struct port *in = &g->port[v->port], *p = &g->port[m->port];
    struct lane *out = &p->lane[m->channel];
    /* The head or next flit now, then what can follow without a dispute. */
    sim_ps tail = cross(g, v, m, now);
    if (m->sent < m->worm->flits && v->out < v->in) tail = train(g, v, m, out, now);
    /* A place has become free, and somebody waits for it. */
    if (v->starved) upstream_wake(g, v->port, now + g->fabric.net->credit + in->wire);
    v->starved = false;
    if (m->sent == m->worm->flits) {
        tail_sent(g, v, m, tail, p->flit);
    } else if (v->out < v->in) {
        router_wake(g, in->to, router_later(in->passed, v->stay[v->out & g->ring].come));
    }
}
