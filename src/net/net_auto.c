/* net_auto.c - level auto: the answer of level packet, bit for bit, without simulating messages
 * that meet nobody.
 *
 * Because a granted packet never stalls, a message alone follows a closed form. When a message
 * starts, its closed form is compared with the claims of other such messages on its resources and
 * with the earliest possible arrivals of simulated ones. If nothing can interfere, the claims are
 * noted and one event, the delivery, is posted. Otherwise it is simulated, and so is every
 * optimistic message that it might meet (net_auto_simulate.c): up to now each of those is exactly
 * where its closed form says, so nothing has to be taken back. */
#include "net/net_auto.h"

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* ---- the closed form ---- */

/* In a message of several packets none waits for the one before when the injection port is the
 * slowest resource and each finds room: packet i passes a resource i paces after the first, and by
 * the credit rule (credit_bound in net_packet.c) it may, whichever packet `ahead` of it one looks
 * at. Routers that need time between packets make it wait. */
static bool train_flows(const struct fabric *f, const struct flight *w)
{
    if (w->npacket == 1) return true;
    sim_ps flit = w->pass[0].flit, tau = f->net->tau, credit = f->net->credit;
    if (flit < w->slowest || f->net->setup > 0) return false;
    /* Each earlier packet that may bind: its first and last flits that matter, as in credit_bound,
     * but with all packets one pace apart. */
    for (int64_t apart = w->full; apart - w->full < f->buffer; apart += w->full) {
        if (apart + w->full <= f->buffer) continue;
        int64_t ahead = apart - f->buffer, k0 = ahead < 0 ? -ahead : 0,
                k1 = w->full - 1 - (ahead > 0 ? ahead : 0);
        sim_ps since = apart * flit - tau;
        if (since < 0 || since < (k0 + ahead) * flit + credit - k0 * f->fastest) return false;
        if (since < (k1 + ahead) * flit + credit - k1 * f->fastest) return false;
    }
    /* Packets that overlap behind a link need a channel each. */
    for (int h = 0; h < w->nhop; h++)
        if (w->pass[h].nchannel > 1 && auto_overlap(f, w, h) > w->pass[h].nchannel) return false;
    return true;
}

/* Fill in the claims of w, starting at `start`; returns when it will be delivered. The head is at
 * resource h at start + h tau; flits leave at the slowest rate so far. */
static sim_ps closed_form(const struct fabric *f, struct flight *w, sim_ps start)
{
    const struct net *n = f->net;
    sim_ps slow = 0, train = (w->npacket - 1) * auto_pace(w);
    w->clear = 0;
    for (int h = 0; h <= w->nhop; h++) {
        struct pass *s = &w->pass[h];
        slow = later(slow, s->flit);
        s->begin = start + h * n->tau;
        s->end = s->begin + train + (w->last - 1) * slow + s->flit;
        s->follow = later(s->end, s->begin + train + n->tau + s->flit) + n->setup;
    }
    for (int h = 0; h <= w->nhop; h++) {
        struct pass *s = &w->pass[h];
        /* With one channel and equal rates the next message may follow sooner, namely as soon as
         * the credit rule cannot bind it; else only when every trace is gone. */
        bool plain = s->nchannel == 1 && w->slowest == f->fastest;
        sim_ps clear = auto_clear(f, s);
        if (!plain || h == w->nhop) s->follow = clear;
        w->clear = later(w->clear, clear);
    }
    return w->pass[w->nhop].begin + train + (w->last - 1) * w->slowest + net_end(n, w->m->bytes);
}

/* ---- may it stay optimistic? ---- */

static bool same_fifo(const struct pass *a, const struct pass *b)
{
    return a->channel == b->channel;
}

/* Claims are in order of time: those that begin after this one has gone cannot meet it. In
 * different FIFOs messages only compete for the link itself, in the same FIFO for its room as
 * well. */
static bool meets_claims(const struct resource *o, const struct pass *s)
{
    for (const struct pass *c = o->claim; c; c = c->next) {
        const struct pass *first = c->begin < s->begin ? c : s, *second = first == c ? s : c;
        sim_ps free = same_fifo(first, second) ? first->follow : first->end;
        if (second->begin < free) return true;
        if (c->begin > s->follow && c->begin > s->end) return false;
    }
    return false;
}

/* Simulated messages have no fixed times: compare with the earliest at which each could come. MOST
 * bounds the cost; beyond it the message is simulated, which is always right. */
static bool meets_simulated(const struct fabric *f, const struct resource *o, const struct pass *s,
                            sim_ps now)
{
    enum { MOST = 32 };
    if (s->hop > 0 && o->free > s->begin) return true;
    int looked = 0;
    for (const struct pass *d = o->pending; d; d = d->next)
        if (looked++ == MOST || auto_earliest(f, d, now) < auto_clear(f, s)) return true;
    if (s->hop == s->flight->nhop || !o->fifo) return false;
    /* Whoever stands in a FIFO, or whose credits are on their way, might delay it. */
    for (int i = s->channel; i < s->channel + s->nchannel; i++) {
        const struct fifo *q = &o->fifo[i];
        if (q->front || later(q->left, q->free) > s->begin || q->home > s->begin) return true;
    }
    return false;
}

/* A message of this node that was admitted at this same time but comes after w in the order of
 * sending: w must go first, so that neither closed form holds. */
static bool overtakes(const struct fabric *f, const struct flight *w)
{
    const struct pass *s = f->source[w->m->src].last_claim;
    const struct net_message *o = s ? s->flight->m : NULL;
    if (!o || s->begin < auto_until(f)) return false;
    return o->ready > w->m->ready || (o->ready == w->m->ready && o->id > w->m->id);
}

/* When w, alone, will be delivered; SIM_NEVER when it might meet somebody. Doubtful cases are
 * simulated: only time is lost then, never exactness. */
static sim_ps foresee(struct fabric *f, struct flight *w, sim_ps now)
{
    if (f->source[w->m->src].front || overtakes(f, w) || !train_flows(f, w) || f->net->tau == 0)
        return SIM_NEVER;
    sim_ps arrival = closed_form(f, w, later(now, f->resource[w->m->src].free));
    for (int h = 0; h <= w->nhop; h++) {
        const struct resource *o = &f->resource[w->pass[h].resource];
        if (meets_simulated(f, o, &w->pass[h], now) || meets_claims(o, &w->pass[h]))
            return SIM_NEVER;
    }
    return arrival;
}

/* The claims are noted and the injection port is taken; nothing else of the fabric is touched. */
static void admit(struct fabric *f, struct flight *w, sim_ps arrival)
{
    struct resource *port = &f->resource[w->m->src];
    f->nadmitted++;
    w->optimistic = true;
    w->port_before = port->free;
    port->free = later(w->pass[0].end,
                       w->pass[0].end - w->pass[0].flit + net_port(f->net, w->m->bytes)->gap);
    w->m->injected = w->pass[0].begin;
    for (int h = 0; h <= w->nhop; h++) pass_claim(f, &w->pass[h]);
    packet_deliver_at(f, w, arrival);
    w->foreseen = arrival;
}

/* ---- the level ---- */

/* Two events at most for a message that meets nobody: start and delivery. */
static void auto_start(struct fabric *f, struct flight *w, sim_ps now)
{
    if (!f->net->port_private) flight_measure(f, w);
    sim_ps arrival = foresee(f, w, now);
    if (arrival != SIM_NEVER)
        admit(f, w, arrival);
    else
        auto_simulate(f, w, now);
}

static void start_event(void *subject, uint64_t argument, sim_ps now)
{
    auto_start(subject, (struct flight *)(uintptr_t)argument, now);
}

static bool auto_create(struct net *n, struct err *e)
{
    struct fabric *f = packet_fabric(n, sizeof(struct fabric), packet_look, e);
    if (f) f->occupied = auto_occupied;
    n->state = f;
    return f != NULL;
}

static void auto_send(struct net *n, struct net_message *m)
{
    struct fabric *f = n->state;
    struct flight *w = flight_take(f, m);
    sim_ps now = sim_now(n->sim);
    if (n->port_private) flight_measure(f, w);
    if (m->ready == now)
        auto_start(f, w, now);
    else
        sim_at(n->sim, m->ready, NET_LANE_START, net_event_key(0, m->id), start_event, f,
               (uintptr_t)w);
}

const struct net_type net_auto = {"auto",        LEVEL_AUTO,      auto_create, auto_send,
                                  packet_occupy, packet_deadlock, false, false};
