/* net_router_lane.h - what routers ask of lanes at every step: room, channels, ways out
 * (net_router.h). */
#ifndef NET_NET_ROUTER_LANE_H
#define NET_NET_ROUTER_LANE_H

#include "net/net_router.h"

/* router_later, router_sooner: of two times the later, the sooner one. */
static inline sim_ps router_later(sim_ps a, sim_ps b) { return a > b ? a : b; }
static inline sim_ps router_sooner(sim_ps a, sim_ps b) { return a < b ? a : b; }

/* router_lanes: the lanes behind port p, made at the first use. */
static inline struct lane *router_lanes(struct routers *g, int p)
{
    return g->port[p].lane ? g->port[p].lane : router_lanes_make(g, p);
}

/* router_room: from when on (>= now) `flits` flits may enter v, one after the other; SIM_NEVER:
 * when that depends on something yet to come, whose event will wake the router.
 *
 * Flits follow each other at the rate of the port, so that the last of them decides where those
 * ahead left at one rate; checked one by one where rates differ. */
static inline sim_ps router_room(const struct routers *g, struct lane *v, int32_t flits, sim_ps now)
{
    const struct fabric *f = &g->fabric;
    const int64_t last = v->in + flits - 1 - f->buffer;
    if (last >= v->out) {
        v->starved = true;
        return SIM_NEVER;
    }
    if (last < 0) return now;
    const struct port *p = &g->port[v->port];
    const sim_ps late = f->net->credit + p->wire;
    for (int32_t j = g->even ? flits - 1 : 0; j < flits; j++) {
        const int64_t n = v->in + j - f->buffer;
        if (n >= 0) now = router_later(now, v->stay[n & g->ring].go + late - j * p->flit);
    }
    return now;
}

/* router_unit: how many flits of w move at once. */
static inline int32_t router_unit(const struct routers *g, const struct worm *w)
{
    return g->whole ? w->flits : 1;
}

/* router_out: the port that option o of lane v's front leads over; o NULL: out of the network. */
static inline int router_out(const struct routers *g, const struct lane *v,
                             const struct route_option *o)
{
    const struct net *n = g->fabric.net;
    return o ? net_resource(n, o->link) : net_ejection(n, v->front->worm->flight->m->dst);
}

/* router_channels: the channels of option o of lane v's front; o NULL: out of the network. Returns
 * how many from *first on. */
static inline int router_channels(const struct lane *v, const struct route_option *o, int *first)
{
    *first = o ? o->first : v->out_first;
    return o ? o->count : v->out_count;
}

/* router_looks: whether the way of v's front depends on loads when it is found, an event of its own
 * before that in which the head asks. */
static inline bool router_looks(const struct routers *g, const struct lane *v)
{
    return g->routing->by_load && (!g->routing->at_source || v->front->worm->route.channel < 0);
}

#endif
