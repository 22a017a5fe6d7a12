/* net_router_front.h - heads that come to the front of a lane (net_router.h): inlined, since every
 * packet does so at every router. */
#ifndef NET_NET_ROUTER_FRONT_H
#define NET_NET_ROUTER_FRONT_H

#include "net/net_router_gather.h"
#include "net/net_router_lane.h"

/* busy_enter, busy_leave: v into and out of its router's list of lanes with a front. The list has
 * no order: turns decide, not places. */
static inline void busy_enter(struct routers *g, struct lane *v)
{
    struct lane **list = &g->router[v->of->to].busy;
    if (v->busy_link) return;
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
    busy_enter(g, v);
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
