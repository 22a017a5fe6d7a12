/* net_auto_simulate.c - level auto: messages become simulated ones, from now on and without loss.
 *
 * Up to now an optimistic message is where its closed form says. What is left of its past is
 * written into the state of level packet: packets and credits in FIFOs, reservations, round-robin
 * pointers. Then it may be met by others, so everybody is turned who might: whose claim has not
 * cleared a resource when a simulated message may come there, and who comes into a FIFO behind one.
 * Earliest possible arrivals only grow with time, so nobody else need be looked at later. FIFOs are
 * filled only when all are known, in the order of time. */
#include <stdlib.h>

#include "net/net_account.h"
#include "net/net_auto.h"

/* A packet, or its credits, in the FIFO behind pass `hop`, which it began to cross at `at`. */
struct presence {
    sim_ps at;
    struct flight *flight;
    int index, hop;
};

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

static void pass_wait(struct fabric *f, struct pass *s)
{
    struct resource *o = &f->resource[s->resource];
    s->prev = NULL;
    s->next = o->pending;
    if (s->next) s->next->prev = s;
    o->pending = s;
    s->state = PASS_PENDING;
}

static void mark_push(struct fabric *f, struct flight *w)
{
    if (f->nmarked == f->marked_room) {
        int room = f->marked_room ? 2 * f->marked_room : 64;
        struct flight **more = TAKE(f->net->arena, room, struct flight *);
        for (int i = 0; i < f->nmarked; i++) more[i] = f->marked[i];
        f->marked = more;
        f->marked_room = room;
    }
    f->marked[f->nmarked++] = w;
}

/* One pass of w: what was done before now is history, the rest is to come. The history is written
 * as grants would have left it: pointer, reservation, accounts. */
static void pass_turn(struct fabric *f, struct flight *w, int h, sim_ps slow)
{
    struct pass *s = &w->pass[h];
    struct resource *o = &f->resource[s->resource];
    int granted = auto_granted(w, h, auto_until(f));
    s->granted = granted;
    if (granted > 0) {
        s->last = auto_begin(w, granted - 1, h);
        if (s->state == PASS_CLAIM) auto_turn(f, o, s, granted);
        sim_ps setup = h == w->nhop ? packet_ejection_setup(f) : 0;
        if (h > 0) o->free = later(o->free, auto_tail(w, granted - 1, h, slow) + s->flit + setup);
    }
    pass_unlink(f, s);
    if (h > 0 && granted < w->npacket) pass_wait(f, s);
    if (!f->net->load || !w->m) return;
    for (int i = 0; i < granted; i++) {
        sim_ps wait = h == 0 && i == 0 ? s->begin - w->m->ready : 0;
        sim_ps busy = (flight_packet_flits(w, i) - 1) * slow + s->flit;
        net_account_packet(f->net, s->resource, w->m, i, busy, wait);
    }
}

/* The injection port was taken for packets that may now be sent at other times: give it back from
 * the end of what has been sent. */
static void port_turn(struct fabric *f, const struct flight *w)
{
    struct resource *port = &f->resource[w->pass[0].resource];
    const struct pass *s = &w->pass[0];
    if (w->injected == w->npacket) return;
    sim_ps free = w->port_before;
    if (w->injected > 0) free = auto_tail(w, w->injected - 1, 0, s->flit) + s->flit;
    if (free < port->free) port->free = free;
}

/* From here on w is a simulated message in the state that level packet would have it in. */
static void mark(struct fabric *f, struct flight *w)
{
    sim_ps slow = 0;
    w->optimistic = false;
    f->nadmitted--;
    for (int h = 0; h <= w->nhop; h++) {
        slow = later(slow, w->pass[h].flit);
        pass_turn(f, w, h, slow);
    }
    w->injected = w->pass[0].granted;
    w->ejected = w->pass[w->nhop].granted;
    if (w->ejected < w->npacket) w->arrival = SIM_NEVER;
    port_turn(f, w);
    mark_push(f, w);
}

/* Does claim c on the resource of s, a pass of a simulated message, touch it: it has not cleared
 * when s may come there; it comes into the FIFO in which s stands; or its credits are ahead of
 * those of s in the FIFO? */
static bool touches(const struct fabric *f, const struct pass *c, const struct pass *s, sim_ps now)
{
    const struct flight *w = s->flight;
    if (s->granted < w->npacket && auto_clear(f, c) > auto_earliest(f, s, now)) return true;
    if (s->granted == 0 || s->hop == w->nhop || c->channel != s->channel) return false;
    /* c comes behind s in the same FIFO, while packets of s are still in it. */
    if (c->begin > s->begin) return s->granted > s[1].granted;
    return auto_clear(f, c) > now && auto_clear(f, s) > now;
}

static struct flight *met(const struct fabric *f, const struct pass *s, sim_ps now)
{
    for (struct pass *c = f->resource[s->resource].claim; c; c = c->next)
        if (touches(f, c, s, now)) return c->flight;
    return NULL;
}

static void mark_all(struct fabric *f, sim_ps now)
{
    for (int i = 0; i < f->nmarked; i++) {
        struct flight *w = f->marked[i], *other;
        for (int h = 0; h <= w->nhop; h++)
            /* The closure: those who become simulated now may in turn touch others. marked grows
             * while it is walked; each message enters once. */
            while ((other = met(f, &w->pass[h], now))) mark(f, other);
    }
}

static void presence_push(struct fabric *f, struct presence p)
{
    if (f->npresence == f->presence_room) {
        int room = f->presence_room ? 2 * f->presence_room : 256;
        struct presence *more = TAKE(f->net->arena, room, struct presence);
        for (int i = 0; i < f->npresence; i++) more[i] = f->presence[i];
        f->presence = more;
        f->presence_room = room;
    }
    f->presence[f->npresence++] = p;
}

/* The packets of w behind pass h, and those whose credits are not home, the youngest first: older
 * ones than the first without a trace have none either. */
static void presence_find(struct fabric *f, struct flight *w, int h, sim_ps slow, sim_ps now)
{
    const struct pass *next = &w->pass[h + 1];
    sim_ps after = later(f->net->credit, next->flit) +
                   (f->net->setup > 0 ? f->net->setup + w->pass[h].flit : 0);
    for (int i = w->pass[h].granted - 1; i >= 0; i--) {
        if (i < next->granted && auto_tail(w, i, h + 1, slow) + after <= now) return;
        presence_push(f, (struct presence){auto_begin(w, i, h), w, i, h});
    }
}

/* FIFOs must be filled in the order in which packets came in; the resource makes the order
 * total. */
static int presence_order(const void *a, const void *b)
{
    const struct presence *p = a, *q = b;
    if (p->at != q->at) return p->at < q->at ? -1 : 1;
    int r = p->flight->pass[p->hop].resource, s = q->flight->pass[q->hop].resource;
    return r < s ? -1 : r > s;
}

/* A packet that has been granted its next resource leaves only credits behind; any other is put
 * into the FIFO, as its front or behind others. */
static void presence_place(struct fabric *f, const struct presence *e)
{
    struct flight *w = e->flight;
    const struct pass *s = &w->pass[e->hop];
    struct fifo *q = fifo_of(f, &f->resource[s->resource], auto_lane(f, w, e->index, e->hop));
    int32_t flits = flight_packet_flits(w, e->index);
    if (e->hop > 0)
        q->free =
            auto_tail(w, e->index, e->hop, auto_slow(w, e->hop)) + s->flit + f->net->allocation;
    if (e->index < s[1].granted) {
        sim_ps tail = auto_tail(w, e->index, e->hop + 1, auto_slow(w, e->hop + 1));
        packet_left(f, q, q->position, flits, auto_begin(w, e->index, e->hop + 1), tail, s[1].flit);
        q->position += (uint32_t)flits;
        return;
    }
    struct packet *p = packet_take(f);
    *p = (struct packet){.flight = w, .index = e->index, .hop = e->hop, .flits = flits};
    p->channel = auto_lane(f, w, e->index, e->hop);
    p->arrive = e->at + f->net->tau;
    p->tail = auto_tail(w, e->index, e->hop, auto_slow(w, e->hop));
    packet_enter(f, p);
}

/* First all FIFOs, then the sources: a source that is looked at must see the FIFO behind its
 * port. */
static void place_all(struct fabric *f, int first, sim_ps now)
{
    f->npresence = 0;
    for (int i = first; i < f->nmarked; i++) {
        struct flight *w = f->marked[i];
        for (int h = 0; h < w->nhop; h++) presence_find(f, w, h, auto_slow(w, h + 1), now);
    }
    if (f->npresence > 1)
        qsort(f->presence, (size_t)f->npresence, sizeof *f->presence, presence_order);
    for (int i = 0; i < f->npresence; i++) presence_place(f, &f->presence[i]);
    for (int i = 0; i < f->nmarked; i++)
        if (f->marked[i]->injected < f->marked[i]->npacket) source_enter(f, f->marked[i]);
}

/* w itself has no past: all its passes are to come. */
void auto_simulate(struct fabric *f, struct flight *w, sim_ps now)
{
    f->nmarked = 0;
    mark_push(f, w);
    for (int h = 1; h <= w->nhop; h++) pass_wait(f, &w->pass[h]);
    mark_all(f, now);
    place_all(f, 1, now);
}

/* How long resource o is taken by what was granted before `until`, and *delayed: a message that
 * would go on in the `busy` after that and must be simulated, since others' traffic delays it. */
static sim_ps taken_until(const struct resource *o, sim_ps until, sim_ps busy,
                          struct flight **delayed)
{
    sim_ps taken = later(o->free, until - 1);
    *delayed = NULL;
    for (const struct pass *c = o->claim; c && c->begin < taken + busy; c = c->next) {
        const struct flight *w = c->flight;
        if (!w->m || auto_begin(w, w->npacket - 1, c->hop) < until)
            taken = later(taken, c->end);
        else
            *delayed = c->flight;
    }
    return taken;
}

void auto_occupied(void *subject, uint64_t argument, sim_ps now)
{
    struct fabric *f = subject;
    struct resource *o = &f->resource[argument];
    struct flight *delayed;
    f->late = now; /* what begins now has been granted */
    f->nmarked = 0;
    sim_ps taken = taken_until(o, auto_until(f), f->debt[argument], &delayed);
    while (delayed) {
        mark(f, delayed);
        taken = taken_until(o, auto_until(f), f->debt[argument], &delayed);
    }
    mark_all(f, now);
    place_all(f, 0, now);
    o->free = taken + f->debt[argument];
    f->debt[argument] = 0;
}
