/* net_clocked_allocate.c - looks at routers in which lanes meet (net_router_allocate.c, in
 * cycles).
 *
 * Two allocators work in the same cycle: one gives channels of outputs to heads, the other one the
 * switch to flits. A head that asks for a channel bids for the switch as well, in the hope of
 * getting the channel: where it does not, its turn at the switch is lost. Both allocators go in
 * rounds of offers and acceptances, by turn; that is iSLIP. */
#include "net/net_clocked_allocate.h"

/* ---- channels ---- */

/* The scratch of a lane. */
static struct clocked_match *match_of(const struct clocked *g, const struct clocked_lane *v)
{
    return &g->match[clocked_number(g, v)];
}

/* The front of `in` asks for channel `out`, of which this allocation knows nothing yet. */
static void ask_add(struct clocked *g, struct clocked_lane *in, struct clocked_lane *out,
                    int priority)
{
    struct clocked_match *m = match_of(g, out);
    clocked_tries(g, clocked_router_of(g, in), in);
    m->match = m->wish = m->fresh = NULL;
    g->ask[g->nask++] = (struct clocked_ask){in, out, priority};
}

/* The front of v asks for those channels of one option that are free: at level packet those with
 * room for all of it. Returns when the next one may be, so that it is looked at then. */
static int32_t ask_option(struct clocked *g, struct clocked_lane *v, struct clocked_way o,
                          int32_t now)
{
    struct clocked_lane *lane = o.port->lane;
    int32_t again = CLOCKED_NEVER;
    for (int i = o.first; i < o.first + o.count; i++) {
        if (lane[i].owned) continue;
        int32_t at = clocked_later(now, lane[i].free);
        if (g->whole && o.port < g->sink)
            at = clocked_later(at, clocked_room(g, &lane[i], o.port, v->front->flits, now, true));
        if (at > now) again = clocked_sooner(again, at);
        else ask_add(g, v, &lane[i], o.priority);
    }
    return again;
}

/* Numbers by which turns go: of a FIFO, of a channel. */
static int number_of(const struct clocked *g, const struct clocked_lane *v, bool input)
{
    const struct clocked_port *p = clocked_port_of(g, v);
    return (input ? p->in : p->out) * (int)g->nchannel + clocked_channel_of(p, v);
}
static int input_of(const struct clocked *g, const struct clocked_lane *v)
{
    return number_of(g, v, true); /* in the order of the router's inputs */
}
static int output_of(const struct clocked *g, const struct clocked_lane *v)
{
    return number_of(g, v, false); /* in the order of its outputs */
}

/* One offer: every channel that nobody has yet, to the FIFO without one whose turn it is. With
 * priorities one that was not taken up stands until a better one replaces it. */
static void channels_offer(struct clocked *g)
{
    for (int i = 0; i < g->nask; i++) {
        struct clocked_match *out = match_of(g, g->ask[i].out);
        out->fresh = NULL;
        if (!g->priority) out->wish = NULL;
    }
    for (int i = 0; i < g->nask; i++) {
        struct clocked_lane *in = g->ask[i].in;
        struct clocked_match *out = match_of(g, g->ask[i].out);
        const int turn = g->ask[i].out->grant;
        if (out->match || match_of(g, in)->match) continue;
        if (!out->fresh ||
            clocked_after(input_of(g, in), turn) < clocked_after(input_of(g, out->fresh), turn))
            out->fresh = in;
        out->wish = out->fresh;
    }
}

/* Every FIFO accepts one of the channels that were offered to it, by priority, then by turn; turns
 * move on in the first round alone. */
static void channels_accept(struct clocked *g, bool turns)
{
    /* Which offer each one accepts; then the turns of both sides move on. */
    for (int i = 0; i < g->nask; i++) match_of(g, g->ask[i].in)->pick = NULL;
    for (int i = 0; i < g->nask; i++) {
        const struct clocked_ask *a = &g->ask[i];
        struct clocked_match *in = match_of(g, a->in);
        const int priority = g->priority ? a->priority : 0, turn = a->in->accept;
        if (match_of(g, a->out)->wish != a->in) continue;
        if (in->pick && priority < in->pick_priority) continue;
        if (!in->pick || priority > in->pick_priority ||
            clocked_after(output_of(g, a->out), turn) <
                clocked_after(output_of(g, in->pick), turn)) {
            in->pick = a->out;
            in->pick_priority = priority;
        }
    }
    for (int i = 0; i < g->nask; i++) {
        struct clocked_lane *in = g->ask[i].in, *out = g->ask[i].out;
        if (match_of(g, in)->pick != out) continue;
        match_of(g, in)->match = out;
        match_of(g, out)->match = in;
        if (turns) clocked_given(in, input_of(g, in), out, output_of(g, out));
    }
}

/* All rounds: a later one serves who got nothing in those before. */
static void channels_allocate(struct clocked *g)
{
    for (int i = 0; i < g->iterations && g->nask > 0; i++) {
        channels_offer(g);
        channels_accept(g, i == 0);
    }
}

/* ---- the switch ---- */

/* The scratch of a port. */
static struct clocked_side *side_of(const struct clocked *g, const struct clocked_port *p)
{
    return &g->side[p - g->port];
}

/* One bid for each input and output: of several FIFOs of an input those that have their channel
 * before those that hope for it, then by turn. False: two met, and one will have to come back. */
static bool bid_add(struct clocked *g, struct clocked_lane *v, struct clocked_port *out, bool spec)
{
    struct clocked_port *in = clocked_port_of(g, v);
    const int n = (int)g->nchannel, turn = in->turn;
    clocked_tries(g, clocked_router_of(g, v), v);
    for (int i = 0; i < g->nbid; i++) {
        struct clocked_bid *b = &g->bid[i];
        if (b->in != in || b->out != out) continue;
        /* The same input and output: a channel before a hope, then the nearer turn. */
        const int mine = (clocked_channel_of(in, v) + n - turn) % n,
                  its = (clocked_channel_of(in, b->lane) + n - turn) % n;
        if (spec != b->spec ? !spec : mine < its) *b = (struct clocked_bid){v, in, out, spec};
        return false;
    }
    side_of(g, in)->match = side_of(g, out)->match = NULL;
    g->bid[g->nbid++] = (struct clocked_bid){v, in, out, spec};
    return true;
}

/* Whether one of the channels of an option is free and has a credit. */
static bool eligible(struct clocked *g, const struct clocked_lane *v, struct clocked_way o,
                     int32_t now)
{
    struct clocked_lane *lane = o.port->lane;
    const int32_t unit = g->whole ? v->front->flits : 1;
    for (int i = o.first; i < o.first + o.count; i++)
        if (!lane[i].owned && lane[i].free <= now &&
            (o.port >= g->sink || clocked_room(g, &lane[i], o.port, unit, now, g->whole) <= now))
            return true;
    return false;
}

/* A head that asks bids for the ports on which it may well get a channel, of the highest priority
 * of its eligible options, or for all of them (strict). Returns when to try again. */
static int32_t bid_asking(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    bool may[CLOCKED_OPTIONS];
    int32_t again = CLOCKED_NEVER;
    int best = -1;
    struct clocked_match *m = match_of(g, v);
    m->bars = false;
    for (int i = 0; i == 0 || i < v->head.noption; i++) {
        const struct clocked_way o = clocked_option(g, v, i);
        may[i] = eligible(g, v, o, now);
        if (may[i] && o.priority > best) best = o.priority;
        if (!may[i] && o.port < g->sink && g->strict) m->bars = true;
    }
    for (int i = 0; i == 0 || i < v->head.noption; i++) {
        const struct clocked_way o = clocked_option(g, v, i);
        if ((!g->strict && o.priority != best) || !may[i]) continue;
        int32_t at = clocked_later(clocked_port_of(g, v)->passed, o.port->free);
        if (at <= now && !bid_add(g, v, o.port, true)) at = now + g->flit;
        if (at > now) again = clocked_sooner(again, at);
    }
    return again;
}

/* Every output that has none yet offers itself to the input whose turn it is, of those that bid for
 * it. */
static void switch_offer(struct clocked *g)
{
    /* Only who has nothing yet takes part. */
    for (int i = 0; i < g->nbid; i++) side_of(g, g->bid[i].out)->wish = NULL;
    for (int i = 0; i < g->nbid; i++) {
        const struct clocked_port *in = g->bid[i].in, *out = g->bid[i].out;
        struct clocked_side *o = side_of(g, out);
        if (o->match || side_of(g, in)->match) continue;
        if (!o->wish || clocked_after(in->in, out->grant) < clocked_after(o->wish->in, out->grant))
            o->wish = in;
    }
}

/* Every input accepts one of the outputs that were offered to it, by turn. As with channels, turns
 * move on in the first round alone: only then is nobody passed over for ever. */
static void switch_accept(struct clocked *g, bool turns)
{
    for (int i = 0; i < g->nbid; i++) side_of(g, g->bid[i].in)->pick = NULL;
    for (int i = 0; i < g->nbid; i++) {
        const struct clocked_port *in = g->bid[i].in, *out = g->bid[i].out;
        struct clocked_side *s = side_of(g, in);
        if (side_of(g, out)->wish != in || s->match) continue;
        if (!s->pick ||
            clocked_after(out->out, in->accept) < clocked_after(s->pick->out, in->accept))
            s->pick = out;
    }
    for (int i = 0; i < g->nbid; i++) {
        struct clocked_port *in = g->bid[i].in, *out = g->bid[i].out;
        struct clocked_side *s = side_of(g, in);
        if (s->pick != out || s->match) continue;
        s->match = out;
        side_of(g, out)->match = in;
        if (turns) clocked_crosses(in, out);
    }
}

/* All rounds. */
static void switch_allocate(struct clocked *g)
{
    for (int i = 0; i < g->iterations && g->nbid > 0; i++) {
        switch_offer(g);
        switch_accept(g, i == 0);
    }
}

/* ---- a look ---- */

/* Requests of the n lanes that can do something now: one that has its channel bids for the switch,
 * a head that has none asks for channels, too. Returns when some of them look again. */
static int32_t requests(struct clocked *g, struct clocked_lane *const *lane, int n, int32_t now)
{
    int32_t again = CLOCKED_NEVER;
    for (int k = 0; k < n; k++) {
        struct clocked_lane *v = lane[k];
        if (v->head.state == LANE_SENDING) {
            struct clocked_port *out = clocked_port_of(g, &g->lane[v->front->ahead->lane]);
            if (!bid_add(g, v, out, false)) again = clocked_sooner(again, now + g->flit);
            continue;
        }
        /* A head asks for channels on all its ways. */
        match_of(g, v)->match = NULL;
        for (int i = 0; i == 0 || i < v->head.noption; i++)
            again = clocked_sooner(again, ask_option(g, v, clocked_option(g, v, i), now));
        again = clocked_sooner(again, bid_asking(g, v, now));
    }
    return again;
}

/* Who has got a channel owns it from now on. */
static void channels_take(struct clocked *g)
{
    for (int i = 0; i < g->nask; i++) {
        struct clocked_lane *in = g->ask[i].in, *out = match_of(g, in)->match;
        if (in->head.state == LANE_ASKING && out == g->ask[i].out) clocked_own(g, in, out);
    }
}

/* A winner of the switch sends, unless it bid for a channel that it has not got here, or that has
 * no room. Returns whether it did. */
static bool winner_sends(struct clocked *g, const struct clocked_bid *b, int32_t now)
{
    struct clocked_lane *v = b->lane;
    if (b->spec && match_of(g, v)->bars) return false;
    b->in->turn = clocked_next_channel(g, clocked_channel_of(b->in, v));
    if (v->head.state != LANE_SENDING) return false;
    struct clocked_lane *to = &g->lane[v->front->ahead->lane];
    if (clocked_port_of(g, to) != b->out) return false;
    const int32_t unit = g->whole ? v->front->flits : 1;
    if (b->out < g->sink && clocked_room(g, to, b->out, unit, now, g->whole) > now) return false;
    clocked_send(g, v, now, INT32_MAX);
    return true;
}

/* Channels to heads, the switch to flits, for n lanes `lane` that may be in each other's way.
 * Returns when to look again. */
static int32_t allocate_together(struct clocked *g, struct clocked_lane *const *lane, int n,
                                 int32_t now)
{
    g->nask = g->nbid = 0;
    int32_t again = requests(g, lane, n, now);
    channels_allocate(g);
    switch_allocate(g);
    channels_take(g);
    /* Who lost, and heads that have a channel and no turn yet, try again in the next cycle. */
    for (int i = 0; i < g->nbid; i++) {
        const struct clocked_bid *b = &g->bid[i];
        const bool won = side_of(g, b->in)->match == b->out && side_of(g, b->out)->match == b->in;
        if (won && winner_sends(g, b, now)) continue;
        again = clocked_sooner(again, now + g->flit);
    }
    /* Of a lane that has sent, the next head waits, too, but did not ask: it has a look coming. */
    for (int i = 0; i < g->nask; i++) {
        const struct clocked_lane *in = g->ask[i].in;
        if (in->due <= now && clocked_waits(in)) again = clocked_sooner(again, now + g->flit);
    }
    return again;
}

/* The lanes of router o that can do something now into g->active, but for those that tried within
 * the last flit: how many. Of the others: *again, when the first of them can. A head whose way is
 * asked for only where it stands asks here. */
static int active_find(struct clocked *g, struct clocked_router *o, int32_t now, int32_t *again)
{
    int n = 0;
    *again = clocked_have_come(o, now);
    for (int k = 0; k < g->sets; k++)
        for (uint64_t busy = o->busy[k]; busy; busy &= busy - 1) {
            struct clocked_lane *v = clocked_lane_of(o, k, busy);
            if (v->head.state == LANE_ROUTING && v->due <= now) clocked_route(g, v);
            int32_t at =
                v->head.state == LANE_SENDING ? clocked_sends_from(g, v, now, g->whole) : v->due;
            at = clocked_later(at, g->retry[clocked_number(g, v)]);
            if (at > now) *again = clocked_sooner(*again, at);
            else g->active[n++] = v;
        }
    return n;
}

int32_t clocked_alone(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    if (v->head.state != LANE_ASKING || g->single) return clocked_pass(g, v, now);
    return allocate_together(g, &v, 1, now);
}

/* v alone: it shares no port with others that can do something now, so that it cannot meet them,
 * whatever the order. */
static int32_t look_alone(struct clocked *g, struct clocked_lane *v, int32_t now)
{
    int32_t again = CLOCKED_NEVER;
    if (v->head.state != LANE_ASKING || !clocked_quick(g, v, now, &again))
        return clocked_alone(g, v, now);
    return again;
}

/* Inputs and outputs of several lanes; heads that have several ways or ask at the same output. */
struct crowd {
    uint64_t in, out, in_twice, out_twice, asked;
    bool mixed;
};

/* The same of two lanes. */
static int32_t meet_two(struct clocked *g, struct clocked_router *o, int32_t now)
{
    struct clocked_lane *v = g->active[0], *w = g->active[1];
    const uint64_t out = clocked_ways(v) & clocked_ways(w);
    if (!out && g->entry[v - o->lane] != g->entry[w - o->lane]) {
        const int32_t again = look_alone(g, v, now);
        return clocked_sooner(again, look_alone(g, w, now));
    }
    /* Heads with several ways, or that want channels of one port, need all rounds; and all heads
     * where a channel that a lone one is given in the first round does not stay its own (single).
     */
    const bool asks = v->head.state != LANE_SENDING, also = w->head.state != LANE_SENDING,
               mixed = (asks && v->head.noption > 1) || (also && w->head.noption > 1) ||
                       (asks && also && out) || (!g->single && (asks || also));
    return mixed ? allocate_together(g, g->active, 2, now) : clocked_few(g, o, 2, now);
}

int32_t clocked_meet(struct clocked *g, struct clocked_router *o, int n, int32_t now)
{
    struct crowd c = {0};
    int32_t again = CLOCKED_NEVER;
    int m = 0;
    if (n == 2) return meet_two(g, o, now);
    for (int k = 0; k < n; k++) {
        const struct clocked_lane *v = g->active[k];
        const uint64_t in = UINT64_C(1) << g->entry[v - o->lane], out = clocked_ways(v);
        c.in_twice |= c.in & in;
        c.out_twice |= c.out & out;
        c.in |= in;
        c.out |= out;
    }
    for (int k = 0; k < n; k++) {
        struct clocked_lane *v = g->active[k];
        const uint64_t out = clocked_ways(v);
        if (!(c.in_twice >> g->entry[v - o->lane] & 1) && !(c.out_twice & out)) {
            again = clocked_sooner(again, look_alone(g, v, now));
            continue;
        }
        g->active[m++] = v;
        if (v->head.state == LANE_SENDING) continue;
        c.mixed |= !g->single || v->head.noption > 1 || (c.asked & out);
        c.asked |= out;
    }
    if (m == 0) return again;
    const int32_t few = c.mixed ? -1 : clocked_few(g, o, m, now);
    return clocked_sooner(again, few >= 0 ? few : allocate_together(g, g->active, m, now));
}

int32_t clocked_look_slowly(struct clocked *g, struct clocked_router *o, int32_t now)
{
    int32_t again;
    const int n = active_find(g, o, now, &again);
    return n > 0 ? clocked_sooner(again, clocked_meet(g, o, n, now)) : again;
}
