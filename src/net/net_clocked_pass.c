/* net_clocked_pass.c - what moves from lane to lane, and looks at routers in which a lane is alone
 * (net_router_pass.c, in cycles).
 *
 * What moves is a whole packet at level packet, and flits at level flit. Flits look ahead: those
 * whose times are known already, and whose way nobody can dispute before, go in one step. The
 * records then tell the future, so that whoever reads them compares with now. */
#include "net/net_clocked_step.h"

/* ---- moving on ---- */

/* From when on v of port p, which is nobody's, is clear. */
static inline void lane_clears(const struct clocked *g, struct clocked_lane *v,
                               const struct clocked_port *p)
{
    if (v->in == v->out && !v->owned)
        v->clear = clocked_later(v->free, v->left + g->credit + p->wire);
}

/* v of port p has a new front, whose head asks from `due` on. Its way is found at once where the
 * table has it or the rule does not look at loads; else where it stands, in that very cycle. */
static inline void front_comes(struct clocked *g, struct clocked_lane *v, struct clocked_port *p,
                               int32_t due)
{
    struct clocked_router *o = &g->router[p->to];
    v->due = due;
    if (v->front->state >= 0) {
        v->due += g->setup;
        clocked_route_on(g, v, p);
    } else if (g->looks_on || (g->looks && p->from < 0)) {
        v->head.state = LANE_ROUTING;
    } else {
        v->due += g->setup;
        clocked_route(g, v);
    }
    if (g->queues) clocked_has_none(o, (int)(v - o->lane));
    clocked_comes(g, o, (int)(v - o->lane), v->due);
    clocked_wake(g, p->to, v->due);
}

void clocked_front(struct clocked *g, struct clocked_lane *v, struct clocked_port *p)
{
    front_comes(g, v, p, clocked_later(v->front->first + g->reach + p->wire, v->left));
}

/* The front of v has gone. The one behind it, if its head is there or under way, is the new one;
 * with no such one there is nothing to look at. */
static inline void front_changes(struct clocked *g, struct clocked_lane *v, struct clocked_port *p)
{
    if (v->front && v->front->sent > 0) {
        clocked_front(g, v, p);
        return;
    }
    struct clocked_router *o = &g->router[p->to];
    v->head.state = LANE_IDLE;
    clocked_has_none(o, (int)(v - o->lane));
}

void clocked_front_changes(struct clocked *g, struct clocked_lane *v, struct clocked_port *p)
{
    front_changes(g, v, p);
}

/* A whole packet from v over port p into out, its head at `now`: its flits follow one in a cycle,
 * so that one entry says when each of them left. */
static inline void packet_crosses(struct clocked *g, struct clocked_lane *v, struct clocked_port *p,
                                  struct clocked_lane *out, bool sink, int32_t now)
{
    const int32_t flits = v->front->flits;
    union clocked_stay *stay = clocked_stay(g, v, v->nleft++);
    stay->position = v->out;
    stay->at = now;
    v->out += flits;
    if (sink) return;
    out->in += flits;
    out->clear = CLOCKED_NEVER;
    p->held += flits;
}

/* When lane w may first compete with v, which sends over `out`: with its next flit, if it has a
 * channel there; with its head, if that may go there, or nobody knows yet where it goes. Where it
 * goes elsewhere it is the packet behind it that may, not before its own tail has left. */
static int32_t competes(const struct clocked *g, const struct clocked_lane *v,
                        const struct clocked_lane *w, const struct clocked_port *out, int32_t now)
{
    int32_t left = w->front->flits;
    if (w->head.state == LANE_ROUTING) return w->due;
    const bool meets = w->port == v->port || clocked_ways(w) >> out->out & 1;
    if (w->head.state == LANE_SENDING) {
        left -= w->front->ahead->sent;
        if (meets) return w->out < w->in ? clocked_stay(g, w, w->out)->come : now + g->reach;
    } else if (meets) {
        return w->due;
    }
    /* With nobody behind it there is none that is known here yet. */
    if (!w->front->behind) return CLOCKED_NEVER;
    return clocked_later(now, w->due) + left * g->flit + g->setup;
}

int32_t clocked_undisputed(const struct clocked *g, const struct clocked_lane *v,
                           const struct clocked_lane *also, const struct clocked_port *out,
                           int32_t until, int32_t now)
{
    const struct clocked_router *o = clocked_router_of(g, v);
    /* Beyond that, heads may come that are not known here yet. */
    until = clocked_sooner(until, now + g->tau);
    for (int k = 0; k < g->sets; k++)
        for (uint64_t busy = o->busy[k]; busy && until > now; busy &= busy - 1) {
            const struct clocked_lane *w = clocked_lane_of(o, k, busy);
            if (w != v && w != also) until = clocked_sooner(until, competes(g, v, w, out, now));
        }
    /* None competes before it is due. */
    for (int k = o->next; k < o->end && o->coming[k].due < until; k++)
        until = clocked_sooner(until, competes(g, v, &o->lane[o->coming[k].lane], out, now));
    return until;
}

/* A flit of v's front over port p into out at `now`, and up to `most` - 1 further ones at cycles
 * that are known, until when nobody can dispute the way. Returns how many; the last one crosses at
 * *last. All look ahead alike, but how far is nobody's business: the times are the same. */
static inline int32_t flits_cross(struct clocked *g, struct clocked_lane *v,
                                  struct clocked_port *in, struct clocked_port *p,
                                  struct clocked_lane *out, bool sink, int32_t most, int32_t now,
                                  int32_t *last)
{
    /* From crossing to standing at the next router; flits that v has, or will have. */
    const int32_t way = g->reach + p->wire, here = v->in - v->out;
    union clocked_stay *const from = clocked_ring(g, v), *const to = clocked_ring(g, out);
    int32_t k = v->out, at = now, sent = 1;
    from[clocked_place(g, k++)].go = now;
    v->out = k;
    out->clear = CLOCKED_NEVER;
    if (!sink) to[clocked_place(g, out->in++)].come = now + way;
    *last = now;
    if (most > here) most = here;
    if (most > ROUTER_AHEAD) most = ROUTER_AHEAD;
    if (most == 1) return 1;
    const int32_t all =
        clocked_later(now, from[clocked_place(g, k + most - 2)].come) + (most + 1) * g->flit;
    const int32_t until = clocked_undisputed(g, v, v, p, all, now);
    /* Mostly all credits are there. */
    const int32_t needed = out->in + most - 2 - g->buffer;
    const bool room =
        sink || needed < 0 ||
        (needed < out->out && to[clocked_place(g, needed)].go + g->credit + p->wire <= now);
    /* The next flit goes when it is there, the one before has gone, and its credit is back. */
    for (; sent < most; sent++) {
        at = clocked_later(from[clocked_place(g, k)].come, at + g->flit);
        if (at < until && !room) at = clocked_room(g, out, p, 1, at, false);
        if (at >= until) break;
        from[clocked_place(g, k++)].go = *last = at;
        v->out = k;
        if (!sink) to[clocked_place(g, out->in++)].come = at + way;
    }
    if (sent > 1) clocked_crosses(in, p); /* alone it would have won every round */
    return sent;
}

/* Whether a head at router o may want a channel that is free from `at` on. */
static bool somebody_asks(const struct clocked *g, const struct clocked_router *o, int32_t at)
{
    if (clocked_next_due(o) <= at) return true;
    for (int k = 0; k < g->sets; k++)
        for (uint64_t busy = o->busy[k]; busy; busy &= busy - 1) {
            const struct clocked_lane *w = clocked_lane_of(o, k, busy);
            if (w->head.state != LANE_SENDING && w->due <= at) return true;
        }
    return false;
}

/* A place has become free, and somebody upstream waits for it: a flit until its credit is back, a
 * whole packet from now on, as its first flits need no place yet. */
CLOCKED_INLINED void place_freed(struct clocked *g, struct clocked_lane *v,
                                 const struct clocked_port *in, int32_t now, const bool whole)
{
    if (!v->starved) return;
    v->starved = false;
    const int32_t at = whole ? now : now + g->credit + in->wire;
    if (in->from >= 0) clocked_wake(g, in->from, at);
    else clocked_wake_source(g, ~in->from, clocked_later(at, g->source[~in->from].free));
}

void clocked_place_freed(struct clocked *g, struct clocked_lane *v, const struct clocked_port *in,
                         int32_t now)
{
    place_freed(g, v, in, now, g->whole);
}

/* Flits of v's front are left: a look when the next one is there and the input is free. */
static inline void rest_waits(struct clocked *g, const struct clocked_lane *v,
                              const struct clocked_port *in)
{
    if (v->out < v->in)
        clocked_wake(g, in->to, clocked_later(in->passed, clocked_stay(g, v, v->out)->come));
}

/* A tail has crossed from v of port in into out at `tail`: the channel is free, and v has a new
 * front. */
static inline void tail_sent(struct clocked *g, struct clocked_lane *v, struct clocked_port *in,
                             struct clocked_lane *out, const struct clocked_port *p, int32_t tail)
{
    out->owned = false;
    out->free = tail + g->flit + g->pause;
    lane_clears(g, out, p);
    lane_clears(g, v, in);
    front_changes(g, v, in);
    /* Others may want the channel. */
    if (somebody_asks(g, &g->router[in->to], out->free)) clocked_wake(g, in->to, out->free);
}

/* Flits of packet m have crossed port p and are, or will be, in `out`: if m is the front there, its
 * head starts to ask, or its flits go on. */
static inline void flits_come(struct clocked *g, struct clocked_port *p, struct clocked_lane *out,
                              const struct clocked_leg *m, bool head, int32_t now)
{
    if (out->front != m) return;
    if (head) clocked_front(g, out, p);
    else if (out->head.state == LANE_SENDING) clocked_wake(g, p->to, now + g->reach + p->wire);
}

/* The tail of v's front, which owned channel `out` of p, crosses at `tail`. Its leg in v goes back,
 * and where it leaves the network the one ahead and the packet, too. */
static inline void tail_crosses(struct clocked *g, struct clocked_lane *v, struct clocked_port *in,
                                struct clocked_lane *out, const struct clocked_port *p,
                                int32_t tail)
{
    struct clocked_leg *l = v->front, *m = l->ahead;
    struct clocked_worm *w = m->worm;
    v->front = l->behind;
    tail_sent(g, v, in, out, p, tail);
    clocked_leg_return(g, l);
    if (p < g->sink) return;
    clocked_delivered(g, w, tail);
    clocked_leg_return(g, m);
}

void clocked_sent(struct clocked *g, struct clocked_lane *v, struct clocked_port *in, int32_t k,
                  int32_t first, int32_t last)
{
    struct clocked_leg *m = v->front->ahead;
    struct clocked_lane *out = &g->lane[m->lane];
    struct clocked_port *p = v->way;
    m->sent += k;
    in->held -= k;
    v->left = last + g->flit;
    if (p < g->sink) {
        p->held += k;
        flits_come(g, p, out, m, false, first);
    }
    place_freed(g, v, in, first, false);
    if (m->sent == m->flits) tail_crosses(g, v, in, out, p, last);
}

/* The steps are in the order of net_router_pass.c. */
void clocked_send(struct clocked *g, struct clocked_lane *v, int32_t now, int32_t most)
{
    struct clocked_leg *l = v->front, *m = l->ahead;
    struct clocked_lane *out = &g->lane[m->lane];
    struct clocked_port *in = clocked_port_of(g, v), *p = clocked_port_of(g, out);
    const bool head = m->sent == 0, sink = p >= g->sink;
    int32_t tail = now + (l->flits - 1) * g->flit, sent = l->flits;
    if (g->whole) packet_crosses(g, v, p, out, sink, now);
    else
        sent = flits_cross(g, v, in, p, out, sink, clocked_sooner(most, l->flits - m->sent), now,
                           &tail);
    m->sent += sent;
    in->held -= sent;
    if (!g->whole && !sink) p->held += sent;
    if (head) m->first = now;
    p->free = in->passed = v->left = tail + g->flit;
    if (!sink) flits_come(g, p, out, m, head, now);
    place_freed(g, v, in, now, g->whole);
    if (m->sent < l->flits) {
        rest_waits(g, v, in);
        return;
    }
    tail_crosses(g, v, in, out, p, tail);
}

/* ---- a lane that is alone ---- */

static inline struct clocked_chance find_channel(struct clocked *g, struct clocked_lane *v,
                                                 const struct clocked_port *p, int first, int count,
                                                 int32_t now)
{
    const bool sink = p >= g->sink;
    const int outputs = p->lanes_out;
    const int32_t unit = g->whole ? v->front->flits : 1;
    struct clocked_chance c = {.again = CLOCKED_NEVER};
    for (int i = first; i < first + count; i++) {
        struct clocked_lane *out = &p->lane[i];
        if (out->owned) continue;
        int32_t at = clocked_later(now, out->free);
        /* The bid does not wait for the channel: any that is free with a credit will do. */
        if (sink) {
            c.bids |= at == now;
        } else if (g->whole || (at == now && !c.bids)) {
            const int32_t room = clocked_room(g, out, p, unit, now, g->whole);
            c.bids |= at == now && room <= now;
            if (g->whole) at = clocked_later(at, room);
        }
        if (at > now) {
            c.again = clocked_sooner(c.again, at);
        } else if (!c.channel || clocked_after(outputs + i, v->accept) < c.distance) {
            c.channel = out;
            c.number = i;
            c.distance = clocked_after(outputs + i, v->accept);
        }
    }
    return c;
}

struct clocked_chance clocked_find(struct clocked *g, struct clocked_lane *v,
                                   const struct clocked_port *p, int first, int count, int32_t now)
{
    return find_channel(g, v, p, first, count, now);
}

/* The front of v, alone, gets channel `number` of port p and the switch in the same cycle, and
 * goes. Where all of it goes at once, nobody ever owns the channel, and its leg moves from one FIFO
 * to the next instead of being made anew. */
CLOCKED_INLINED void pass_on(struct clocked *g, struct clocked_lane *v, struct clocked_port *in,
                             struct clocked_port *p, int number, int32_t now, int32_t most,
                             const bool whole)
{
    struct clocked_lane *out = &p->lane[number];
    struct clocked_leg *l = v->front, *m = l;
    const bool sink = p >= g->sink;
    int32_t sent = l->flits, tail = now + (sent - 1) * g->flit;
    if (whole) packet_crosses(g, v, p, out, sink, now);
    else sent = flits_cross(g, v, in, p, out, sink, clocked_sooner(most, sent), now, &tail);
    in->held -= sent;
    if (!whole && !sink) p->held += sent;
    p->free = in->passed = v->left = tail + g->flit;
    if (whole || sent == l->flits) {
        v->front = l->behind;
        if (!sink) {
            if (l->state < 0) clocked_taken(g, v, l, p, number);
            l->behind = l->ahead = NULL;
            l->lane = clocked_number(g, out);
            clocked_enter(out, l);
        }
    } else {
        clocked_own(g, v, out);
        m = l->ahead;
    }
    m->sent = sent;
    m->first = now;
    if (!sink) flits_come(g, p, out, m, true, now);
    place_freed(g, v, in, now, whole);
    if (!whole && sent < l->flits) {
        rest_waits(g, v, in);
        return;
    }
    tail_sent(g, v, in, out, p, tail);
    if (!sink) return;
    struct clocked_worm *w = l->worm;
    clocked_leg_return(g, l);
    clocked_delivered(g, w, tail);
}

void clocked_pass_on(struct clocked *g, struct clocked_lane *v, struct clocked_port *in,
                     struct clocked_port *p, int number, int32_t now, int32_t most)
{
    if (p->lane[number].clear <= now) clocked_restart(&p->lane[number]);
    if (g->whole) pass_on(g, v, in, p, number, now, most, true);
    else pass_on(g, v, in, p, number, now, most, false);
}

/* A head that asks, with one way on. It gets its channel even if it cannot send yet: then it owns
 * it, and bids again in the next cycle. Returns when to look again. */
static int32_t head_alone(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    struct clocked_port *in = clocked_port_of(g, v), *p = v->way;
    const struct clocked_chance c = find_channel(g, v, p, v->head.first, v->head.count, now);
    int32_t again = c.again;
    bool bids = c.bids;
    const int32_t at = clocked_later(in->passed, p->free);
    /* A bid for a switch that is not free is none. */
    if (bids && at > now) {
        again = clocked_sooner(again, at);
        bids = false;
    }
    if (bids) {
        clocked_crosses(in, p);
        in->turn = clocked_next_channel(g, clocked_channel_of(in, v));
    }
    struct clocked_router *o = &g->router[in->to];
    if (bids || c.channel) clocked_tries(g, o, v);
    /* A bid without a channel has spent its turn. */
    if (!c.channel) return bids ? clocked_sooner(again, now + g->flit) : again;
    clocked_given(v, (int)(v - o->lane), c.channel, p->lanes_out + c.number);
    if (bids && (g->whole || p >= g->sink || clocked_room(g, c.channel, p, 1, now, false) <= now)) {
        clocked_pass_on(g, v, in, p, c.number, now, INT32_MAX);
        return again;
    }
    clocked_own(g, v, c.channel);
    return clocked_sooner(again, now + g->flit);
}

/* The output for which v's head bids with success: of those where it `may`, the ones of the highest
 * priority (strict: all), then by turn. NULL: none is free. *again: when to look again, if sooner.
 */
static struct clocked_port *find_output(struct clocked *g, const struct clocked_lane *v,
                                        const struct clocked_port *in, const bool *may, int32_t now,
                                        int32_t *again)
{
    struct clocked_port *bid[CLOCKED_OPTIONS], *best = NULL;
    int nbid = 0, top = -1;
    /* What may go somewhere with priority does not bid elsewhere. */
    for (int i = 0; i < v->head.noption; i++)
        if (may[i] && clocked_option(g, v, i).priority > top)
            top = clocked_option(g, v, i).priority;
    for (int i = 0; i < v->head.noption; i++) {
        const struct clocked_way o = clocked_option(g, v, i);
        if (!may[i] || (!g->strict && o.priority != top)) continue;
        int32_t at = clocked_later(in->passed, o.port->free);
        int k = 0;
        while (k < nbid && bid[k] != o.port) k++;
        if (at <= now && k < nbid) at = now + g->flit;
        if (at > now) {
            *again = clocked_sooner(*again, at);
            continue;
        }
        clocked_tries(g, clocked_router_of(g, v), v);
        bid[nbid++] = o.port;
        if (!best || clocked_after(o.port->out, in->accept) < clocked_after(best->out, in->accept))
            best = o.port;
    }
    if (nbid > 1) *again = clocked_sooner(*again, now + g->flit);
    return best;
}

/* A head that asks, with several ways on. The channel and the output of the switch are chosen
 * apart, by different turns; the head goes at once only where both are of one port. */
static int32_t head_choosing(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    bool may[CLOCKED_OPTIONS], bars = false;
    struct clocked_chance best = {.again = CLOCKED_NEVER};
    int priority = 0;
    int32_t again = CLOCKED_NEVER;
    struct clocked_port *in = clocked_port_of(g, v), *from = NULL;
    for (int i = 0; i < v->head.noption; i++) {
        const struct clocked_way o = clocked_option(g, v, i);
        const int level = g->priority ? o.priority : 0;
        const struct clocked_chance c = find_channel(g, v, o.port, o.first, o.count, now);
        again = clocked_sooner(again, c.again);
        may[i] = c.bids;
        /* A strict rule's head goes only where all its ways are open. */
        bars = bars || (g->strict && !c.bids);
        if (!c.channel) continue;
        clocked_tries(g, &g->router[in->to], v);
        if (best.channel &&
            (level < priority || (level == priority && c.distance >= best.distance)))
            continue;
        best = c;
        priority = level;
        from = o.port;
    }
    struct clocked_port *p = find_output(g, v, in, may, now, &again);
    if (p) {
        clocked_crosses(in, p);
        if (!bars) in->turn = clocked_next_channel(g, clocked_channel_of(in, v));
    }
    if (!from) return p ? clocked_sooner(again, now + g->flit) : again;
    clocked_given(v, (int)(v - g->router[in->to].lane), best.channel,
                  from->lanes_out + best.number);
    if (p == from && !bars &&
        clocked_room(g, best.channel, p, g->whole ? v->front->flits : 1, now, g->whole) <= now) {
        clocked_pass_on(g, v, in, p, best.number, now, INT32_MAX);
        return clocked_waits(v) ? clocked_sooner(again, now + g->flit) : again;
    }
    clocked_own(g, v, best.channel);
    return clocked_sooner(again, now + g->flit);
}

int32_t clocked_pass(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    if (v->head.state != LANE_SENDING)
        return v->head.noption > 1 ? head_choosing(g, v, now) : head_alone(g, v, now);
    struct clocked_port *in = clocked_port_of(g, v);
    clocked_crosses(in, v->way);
    in->turn = clocked_next_channel(g, clocked_channel_of(in, v));
    clocked_send(g, v, now, INT32_MAX);
    return CLOCKED_NEVER;
}
