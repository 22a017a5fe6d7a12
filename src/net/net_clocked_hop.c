/* net_clocked_hop.c - the short step of a head that is alone: its whole packet goes at once.
 *
 * Most often one lane of a router is due, its head has one way on, or two over one port, and a
 * channel and the switch are free for all of the packet. What comes of it is worked out here at
 * once; all else is left to net_clocked_pass.c and net_clocked_allocate.c. */
#include "net/net_clocked_step.h"

/* ---- a clear way ---- */

/* What the lanes remember of a packet of `flits` flits that crosses p from v into out, one in a
 * cycle from `now` on: at level packet that of v alone; at level flit when each left, and when it
 * comes. */
CLOCKED_INLINED void flits_note(struct clocked *g, struct clocked_lane *v, struct clocked_lane *out,
                                const struct clocked_port *p, int32_t flits, int32_t now,
                                const bool whole)
{
    union clocked_stay *stay = clocked_ring(g, v);
    if (whole) {
        stay += clocked_place(g, v->nleft++);
        stay->position = v->out;
        stay->at = now;
        return;
    }
    for (int32_t k = 0; k < flits; k++) stay[clocked_place(g, v->out + k)].go = now + k * g->flit;
    if (v->head.noption == 0) return;
    stay = clocked_ring(g, out);
    const int32_t come = now + g->reach + p->wire;
    for (int32_t k = 0; k < flits; k++) stay[clocked_place(g, k)].come = come + k * g->flit;
}

/* The way on of out's front l, which has none behind it: mostly a step of the table. */
static inline void way_on(struct clocked *g, struct clocked_lane *out, struct clocked_port *p,
                          const struct clocked_leg *l)
{
    if (l->state < 0) {
        if (g->looks_on) out->head.state = LANE_ROUTING;
        else clocked_route(g, out);
        return;
    }
    const int step = g->steps->step[l->row + p->row], exit = step & ((1 << ROUTING_STEP_BITS) - 1);
    if (exit <= ROUTING_STEP_MOST && step >> ROUTING_STEP_BITS == l->state) {
        out->way = g->exit[p->to * CLOCKED_WORD + exit];
        out->head = g->asking[step >> ROUTING_STEP_BITS];
    } else {
        clocked_route_on(g, out, p);
    }
}

/* l comes into lane `out` of p, which it enters behind those that are there; a lane that is clear
 * counts anew. If it is the front there, its head asks when it has come. */
static inline void comes(struct clocked *g, struct clocked_lane *out, struct clocked_port *p,
                         struct clocked_leg *l, bool clear, int32_t now)
{
    const int32_t flits = l->flits;
    int32_t due = now + g->due + p->wire;
    p->held += flits;
    l->behind = NULL;
    l->sent = flits;
    l->first = now;
    l->lane = clocked_number(g, out);
    out->clear = CLOCKED_NEVER;
    if (clear) {
        out->in = flits;
        out->out = out->nleft = 0;
    } else {
        out->in += flits;
        if (out->front) {
            out->back = out->back->behind = l;
            return;
        }
        due = clocked_later(due, out->left + g->due - g->reach);
    }
    struct clocked_router *o = &g->router[p->to];
    out->front = out->back = l;
    out->due = due;
    clocked_comes(g, o, (int)(out - o->lane), due);
    clocked_wake(g, p->to, due);
    way_on(g, out, p, l);
}

/* Whether all flits of v's front can follow each other from now on, and nobody can come between:
 * level flit. */
static inline bool flits_follow(const struct clocked *g, const struct clocked_lane *v,
                                int32_t flits, int32_t now)
{
    const int32_t tail = now + (flits - 1) * g->flit;
    if (v->in - v->out < flits || flits > ROUTER_AHEAD || flits > g->buffer) return false;
    /* They come one after the other: the last one says it of all. */
    if (clocked_stay(g, v, v->out + flits - 1)->come > tail) return false;
    return flits == 1 || tail < clocked_undisputed(g, v, v, v->way, tail + 1, now);
}

/* The channel of v's way whose turn it is. */
static inline int turn_channel(const struct clocked_lane *v, const struct clocked_port *p)
{
    const int turn = v->accept - p->lanes_out - v->head.first;
    return v->head.first + (turn >= 0 && turn < v->head.count ? turn : 0);
}

/* Of the channels of v's way, from `number` on and round, the first one that v gets at once; -1:
 * there is none. A channel that is clear has all its credits. At level packet it gets one with room
 * for all of it; at level flit any, but goes only if that has a credit. */
static __attribute__((noinline)) int open_channel(struct clocked *g, const struct clocked_lane *v,
                                                  int number, int32_t now)
{
    const struct clocked_port *p = v->way;
    const int first = v->head.first, end = first + v->head.count;
    for (int i = first; i < end; i++) {
        struct clocked_lane *out = &p->lane[number];
        if (out->clear <= now) return number;
        if (!out->owned && out->free <= now) {
            const int32_t unit = g->whole ? v->front->flits : 1;
            if (p < g->sink && clocked_room(g, out, p, unit, now, g->whole) <= now) return number;
            if (!g->whole) return -1;
        }
        if (++number == end) number = first;
    }
    return -1;
}

/* The channel for a head with two ways, both over one port: of those that it gets at once that of
 * the higher priority, where this counts, then by turn. -1: there is none, or a strict rule's head
 * has only one of its ways open, or, at level flit, a channel lacks a credit. *again: when the
 * router is looked at again as if its bids had not been for one port. */
static __attribute__((noinline)) int channel_of_two(struct clocked *g, const struct clocked_lane *v,
                                                    int32_t now, int32_t *again)
{
    const struct route_option *o = &g->option[clocked_number(g, v) * CLOCKED_OPTIONS];
    const struct clocked_port *p = v->way;
    const int32_t unit = g->whole ? v->front->flits : 1;
    int best = -1, top = 0, nopen = 0;
    int32_t later = CLOCKED_NEVER;
    uint8_t nearest = 0;
    for (int k = 0; k < CLOCKED_OPTIONS; k++) {
        const int priority = g->priority ? o[k].priority : 0;
        bool open = false;
        for (int i = o[k].first; i < o[k].first + o[k].count; i++) {
            struct clocked_lane *out = &p->lane[i];
            const uint8_t distance = clocked_after(p->lanes_out + i, v->accept);
            if (out->clear > now) {
                if (out->owned) continue;
                const int32_t at =
                    clocked_later(out->free, clocked_room(g, out, p, unit, now, g->whole));
                if (at > now && !g->whole) return -1;
                later = at > now ? clocked_sooner(later, at) : later;
                if (at > now) continue;
            }
            open = true;
            if (best >= 0 && (priority < top || (priority == top && distance >= nearest))) continue;
            best = i;
            top = priority;
            nearest = distance;
        }
        if (!open && g->strict) return -1;
        nopen += open;
    }
    /* Both ways bid, and one bid is left over. */
    if (nopen == CLOCKED_OPTIONS && (g->strict || o[0].priority == o[1].priority))
        later = now + g->flit;
    *again = later;
    return best;
}

/* Where priorities count, what was offered in the first round of an allocation stands in those that
 * follow: the head accepts the next channel after that whose turn it was, `number`. -1: that is not
 * clear. */
static __attribute__((noinline)) int next_channel(struct clocked *g, const struct clocked_lane *v,
                                                  int number, int32_t now)
{
    const int first = v->head.first, next = number + 1;
    return open_channel(g, v, next < first + v->head.count ? next : first, now);
}

/* All turns move on as the allocators would have moved them: lane i of its router sends over p,
 * whose channel `number` was offered to it first. */
static inline void turns_move(const struct clocked *g, struct clocked_lane *v, int i,
                              struct clocked_port *in, struct clocked_port *p, int number)
{
    clocked_crosses(in, p);
    in->turn = g->after[i];
    clocked_given(v, i, &p->lane[number], p->lanes_out + number);
}

/* Head i of router o, whose ways on are of one port and which nobody disputes now. It gets its
 * channel and the switch in one cycle, and all of it goes; at level flit as much as can go at once.
 * Nobody ever owns the channel then, and its leg moves from one FIFO to the next instead of being
 * made anew. False: there is no such channel, and nothing has changed. asks: when the first of the
 * other heads does, which may want the channel when that is free. */
CLOCKED_INLINED bool hop(struct clocked *g, struct clocked_router *o, int i, int32_t asks,
                         int32_t now, int32_t *again, const bool whole)
{
    struct clocked_lane *v = &o->lane[i];
    struct clocked_port *in = &o->port[g->entry[i]], *p = v->way;
    struct clocked_leg *l = v->front;
    const int32_t flits = l->flits, gone = now + flits * g->flit;
    if (in->passed > now || p->free > now) return false;
    int number, turn;
    if (v->head.noption > 1) {
        if (!g->single || v->other != p->out || (number = channel_of_two(g, v, now, again)) < 0)
            return false;
        /* It bid for both ways: a second look within a flit leaves it out. */
        clocked_tries(g, o, v);
        turn = number;
    } else {
        number = turn_channel(v, p);
        if (p->lane[number].clear > now && (number = open_channel(g, v, number, now)) < 0)
            return false;
        turn = number;
        if (!g->single && (number = next_channel(g, v, number, now)) < 0) return false;
    }
    struct clocked_lane *out = &p->lane[number];
    const bool clear = out->clear <= now, sink = v->head.noption == 0, two = v->head.noption > 1;
    turns_move(g, v, i, in, p, turn);
    /* Flits that somebody may come between, or whose credits are not all back, go as far as that is
     * known. */
    if (!whole && (!clear || !flits_follow(g, v, flits, now))) {
        clocked_pass_on(g, v, in, p, number, now, INT32_MAX);
        return true;
    }
    if (!sink && l->state < 0) clocked_taken(g, v, l, p, number);
    flits_note(g, v, out, p, flits, now, whole);
    v->out += flits;
    v->left = in->passed = p->free = gone;
    in->held -= flits;
    v->front = l->behind;
    if (v->starved) clocked_place_freed(g, v, in, now);
    /* Who stands behind it is the front now, and v is not clear; else v has nothing any more, and
     * nobody upstream has a channel into it. */
    if (l->behind) {
        clocked_front_changes(g, v, in);
        if (two && clocked_waits(v)) *again = now + g->flit;
    } else {
        v->head.state = LANE_IDLE;
        v->clear = clocked_later(v->free, gone + g->credit + in->wire);
        clocked_has_none(o, i);
    }
    out->free = gone + g->pause; /* nobody ever owned it */
    /* Flits take no place in the cycle in which it is left. */
    if (whole) clocked_wake_if(g, o, out->free, asks <= out->free);
    if (!sink) {
        comes(g, out, p, l, clear, now);
        return true;
    }
    out->clear = clocked_later(out->free, g->credit);
    clocked_leg_return(g, l);
    clocked_delivered(g, l->worm, gone - g->flit);
    return true;
}

bool clocked_hop(struct clocked *g, struct clocked_router *o, int i, int32_t asks, int32_t now,
                 int32_t *again)
{
    return g->whole ? hop(g, o, i, asks, now, again, true) : hop(g, o, i, asks, now, again, false);
}

bool clocked_quick(struct clocked *g, struct clocked_lane *v, int32_t now, int32_t *again)
{
    struct clocked_router *o = clocked_router_of(g, v);
    int32_t asks = clocked_next_due(o);
    for (int k = 0; k < g->sets; k++)
        for (uint64_t busy = o->busy[k]; busy; busy &= busy - 1) {
            const struct clocked_lane *w = clocked_lane_of(o, k, busy);
            if (w != v && w->head.state != LANE_SENDING) asks = clocked_sooner(asks, w->due);
        }
    return clocked_hop(g, o, (int)(v - o->lane), asks, now, again);
}
