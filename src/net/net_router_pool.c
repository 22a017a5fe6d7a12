/* net_router_pool.c - records of net_router.h: lanes where they are first used, legs and worms out
 * of pools, so that a steady load allocates nothing. */
#include "net/net_router_front.h"

struct lane *router_lanes_make(struct routers *g, int p)
{
    struct port *o = &g->port[p];
    const struct net *n = g->fabric.net;
    const int count = g->fabric.nchannel;
    /* The sink keeps nothing. */
    const int64_t places = net_is_ejection(n, p) ? 0 : g->ring + 1;
    o->lane = TAKE(n->arena, count, struct lane);
    struct stay *ring =
        places ? TAKE(n->arena, size_product((size_t)count, (size_t)places), struct stay) : NULL;
    for (int i = 0; i < count; i++) {
        o->lane[i].port = p;
        o->lane[i].of = o;
        o->lane[i].option = o->lane[i].few;
        o->lane[i].room = LANE_OPTIONS;
        o->lane[i].channel = (int16_t)i;
        o->lane[i].input = o->in * (uint32_t)count + (uint32_t)i;
        o->lane[i].output = o->out * (uint32_t)count + (uint32_t)i;
        if (ring) o->lane[i].stay = ring + i * places;
    }
    return o->lane;
}

struct leg *router_leg(struct routers *g, struct worm *w, struct lane *v)
{
    enum { CHUNK = 128 };
    if (!g->free_leg) {
        struct leg *chunk = TAKE(g->fabric.net->arena, CHUNK, struct leg);
        for (int i = 0; i < CHUNK; i++) router_leg_return(g, &chunk[i]);
    }
    struct leg *l = g->free_leg;
    g->free_leg = l->behind;
    /* It owns the channel from now on, so that no other worm comes between its flits. */
    *l = (struct leg){.worm = w, .port = v->port, .channel = v->channel};
    v->owner = l;
    if (v->clear <= g->now) lane_restart(v);
    v->clear = SIM_NEVER;
    /* The sink has no FIFO: it takes what comes. */
    if (net_is_ejection(g->fabric.net, v->port)) return l;
    lane_enter(v, l);
    return l;
}

void router_leg_return(struct routers *g, struct leg *l)
{
    l->behind = g->free_leg;
    g->free_leg = l;
}

/* Places from which all have come are used anew, if they are half of all. */
void router_coming_room(struct routers *g, struct router *o)
{
    struct coming *to = o->coming;
    if (o->next <= o->room / 2) {
        o->room = o->room ? 2 * o->room : 8;
        to = TAKE(g->fabric.net->arena, o->room, struct coming);
    }
    for (int32_t k = o->next; k < o->end; k++) to[k - o->next] = o->coming[k];
    o->coming = to;
    o->end -= o->next;
    o->next = 0;
}

/* Each packet of a message chooses for itself; the first one as the message would. */
struct worm *router_worm(struct routers *g, struct flight *m)
{
    enum { CHUNK = 64 };
    if (!g->free_worm) {
        struct worm *chunk = TAKE(g->fabric.net->arena, CHUNK, struct worm);
        for (int i = 0; i < CHUNK; i++) router_worm_return(g, &chunk[i]);
    }
    struct worm *w = g->free_worm;
    g->free_worm = w->next;
    *w = (struct worm){.flight = m, .index = m->injected};
    w->flits = flight_packet_flits(m, w->index);
    const uint64_t choice = net_choice(m->m) + (uint64_t)w->index * 0xd1342543de82ef95u;
    w->route = routing_start(g->routing, m->m->src, m->m->dst, choice);
    return w;
}

void router_worm_return(struct routers *g, struct worm *w)
{
    w->next = g->free_worm;
    g->free_worm = w;
}
