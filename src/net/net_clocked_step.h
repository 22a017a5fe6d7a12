/* net_clocked_step.h - the steps of net_clocked.h, by file: nodes, ways on, lanes that are alone,
 * lanes that meet, cycles. Each does what its namesake of net_router.h does. */
#ifndef NET_NET_CLOCKED_STEP_H
#define NET_NET_CLOCKED_STEP_H

#include "net/net_clocked_lane.h"

/* clocked_cycle: cycle g->now, whose bits are `slot`: nodes, then routers, each by number, then
 * those that are looked at again. All bits are cleared. */
void clocked_cycle(struct clocked *g, uint64_t *slot);

/* clocked_source_look: at the way into the network of `node`: messages that have started begin
 * there one after the other. */
void clocked_source_look(struct clocked *g, int node, int32_t now);

/* clocked_look_slowly: at all lanes of router o, also where some tried within the last flit.
 * Returns when to look again. */
int32_t clocked_look_slowly(struct clocked *g, struct clocked_router *o, int32_t now);

/* clocked_meet: the n lanes g->active of router o can do something now. Returns when to look again.
 */
int32_t clocked_meet(struct clocked *g, struct clocked_router *o, int n, int32_t now);

/* clocked_alone: the same for v, which is in nobody's way, and whose way is not clear. */
int32_t clocked_alone(struct clocked *g, struct clocked_lane *v, int32_t now);

/* clocked_few: the same where they are few with one way on each, and no two heads ask at one port;
 * else it does nothing and returns -1. */
int32_t clocked_few(struct clocked *g, struct clocked_router *o, int n, int32_t now);

/* clocked_route: the way on of v's front, by the rule itself; clocked_route_on: the same by the
 * table, of v in port p, behind the first router. From now on it asks. */
void clocked_route(struct clocked *g, struct clocked_lane *v);
void clocked_route_on(struct clocked *g, struct clocked_lane *v, const struct clocked_port *p);

/* clocked_own: the front of v owns channel `out` from now on, until its tail has crossed.
 * clocked_send: the front of v sends what moves at once over the channel that it owns, at most
 * `most` flits. */
void clocked_own(struct clocked *g, struct clocked_lane *v, struct clocked_lane *out);
void clocked_send(struct clocked *g, struct clocked_lane *v, int32_t now, int32_t most);

/* clocked_pass_on: the front of v, a lane of `in`, gets channel `number` of port p and the switch
 * in the same cycle, and sends at most `most` flits. */
void clocked_pass_on(struct clocked *g, struct clocked_lane *v, struct clocked_port *in,
                     struct clocked_port *p, int number, int32_t now, int32_t most);

/* clocked_pass: v, which is in nobody's way, gets what it asks for, as far as that is there.
 * Returns when to look at it again; CLOCKED_NEVER: nothing of it needs that. */
int32_t clocked_pass(struct clocked *g, struct clocked_lane *v, int32_t now);

/* clocked_hop: head i of router o, which nobody disputes now, goes at once if a channel and the
 * switch are free for that; else nothing has changed: false. asks: when the first of the other
 * heads does; *again: when to look again, if that is needed. */
bool clocked_hop(struct clocked *g, struct clocked_router *o, int i, int32_t asks, int32_t now,
                 int32_t *again);

/* clocked_quick: the same for a head that asks, if all is free for it to go at once; else it does
 * nothing and returns false. *again: when to look again, if that is needed. */
bool clocked_quick(struct clocked *g, struct clocked_lane *v, int32_t now, int32_t *again);

/* clocked_front: the head of the front of v, a lane of p, is there or on its way: see
 * router_front_comes. */
void clocked_front(struct clocked *g, struct clocked_lane *v, struct clocked_port *p);

/* clocked_front_changes: the front of v, a lane of p, has gone. The one behind it, if its head is
 * there or under way, is the new one; with no such one there is nothing to look at. */
void clocked_front_changes(struct clocked *g, struct clocked_lane *v, struct clocked_port *p);

/* clocked_place_freed: flits leave v, a lane of `in`, from now on, and somebody upstream waits for
 * their places. */
void clocked_place_freed(struct clocked *g, struct clocked_lane *v, const struct clocked_port *in,
                         int32_t now);

/* clocked_leg: a packet's leg at the end of lane v, which is its own from now on. */
struct clocked_leg *clocked_leg(struct clocked *g, struct clocked_lane *v);

/* clocked_worm: the packet of `message`, at its source. */
struct clocked_worm *clocked_worm(struct clocked *g, int message);

/* One way on: the channels first .. first + count - 1 of a port. */
struct clocked_way {
    struct clocked_port *port;
    int first, count, priority;
};

/* clocked_option: way number i of those of v's front; 0 where it leaves the network, too. */
struct clocked_way clocked_option(const struct clocked *g, const struct clocked_lane *v, int i);

/* clocked_taken: v's front l goes over channel `number` of port p, which is no way out; where its
 * way was not found in the table. */
void clocked_taken(struct clocked *g, const struct clocked_lane *v, struct clocked_leg *l,
                   const struct clocked_port *p, int number);

/* What a head finds on one way: the free channel whose turn it is, NULL if there is none; whether
 * it bids for the switch; when something may be free that is not now. */
struct clocked_chance {
    struct clocked_lane *channel;
    int number;
    uint8_t distance;
    bool bids;
    int32_t again;
};

/* clocked_find: the same for v and the channels first .. first + count - 1 of port p. */
struct clocked_chance clocked_find(struct clocked *g, struct clocked_lane *v,
                                   const struct clocked_port *p, int first, int count, int32_t now);

/* clocked_undisputed: until when, at most `until`, no lane of its router but `also` can dispute v's
 * way over port out. */
int32_t clocked_undisputed(const struct clocked *g, const struct clocked_lane *v,
                           const struct clocked_lane *also, const struct clocked_port *out,
                           int32_t until, int32_t now);

/* clocked_sent: what comes of it that k flits of v's front, a lane of `in`, whose head went before,
 * have crossed over the channel that it owns, or will, from `first` to `last`. */
void clocked_sent(struct clocked *g, struct clocked_lane *v, struct clocked_port *in, int32_t k,
                  int32_t first, int32_t last);

/* clocked_delivered: w has left the network, its tail at `tail`. */
void clocked_delivered(struct clocked *g, struct clocked_worm *w, int32_t tail);

/* clocked_waits: whether the front of v still has to send its head. */
static inline bool clocked_waits(const struct clocked_lane *v)
{
    return v->head.state == LANE_ASKING ||
           (v->head.state == LANE_SENDING && v->front->ahead->sent == 0);
}

/* clocked_used: flits that `link` was given and whose credits are not back (router_used); `of` is
 * a struct clocked. */
int64_t clocked_used(const void *of, int link);

/* clocked_sends_from: from when on v, a FIFO that has its channel, has a flit, a credit, and both
 * sides of the switch free. */
CLOCKED_INLINED int32_t clocked_sends_from(struct clocked *g, const struct clocked_lane *v,
                                           int32_t now, const bool whole)
{
    if (v->out >= v->in) return CLOCKED_NEVER; /* its next flit has not been sent */
    const struct clocked_port *out = v->way;
    int32_t at = clocked_later(clocked_port_of(g, v)->passed, out->free);
    /* A whole packet is there when its head is. */
    at = clocked_later(at, whole ? v->due : clocked_stay(g, v, v->out)->come);
    if (out >= g->sink) return at;
    return clocked_later(at, clocked_room(g, &g->lane[v->front->ahead->lane], out,
                                          whole ? v->front->flits : 1, now, whole));
}

#endif
