/* net_router_pass.c - what moves from lane to lane, and what a look at a router comes to where a
 * lane is alone.
 *
 * Most looks find one lane that nobody disputes anything: its head gets the channel whose turn it
 * is and the way through the switch, and goes, in one step without lists and rounds. The times and
 * turns are those that the allocation of net_router_allocate.c comes to. */
#include "net/net_account.h"
#include "net/net_router_front.h"

/* For whole packets and for flits apart: `whole` is constant in each. */
#define INLINED static inline __attribute__((always_inline))

/* ---- moving on ---- */

/* The sender upstream of port p may have room: a router, or a node. */
static void upstream_wake(struct routers *g, int p, sim_ps at)
{
    const struct port *o = &g->port[p];
    if (o->from >= 0) router_wake(g, o->from, at);
    else packet_wake(&g->fabric, p, router_later(at, g->fabric.resource[p].free));
}

/* Whether a head at router r may want a channel that is free from `at` on: none does that comes
 * later. */
static bool somebody_asks(const struct routers *g, int r, sim_ps at)
{
    const struct router *o = &g->router[r];
    const struct lane *w = o->busy;
    if (o->next < o->end && (!g->spares || o->coming[o->next].due <= at)) return true;
    if (!g->spares) return w != NULL;
    while (w && (w->state == LANE_SENDING || w->due > at)) w = w->busy;
    return w != NULL;
}

/* From when on v, which is nobody's, is clear: once it is empty, with the last credit. */
static inline void lane_clears(const struct routers *g, struct lane *v)
{
    if (v->in == v->out && !v->owner)
        v->clear = router_later(v->free, v->left + g->credit + v->of->wire);
}

/* The tail of v's packet has crossed into out: the channel is free for the next, and v has the
 * front that it has now: what stood behind it, from a flit after the tail on. */
static inline void tail_sent(struct routers *g, struct lane *v, struct lane *out, sim_ps tail,
                             sim_ps flit)
{
    /* From its tail on the next packet may own the channel, at a time that may lie ahead. */
    out->owner = NULL;
    out->free = ps_later(tail, flit + g->pause);
    lane_clears(g, out);
    lane_clears(g, v);
    router_front(g, v);
    /* Others may want the channel. */
    const int r = v->of->to;
    if (somebody_asks(g, r, out->free)) router_wake(g, r, out->free);
}

/* Packet w has left the network, at the end of its way: the message may be complete, with the last
 * tail of its packets. */
static void worm_left(struct routers *g, struct worm *w, sim_ps tail)
{
    struct flight *s = w->flight;
    router_worm_return(g, w);
    if (++s->ejected == s->npacket)
        packet_deliver_at(&g->fabric, s, ps_later(tail, net_end(g->fabric.net, s->m->bytes)));
}

/* The account of a packet that crossed port p. */
static inline void worm_account(struct routers *g, const struct worm *w, int p, sim_ps queue)
{
    struct net *n = g->fabric.net;
    net_account_packet(n, p, w->flight->m, w->index, w->flits * g->port[p].flit, queue);
}

/* When lane w may first compete with v, which sends over port `out`: never before it has a flit,
 * and where it goes elsewhere, not before its next packet. */
static sim_ps competes(const struct routers *g, const struct lane *v, const struct lane *w,
                       const struct port *out, sim_ps now)
{
    int32_t left = w->front->worm->flits;
    if (w->state == LANE_ROUTING) return w->due;
    const bool meets = w->port == v->port || (w->ways & router_bit(out->out));
    if (w->state == LANE_SENDING) {
        left -= w->front->ahead->sent;
        if (meets) return w->out < w->in ? w->stay[w->out & g->ring].come : now + g->reach;
    } else if (meets) {
        return w->due;
    }
    return router_later(now, w->due) + left * g->fabric.fastest + g->setup;
}

/* Until when, at most `until`, nobody can dispute v's way over port out: a head that is not yet
 * under way to this router asks no sooner than a hop latency from now. */
static inline sim_ps undisputed(const struct routers *g, const struct lane *v,
                                const struct port *out, sim_ps until, sim_ps now)
{
    /* A rule that looks at the room in a lane must not see what is yet to come. */
    if (g->fits) return now;
    until = router_sooner(until, now + g->tau);
    const struct router *o = &g->router[v->of->to];
    for (const struct lane *w = o->busy; w && until > now; w = w->busy)
        if (w != v) until = router_sooner(until, competes(g, v, w, out, now));
    /* None competes before it is due. */
    for (int32_t k = o->next; k < o->end && o->coming[k].due < until; k++)
        until = router_sooner(until, competes(g, v, o->coming[k].lane, out, now));
    return until;
}

/* A whole packet from v over port p into out, its head at `now`; *tail: its tail. */
static inline void packet_crosses(struct routers *g, struct lane *v, struct port *p,
                                  struct lane *out, bool sink, sim_ps now, sim_ps *tail)
{
    const struct leg *l = v->front;
    const int32_t flits = l->worm->flits;
    const sim_ps flit = p->flit, come = now + g->reach + p->wire;
    /* A fast port cannot outrun a slow one before it. */
    *tail = router_later(now + (flits - 1) * flit, l->tail + g->tau + v->of->wire);
    const int64_t ring = g->ring;
    struct stay *stay = v->stay;
    int64_t n = v->out, end = n + flits;
    v->out = end;
    for (sim_ps at = now; n < end; n++, at += flit) stay[n & ring].go = at;
    if (sink) return;
    stay = out->stay;
    n = out->in;
    end = n + flits;
    out->in = end;
    out->clear = SIM_NEVER;
    for (sim_ps at = come; n < end; n++, at += flit) stay[n & ring].come = at;
}

/* A flit of v's front over port p into out at `now`, and up to `most` - 1 further ones at times
 * that are known: until when nobody can dispute the way. Alone they win, and turns move on. Returns
 * how many; the last one crosses at *last. */
static inline int32_t flits_cross(struct routers *g, struct lane *v, struct port *p,
                                  struct lane *out, bool sink, int32_t most, sim_ps now,
                                  sim_ps *last)
{
    const sim_ps flit = p->flit, way = g->reach + p->wire;
    const int64_t ring = g->ring, here = v->in - v->out;
    struct stay *const from = v->stay, *const to = out->stay;
    int64_t k = v->out;
    sim_ps at = now;
    int32_t sent = 1;
    from[k++ & ring].go = now;
    v->out = k;
    out->clear = SIM_NEVER;
    if (!sink) to[out->in++ & ring].come = now + way;
    *last = now;
    if (most > here) most = (int32_t)here;
    if (most > ROUTER_AHEAD) most = ROUTER_AHEAD;
    if (most == 1) return 1;
    const sim_ps all = router_later(now, from[(k + most - 2) & ring].come) + (most + 1) * flit;
    const sim_ps until = undisputed(g, v, p, all, now);
    /* Mostly all credits are there. */
    const int64_t needed = out->in + most - 2 - g->buffer;
    const bool room = sink || needed < 0 ||
                      (needed < out->out && to[needed & ring].go + g->credit + p->wire <= now);
    for (; sent < most; sent++) {
        at = router_later(from[k & ring].come, at + flit);
        if (at < until && !room) at = router_room(g, out, 1, at);
        if (at >= until) break;
        from[k++ & ring].go = *last = at;
        v->out = k;
        if (!sink) to[out->in++ & ring].come = at + way;
    }
    if (sent == 1) return 1;
    /* Alone at both sides of the switch it would have won every round. */
    router_crosses(v->of, p);
    return sent;
}

/* A place has become free, and somebody waits for it: for its credit, or with a whole packet, whose
 * first flits may go before the place for the last one is free, from now on. */
static inline void place_freed(struct routers *g, struct lane *v, sim_ps now)
{
    if (v->starved) upstream_wake(g, v->port, g->whole ? now : now + g->credit + v->of->wire);
    v->starved = false;
}

/* The next flit of a packet whose channel is v's, if it is here. */
static inline void rest_waits(struct routers *g, const struct lane *v)
{
    if (v->out < v->in)
        router_wake(g, v->of->to, router_later(v->of->passed, v->stay[v->out & g->ring].come));
}

/* What has crossed stands behind port p, whose lane it enters as m; the head may be its front. */
static inline void flits_come(struct routers *g, const struct port *p, struct lane *out,
                              const struct leg *m, bool head, sim_ps now)
{
    if (out->front != m) return;
    if (head) router_front_comes(g, out);
    else if (out->state == LANE_SENDING) router_wake(g, p->to, now + g->reach + p->wire);
}

void router_send(struct routers *g, struct lane *v, sim_ps now)
{
    struct leg *l = v->front, *m = l->ahead;
    struct worm *w = m->worm;
    struct port *in = v->of, *p = &g->port[m->port];
    struct lane *out = &p->lane[m->channel];
    const bool head = m->sent == 0, sink = m->port >= g->sink;
    sim_ps tail;
    /* The head or next flit now, then what can follow without a dispute. */
    if (g->whole) packet_crosses(g, v, p, out, sink, now, &tail);
    m->sent +=
        g->whole ? w->flits : flits_cross(g, v, p, out, sink, w->flits - m->sent, now, &tail);
    m->tail = tail;
    if (head) m->first = now;
    p->free = in->passed = v->left = ps_later(tail, p->flit);
    if (!sink) flits_come(g, p, out, m, head, now);
    place_freed(g, v, now);
    if (m->sent < w->flits) {
        rest_waits(g, v);
        return;
    }
    worm_account(g, w, m->port, m->first - m->ask);
    v->front = l->behind;
    tail_sent(g, v, out, tail, p->flit);
    router_leg_return(g, l);
    if (!sink) return;
    worm_left(g, w, tail);
    router_leg_return(g, m);
}

/* ---- a lane that is alone ---- */

/* What a head without rivals finds on one way: the channel whose turn it is and how far it is from
 * the turn, whether it bids for the switch, and when to ask for other channels. */
struct chance {
    struct lane *channel;
    uint32_t distance;
    bool bids;
    sim_ps again;
};

static inline struct chance find_channel(struct routers *g, struct lane *v, struct port *p,
                                         int first, int count, bool sink, sim_ps now,
                                         const bool whole)
{
    const struct worm *w = v->front->worm;
    const uint32_t turn = p->out * g->nchannel - v->accept;
    const int32_t unit = whole ? w->flits : 1;
    struct lane *best = NULL;
    sim_ps again = SIM_NEVER;
    uint32_t nearest = 0;
    bool bids = false;
    for (int i = first; i < first + count; i++) {
        struct lane *out = &p->lane[i];
        if (out->owner) continue;
        const bool holds = sink || router_may_hold(g, out, w);
        sim_ps at = router_later(now, out->free);
        /* The bid does not wait for the channel: any that is free with a credit will do. */
        if (sink) {
            bids |= at == now;
        } else if ((whole && holds) || (at == now && !bids)) {
            const sim_ps room = router_room(g, out, unit, now);
            bids |= at == now && room <= now;
            if (whole) at = router_later(at, room);
        }
        if (!holds) continue;
        if (at > now) {
            again = router_sooner(again, at);
        } else if (!best || turn + (uint32_t)i < nearest) {
            best = out;
            nearest = turn + (uint32_t)i;
        }
    }
    return (struct chance){best, nearest, bids, again};
}

/* The front of v gets channel `out` of port p and the switch and goes, alone. The same as
 * router_own and router_send, in one step: if all of the packet has gone, its leg goes with it. */
INLINED void pass_on(struct routers *g, struct lane *v, struct port *in, struct lane *out,
                     struct port *p, bool sink, sim_ps now, const bool whole)
{
    struct leg *l = v->front;
    struct worm *w = l->worm;
    const sim_ps asked = v->due;
    int32_t sent = w->flits;
    sim_ps tail;
    if (whole) packet_crosses(g, v, p, out, sink, now, &tail);
    else sent = flits_cross(g, v, p, out, sink, sent, now, &tail);
    p->free = in->passed = v->left = ps_later(tail, p->flit);
    /* Its leg goes with it, or stays for the rest, which then holds the channel. */
    struct leg *m = l;
    if (whole || sent == w->flits) {
        v->front = l->behind;
        if (!sink) {
            routing_take(g->routing, &w->route, v->option, out->channel);
            l->behind = l->ahead = NULL;
            l->port = out->port;
            l->channel = out->channel;
            l->ask = asked;
            lane_enter(out, l);
        }
    } else {
        router_own(g, v, out);
        m = l->ahead;
    }
    m->sent = sent;
    m->first = now;
    m->tail = tail;
    if (!sink) flits_come(g, p, out, m, true, now);
    place_freed(g, v, now);
    if (!whole && sent < w->flits) {
        rest_waits(g, v);
        return;
    }
    worm_account(g, w, out->port, now - asked);
    tail_sent(g, v, out, tail, p->flit);
    if (!sink) return;
    router_leg_return(g, l);
    worm_left(g, w, tail);
}

/* Of the channels that v's only way on offers at `now`, the one whose turn it is. NULL: none is
 * there, or the way of the one is not clear at once. */
static inline struct lane *clear_channel(struct routers *g, const struct lane *v,
                                         const struct port *p, sim_ps now, const bool whole)
{
    const uint32_t turn = v->accept - p->out * g->nchannel - (uint32_t)v->first;
    const int count = v->count;
    int k = turn < (uint32_t)count ? (int)turn : 0;
    for (int i = 0; i < count; i++) {
        struct lane *out = &p->lane[v->first + k];
        if (++k == count) k = 0;
        /* Mostly so, and then one comparison says it all. */
        if (out->clear <= now) return out;
        if (out->owner || out->free > now) continue;
        if (!whole) return NULL;
        if (v->noption > 0 && router_room(g, out, v->front->worm->flits, now) <= now) return out;
    }
    return NULL;
}

/* router_quick. The ways through the switch are free at both ends, and what is given can be used at
 * once; nothing has changed when one of these is not so. */
INLINED bool head_quick(struct routers *g, struct lane *v, sim_ps now, const bool whole)
{
    struct port *in = v->of, *p = &g->port[v->way];
    if (router_later(in->passed, p->free) > now || !p->lane) return false;
    struct lane *out = clear_channel(g, v, p, now, whole);
    if (!out) return false;
    /* Nobody is in the way: as in head_alone, but for what it looks up in case of a wait. */
    if (out->clear <= now) lane_restart(out);
    /* Alone it wins every round, and all turns move on. */
    router_crosses(in, p);
    in->turn = router_next_channel(g, v);
    router_channel_given(v, out);
    pass_on(g, v, in, out, p, v->noption == 0, now, whole);
    return true;
}

static bool packet_quick(struct routers *g, struct lane *v, sim_ps now)
{
    return head_quick(g, v, now, true);
}

bool router_quick(struct routers *g, struct lane *v, sim_ps now)
{
    return g->whole ? packet_quick(g, v, now) : head_quick(g, v, now, false);
}

/* A head that asks. */
static inline sim_ps head_alone(struct routers *g, struct lane *v, sim_ps now, const bool whole)
{
    const bool sink = v->noption == 0;
    struct port *in = v->of, *p = &g->port[v->way];
    if (!p->lane) router_lanes_make(g, v->way);
    const struct chance c = find_channel(g, v, p, v->first, v->count, sink, now, whole);
    sim_ps again = c.again;
    bool bids = c.bids;
    const sim_ps at = router_later(in->passed, p->free);
    if (bids && at > now) {
        again = router_sooner(again, at);
        bids = false;
    }
    /* The switch moves its turns on, even if there is no channel to use it for. */
    if (bids) {
        router_crosses(in, p);
        in->turn = router_next_channel(g, v);
    }
    if (bids || c.channel) router_tries(g, v);
    if (!c.channel) return bids ? router_sooner(again, ps_later(now, p->flit)) : again;
    /* So does the one offer that it accepts, as in a first round. */
    router_channel_given(v, c.channel);
    /* It has a channel and the switch: a flit goes if its buffer has room. */
    if (bids && (whole || sink || router_room(g, c.channel, 1, now) <= now)) {
        pass_on(g, v, in, c.channel, p, sink, now, whole);
        return again;
    }
    router_own(g, v, c.channel);
    return router_sooner(again, ps_later(now, p->flit));
}

/* The outputs for which v's head bids: of its eligible options those of the highest priority, or
 * all of them (routers.strict). Returns the one whose turn it is, NULL: none; *again: when to come
 * back for others, or because two bids were for one output. */
static struct port *find_output(struct routers *g, struct lane *v, const bool *may, sim_ps now,
                                sim_ps *again)
{
    struct port *in = v->of, *bid[ROUTING_MOST_OPTIONS], *best = NULL;
    int nbid = 0, top = -1;
    for (int i = 0; i < v->noption; i++)
        if (may[i] && v->option[i].priority > top) top = v->option[i].priority;
    for (int i = 0; i < v->noption; i++) {
        const struct route_option *o = &v->option[i];
        if (!may[i] || (!g->strict && o->priority != top)) continue;
        struct port *p = &g->port[router_out(g, v, o)];
        sim_ps at = router_later(in->passed, p->free);
        int k = 0;
        while (k < nbid && bid[k] != p) k++;
        if (at <= now && k < nbid) at = ps_later(now, p->flit);
        if (at > now) {
            *again = router_sooner(*again, at);
            continue;
        }
        router_tries(g, v);
        bid[nbid++] = p;
        if (!best || router_after(p->out, in->accept) < router_after(best->out, in->accept))
            best = p;
    }
    for (int k = 0; k < nbid; k++)
        if (bid[k] != best) *again = router_sooner(*again, ps_later(now, bid[k]->flit));
    return best;
}

/* A head that asks, with several ways on. Whom a channel of no use to it was offered, and who gets
 * no channel, tries again a flit later. */
static sim_ps head_choosing(struct routers *g, struct lane *v, sim_ps now)
{
    bool may[ROUTING_MOST_OPTIONS], bars = false;
    struct chance best = {NULL, 0, false, SIM_NEVER};
    int priority = 0;
    sim_ps again = SIM_NEVER, back = SIM_NEVER;
    struct port *in = v->of;
    for (int i = 0; i < v->noption; i++) {
        const struct route_option *o = &v->option[i];
        const int at = router_out(g, v, o), level = g->priority ? o->priority : 0;
        router_lanes(g, at);
        const struct chance c =
            find_channel(g, v, &g->port[at], o->first, o->count, false, now, g->whole);
        again = router_sooner(again, c.again);
        may[i] = c.bids;
        bars = bars || (g->strict && !c.bids);
        if (!c.channel) continue;
        router_tries(g, v);
        back = router_sooner(back, ps_later(now, g->port[at].flit));
        if (best.channel &&
            (level < priority || (level == priority && c.distance >= best.distance)))
            continue;
        best = c;
        priority = level;
    }
    struct port *p = find_output(g, v, may, now, &again);
    if (p) {
        router_crosses(in, p);
        if (!bars) in->turn = router_next_channel(g, v);
    }
    struct lane *out = best.channel;
    if (out) {
        router_channel_given(v, out);
        router_own(g, v, out);
    }
    if (p && !bars && out && out->of == p &&
        router_room(g, out, router_unit(g, v->front->worm), now) <= now)
        router_send(g, v, now);
    else if (p) again = router_sooner(again, ps_later(now, p->flit));
    return router_waits(v) ? router_sooner(again, back) : again;
}

sim_ps router_pass(struct routers *g, struct lane *v, sim_ps now)
{
    if (v->state != LANE_SENDING && v->noption > 1) return head_choosing(g, v, now);
    if (v->state != LANE_SENDING)
        return g->whole ? head_alone(g, v, now, true) : head_alone(g, v, now, false);
    /* It has a flit, a credit and the way. */
    struct port *in = v->of, *p = &g->port[v->front->ahead->port];
    router_crosses(in, p);
    in->turn = router_next_channel(g, v);
    router_send(g, v, now);
    return SIM_NEVER;
}
