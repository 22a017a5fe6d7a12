/* net_router_lane.h - what routers do with lanes at every step: fronts, room, channels, ways out
 * (net_router.h). */
#ifndef NET_NET_ROUTER_LANE_H
#define NET_NET_ROUTER_LANE_H

#include "net/net_router.h"

/* router_lanes_make: the lanes behind port p, at their first use (router_lanes). */
struct lane *router_lanes_make(struct routers *g, int p);

/* router_route: the way on of v's front; what it asks for from when on. */
void router_route(struct routers *g, struct lane *v);

/* router_own: the front of v gets lane `out`, by its option o. */
void router_own(struct routers *g, struct lane *v, struct lane *out);

/* router_send: the front of v sends what moves at once; its channel and the switch are its own. */
void router_send(struct routers *g, struct lane *v, sim_ps now);

/* router_pass: what an allocation comes to when v alone asks or sends: it gets what it wants, and
 * turns move on. Returns when to look again; SIM_NEVER: nothing of v needs it. */
sim_ps router_pass(struct routers *g, struct lane *v, sim_ps now);

/* router_quick: the same for a head with one way on, if that is clear at `now`; else it does
 * nothing that matters and returns false. Nothing of v needs another look then. Where g->quick. */
bool router_quick(struct routers *g, struct lane *v, sim_ps now);

/* router_coming_room: room for one more of o's coming lanes. */
void router_coming_room(struct routers *g, struct router *o);

/* router_leg: lane v of port p becomes w's: a leg at the end of its FIFO. */
struct leg *router_leg(struct routers *g, struct worm *w, struct lane *v);
void router_leg_return(struct routers *g, struct leg *l);
struct worm *router_worm(struct routers *g, struct flight *m);
void router_worm_return(struct routers *g, struct worm *w);

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
    const struct port *p = v->of;
    const sim_ps late = g->credit + p->wire;
    /* Mostly it is empty and all its credits are back. */
    if (v->in == v->out && v->left + late <= now && flits <= g->buffer) return now;
    const int64_t last = v->in + flits - 1 - g->buffer;
    if (last >= v->out) {
        v->starved = true;
        return SIM_NEVER;
    }
    if (last < 0) return now;
    if (g->even)
        return router_later(now, v->stay[last & g->ring].go + late - (flits - 1) * p->flit);
    for (int32_t j = 0; j < flits; j++) {
        const int64_t n = v->in + j - g->buffer;
        if (n >= 0) now = router_later(now, v->stay[n & g->ring].go + late - j * p->flit);
    }
    return now;
}

/* lane_restart: v is clear, and its ring begins anew: mostly the first places are enough, and stay
 * in the cache. */
static inline void lane_restart(struct lane *v) { v->in = v->out = 0; }

/* lane_enter: l at the end of v's FIFO. */
static inline void lane_enter(struct lane *v, struct leg *l)
{
    *(v->front ? &v->back->behind : &v->front) = l;
    v->back = l;
}

/* router_unit: how many flits of w move at once. */
static inline int32_t router_unit(const struct routers *g, const struct worm *w)
{
    return g->whole ? w->flits : 1;
}

/* router_tries: v takes part in an allocation now, and in no other one for a flit: who gets nothing
 * comes back then, whether somebody else has the router looked at before or not. */
static inline void router_tries(const struct routers *g, struct lane *v)
{
    v->retry = g->router[v->of->to].retry = g->now + g->fabric.fastest;
}

/* router_out: the port that option o of lane v's front leads over; o NULL: out of the network. */
static inline int router_out(const struct routers *g, const struct lane *v,
                             const struct route_option *o)
{
    return o ? net_resource(g->fabric.net, o->link) : g->sink + v->front->worm->route.node;
}

/* router_channels: the channels of option o of lane v's front; o NULL: out of the network. Returns
 * how many from *first on. */
static inline int router_channels(const struct lane *v, const struct route_option *o, int *first)
{
    *first = o ? o->first : v->first;
    return o ? o->count : v->count;
}

/* router_bit: number i in a set of inputs or outputs of a router, in which those above the last bit
 * are all of them. */
static inline uint64_t router_bit(uint32_t i) { return i < 64 ? UINT64_C(1) << i : ~UINT64_C(0); }

/* router_waits: whether the front of v still has to send its head. */
static inline bool router_waits(const struct lane *v)
{
    return v->state == LANE_ASKING || (v->state == LANE_SENDING && v->front->ahead->sent == 0);
}

/* router_looks: whether the way of v's front depends on loads when it is found, an event of its own
 * before that in which the head asks. */
static inline bool router_looks(const struct routers *g, const struct lane *v)
{
    return g->looks_on || (g->looks && v->front->worm->route.channel < 0);
}

/* router_after: the place of a number after `turn`, in unsigned arithmetic that wraps. */
static inline uint32_t router_after(uint32_t number, uint32_t turn) { return number - turn; }

/* router_next_channel: the channel after v's, round. */
static inline int router_next_channel(const struct routers *g, const struct lane *v)
{
    return (uint32_t)v->channel + 1 < g->nchannel ? v->channel + 1 : 0;
}

/* router_crosses: a flit comes from input `in` over output `out`: the turns of both sides of the
 * switch move on. */
static inline void router_crosses(struct port *in, struct port *out)
{
    out->grant = in->in + 1;
    in->accept = out->out + 1;
}

/* router_channel_given: FIFO v gets channel `out`: the turns of both move on. */
static inline void router_channel_given(struct lane *v, struct lane *out)
{
    out->grant = v->input + 1;
    v->accept = out->output + 1;
}

/* router_may_hold: whether w may be given channel v. A worm that spreads over two channels and is
 * not the first in the second cannot turn to the escape channels, so that those above them are
 * given to packets that fit (Ma, Enright Jerger and Wang 2012), or when empty. */
static inline bool router_may_hold(const struct routers *g, const struct lane *v,
                                   const struct worm *w)
{
    if (!g->fits || v->channel < g->routing->escape || v->in == v->out) return true;
    return g->buffer - (v->in - v->out) >= w->flits;
}

#endif
