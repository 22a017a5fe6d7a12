/* net_router_source.c - packets from their nodes into the first lane, and the levels themselves. */
#include <string.h>

#include "net/net_account.h"
#include "net/net_router_front.h"

/* ---- sources ---- */

/* A free channel with room for what moves at once, round robin over those that the rule permits;
 * -1: none. *again: when one may have room. */
static int source_channel(struct routers *g, int node, const struct worm *w, sim_ps now,
                          sim_ps *again)
{
    struct port *p = &g->port[node];
    struct lane *v = router_lanes(g, node);
    /* Turns of packets that may enter over more channels may lie behind the last one. */
    int turn = p->enter < w->count ? p->enter : p->enter % w->count;
    for (int k = 0; k < w->count; k++, turn++) {
        if (turn == w->count) turn = 0;
        const int i = w->first + turn;
        if (v[i].owner) continue;
        const sim_ps at = router_room(g, &v[i], router_unit(g, w), now);
        *again = router_sooner(*again, at);
        if (at > now) continue;
        p->enter = turn + 1 < w->count ? turn + 1 : 0;
        return i;
    }
    return -1;
}

/* The flits of a packet that leaves its node, as far as the credits for them are known: all times
 * follow from each other, so that no event is needed for each. */
static void source_flits(struct routers *g, int node, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct resource *o = &f->resource[node];
    struct leg *l = g->sending[node];
    struct flight *m = l->worm->flight;
    struct lane *v = &g->port[node].lane[l->channel];
    const sim_ps flit = net_port(f->net, m->m->bytes)->rate.flit;
    const int32_t unit = router_unit(g, l->worm);
    while (l->sent < l->worm->flits) {
        const sim_ps at = router_room(g, v, unit, router_later(now, o->free));
        if (at == SIM_NEVER) return; /* a credit will wake us */
        const bool head = l->sent == 0;
        const sim_ps there = at + f->net->tau - f->net->setup;
        if (head) l->first = at;
        if (head && l->worm->index == 0) m->m->injected = at;
        for (int32_t j = 0; j < unit; j++) v->stay[v->in++ & g->ring].come = there + j * flit;
        l->sent += unit;
        l->tail = at + (unit - 1) * flit;
        o->free = ps_later(l->tail, flit);
        if (v->front == l && head) router_front(g, v);
        else if (v->front == l && v->state == LANE_SENDING)
            router_wake(g, g->port[node].to, router_later(there, now));
    }
    /* The tail has gone, or will at a time that is known. The gap g follows a message. */
    v->owner = NULL;
    g->sending[node] = NULL;
    net_account_packet(f->net, node, m->m, l->worm->index, l->worm->flits * flit,
                       l->first - l->ask);
    if (l->worm->index == m->npacket - 1)
        o->free = router_later(o->free, ps_later(l->tail, net_port(f->net, m->m->bytes)->gap));
}

/* The next packet of a node begins when the one before has gone. It waits at its node until one of
 * the channels that it may enter over has room. */
static sim_ps source_begin(struct routers *g, int node, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct source *z = &f->source[node];
    struct flight *m = z->front;
    sim_ps again = SIM_NEVER;
    if (!m) return SIM_NEVER;
    if (m->m->ready > now) return m->m->ready;
    struct worm *w = g->waiting[node];
    if (!w) {
        w = g->waiting[node] = router_worm(g, m);
        w->count = routing_inject(g->routing, &w->route, &w->first);
    }
    /* The channel is chosen when one has room, not before: each packet takes the next in turn. */
    const int channel = source_channel(g, node, w, now, &again);
    if (channel < 0) {
        /* Where chance names the channel, it names one anew a flit later, as in BookSim. */
        if (w->count == g->routing->channels) return again;
        w->count = routing_inject(g->routing, &w->route, &w->first);
        return ps_later(now, g->port[node].flit);
    }
    struct leg *l = router_leg(g, w, &g->port[node].lane[channel]);
    l->ask = m->injected == 0 ? m->m->ready : f->resource[node].free;
    if (++m->injected == m->npacket && !(z->front = m->next)) z->back = NULL;
    g->waiting[node] = NULL;
    g->sending[node] = l;
    source_flits(g, node, now);
    return SIM_NEVER;
}

static void router_source(struct routers *g, int node, sim_ps now)
{
    struct fabric *f = &g->fabric;
    g->now = now;
    sim_ps again = SIM_NEVER;
    if (g->sending[node]) source_flits(g, node, now);
    else again = source_begin(g, node, now);
    /* The next packet when this one has gone. */
    if (!g->sending[node] && f->source[node].front && f->resource[node].free > now)
        again = router_later(f->source[node].front->m->ready, f->resource[node].free);
    if (again != SIM_NEVER) packet_wake(f, node, router_later(again, now + 1));
}

void router_source_look(struct routers *g, int node, sim_ps now)
{
    struct resource *o = &g->fabric.resource[node];
    if (o->wake != now + 1) return;
    o->wake = 0;
    if (o->free > now) packet_wake(&g->fabric, node, o->free);
    else router_source(g, node, now);
}

static void source_look(void *subject, uint64_t argument, sim_ps now)
{
    router_source_look(subject, (int)argument, now);
}

/* ---- the levels ---- */

/* Which router is at either end of each port, and its number there. */
static void ports_make(struct routers *g)
{
    struct net *n = g->fabric.net;
    const struct topology *t = n->topology;
    uint32_t *leaving = TAKE(n->arena, t->nrouter, uint32_t),
             *coming = TAKE(n->arena, t->nrouter, uint32_t), most = 0;
    for (int i = 0; i < n->nresource; i++) {
        struct port *p = &g->port[i];
        int port;
        p->from = p->to = -1;
        p->flit = net_resource_rate(n, i, 0).flit;
        if (net_is_injection(n, i)) {
            p->to = topology_router_of(t, i);
            p->in = (uint32_t)topology_injection_port(t, i);
        } else if (net_is_ejection(n, i)) {
            p->from = topology_router_of(t, i - n->nnode - n->nlink);
        } else {
            topology_link_ends(t, i - n->nnode, &p->from, &p->to, &port);
            p->in = (uint32_t)port;
            if (n->wire) p->wire = n->wire[i - n->nnode];
        }
        if (p->from >= 0) p->out = leaving[p->from]++;
        if (p->to >= 0 && ++coming[p->to] > most) most = coming[p->to];
    }
    g->active = TAKE(n->arena, size_product(most, (size_t)g->fabric.nchannel), struct lane *);
}

/* Others' traffic, as packet_occupied. */
static void router_occupied(void *subject, uint64_t argument, sim_ps now)
{
    struct routers *g = subject;
    struct port *p = &g->port[argument];
    p->free = router_later(p->free, now) + g->fabric.debt[argument];
    g->fabric.debt[argument] = 0;
}

static struct routers *routers_create(struct net *n, bool whole, struct err *e)
{
    struct routers *g =
        (struct routers *)(void *)(whole ? packet_fabric(n, sizeof *g, source_look, e)
                                         : fabric_create(n, sizeof *g, source_look, e));
    if (!g) return NULL;
    /* What differs between the levels, and between this program's rules and BookSim's. */
    g->routing = n->routing;
    g->look = router_look;
    g->post = router_post;
    g->whole = whole;
    /* This program's own adaptive rule says which way is best by priorities alone. */
    g->priority = n->machine->network.vc_allocator == ALLOCATOR_SELECT ||
                  n->routing->rule == ROUTING_ADAPTIVE;
    g->strict = n->routing->rule == ROUTING_BOOKSIM_MIN_ADAPT;
    g->iterations = n->machine->network.allocator_iterations;
    g->single = g->iterations == 1 || !g->priority;
    g->tau = n->tau;
    g->credit = n->credit;
    g->setup = n->setup;
    g->reach = n->tau - n->setup;
    g->pause = n->allocation;
    g->buffer = g->fabric.buffer;
    g->nchannel = (uint32_t)g->fabric.nchannel;
    g->sink = net_ejection(n, 0);
    g->fits = n->routing->fits;
    g->looks = n->routing->by_load;
    g->looks_on = g->looks && !n->routing->at_source;
    /* So that routes are written where they are kept. */
    g->few = n->routing->most <= LANE_OPTIONS;
    g->even = !n->link_rate && n->ejection.flit == n->link.flit;
    /* A buffer, and what may be known to come. */
    while (g->ring + 1 < g->fabric.buffer + ROUTER_AHEAD) g->ring = 2 * g->ring + 1;
    g->fabric.occupied = router_occupied;
    n->message_bytes += sizeof(struct worm);
    n->hop_bytes = sizeof(struct leg);
    const size_t places = (size_t)(g->ring + 1) * sizeof(struct stay);
    n->resource_bytes = size_product(g->nchannel, sizeof(struct lane) + places);
    g->port = TAKE(n->arena, n->nresource, struct port);
    g->router = TAKE(n->arena, n->topology->nrouter, struct router);
    g->sending = TAKE(n->arena, n->nnode, struct leg *);
    g->waiting = TAKE(n->arena, n->nnode, struct worm *);
    ports_make(g);
    return g;
}

static bool whole_create(struct net *n, struct err *e)
{
    n->state = routers_create(n, true, e);
    return n->state != NULL;
}

static bool flits_create(struct net *n, struct err *e)
{
    n->state = routers_create(n, false, e);
    return n->state != NULL;
}

static void router_start(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    struct flight *w = (struct flight *)(uintptr_t)argument;
    struct net_message *m = w->m;
    (void)now;
    /* As if the network were empty and the port only this processor's. */
    sim_ps *port = &f->own_port[m->src * f->nprocessor + m->processor];
    const int64_t flits = (int64_t)(w->npacket - 1) * w->full + w->last;
    const sim_ps at = router_later(m->ready, *port);
    *port = ps_later(at, net_port_busy(f->net, m->bytes, flits));
    m->uncontended = ps_later(at, m->uncontended);
    source_enter(f, w);
}

static void router_net_send(struct net *n, struct net_message *m)
{
    struct fabric *f = n->state;
    struct net_rate slowest;
    const sim_ps way = net_way(n, m, &slowest);
    struct flight *w = flight_plain(f, m, slowest);
    const int64_t flits = (int64_t)(w->npacket - 1) * w->full + w->last;
    /* The duration in an empty network; router_start adds when it begins. */
    const sim_ps tail = ps_times(flits - 1, w->slowest);
    m->uncontended = ps_later(ps_later(way, tail), net_end(n, m->bytes));
    if (n->port_private || m->ready == sim_now(n->sim)) router_start(f, (uintptr_t)w, m->ready);
    else
        sim_at(n->sim, m->ready, NET_LANE_START, net_event_key(0, m->id), router_start, f,
               (uintptr_t)w);
}

/* ---- standstill ---- */

/* The lane that keeps the front of v waiting: its channel, or the first that it asks for. */
static const struct lane *waits_for(const struct routers *g, const struct lane *v)
{
    const struct leg *m = v->front->ahead;
    if (v->state == LANE_SENDING) return &g->port[m->port].lane[m->channel];
    if (v->noption == 0) return NULL;
    const struct lane *lane = g->port[router_out(g, v, v->option)].lane;
    return lane ? &lane[v->option->first] : NULL;
}

static bool router_deadlock(const struct net *n, char *text, int size)
{
    const struct routers *g = n->state;
    const struct lane *v = NULL;
    /* Nothing is under way any more. */
    for (int r = 0; r < n->topology->nrouter && !v; r++) v = g->router[r].busy;
    struct arena_mark mark = arena_mark(n->arena);
    int *way = TAKE(n->arena, n->nresource, int), *seen = TAKE(n->arena, n->nresource, int),
        count = 0;
    while (v && v->front && v->state != LANE_IDLE && !seen[v->port]) {
        way[count++] = v->port;
        seen[v->port] = count;
        v = waits_for(g, v);
    }
    const bool found = v && v->front && seen[v->port];
    if (found) packet_name_cycle(n, way + seen[v->port] - 1, count - seen[v->port] + 1, text, size);
    arena_release(n->arena, mark);
    return found;
}

const struct net_type net_routed_packet = {"packet",        LEVEL_PACKET,  whole_create,
                                           router_net_send, packet_occupy, router_deadlock,
                                           false,           false};
const struct net_type net_routed_flit = {"flit",          LEVEL_FLIT,    flits_create,
                                         router_net_send, packet_occupy, router_deadlock,
                                         false,           false};
