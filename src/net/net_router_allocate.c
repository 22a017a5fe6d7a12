/* net_router_allocate.c - one look at a router: channels to heads that ask, and the switch to
 * flits.
 *
 * Both are iSLIP (McKeown 1999), as in BookSim's input-queued router: every output offers itself to
 * the input whose turn it is, every input accepts the offer whose turn it is, and turns move on
 * only after the first iteration. BookSim's router makes one iteration, whatever its option
 * alloc_iters says. A head bids for the switch in the same instant in which it asks for a channel,
 * and its turn is wasted if it gets none (speculation). */
#include "net/net_router_lane.h"

/* The place of a number after `turn`, in unsigned arithmetic that wraps. */
static inline uint32_t after(uint32_t number, uint32_t turn) { return number - turn; }

static inline uint32_t input_number(const struct routers *g, const struct lane *v)
{
    return g->port[v->port].in * (uint32_t)g->fabric.nchannel + (uint32_t)v->channel;
}

static inline uint32_t output_number(const struct routers *g, const struct lane *v)
{
    return g->port[v->port].out * (uint32_t)g->fabric.nchannel + (uint32_t)v->channel;
}

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
    out->match = out->wish = out->fresh = NULL;
    g->ask[g->nask++] = (struct ask){in, out, priority};
}

/* A worm that spreads over two channels and is not the first in the second cannot turn to the
 * escape channels, so that those above them are given to packets that fit (Ma, Enright Jerger and
 * Wang 2012), or when empty. */
static bool may_hold(const struct routers *g, const struct lane *v, const struct worm *w)
{
    if (!g->routing->fits || v->channel < g->routing->escape || v->in == v->out) return true;
    return g->fabric.buffer - (v->in - v->out) >= w->flits;
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
        if (o && !may_hold(g, &lane[i], v->front->worm)) continue;
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
            after(input_number(g, in), out->grant) < after(input_number(g, out->fresh), out->grant))
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
            after(output_number(g, out), in->accept) <
                after(output_number(g, in->pick), in->accept)) {
            in->pick = out;
            in->pick_priority = priority;
        }
    }
    for (int i = 0; i < g->nask; i++) {
        struct lane *in = g->ask[i].in, *out = g->ask[i].out;
        if (in->pick != out) continue;
        in->match = out;
        out->match = in;
        if (!turns) continue;
        out->grant = input_number(g, in) + 1;
        in->accept = output_number(g, out) + 1;
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
static sim_ps switch_free(const struct routers *g, const struct lane *v, int out)
{
    return router_later(g->port[v->port].passed, g->fabric.resource[out].free);
}

/* From when on a FIFO that has its channel has a flit, a credit, and a free way. */
static sim_ps sends_from(struct routers *g, struct lane *v, sim_ps now)
{
    const struct leg *to = v->front->ahead;
    if (v->out >= v->in) return SIM_NEVER;
    const sim_ps at = router_later(v->come[v->out & g->ring], switch_free(g, v, to->port));
    struct lane *out = &g->port[to->port].lane[to->channel];
    if (net_is_ejection(g->fabric.net, to->port)) return at;
    return router_later(at, router_room(g, out, router_unit(g, to->worm), now));
}

/* Then it bids. */
static sim_ps bid_sending(struct routers *g, struct lane *v, sim_ps now)
{
    const struct leg *to = v->front->ahead;
    const sim_ps at = sends_from(g, v, now);
    if (at <= now && !bid_add(g, v, &g->port[to->port], false))
        return ps_later(now, g->port[to->port].flit);
    return at;
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
    sim_ps again = SIM_NEVER;
    int best = -1;
    v->bars = false;
    for (int i = 0; i < v->noption; i++) {
        const bool may = eligible(g, v, &v->option[i], now);
        if (may && v->option[i].priority > best) best = v->option[i].priority;
        if (!may && g->strict) v->bars = true;
    }
    for (int i = 0; i == 0 || i < v->noption; i++) {
        const struct route_option *o = v->noption > 0 ? &v->option[i] : NULL;
        if ((o && !g->strict && o->priority != best) || !eligible(g, v, o, now)) continue;
        const int p = router_out(g, v, o);
        sim_ps at = switch_free(g, v, p);
        if (at <= now && !bid_add(g, v, &g->port[p], true)) at = ps_later(now, g->port[p].flit);
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
        if (!out->wish || after(in->in, out->grant) < after(out->wish->in, out->grant))
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
        if (!in->pick || after(out->out, in->accept) < after(in->pick->out, in->accept))
            in->pick = out;
    }
    for (int i = 0; i < g->nbid; i++) {
        struct port *in = g->bid[i].in, *out = g->bid[i].out;
        if (in->pick != out || in->match) continue;
        in->match = out;
        out->match = in;
        if (!turns) continue;
        out->grant = in->in + 1;
        in->accept = out->out + 1;
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

/* Requests of all FIFOs that have a front. */
static sim_ps requests(struct routers *g, int r, sim_ps now)
{
    sim_ps again = SIM_NEVER;
    for (struct lane *v = g->router[r].busy; v; v = v->busy) {
        if (v->state == LANE_ROUTING && v->due <= now) router_route(g, v);
        if (v->state == LANE_SENDING) {
            const sim_ps at = bid_sending(g, v, now);
            if (at > now) again = router_sooner(again, at);
            continue;
        }
        v->match = NULL;
        if (v->due > now) {
            again = router_sooner(again, v->due);
            continue;
        }
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
    b->in->turn = (v->channel + 1) % g->fabric.nchannel;
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

/* Whether the front of v still has to send its head. */
static bool waits(const struct lane *v)
{
    return v->state == LANE_ASKING || (v->state == LANE_SENDING && v->front->ahead->sent == 0);
}

/* ---- a lane that is alone ---- */

/* The one that a head without rivals gets of the channels of its only way: the one whose turn it
 * is. *again: when to ask for others. */
static struct lane *channel_alone(struct routers *g, struct lane *v, const struct route_option *o,
                                  sim_ps now, sim_ps *again)
{
    struct lane *lane = router_lanes(g, router_out(g, v, o)), *best = NULL;
    int first;
    const int count = router_channels(v, o, &first);
    for (int i = first; i < first + count; i++) {
        struct lane *out = &lane[i];
        if (out->owner || (o && !may_hold(g, out, v->front->worm))) continue;
        sim_ps at = router_later(now, out->free);
        if (g->whole && o) at = router_later(at, router_room(g, out, v->front->worm->flits, now));
        if (at > now) *again = router_sooner(*again, at);
        else if (!best ||
                 after(output_number(g, out), v->accept) < after(output_number(g, best), v->accept))
            best = out;
    }
    return best;
}

/* What an allocation comes to when lane v alone asks or sends: it gets what it wants, and turns
 * move on. The same as router_allocate, without lists. */
static sim_ps allocate_alone(struct routers *g, struct lane *v, sim_ps now)
{
    sim_ps again = SIM_NEVER;
    struct port *in = &g->port[v->port];
    bool bids = true;
    if (v->state == LANE_ASKING) {
        const struct route_option *o = v->noption > 0 ? v->option : NULL;
        struct port *p = &g->port[router_out(g, v, o)];
        struct lane *out = channel_alone(g, v, o, now, &again);
        const sim_ps flit = ps_later(now, p->flit);
        /* Its bid at the switch does not wait for the channel. */
        bids = eligible(g, v, o, now);
        const sim_ps at = switch_free(g, v, (int)(p - g->port));
        if (bids && at > now) again = router_sooner(again, at);
        bids = bids && at <= now;
        /* The one offer that it accepts moves both turns on, as in a first round. */
        if (out) {
            out->grant = input_number(g, v) + 1;
            v->accept = output_number(g, out) + 1;
            v->match = out;
            router_own(g, v, out);
        }
        /* So does the switch, even if there is no channel to use it for. */
        if (bids) {
            p->grant = in->in + 1;
            in->accept = p->out + 1;
            in->turn = (v->channel + 1) % g->fabric.nchannel;
        }
        if (!out) return bids ? router_sooner(again, flit) : again;
        if (!bids) return router_sooner(again, flit);
    } else {
        const sim_ps at = sends_from(g, v, now);
        if (at > now) return at;
    }
    /* It has a channel and the switch: a flit goes if its buffer has room. */
    const struct bid b = {v, in, &g->port[v->front->ahead->port], false};
    b.out->grant = in->in + 1;
    in->accept = b.out->out + 1;
    if (!winner_sends(g, &b, now)) again = router_sooner(again, ps_later(now, b.out->flit));
    return again;
}

enum { MOST_APART = 6 };

/* The lanes of router r whose time has come, into lane[MOST_APART], if none of them is in another's
 * way; else -1. *others: when the time of the others comes. */
static int lanes_apart(struct routers *g, int r, sim_ps now, struct lane **lane, sim_ps *others)
{
    int n = 0, out[MOST_APART];
    for (struct lane *v = g->router[r].busy; v; v = v->busy) {
        if (v->due > now) {
            *others = router_sooner(*others, v->due);
            continue;
        }
        /* Loads must be looked at by all of an instant together, before anything moves. */
        if (n == MOST_APART || v->state == LANE_ROUTING) return -1;
        if (v->state == LANE_ASKING && (v->noption > 1 || !g->single)) return -1;
        out[n] = v->state == LANE_SENDING ? v->front->ahead->port
                                          : router_out(g, v, v->noption > 0 ? v->option : NULL);
        /* The same way out, or the same input of the switch: allocation decides. */
        for (int i = 0; i < n; i++)
            if (out[i] == out[n] || lane[i]->port == v->port) return -1;
        lane[n++] = v;
    }
    return n;
}

sim_ps router_allocate(struct routers *g, int r, sim_ps now)
{
    g->now = now;
    struct lane *lane[MOST_APART];
    sim_ps others = SIM_NEVER;
    const int n = lanes_apart(g, r, now, lane, &others);
    /* Lanes that share no port cannot meet, whatever the order: no lists, no rounds. */
    for (int i = 0; i < n; i++) others = router_sooner(others, allocate_alone(g, lane[i], now));
    if (n >= 0) return others;
    g->nask = g->nbid = 0;
    sim_ps again = requests(g, r, now);
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
    for (int i = 0; i < g->nask; i++)
        if (waits(g->ask[i].in))
            again = router_sooner(again, ps_later(now, g->port[g->ask[i].out->port].flit));
    return again;
}

void router_look(void *subject, uint64_t argument, sim_ps now)
{
    struct routers *g = subject;
    struct router *o = &g->router[argument];
    for (int i = 0; i < ROUTER_POSTED; i++)
        if (o->posted[i] == now + 1) o->posted[i] = 0;
    if (o->wake != now + 1) return; /* another event came before and did it */
    o->wake = 0;
    const sim_ps again = router_allocate(g, (int)argument, now);
    if (again != SIM_NEVER) router_wake(g, (int)argument, again);
}
