/* net_packet.c - level packet: one event per resource and packet.
 *
 * An event of a resource looks at the FIFO fronts that ask for it, grants it to one whose flits
 * will find room behind it, and works out at once everything that follows from the grant: until
 * when the resource is taken, when the packet may ask for its next one, when the packet behind it
 * may ask, when it has arrived.
 *
 *     grant at t:   link taken [t, t + S)   head at its end t + tau   FIFO before it left at t + S
 *
 * S is the length of the packet in flits at the rate of the link, or longer if it still comes in
 * slower. */
#include "net/net_packet.h"
#include "net/net_account.h"

/* Second look of a resource at the same time: for packets that go where another has just made room.
 * Deliveries where a tail is delivered in the very moment in which the ejection port is granted.
 * Others' traffic comes last. */
enum { LANE_AGAIN = NET_LANE_ARBITRATE + 1, LANE_LATE, LANE_OCCUPY };

/* One pending event a resource is enough: an earlier one makes the later unnecessary. An event that
 * has been overtaken finds another time in `wake` and does nothing. */
static void wake_in(struct fabric *f, int r, sim_ps at, unsigned lane)
{
    struct resource *o = &f->resource[r];
    if (o->wake && o->wake <= at + 1) return;
    o->wake = at + 1;
    sim_at(f->net->sim, at, lane, (uint64_t)r, f->look, f,
           (uint64_t)(lane == LANE_AGAIN) << 32 | (uint64_t)r);
}

void packet_wake(struct fabric *f, int r, sim_ps at)
{
    struct resource *o = &f->resource[r];
    if (!f->wake) {
        wake_in(f, r, at, NET_LANE_ARBITRATE);
        return;
    }
    if (o->wake && o->wake <= at + 1) return;
    o->wake = at + 1;
    f->wake(f, r, at);
}

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* ---- room behind a resource ---- */

/* When flit j of a packet that left as told by c had crossed, at the latest: on the straight line
 * from its first to its last flit, rounded up. */
static sim_ps credit_left(const struct credit *c, int64_t j)
{
    if (c->flits < 2) return c->at;
    sim_ps span = c->tail - c->at, n = c->flits - 1;
    return c->at + (j * span + n - 1) / n;
}

/* Earliest time for a packet that starts `apart` flits behind c in the FIFO: each flit needs the
 * credit of the flit a buffer's size before it. All times are linear, so the first and the last
 * flit concerned decide.
 *
 * To wait until the whole packet ahead has left would be simpler, and too slow: a packet may follow
 * while the one ahead is still leaving. */
static sim_ps credit_bound(const struct fabric *f, const struct credit *c, int64_t apart,
                           int32_t flits, sim_ps flit)
{
    int64_t ahead = apart - f->buffer, k0 = ahead < 0 ? -ahead : 0, k1 = c->flits - 1 - ahead;
    if (k1 > flits - 1) k1 = flits - 1;
    sim_ps at = c->at;
    if (k0 > k1) return at;
    at = later(at, credit_left(c, k0 + ahead) + f->net->credit - k0 * flit);
    return later(at, credit_left(c, k1 + ahead) + f->net->credit - k1 * flit);
}

/* Forget the packets of which every credit is back: they bind nobody. */
static void credits_drop(struct fabric *f, struct fifo *q, sim_ps now)
{
    while (q->first && q->first->tail + f->net->credit <= now) {
        struct credit *c = q->first;
        q->first = c->next;
        credit_return(f, c);
    }
    if (!q->first) q->last = NULL;
}

/* From when on (>= now) a packet of `flits`, one flit every `flit`, may enter q; SIM_NEVER when
 * that depends on a grant yet to come: then `starved` asks for a wake-up at that grant. */
static sim_ps fifo_room(struct fabric *f, struct fifo *q, int32_t flits, sim_ps flit, sim_ps now)
{
    credits_drop(f, q, now);
    int32_t spare = f->buffer - flits;
    if (q->front && (int32_t)(q->position - q->front->position) > spare) {
        q->starved = true;
        return SIM_NEVER;
    }
    sim_ps at = now;
    /* Packets that have left, as far as their credits are still needed for the room of this one. */
    for (const struct credit *c = q->first; c; c = c->next) {
        int32_t apart = (int32_t)(q->position - c->position);
        if (apart > spare) at = later(at, credit_bound(f, c, apart, flits, flit));
    }
    return at;
}

/* What remains of a packet in its FIFO: a credit record, the time from which the next front may
 * ask, and the time when all is as if nobody had been there. */
void packet_left(struct fabric *f, struct fifo *q, uint32_t position, int32_t flits, sim_ps at,
                 sim_ps tail, sim_ps flit)
{
    struct credit *c = credit_take(f);
    *c = (struct credit){.at = at, .tail = tail, .position = position, .flits = flits};
    if (q->last)
        q->last->next = c;
    else
        q->first = c;
    q->last = c;
    q->left = tail + flit;
    q->home = tail + f->net->credit;
}

/* the channel for a packet that takes s: an idle one if there is one, else one with room */
static sim_ps channel_room(struct fabric *f, struct resource *o, const struct pass *s,
                           int32_t flits, sim_ps now, int *channel)
{
    sim_ps best = SIM_NEVER;
    for (int i = s->channel; i < s->channel + s->nchannel; i++) {
        struct fifo *q = fifo_of(f, o, i);
        sim_ps at = later(fifo_room(f, q, flits, s->flit, now), q->free);
        if (at < best) {
            best = at;
            *channel = i;
        }
        /* An idle channel: no other can be better. */
        if (at == now && !q->front && q->left <= now) {
            *channel = i;
            return now;
        }
    }
    return best;
}

/* ---- grants ---- */

/* A FIFO's front packet asks for its next resource; only the front may (head-of-line blocking). */
static void request(struct fabric *f, struct packet *p)
{
    const struct pass *s = &p->flight->pass[p->hop + 1];
    struct resource *o = &f->resource[s->resource];
    p->next_request = o->request;
    o->request = p;
    packet_wake(f, s->resource, later(p->ask, o->free));
}

void packet_enter(struct fabric *f, struct packet *p)
{
    struct pass *s = &p->flight->pass[p->hop];
    struct fifo *q = fifo_of(f, &f->resource[s->resource], p->channel);
    p->input = s->port * f->nchannel + p->channel;
    p->position = q->position;
    q->position += (uint32_t)p->flits;
    p->next = NULL;
    /* The channel is taken until the tail is through and the router has allocated it anew. */
    if (s->hop > 0) q->free = p->tail + s->flit + f->net->allocation;
    /* Somebody stands in front: its departure will bring this packet's turn. */
    if (q->front) {
        q->back->next = p;
        q->back = p;
        return;
    }
    q->front = q->back = p;
    p->ask = later(p->arrive, q->left + f->net->setup);
    request(f, p);
}

/* p, front of its FIFO, goes on to its next resource: the next packet becomes the front and asks; a
 * packet upstream that waited for room looks again at the same time. */
static void fifo_pop(struct fabric *f, struct packet *p, sim_ps now, sim_ps tail, sim_ps flit)
{
    const struct pass *s = &p->flight->pass[p->hop];
    struct resource *o = &f->resource[s->resource];
    struct fifo *q = &o->fifo[p->channel];
    packet_left(f, q, p->position, p->flits, now, tail, flit);
    q->front = p->next;
    if (q->front) {
        q->front->ask = later(q->front->arrive, q->left + f->net->setup);
        request(f, q->front);
    }
    if (!q->starved) return;
    q->starved = false;
    wake_in(f, s->resource, later(now, o->free), LANE_AGAIN);
}

static void packet_delivered(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    struct flight *w = (struct flight *)(uintptr_t)argument;
    struct net_message *m = w->m;
    if (w->arrival != now) { /* it was foreseen, but met somebody since */
        w->foreseen = -1;
        return;
    }
    m->arrival = now;
    /* Grants of this instant have been made when a message arrives at it. */
    if (net_end(f->net, m->bytes) == 0) f->late = now;
    if (w->optimistic)
        auto_delivered(f, w);
    else
        flight_return(f, w);
    net_arrive(f->net, m);
}

void packet_deliver_at(struct fabric *f, struct flight *w, sim_ps arrival)
{
    struct net_message *m = w->m;
    /* Who starts when it arrives may come no sooner than after the grants of that instant. */
    if (f->ahead && net_end(f->net, m->bytes) > 0) {
        m->arrival = arrival;
        flight_return(f, w);
        net_arrive(f->net, m);
        return;
    }
    w->arrival = arrival;
    if (w->foreseen == arrival) return;
    unsigned lane = net_end(f->net, w->m->bytes) > 0 ? NET_LANE_FREE : LANE_LATE;
    sim_at(f->net->sim, arrival, lane, (uint64_t)w->m->dst, packet_delivered, f, (uintptr_t)w);
}

/* Packet p is granted its next resource o now; returns when its tail crosses it. The tail may not
 * be earlier than behind the previous resource: a fast link cannot outrun a slow one before it. */
static sim_ps grant(struct fabric *f, struct resource *o, struct packet *p, sim_ps now)
{
    struct flight *w = p->flight;
    struct pass *s = &w->pass[p->hop + 1];
    sim_ps tail = now + (p->flits - 1) * s->flit;
    if (p->hop >= 0) {
        tail = later(tail, p->tail + f->net->tau);
        fifo_pop(f, p, now, tail, s->flit);
    }
    o->free = tail + s->flit;
    net_account_packet(f->net, s->resource, w->m, p->index, o->free - now, now - p->ask);
    if (s->hop == w->nhop) o->free += packet_ejection_setup(f);
    s->granted++;
    s->last = now;
    if (s->state == PASS_PENDING && s->granted == w->npacket) pass_unlink(f, s);
    p->hop++;
    p->tail = tail;
    p->arrive = now + f->net->tau;
    return tail;
}

/* ---- ejection ports and links ---- */

/* A message has arrived when its last packet has; packets may end in any order. */
static void eject(struct fabric *f, struct packet *p, sim_ps tail)
{
    struct flight *w = p->flight;
    if (++w->ejected == w->npacket) packet_deliver_at(f, w, tail + net_end(f->net, w->m->bytes));
    packet_return(f, p);
}

struct choice {
    struct packet *best, **link; /* link: where it hangs in the list of requests */
    int channel;
    sim_ps again;                /* when another may become eligible */
    bool wait;                   /* one may become eligible later at this same time */
};

/* Round robin: the input at or after `turn` with the smallest distance wins, in unsigned arithmetic
 * that wraps. First come first served: by time of asking, then by input. */
static bool better(const struct fabric *f, const struct resource *o, const struct packet *p,
                   const struct packet *q)
{
    if (f->first_come && p->ask != q->ask) return p->ask < q->ask;
    uint32_t turn = f->first_come ? 0 : o->turn;
    return (uint32_t)p->input - turn < (uint32_t)q->input - turn;
}

/* A packet that blocks the way of s may yet be granted at this time: its own resource has an event
 * pending now. Then s looks once more, after all others of this instant. */
static bool fronts_move(const struct fabric *f, const struct resource *o, const struct pass *s,
                        sim_ps now)
{
    for (int i = s->channel; i < s->channel + s->nchannel; i++) {
        const struct packet *p = o->fifo[i].front;
        if (p && p->ask <= now && f->resource[p->flight->pass[p->hop + 1].resource].wake == now + 1)
            return true;
    }
    return false;
}

/* The best of the requests that could go now, and when it is worth looking again if none can. */
static struct choice choose(struct fabric *f, struct resource *o, sim_ps now)
{
    struct choice c = {.again = SIM_NEVER};
    for (struct packet **link = &o->request; *link; link = &(*link)->next_request) {
        struct packet *p = *link;
        const struct pass *s = &p->flight->pass[p->hop + 1];
        int channel = 0;
        sim_ps at = p->ask;
        if (at <= now && s->hop < p->flight->nhop)
            at = channel_room(f, o, s, p->flits, now, &channel);
        if (at > now) {
            if (at < c.again) c.again = at;
            c.wait = c.wait || (at == SIM_NEVER && fronts_move(f, o, s, now));
        } else if (!c.best || better(f, o, p, c.best)) {
            c.best = p;
            c.link = link;
            c.channel = channel;
        }
    }
    return c;
}

static void resource_serve(struct fabric *f, int r, bool again, sim_ps now)
{
    struct resource *o = &f->resource[r];
    /* Level auto: claims before now have moved the round-robin pointer, too. */
    if (o->claim) auto_catch_up(f, o, now);
    struct choice c = choose(f, o, now);
    struct packet *p = c.best;
    /* At most one second look an instant, or two resources could wait for each other for ever. */
    if (c.wait && !again) {
        wake_in(f, r, now, LANE_AGAIN);
        return;
    }
    if (!p) {
        if (c.again != SIM_NEVER) packet_wake(f, r, c.again);
        return;
    }
    *c.link = p->next_request;
    /* Granted: out of the requests, and the next search begins behind its input. */
    o->turn = (uint32_t)p->input + 1;
    o->turn_time = now;
    sim_ps tail = grant(f, o, p, now);
    p->channel = c.channel;
    if (p->hop == p->flight->nhop)
        eject(f, p, tail);
    else
        packet_enter(f, p);
    if (o->request) packet_wake(f, r, o->free);
}

/* ---- injection ports ---- */

/* a is sent before b: what has begun is not overtaken; else by ready time, then by id. */
static bool sent_before(const struct flight *a, const struct flight *b)
{
    if (a->injected != b->injected) return a->injected > b->injected;
    return a->m->ready != b->m->ready ? a->m->ready < b->m->ready : a->m->id < b->m->id;
}

/* Mostly in order of time: the new message goes to the end without a search. */
void source_enter(struct fabric *f, struct flight *w)
{
    int node = w->m->src;
    struct source *z = &f->source[node];
    struct flight **link = &z->front;
    if (z->back && sent_before(z->back, w)) link = &z->back->next;
    while (*link && sent_before(*link, w)) link = &(*link)->next;
    w->next = *link;
    *link = w;
    if (!w->next) z->back = w;
    if (z->front != w) return;
    sim_ps at = later(w->m->ready, f->resource[node].free);
    packet_wake(f, node, later(at, sim_now(f->net->sim)));
}

/* As if the network were empty and the port only this processor's: what `uncontended` means. */
void flight_measure(struct fabric *f, struct flight *w)
{
    const struct net *n = f->net;
    struct net_message *m = w->m;
    int64_t flits = (int64_t)(w->npacket - 1) * w->full + w->last;
    sim_ps *port = &f->own_port[m->src * f->nprocessor + m->processor];
    sim_ps at = later(m->ready, *port);
    *port = ps_later(at, net_port_busy(n, m->bytes, flits));
    m->uncontended = ps_later(at, flight_empty(n, w));
}

/* the next packet of w leaves its node; the gap between messages follows the last one */
static void inject(struct fabric *f, struct flight *w, int channel, sim_ps now)
{
    struct resource *o = &f->resource[w->m->src];
    struct packet *p = packet_take(f);
    sim_ps ask = w->injected == 0 ? w->m->ready : o->free;
    *p = (struct packet){
        .flight = w, .index = w->injected, .hop = -1, .channel = channel, .ask = ask};
    p->flits = flight_packet_flits(w, p->index);
    if (w->injected++ == 0) w->m->injected = now;
    sim_ps tail = grant(f, o, p, now);
    if (w->injected == w->npacket)
        o->free = later(o->free, tail + net_port(f->net, w->m->bytes)->gap);
    packet_enter(f, p);
}

static void source_serve(struct fabric *f, int node, sim_ps now)
{
    struct source *z = &f->source[node];
    struct flight *w = z->front;
    if (!w) return;
    if (w->m->ready > now) {
        packet_wake(f, node, w->m->ready);
        return;
    }
    int channel = 0;
    /* The injection port is a resource like others: room behind it first. */
    sim_ps at = channel_room(f, &f->resource[node], &w->pass[0],
                             flight_packet_flits(w, w->injected), now, &channel);
    if (at > now) {
        if (at != SIM_NEVER) packet_wake(f, node, at);
        return;
    }
    inject(f, w, channel, now);
    if (w->injected == w->npacket && !(z->front = w->next)) z->back = NULL;
    if (z->front) packet_wake(f, node, later(z->front->m->ready, f->resource[node].free));
}

void packet_look(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    int r = (int)(argument & INT32_MAX);
    bool again = argument >> 32 != 0;
    struct resource *o = &f->resource[r];
    if (o->wake != now + 1) return; /* another event came before and did it */
    o->wake = 0;
    /* Taken in the meantime: look again when it is free. */
    if (o->free > now) {
        packet_wake(f, r, o->free);
    } else if (net_is_injection(f->net, r)) {
        source_serve(f, r, now);
    } else {
        resource_serve(f, r, again, now);
    }
}

/* ---- the level ---- */

static bool packet_create(struct net *n, struct err *e)
{
    struct fabric *f = packet_fabric(n, sizeof(struct fabric), packet_look, e);
    if (f) f->occupied = packet_occupied;
    n->state = f;
    return f != NULL;
}

/* Others' traffic begins after what has been granted at this time (LANE_OCCUPY is the last
 * lane). */
void packet_occupied(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    struct resource *o = &f->resource[argument];
    o->free = later(o->free, now) + f->debt[argument];
    f->debt[argument] = 0;
}

/* Several of one instant are added up and served together: one event. */
void packet_occupy(struct net *n, int link, sim_ps now, sim_ps busy)
{
    struct fabric *f = n->state;
    int r = net_resource(n, link);
    if (!f->debt) f->debt = TAKE(n->arena, n->nresource, sim_ps);
    if (f->debt[r] == 0) sim_at(n->sim, now, LANE_OCCUPY, (uint64_t)r, f->occupied, f, (uint64_t)r);
    f->debt[r] = ps_later(f->debt[r], busy);
}

static void packet_start(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    struct flight *w = (struct flight *)(uintptr_t)argument;
    (void)now;
    flight_measure(f, w);
    source_enter(f, w);
}

void packet_send(struct net *n, struct net_message *m)
{
    struct fabric *f = n->state;
    struct flight *w = flight_take(f, m);
    /* No event where the start is now, or in order anyway. */
    if (n->port_private || m->ready == sim_now(n->sim))
        packet_start(f, (uintptr_t)w, m->ready);
    else
        sim_at(n->sim, m->ready, NET_LANE_START, net_event_key(0, m->id), packet_start, f,
               (uintptr_t)w);
}

const struct net_type net_packet = {"packet",      LEVEL_PACKET,    packet_create, packet_send,
                                    packet_occupy, packet_deadlock, false, false};
