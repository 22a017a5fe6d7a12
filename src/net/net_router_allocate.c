/* net_router_allocate.c - one look at a router: channels to heads that ask, and the switch to
 * flits.
 *
 * Both are iSLIP (McKeown 1999), as in BookSim's input-queued router: every output offers itself to
 * the input whose turn it is, every input accepts the offer whose turn it is, and turns move on
 * only after the first iteration. BookSim's router makes one iteration, whatever its option
 * alloc_iters says. A head bids for the switch in the same instant in which it asks for a channel,
 * and its turn is wasted if it gets none (speculation). */
#include "net/net_router_front.h"

/* A FIFO's request for a channel, and its bid for the way through the switch. */
struct ask {
    struct lane *in, *out;
    int priority;
};
struct bid {
    struct lane *lane;
    struct port *in, *out;
    bool spec; /* its channel is still being asked for */
};

/* ---- channels ---- */

static void ask_add(struct routers *g, struct lane *in, struct lane *out, int priority)
{
    if (g->nask == g->ask_room) {
        struct ask *more = TAKE(g->fabric.net->arena,
                                size_sum(size_product((size_t)g->ask_room, 2), 64), struct ask);
        for (int i = 0; i < g->nask; i++) more[i] = g->ask[i];
        g->ask = more;
        g->ask_room = 2 * g->ask_room + 64;
    }
    router_tries(g, in);
    out->match = out->wish = out->fresh = NULL;
    g->ask[g->nask++] = (struct ask){in, out, priority};
}

/* The channels of one option that are free; whole packets also need room. Returns when it may be
 * worth asking again for one that is not. */
static sim_ps ask_option(struct routers *g, struct lane *v, const struct route_option *o,
                         sim_ps now)
{
    const int p = router_out(g, v, o);
    struct lane *lane = router_lanes(g, p);
    int first;
    const int count = router_channels(v, o, &first);
    sim_ps again = SIM_NEVER;
    for (int i = first; i < first + count; i++) {
        if (lane[i].owner) continue;
        sim_ps at = router_later(now, lane[i].free);
        if (o && !router_may_hold(g, &lane[i], v->front->worm)) continue;
        if (g->whole && o)
            at = router_later(at, router_room(g, &lane[i], v->front->worm->flits, now));
        if (at > now) again = router_sooner(again, at);
        else ask_add(g, v, &lane[i], o ? o->priority : 0);
    }
    return again;
}

/* One offer: every channel that nobody has yet, to the FIFO without one whose turn it is. With
 * priorities an offer that was not taken up stands until a better one replaces it, as in BookSim's
 * allocator of that name. */
static void channels_offer(struct routers *g)
{
    for (int i = 0; i < g->nask; i++) {
        struct ask *a = &g->ask[i];
        a->out->fresh = NULL;
        if (!g->priority) a->out->wish = NULL;
    }
    for (int i = 0; i < g->nask; i++) {
        struct lane *in = g->ask[i].in, *out = g->ask[i].out;
        if (out->match || in->match) continue;
        if (!out->fresh ||
            router_after(in->input, out->grant) < router_after(out->fresh->input, out->grant))
            out->fresh = in;
        out->wish = out->fresh;
    }
}

/* Every FIFO accepts one of the channels that were offered to it. */
static void channels_accept(struct routers *g, bool turns)
{
    for (int i = 0; i < g->nask; i++) g->ask[i].in->pick = NULL;
    for (int i = 0; i < g->nask; i++) {
        struct ask *a = &g->ask[i];
        struct lane *in = a->in, *out = a->out;
        const int priority = g->priority ? a->priority : 0;
        if (out->wish != in) continue;
        if (in->pick && priority < in->pick_priority) continue;
        if (!in->pick || priority > in->pick_priority ||
            router_after(out->output, in->accept) < router_after(in->pick->output, in->accept)) {
            in->pick = out;
            in->pick_priority = priority;
        }
    }
    for (int i = 0; i < g->nask; i++) {
        struct lane *in = g->ask[i].in, *out = g->ask[i].out;
        if (in->pick != out) continue;
        in->match = out;
        out->match = in;
        if (turns) router_channel_given(in, out);
    }
}

static void channels_allocate(struct routers *g)
{
    for (int i = 0; i < g->iterations && g->nask > 0; i++) {
        channels_offer(g);
        channels_accept(g, i == 0);
    }
}

/* ---- the switch ---- */

/* One bid for each input and output: of several FIFOs of an input, those that have their channel
 * before those that only hope for it, then the one whose turn it is. Returns false where two met:
 * one of them will have to come back. */
static bool bid_add(struct routers *g, struct lane *v, struct port *out, bool spec)
{
    struct port *in = &g->port[v->port];
    const uint32_t n = (uint32_t)g->fabric.nchannel;
    router_tries(g, v);
    for (int i = 0; i < g->nbid; i++) {
        struct bid *b = &g->bid[i];
        if (b->in != in || b->out != out) continue;
        const uint32_t turn = (uint32_t)in->turn, mine = ((uint32_t)v->channel + n - turn) % n,
                       its = ((uint32_t)b->lane->channel + n - turn) % n;
        if (spec != b->spec ? !spec : mine < its) *b = (struct bid){v, in, out, spec};
        return false;
    }
    if (g->nbid == g->bid_room) {
        struct bid *more = TAKE(g->fabric.net->arena,
                                size_sum(size_product((size_t)g->bid_room, 2), 64), struct bid);
        for (int i = 0; i < g->nbid; i++) more[i] = g->bid[i];
        g->bid = more;
        g->bid_room = 2 * g->bid_room + 64;
    }
    in->match = out->match = NULL;
    g->bid[g->nbid++] = (struct bid){v, in, out, spec};
    return true;
}

/* When the way through the switch is free at both ends. */
static inline sim_ps switch_free(const struct lane *v, const struct port *out)
{
    return router_later(v->of->passed, out->free);
}

/* From when on a FIFO that has its channel has a flit, a credit, and a free way. */
static sim_ps sends_from(struct routers *g, struct lane *v, sim_ps now)
{
    if (v->out >= v->in) return SIM_NEVER;
    const struct leg *to = v->front->ahead;
    const struct port *p = &g->port[to->port];
    const sim_ps at = router_later(v->stay[v->out & g->ring].come, switch_free(v, p));
    if (to->port >= g->sink) return at;
    return router_later(at, router_room(g, &p->lane[to->channel], router_unit(g, to->worm), now));
}

/* Then it bids; SIM_NEVER unless it will have to come back. */
static sim_ps bid_sending(struct routers *g, struct lane *v, sim_ps now)
{
    struct port *out = &g->port[v->front->ahead->port];
    return bid_add(g, v, out, false) ? SIM_NEVER : ps_later(now, out->flit);
}

/* Whether one of the channels of an option is free and has a credit. */
static bool eligible(struct routers *g, const struct lane *v, const struct route_option *o,
                     sim_ps now)
{
    struct lane *lane = router_lanes(g, router_out(g, v, o));
    int first;
    const int count = router_channels(v, o, &first);
    const int32_t unit = router_unit(g, v->front->worm);
    for (int i = first; i < first + count; i++)
        if (!lane[i].owner && lane[i].free <= now &&
            (!o || router_room(g, &lane[i], unit, now) <= now))
            return true;
    return false;
}

/* A head that asks bids for the ports on which it may well get a channel: those of the highest
 * priority of its eligible options. BookSim's bids for all that are eligible, but where one is not,
 * the router throws its turn away, if it gets one. Returns when to try again, if the switch is not
 * free. */
static sim_ps bid_asking(struct routers *g, struct lane *v, sim_ps now)
{
    bool may[ROUTING_MOST_OPTIONS];
    sim_ps again = SIM_NEVER;
    int best = -1;
    v->bars = false;
    for (int i = 0; i == 0 || i < v->noption; i++) {
        const struct route_option *o = v->noption > 0 ? &v->option[i] : NULL;
        may[i] = eligible(g, v, o, now);
        if (may[i] && o && o->priority > best) best = o->priority;
        if (!may[i] && o && g->strict) v->bars = true;
    }
    for (int i = 0; i == 0 || i < v->noption; i++) {
        const struct route_option *o = v->noption > 0 ? &v->option[i] : NULL;
        if ((o && !g->strict && o->priority != best) || !may[i]) continue;
        struct port *p = &g->port[router_out(g, v, o)];
        sim_ps at = switch_free(v, p);
        if (at <= now && !bid_add(g, v, p, true)) at = ps_later(now, p->flit);
        if (at > now) again = router_sooner(again, at);
    }
    return again;
}

static void switch_offer(struct routers *g)
{
    for (int i = 0; i < g->nbid; i++) g->bid[i].out->wish = NULL;
    for (int i = 0; i < g->nbid; i++) {
        struct port *in = g->bid[i].in, *out = g->bid[i].out;
        if (out->match || in->match) continue;
        if (!out->wish ||
            router_after(in->in, out->grant) < router_after(out->wish->in, out->grant))
            out->wish = in;
    }
}

/* An output's `match` is the input that has it. An input that has one is marked by itself, since a
 * port may be an input of one router and an output of another but not of the same instant's look.
 */
static void switch_accept(struct routers *g, bool turns)
{
    for (int i = 0; i < g->nbid; i++) g->bid[i].in->pick = NULL;
    for (int i = 0; i < g->nbid; i++) {
        struct port *in = g->bid[i].in, *out = g->bid[i].out;
        if (out->wish != in || in->match) continue;
        if (!in->pick ||
            router_after(out->out, in->accept) < router_after(in->pick->out, in->accept))
            in->pick = out;
    }
    for (int i = 0; i < g->nbid; i++) {
        struct port *in = g->bid[i].in, *out = g->bid[i].out;
        if (in->pick != out || in->match) continue;
        in->match = out;
        out->match = in;
        if (turns) router_crosses(in, out);
    }
}

static void switch_allocate(struct routers *g)
{
    for (int i = 0; i < g->iterations && g->nbid > 0; i++) {
        switch_offer(g);
        switch_accept(g, i == 0);
    }
}

/* ---- a look ---- */

/* Requests of the lanes that can do something now. */
static sim_ps requests(struct routers *g, struct lane *const *active, int n, sim_ps now)
{
    sim_ps again = SIM_NEVER;
    for (int k = 0; k < n; k++) {
        struct lane *v = active[k];
        if (v->state == LANE_SENDING) {
            again = router_sooner(again, bid_sending(g, v, now));
            continue;
        }
        v->match = NULL;
        for (int i = 0; i == 0 || i < v->noption; i++) {
            const struct route_option *o = v->noption > 0 ? &v->option[i] : NULL;
            again = router_sooner(again, ask_option(g, v, o, now));
        }
        again = router_sooner(again, bid_asking(g, v, now));
    }
    return again;
}

/* Who has got a channel owns it from now on. */
static void channels_take(struct routers *g)
{
    for (int i = 0; i < g->nask; i++) {
        struct lane *in = g->ask[i].in;
        if (in->state != LANE_ASKING || in->match != g->ask[i].out) continue;
        router_own(g, in, in->match);
    }
}

/* A winner of the switch sends, unless it bid for a channel that it has not got here. Returns
 * whether it did. */
static bool winner_sends(struct routers *g, const struct bid *b, sim_ps now)
{
    struct lane *v = b->lane;
    if (b->spec && v->bars) return false;
    b->in->turn = router_next_channel(g, v);
    if (v->state != LANE_SENDING) return false;
    const struct leg *to = v->front->ahead;
    if (&g->port[to->port] != b->out) return false;
    struct lane *out = &b->out->lane[to->channel];
    if (!net_is_ejection(g->fabric.net, to->port) &&
        router_room(g, out, router_unit(g, to->worm), now) > now)
        return false;
    router_send(g, v, now);
    return true;
}

/* ---- a look ---- */

/* v is one more beside the first n of g->active, which are in the order of the router's FIFOs: who
 * goes first counts now and then. */
static inline void active_add(struct routers *g, int n, struct lane *v)
{
    for (; n > 0 && g->active[n - 1]->input > v->input; n--) g->active[n] = g->active[n - 1];
    g->active[n] = v;
}

/* The lanes of router r that can do something now into g->active; returns how many. *again: when
 * others may. Loads are looked at by all of an instant together, before anything moves. */
static int active_find(struct routers *g, int r, sim_ps now, sim_ps *again)
{
    int n = 0;
    for (struct lane *v = g->router[r].busy; v; v = v->busy) {
        if (v->state == LANE_ROUTING && v->due <= now) router_route(g, v);
        const sim_ps at = v->state == LANE_SENDING ? sends_from(g, v, now) : v->due;
        if (at > now || v->retry > now) *again = router_sooner(*again, router_later(at, v->retry));
        else active_add(g, n++, v);
    }
    return n;
}

/* Those whose time has come, whether they can do something or not; -1: there are loads to be looked
 * at. */
static int due_find(struct routers *g, int r, sim_ps now)
{
    int n = 0;
    for (struct lane *v = g->router[r].busy; v; v = v->busy) {
        if (v->due > now) continue;
        if (v->state == LANE_ROUTING) return -1;
        g->active[n++] = v;
    }
    return n;
}

enum { MOST_APART = 6 };

/* Whether none of the first n of g->active is in another's way: no two have an input or an output
 * in common, and a channel that a lone head is given stays its own. */
static bool are_apart(const struct routers *g, int n)
{
    uint64_t in = 0, out = 0;
    if (n > MOST_APART) return false;
    for (int k = 0; k < n; k++) {
        const struct lane *v = g->active[k];
        const uint64_t entry = router_bit(v->of->in);
        if (v->state == LANE_ASKING && !(g->single && (v->noption <= 1 || g->gather))) return false;
        if ((in & entry) || (out & v->ways)) return false;
        in |= entry;
        out |= v->ways;
    }
    return n >= 0;
}

/* Channels to heads, the switch to flits. */
static sim_ps allocate_together(struct routers *g, int n, sim_ps now)
{
    g->nask = g->nbid = 0;
    sim_ps again = requests(g, g->active, n, now);
    channels_allocate(g);
    switch_allocate(g);
    channels_take(g);
    /* Who lost, and heads that have a channel and no turn yet, try again a flit later. */
    for (int i = 0; i < g->nbid; i++) {
        const struct bid *b = &g->bid[i];
        const bool won = b->in->match == b->out && b->out->match == b->in;
        if (won && winner_sends(g, b, now)) continue;
        again = router_sooner(again, ps_later(now, b->out->flit));
    }
    /* Of a lane that has sent, the next head waits, too, but did not ask: it has a look coming. */
    for (int i = 0; i < g->nask; i++) {
        const struct lane *in = g->ask[i].in;
        if (in->due <= now && router_waits(in))
            again = router_sooner(again, ps_later(now, g->port[g->ask[i].out->port].flit));
    }
    return again;
}

/* v, which is in nobody's way, goes if its own is clear. */
static inline bool passes_quickly(struct routers *g, struct lane *v, sim_ps now)
{
    return g->quick && v->state == LANE_ASKING && v->noption <= 1 && router_quick(g, v, now);
}

/* The only lane of a router whose front has come. */
static sim_ps look_single(struct routers *g, struct lane *v, sim_ps now)
{
    if (v->state == LANE_ROUTING && v->due <= now) router_route(g, v);
    const sim_ps at = v->state == LANE_SENDING ? sends_from(g, v, now) : v->due;
    if (at > now || v->retry > now) return router_later(at, v->retry);
    if (passes_quickly(g, v, now)) return SIM_NEVER;
    if (v->state != LANE_ASKING || g->single) return router_pass(g, v, now);
    g->active[0] = v;
    return allocate_together(g, 1, now);
}

static sim_ps look_several(struct routers *g, int r, sim_ps now)
{
    sim_ps again = SIM_NEVER;
    /* Events of its own come in the order in which they are asked for: as ever. */
    const bool meet = !g->gather && !are_apart(g, due_find(g, r, now));
    const int n = active_find(g, r, now, &again);
    if (meet || !are_apart(g, n)) return router_sooner(again, allocate_together(g, n, now));
    /* Lanes that share no port cannot meet, whatever the order: no lists, no rounds. */
    for (int k = 0; k < n; k++)
        if (!passes_quickly(g, g->active[k], now))
            again = router_sooner(again, router_pass(g, g->active[k], now));
    return again;
}

/* Most often one lane is due, whose head has a clear way. Returns whether that was so, or nothing
 * is due; *again: when others are. */
static inline bool look_quickly(struct routers *g, struct lane *busy, sim_ps now, sim_ps *again)
{
    struct lane *due = NULL;
    for (struct lane *v = busy; v; v = v->busy) {
        if (v->state == LANE_ROUTING && v->due <= now) router_route(g, v);
        /* Whether a flit can go is asked with care, and of heads that come together or have several
         * ways on, too. */
        if (v->state == LANE_SENDING) return false;
        if (v->due > now) {
            *again = router_sooner(*again, v->due);
            continue;
        }
        if (due || v->noption > 1) return false;
        due = v;
    }
    return !due || router_quick(g, due, now);
}

/* All else: apart, so that the quick look needs few registers. */
static __attribute__((noinline)) sim_ps look_slowly(struct routers *g, int r, sim_ps now)
{
    struct lane *v = g->router[r].busy;
    return g->gather && !v->busy ? look_single(g, v, now) : look_several(g, r, now);
}

void router_look_at(struct routers *g, int r, bool second, sim_ps now)
{
    struct router *o = &g->router[r];
    sim_ps again = SIM_NEVER;
    if (o->wake != now + 1) return; /* an earlier look did it */
    if (o->second && !second) return;
    o->wake = 0;
    g->now = now;
    const sim_ps next = router_has_come(o, now);
    if (o->busy && (o->retry > now || !g->quick || !look_quickly(g, o->busy, now, &again)))
        again = look_slowly(g, r, now);
    again = router_sooner(again, next);
    if (again != SIM_NEVER) router_wake(g, r, again);
}

void router_look(void *subject, uint64_t argument, sim_ps now)
{
    struct routers *g = subject;
    const uint64_t nrouter = (uint64_t)g->fabric.net->topology->nrouter;
    const bool second = argument >= nrouter;
    const int r = (int)(second ? argument - nrouter : argument);
    struct router *o = &g->router[r];
    for (int i = 0; i < ROUTER_POSTED && !second; i++)
        if (o->posted[i] == now + 1) o->posted[i] = 0;
    router_look_at(g, r, second, now);
}
