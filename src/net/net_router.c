/* net_router.c - what happens at the routers of net_router.h: heads come to the front, find their
 * way on, and flits cross from lane to lane.
 *
 * The times are those of levels packet and flit (docs/network.md): a head is at the next port a hop
 * latency after it crossed the last one, the setup of the router is its alone, and a flit needs the
 * credit of the flit a buffer's size earlier. A router is looked at when something can happen in
 * it: then all that asks at this instant is served together (net_router_allocate.c). */
#include "net/net_router.h"

/* Second look at a router at the same time. */
enum { LANE_AGAIN = NET_LANE_ARBITRATE + 1 };

/* ---- events ---- */

void router_wake(struct routers *g, int r, sim_ps at)
{
    struct router *o = &g->router[r];
    const struct net *n = g->fabric.net;
    if (o->wake && o->wake <= at + 1) return;
    o->wake = at + 1;
    const unsigned lane = at == sim_now(n->sim) ? LANE_AGAIN : NET_LANE_ARBITRATE;
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

/* A head is routed when it is there and the tail ahead of it has gone; then it asks. Where load
 * does not matter the way is found when it asks, which saves an event. */
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
    if (!g->routing->by_load) v->due += n->setup;
    busy_enter(g, v);
    router_wake(g, p->to, v->due);
}

/* ---- credits ---- */

/* Flits follow each other at the rate of the port, so that the first and the last of them decide
 * where those ahead left at one rate; checked one by one, as rates may differ. */
sim_ps router_room(const struct routers *g, const struct lane *v, int32_t flits, sim_ps now)
{
    const struct fabric *f = &g->fabric;
    const struct port *p = &g->port[v->port];
    const int64_t free = f->buffer - (v->in - v->out);
    if (flits > free) return SIM_NEVER;
    sim_ps at = now;
    const sim_ps late = f->net->credit + p->wire;
    for (int32_t j = 0; j < flits; j++) {
        const int64_t n = v->in + j;
        if (n < f->buffer) continue;
        at = router_later(at, v->slot[n % f->buffer] + late - j * p->flit);
    }
    return at;
}

/* Flits in the lanes, and those that left so short a time ago that their credits are not back. */
int64_t router_used(const void *of, int link)
{
    const struct routers *g = of;
    const struct fabric *f = &g->fabric;
    const struct port *p = &g->port[net_resource(f->net, link)];
    const sim_ps late = f->net->credit + p->wire;
    int64_t used = 0;
    for (int i = 0; p->lane && i < f->nchannel; i++) {
        const struct lane *v = &p->lane[i];
        used += v->in - v->out;
        for (int64_t k = v->out - 1; k >= 0 && k >= v->in - f->buffer; k--) {
            if (v->slot[k % f->buffer] + late <= g->now) break;
            used++;
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
    out->owner = NULL;
    out->free = ps_later(tail, flit + f->net->allocation);
    net_account(f->net, m->port, s->m, w->index == 0, w->index == 0 ? s->m->bytes : 0,
                w->flits * flit, m->first - m->ask);
    v->left = ps_later(tail, flit);
    v->front = l->behind;
    router_leg_return(g, l);
    router_front(g, v);
    /* Others may want the channel. */
    router_wake(g, g->port[v->port].to, out->free);
    if (!last) return;
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
    for (int32_t j = 0; j < flits; j++)
        out->slot[out->in++ % g->fabric.buffer] = there + j * p->flit;
    if (out->front != m) return;
    if (head) router_front(g, out);
    else if (out->state == LANE_SENDING) router_wake(g, p->to, there);
}

void router_send(struct routers *g, struct lane *v, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct leg *l = v->front, *m = l->ahead;
    struct port *in = &g->port[v->port], *p = &g->port[m->port];
    struct lane *out = &p->lane[m->channel];
    const int32_t flits = router_unit(g, m->worm);
    const bool full = v->in - v->out + in->loop >= f->buffer || g->whole;
    if (m->sent == 0) m->first = now;
    m->sent += flits;
    /* A fast port cannot outrun a slow one before it. */
    sim_ps tail = now + (flits - 1) * p->flit;
    if (g->whole) tail = router_later(tail, l->tail + f->net->tau + in->wire);
    m->tail = tail;
    f->resource[m->port].free = in->passed = ps_later(tail, p->flit);
    for (int32_t j = 0; j < flits; j++) v->slot[v->out++ % f->buffer] = now + j * p->flit;
    if (full) upstream_wake(g, v->port, now + f->net->credit + in->wire);
    if (!net_is_ejection(f->net, m->port)) flits_arrive(g, m, out, flits, now);
    if (m->sent == m->worm->flits) {
        tail_sent(g, v, m, tail, p->flit);
    } else if (v->out < v->in) {
        router_wake(g, in->to, router_later(in->passed, v->slot[v->out % f->buffer]));
    }
}
