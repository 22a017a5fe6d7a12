/* net_router_front.h - heads that come to the front of a lane (net_router.h): inlined, since every
 * packet does so at every router. */
#ifndef NET_NET_ROUTER_FRONT_H
#define NET_NET_ROUTER_FRONT_H

#include "net/net_router_gather.h"
#include "net/net_router_lane.h"

/* A lane whose front is under way to its router. */
struct coming {
    sim_ps due;
    struct lane *lane;
};

/* busy_enter, busy_leave: v into and out of its router's list of lanes whose front has come. The
 * list has no order: turns decide, not places. */
static inline void busy_enter(struct lane **list, struct lane *v)
{
    v->busy = *list;
    if (v->busy) v->busy->busy_link = &v->busy;
    *list = v;
    v->busy_link = list;
}

/* See busy_enter. */
static inline void busy_leave(struct lane *v)
{
    if (!v->busy_link) return;
    *v->busy_link = v->busy;
    if (v->busy) v->busy->busy_link = v->busy_link;
    v->busy_link = NULL;
}

/* router_comes: the front of v, which is in no list of router o, asks from v->due on. Over cables
 * of one length heads come in the order in which they were sent. */
static inline void router_comes(struct routers *g, struct router *o, struct lane *v)
{
    if (o->end == o->room) router_coming_room(g, o);
    int32_t k = o->end++;
    for (; k > o->next && o->coming[k - 1].due > v->due; k--) o->coming[k] = o->coming[k - 1];
    o->coming[k] = (struct coming){v->due, v};
}

/* router_has_come: those that are due into the list of router o. Returns when the next one is. */
static inline sim_ps router_has_come(struct router *o, sim_ps now)
{
    for (; o->next < o->end; o->next++) {
        const struct coming *c = &o->coming[o->next];
        if (c->due > now) return c->due;
        busy_enter(&o->busy, c->lane);
    }
    o->next = o->end = 0;
    return SIM_NEVER;
}

/* router_front_comes: the head of v's front is there, or on its way: it is routed when it is there
 * and the tail ahead of it has gone; then it asks. Where load does not matter the way is found at
 * once, which saves an event and tells others early. */
static inline void router_front_comes(struct routers *g, struct lane *v)
{
    const struct port *p = v->of;
    v->due = router_later(v->front->first + g->reach + p->wire, v->left);
    if (router_looks(g, v)) {
        v->state = LANE_ROUTING;
    } else {
        v->due += g->setup;
        router_route(g, v);
    }
    busy_leave(v);
    router_comes(g, &g->router[p->to], v);
    router_wake(g, p->to, v->due);
}

/* router_front: v may have a new front, or none: find out when its way on is due. A front whose
 * head has not crossed the port of v comes when that does. */
static inline void router_front(struct routers *g, struct lane *v)
{
    if (v->front && v->front->sent > 0) {
        router_front_comes(g, v);
        return;
    }
    v->state = LANE_IDLE;
    busy_leave(v);
}

#endif
