/* net_clocked_source.c - packets from their nodes into the first lane (net_router_source.c, in
 * cycles). */
#include "net/net_clocked_step.h"

/* A free channel with room for what moves at once, round robin over those that the rule permits;
 * -1: none. *again: when one may have room. */
static int source_channel(struct clocked *g, struct clocked_port *p, const struct clocked_worm *w,
                          int32_t now, int32_t *again)
{
    struct clocked_lane *v = p->lane;
    const int32_t unit = g->whole ? w->flits : 1;
    /* The turn is kept from packet to packet, whatever channels the rule permits each. */
    int turn = p->enter < w->count ? p->enter : p->enter % w->count;
    for (int k = 0; k < w->count; k++, turn++) {
        if (turn == w->count) turn = 0;
        const int i = w->first + turn;
        if (v[i].clear <= now) {
            p->enter = (uint8_t)(turn + 1 < w->count ? turn + 1 : 0);
            return i;
        }
        if (v[i].owned) continue;
        const int32_t at = clocked_room(g, &v[i], p, unit, now, g->whole);
        *again = clocked_sooner(*again, at);
        if (at > now) continue;
        p->enter = (uint8_t)(turn + 1 < w->count ? turn + 1 : 0);
        return i;
    }
    return -1;
}

/* The flits of a packet that leaves its node, as far as the credits for them are known. One flit
 * leaves in each cycle; a credit that nobody can tell yet wakes the node when it can. */
static void source_flits(struct clocked *g, int node, int32_t now)
{
    struct clocked_source *z = &g->source[node];
    struct clocked_leg *l = z->sending;
    struct clocked_lane *v = &g->lane[l->lane];
    struct clocked_port *p = z->port;
    union clocked_stay *stay = clocked_ring(g, v);
    const int32_t unit = g->whole ? l->flits : 1;
    while (l->sent < l->flits) {
        const int32_t at = clocked_room(g, v, p, unit, clocked_later(now, z->free), g->whole);
        if (at == CLOCKED_NEVER) return; /* a credit will wake us */
        const bool head = l->sent == 0;
        if (head) l->first = l->worm->begun = at;
        if (!g->whole) stay[clocked_place(g, v->in)].come = at + g->reach;
        v->in += unit;
        p->held += unit;
        l->sent += unit;
        z->free = at + unit * g->flit;
        if (v->front == l && head) clocked_front(g, v, p);
        else if (v->front == l && v->head.state == LANE_SENDING)
            clocked_wake(g, p->to, clocked_later(at + g->reach, now));
    }
    /* The tail has gone, or will at a time that is known. */
    v->owned = false;
    z->sending = NULL;
    z->free = clocked_later(z->free, z->free - g->flit + l->worm->gap);
}

/* All flits of l, one in each cycle from now on, into v of port p, which was clear and holds them
 * all: what source_flits comes to. */
static void source_whole(struct clocked *g, struct clocked_source *z, struct clocked_lane *v,
                         struct clocked_leg *l, int32_t now)
{
    const int32_t flits = l->flits;
    struct clocked_port *p = z->port;
    l->first = l->worm->begun = now;
    l->sent = flits;
    v->in = flits;
    v->owned = false;
    p->held += flits;
    if (!g->whole) {
        union clocked_stay *stay = clocked_ring(g, v);
        for (int32_t k = 0; k < flits; k++)
            stay[clocked_place(g, k)].come = now + g->reach + k * g->flit;
    }
    z->free = now + (flits - 1) * g->flit + clocked_later(g->flit, l->worm->gap);
    clocked_front(g, v, p);
}

/* The next packet of a node begins, if there is one, over the channel that has room; else it waits.
 * Returns when to look again. */
static int32_t source_begin(struct clocked *g, int node, int32_t now)
{
    struct clocked_source *z = &g->source[node];
    int32_t again = CLOCKED_NEVER;
    if (z->front < 0) return CLOCKED_NEVER;
    /* A packet that found no channel keeps what was drawn for it. */
    struct clocked_worm *w = z->waiting;
    if (!w) {
        w = z->waiting = clocked_worm(g, z->front);
        w->count = routing_inject(g->routing, &w->route, &w->first);
    }
    const int channel = source_channel(g, z->port, w, now, &again);
    if (channel < 0) {
        /* Where chance names the channel, it names one anew a flit later, as in BookSim. */
        if (w->count == g->routing->channels) return again;
        w->count = routing_inject(g->routing, &w->route, &w->first);
        return now + g->flit;
    }
    struct clocked_lane *v = &z->port->lane[channel];
    const bool clear = v->clear <= now;
    struct clocked_leg *l = clocked_leg(g, v);
    l->worm = w;
    l->flits = w->flits;
    z->front = g->next[z->front];
    z->waiting = NULL;
    if (clear && l->flits <= g->buffer) {
        source_whole(g, z, v, l, now);
        return CLOCKED_NEVER;
    }
    z->sending = l;
    source_flits(g, node, now);
    return CLOCKED_NEVER;
}

/* The bit of a look that has been put off or done is passed over. */
void clocked_source_look(struct clocked *g, int node, int32_t now)
{
    struct clocked_source *z = &g->source[node];
    int32_t again = CLOCKED_NEVER;
    if (z->wake != now) return;
    z->wake = CLOCKED_NEVER;
    if (z->free > now) {
        clocked_wake_source(g, node, z->free);
        return;
    }
    if (z->sending) source_flits(g, node, now);
    else again = source_begin(g, node, now);
    /* The next packet when this one has gone. */
    if (!z->sending && z->front >= 0 && z->free > now) again = z->free;
    if (again != CLOCKED_NEVER) clocked_wake_source(g, node, clocked_later(again, now + 1));
}
