/* net_clocked_hop.c - a cycle: looks at routers, of which most come to one short step.
 *
 * Most often one lane of a router is due, its head has one way on, the channel whose turn it is is
 * clear, and nobody stands behind it. All that comes of it is worked out here at once; all else is
 * left to net_clocked_pass.c and net_clocked_allocate.c. */
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
    for (int32_t k = 0; k < flits; k++) stay[clocked_place(g, v->out + k)].go = now + k;
    if (v->head.noption == 0) return;
    stay = clocked_ring(g, out);
    const int32_t come = now + g->reach + p->wire;
    for (int32_t k = 0; k < flits; k++) stay[clocked_place(g, k)].come = come + k;
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

/* l comes into lane `out` of p, which is empty and counts anew: it is the front there, and its head
 * asks when it has come. */
static inline void comes_first(struct clocked *g, struct clocked_lane *out, struct clocked_port *p,
                               struct clocked_leg *l, int32_t now)
{
    struct clocked_router *o = &g->router[p->to];
    const int32_t flits = l->flits, due = now + g->due + p->wire;
    out->in = flits;
    out->out = out->nleft = 0;
    out->clear = CLOCKED_NEVER;
    out->front = out->back = l;
    out->due = due;
    p->held += flits;
    l->behind = NULL;
    l->sent = flits;
    l->first = now;
    l->lane = clocked_number(g, out);
    o->busy |= UINT64_C(1) << (out - o->lane);
    clocked_wake(g, p->to, due);
    way_on(g, out, p, l);
}

/* Whether all flits of v's front can follow each other from now on, and nobody can come between:
 * level flit. */
static inline bool flits_follow(const struct clocked *g, const struct clocked_router *o,
                                const struct clocked_lane *v, const struct clocked_port *in,
                                int32_t flits, int32_t now)
{
    if (v->in - v->out < flits || flits > ROUTER_AHEAD || flits > g->buffer) return false;
    /* They come one after the other: the last one says it of all. */
    if (clocked_stay(g, v, v->out + flits - 1)->come > now + flits - 1) return false;
    const bool alone = (o->busy & (o->busy - 1)) == 0;
    return flits == 1 ||
           now + flits <= (alone ? now + g->tau : clocked_undisputed(g, v, in, v->way, now));
}

/* The channel of v's way whose turn it is, if that and the switch are clear; -1: not so. */
static inline int clear_turn(const struct clocked_lane *v, const struct clocked_port *in,
                             const struct clocked_port *p, int32_t now)
{
    const int turn = v->accept - p->lanes_out - v->head.first;
    const int number = v->head.first + (turn >= 0 && turn < v->head.count ? turn : 0);
    return in->passed > now || p->free > now || p->lane[number].clear > now ? -1 : number;
}

/* All turns move on, as clocked_quick moves them: lane i of its router sends over `out`. */
static inline void turns_move(const struct clocked *g, struct clocked_lane *v, int i,
                              struct clocked_port *in, struct clocked_port *p, int number)
{
    clocked_crosses(in, p);
    in->turn = g->after[i];
    clocked_given(v, i, &p->lane[number], p->lanes_out + number);
}

/* Lane i of router o, the only one that is due, others from cycle `next` on: the same as
 * clocked_quick, where nobody stands behind the head or waits for its place. False: it is not so,
 * and nothing has changed. */
CLOCKED_INLINED bool hop(struct clocked *g, struct clocked_router *o, int i, int32_t next,
                         int32_t now, const bool whole)
{
    struct clocked_lane *v = &o->lane[i];
    struct clocked_port *in = &o->port[g->entry[i]], *p = v->way;
    struct clocked_leg *l = v->front;
    const int32_t flits = l->flits, gone = now + flits;
    const int number = clear_turn(v, in, p, now);
    if (number < 0 || l->behind || v->starved) return false;
    if (!whole && !flits_follow(g, o, v, in, flits, now)) return false;
    struct clocked_lane *out = &p->lane[number];
    turns_move(g, v, i, in, p, number);
    flits_note(g, v, out, p, flits, now, whole);
    v->out += flits;
    v->left = in->passed = p->free = gone;
    v->front = NULL;
    v->head.state = LANE_IDLE;
    v->clear = clocked_later(v->free, gone + g->credit + in->wire);
    in->held -= flits;
    o->busy &= ~(UINT64_C(1) << i);
    out->free = gone + g->pause; /* nobody ever owned it */
    /* Others may want the channel. */
    if (next <= out->free) clocked_wake(g, (int)(o - g->router), out->free);
    if (v->head.noption > 0) {
        if (l->state < 0) clocked_taken(g, v, l, p, number);
        comes_first(g, out, p, l, now);
        return true;
    }
    out->clear = clocked_later(out->free, g->credit);
    clocked_leg_return(g, l);
    clocked_delivered(g, l->worm, gone - 1);
    return true;
}

/* ---- looks ---- */

/* The lanes of router o that can do something now into g->active, and how many; *next: when the
 * first of the others can. A head whose way is asked for only where it stands asks here. */
CLOCKED_INLINED int due_find(struct clocked *g, struct clocked_router *o, int32_t now,
                             int32_t *next, const bool whole)
{
    int n = 0;
    for (uint64_t busy = o->busy; busy; busy &= busy - 1) {
        struct clocked_lane *v = &o->lane[__builtin_ctzll(busy)];
        int32_t at = v->due;
        if (v->head.state != LANE_ASKING) {
            if (v->head.state == LANE_SENDING) at = clocked_sends_from(g, v, now, whole);
            else if (at <= now) {
                clocked_route(g, v);
                at = v->due;
            }
        }
        if (at > now) *next = clocked_sooner(*next, at);
        else g->active[n++] = v;
    }
    return n;
}

/* Router o, of which no lane tried before in this cycle. Returns when to look again. */
CLOCKED_INLINED int32_t look_once(struct clocked *g, struct clocked_router *o, int32_t now,
                                  const bool whole)
{
    int32_t next = CLOCKED_NEVER, again;
    const int n = due_find(g, o, now, &next, whole);
    if (n == 0) return next;
    if (n > 1) {
        again = clocked_meet(g, o, n, now);
    } else {
        struct clocked_lane *v = g->active[0];
        if (v->head.state == LANE_ASKING && v->head.noption <= 1 &&
            (hop(g, o, (int)(v - o->lane), next, now, whole) || clocked_quick(g, v, now)))
            return next;
        again = clocked_pass(g, v, now);
    }
    again = clocked_sooner(again, next);
    if (o->tried == now) o->again = again;
    return again;
}

/* If router r is due; `tried`: lanes of it tried before in this cycle. */
CLOCKED_INLINED void look(struct clocked *g, int r, int32_t now, bool tried, const bool whole)
{
    struct clocked_router *o = &g->router[r];
    if (o->wake != now) return; /* an earlier look did it */
    o->wake = CLOCKED_NEVER;
    if (!o->busy) return; /* what was waited for has been served */
    const int32_t again =
        tried || !g->single ? clocked_look_slowly(g, o, now) : look_once(g, o, now, whole);
    if (again != CLOCKED_NEVER) clocked_wake(g, r, again);
}

/* All nodes that are due, by number; those that wake meanwhile, too. */
static inline void look_sources(struct clocked *g, uint64_t *source, int32_t now)
{
    g->sources = false;
    for (int i; (i = clocked_take(source, g->words - g->router_words)) >= 0;)
        clocked_source_look(g, i, now);
}

/* Seldom: kept out of the loop of the cycle. */
static __attribute__((noinline)) void clocked_look_again(struct clocked *g, int r, int32_t now)
{
    look(g, r, now, g->router[r].tried == now, g->whole);
}

/* The sets of a slot are emptied on the way. A router that wakes a node of this cycle is followed
 * by it at once, and one that is woken in it comes after all others. */
CLOCKED_INLINED void cycle(struct clocked *g, uint64_t *router, const bool whole)
{
    const int32_t now = g->now;
    uint64_t *source = router + g->router_words;
    look_sources(g, source, now);
    for (int w = 0; w < g->router_words; w++) {
        uint64_t word = router[w];
        router[w] = 0;
        for (; word; word &= word - 1) {
            look(g, w * CLOCKED_WORD + __builtin_ctzll(word), now, false, whole);
            if (g->sources) look_sources(g, source, now);
        }
    }
    for (int i; (i = clocked_take(g->again, g->router_words)) >= 0;) {
        clocked_look_again(g, i, now);
        if (g->sources) look_sources(g, source, now);
    }
}

/* In the order of net_router_gather.c. */
void clocked_cycle(struct clocked *g, uint64_t *slot)
{
    if (g->whole) cycle(g, slot, true);
    else cycle(g, slot, false);
}
