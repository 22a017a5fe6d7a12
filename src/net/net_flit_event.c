/* net_flit_event.c - wormhole switching with several virtual channels per link, flit by flit.
 *
 * Packets on different channels share a link flit by flit, so their flits are at no fixed distances
 * and crossings are events of the link: it first gives free channels to heads that ask, then sends
 * one flit, round robin over the channels that have a flit and a credit, and with it those after it
 * that nobody can meet (burst). Behind each channel lies a ring as long as the buffer; the slot of
 * flit n holds the time of its arrival and later that of its departure, which is the credit for
 * flit n + buffer. A node sends its packets one after the other, and an input port passes on one
 * flit at a time. */
#include "net/net_account.h"
#include "net/net_flit.h"

struct worm;

/* A worm at one resource of its way. */
struct leg {
    struct worm *worm;
    struct leg *behind;   /* the next in the FIFO behind the resource */
    struct leg *rival;    /* the next among the requests for the resource */
    sim_ps ask;           /* from when it could have had the resource */
    sim_ps first;         /* when its head crossed */
    int32_t sent;         /* flits that crossed */
    int32_t hop, resource;
    int32_t channel;      /* that it owns or owned behind the resource, -1: none yet */
};

struct worm {
    struct worm *next;    /* in the pool */
    struct flight *flight;
    int32_t flits, index;
    int nhop;
    struct leg leg[];     /* (nhop + 1) */
};

/* A virtual channel of a resource, and the FIFO at its end. */
struct vc {
    struct leg *owner;        /* who sends over it, from its head to its tail */
    sim_ps free;              /* when the next may own it, if nobody does */
    struct leg *front, *back; /* worms in the FIFO */
    sim_ps left;              /* when the tail of the one that left last had left */
    int64_t in, out;          /* flits that ever entered and left */
    sim_ps *slot;             /* (buffer) see above */
};

struct crossing {
    struct vc *vc;            /* (channels), NULL until used */
    struct leg *request;      /* FIFO fronts that want a channel */
    sim_ps passed;            /* when the FIFOs at its end can pass on the next flit */
    int next;                 /* channel to try first */
    int router;               /* behind it, once there are channels */
};

struct flits {
    struct fabric fabric;     /* first */
    struct crossing *crossing;/* (nresource) */
    struct worm **free_worm;  /* by nhop / WORM_STEP */
    int *queued;              /* (nrouter) worms in its FIFOs that are not the fronts */
    /* nobody else's traffic takes links, and no credit is back in the instant in which its flit
     * leaves, where it would matter who is looked at first */
    bool bursts;
};

enum { WORM_STEP = 4 };

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }
static inline sim_ps sooner(sim_ps a, sim_ps b) { return a < b ? a : b; }
static inline bool is_last(const struct leg *l) { return l->hop == l->worm->nhop; }
static inline const struct pass *pass_of(const struct leg *l)
{
    return &l->worm->flight->pass[l->hop];
}

static int router_behind(const struct net *n, int r)
{
    int from, to, port;
    if (net_is_injection(n, r)) return topology_router_of(n->topology, r);
    if (net_is_ejection(n, r)) return -1;
    topology_link_ends(n->topology, r - n->nnode, &from, &to, &port);
    return to;
}

/* Made at the first use. Ejection ports have no FIFO behind: the sink always accepts. */
static struct vc *vcs_of(struct flits *g, int r)
{
    struct crossing *x = &g->crossing[r];
    if (x->vc) return x->vc;
    int n = g->fabric.nchannel;
    int64_t buffer = net_is_ejection(g->fabric.net, r) ? 0 : g->fabric.buffer;
    x->vc = TAKE(g->fabric.net->arena, n, struct vc);
    sim_ps *slot = buffer ? TAKE(g->fabric.net->arena, size_product(n, buffer), sim_ps) : NULL;
    for (int i = 0; slot && i < n; i++) x->vc[i].slot = slot + i * buffer;
    x->router = router_behind(g->fabric.net, r);
    return x->vc;
}

/* The ring: flit n and flit n + buffer share a slot, since the second may only come when the first
 * has left. */
static inline sim_ps *slot_of(const struct flits *g, struct vc *v, int64_t flit)
{
    return &v->slot[flit % g->fabric.buffer];
}

/* The channel in which l's next flit waits; not for injection. */
static struct vc *vc_before(struct flits *g, const struct leg *l)
{
    return &g->crossing[l[-1].resource].vc[l[-1].channel];
}

/* ---- channels for heads ---- */

/* The front of the FIFO v, if its head is there or on its way, asks for its next resource: not
 * before its head has arrived, and not before the tail in front of it is through the router. */
static void front_asks(struct flits *g, struct vc *v)
{
    struct leg *l = v->front;
    if (!l || l->sent == 0) return;
    struct leg *to = l + 1;
    struct crossing *x = &g->crossing[to->resource];
    to->ask = later(l->first + g->fabric.net->tau, v->left + g->fabric.net->setup);
    to->rival = x->request;
    x->request = to;
    packet_wake(&g->fabric, to->resource, later(to->ask, g->fabric.resource[to->resource].free));
}

/* A channel for l: an idle one if there is one, else one that nobody owns; -1: none, *again is when
 * to try again. A channel may be given away while it has no credit: the worm then waits as its
 * owner. */
static int channel_for(struct flits *g, const struct leg *l, sim_ps now, sim_ps *again)
{
    struct vc *v = vcs_of(g, l->resource);
    const struct pass *s = pass_of(l);
    int found = -1;
    for (int i = s->channel; i < s->channel + s->nchannel; i++) {
        if (v[i].owner) continue;
        if (v[i].free > now) {
            *again = sooner(*again, v[i].free);
        } else if (is_last(l) || v[i].in == v[i].out) {
            return i;
        } else if (found < 0) {
            found = i;
        }
    }
    return found;
}

/* From its head to its tail the channel belongs to this worm, so that flits of different worms
 * never mix in a FIFO. */
static void own(struct flits *g, struct leg *l, int channel)
{
    l->channel = channel;
    struct vc *v = &g->crossing[l->resource].vc[channel];
    v->owner = l;
    if (is_last(l)) return;
    l->behind = NULL;
    if (v->front) g->queued[g->crossing[l->resource].router]++;
    *(v->front ? &v->back->behind : &v->front) = l;
    v->back = l;
}

static uint32_t input_of(const struct flits *g, const struct leg *l)
{
    return (uint32_t)(pass_of(l - 1)->port * g->fabric.nchannel + l[-1].channel);
}

/* The same order as on level packet. */
static bool better(const struct flits *g, const struct resource *o, const struct leg *l,
                   const struct leg *m)
{
    const struct fabric *f = &g->fabric;
    if (f->first_come && l->ask != m->ask) return l->ask < m->ask;
    uint32_t turn = f->first_come ? 0 : o->turn;
    return input_of(g, l) - turn < input_of(g, m) - turn;
}

/* Give the free channels of resource r to heads that ask; returns when it may be worth trying
 * again. One at a time, because each channel given away changes what the others can get. */
static sim_ps channels_give(struct flits *g, int r, sim_ps now)
{
    struct resource *o = &g->fabric.resource[r];
    for (;;) {
        /* Of all requests that are due and find a channel, the one whose turn it is. */
        struct leg **best = NULL;
        sim_ps again = SIM_NEVER;
        int channel = -1;
        for (struct leg **l = &g->crossing[r].request; *l; l = &(*l)->rival) {
            if ((*l)->ask > now) {
                again = sooner(again, (*l)->ask);
                continue;
            }
            int i = channel_for(g, *l, now, &again);
            /* A head without a free channel waits; others may still get one. */
            if (i < 0 || (best && !better(g, o, *l, *best))) continue;
            best = l;
            channel = i;
        }
        if (!best) return again;
        struct leg *l = *best;
        *best = l->rival;
        o->turn = input_of(g, l) + 1;
        own(g, l, channel);
    }
}

/* ---- flits ---- */

/* From when on the next flit of l can cross; SIM_NEVER when that depends on something yet to come,
 * whose event will wake this resource. */
static sim_ps flit_ready(struct flits *g, const struct leg *l, sim_ps now)
{
    const struct fabric *f = &g->fabric;
    sim_ps at = now;
    if (l->hop > 0) {
        struct vc *v = vc_before(g, l);
        if (v->out == v->in) return SIM_NEVER;
        at = later(at, later(*slot_of(g, v, v->out), g->crossing[l[-1].resource].passed));
    }
    if (is_last(l)) return at;
    struct vc *v = &g->crossing[l->resource].vc[l->channel];
    if (v->in < f->buffer) return at;
    if (v->in - f->buffer >= v->out) return SIM_NEVER;
    return later(at, *slot_of(g, v, v->in) + f->net->credit);
}

static void worm_return(struct flits *g, struct worm *w)
{
    struct worm **pool = &g->free_worm[w->nhop / WORM_STEP];
    w->next = *pool;
    *pool = w;
}

/* The tail of l crosses now: the channel is free for the next worm, the FIFO before it has a new
 * front, and at the ejection port the message may be complete. */
static void tail_sent(struct flits *g, struct leg *l, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct worm *w = l->worm;
    struct flight *m = w->flight;
    /* Room behind: the flit a buffer's size earlier must have left, and its credit must be back. */
    struct vc *v = &g->crossing[l->resource].vc[l->channel];
    sim_ps flit = pass_of(l)->flit;
    v->owner = NULL;
    v->free = now + flit + (l->hop > 0 ? f->net->allocation : 0);
    net_account_packet(f->net, l->resource, m->m, w->index, w->flits * flit, l->first - l->ask);
    /* The gap g follows the last packet of a message. */
    if (l->hop == 0 && w->index == m->npacket - 1) {
        struct resource *o = &f->resource[l->resource];
        o->free = later(o->free, now + net_port(f->net, m->m->bytes)->gap);
    }
    if (l->hop > 0) {
        struct vc *before = vc_before(g, l);
        before->left = now + flit;
        before->front = before->front->behind;
        if (before->front) g->queued[g->crossing[l[-1].resource].router]--;
        front_asks(g, before);
    }
    if (!is_last(l)) return;
    if (++m->ejected == m->npacket) packet_deliver_at(f, m, flit_arrival(f, m, now));
    worm_return(g, w);
}

/* How long a flit that is no head is under way from one resource to the next: the setup part of the
 * hop latency is the head's alone; front_asks adds it. */
static inline sim_ps trip(const struct fabric *f) { return f->net->tau - f->net->setup; }

/* The next flit of l crosses its resource at `at`. Its slot before keeps the departure, which is
 * the credit of the flit a buffer's size later, that behind the arrival. */
static inline void flit_crosses(struct flits *g, struct leg *l, sim_ps at)
{
    struct fabric *f = &g->fabric;
    const sim_ps flit = pass_of(l)->flit;
    l->sent++;
    f->resource[l->resource].free = at + flit;
    if (l->hop > 0) {
        struct vc *v = vc_before(g, l);
        *slot_of(g, v, v->out++) = at;
        g->crossing[l[-1].resource].passed = at + flit;
    }
    if (!is_last(l)) {
        struct vc *v = &g->crossing[l->resource].vc[l->channel];
        *slot_of(g, v, v->in++) = at + trip(f);
    }
}

/* It crosses now: the resource before is told of the credit, the next one of the arrival. */
static void flit_send(struct flits *g, struct leg *l, sim_ps now)
{
    struct fabric *f = &g->fabric;
    const bool head = l->sent == 0;
    flit_crosses(g, l, now);
    if (head) l->first = now;
    if (head && l->hop == 0 && l->worm->index == 0) l->worm->flight->m->injected = now;
    if (l->hop > 0)
        packet_wake(f, l[-1].resource,
                    later(now + f->net->credit, f->resource[l[-1].resource].free));
    if (!is_last(l)) {
        struct vc *v = &g->crossing[l->resource].vc[l->channel];
        if (head && v->front == l) front_asks(g, v);
        if (l[1].channel >= 0)
            packet_wake(f, l[1].resource, later(now + trip(f), f->resource[l[1].resource].free));
    }
    if (l->sent == l->worm->flits) tail_sent(g, l, now);
}

/* ---- bursts ---- */

/* Before when nothing that has not happened yet can act on what l's flits find at its resource,
 * whose only owner it is while no head asks. A head that asks has crossed the link before, a hop
 * latency ago; or it was behind another worm whose tail has gone. Flits that come through the same
 * input have crossed the same link, or are there. */
static sim_ps undisturbed(const struct flits *g, const struct leg *l, sim_ps now)
{
    const struct fabric *f = &g->fabric;
    if (l->hop == 0) return SIM_NEVER;
    const struct crossing *input = &g->crossing[l[-1].resource];
    const struct vc *own = &input->vc[l[-1].channel];
    /* A node looks how much room its channels have, and may not see it early. */
    if (l->hop == 1 && own->in - own->out + trip(f) / f->fastest + 2 >= f->buffer) return now;
    sim_ps until = ps_later(now, trip(f));
    if (g->queued[input->router] > 0) until = sooner(until, now + f->fastest + f->net->setup);
    for (int i = 0; i < f->nchannel; i++) {
        struct vc *v = &input->vc[i];
        if (v != own && v->in > v->out) until = sooner(until, *slot_of(g, v, v->out));
    }
    return until;
}

/* After a flit of l over its resource, whose only owner it is while no head asks: those after it,
 * but for the tail, that cross before anything can act on them, in the same event. That they go is
 * known to both ends at once; when they go is written beside it. */
static void burst(struct flits *g, struct leg *l, sim_ps now)
{
    const sim_ps until = undisturbed(g, l, now);
    const struct resource *o = &g->fabric.resource[l->resource];
    while (l->sent + 1 < l->worm->flits) {
        const sim_ps at = flit_ready(g, l, o->free);
        if (at >= until) return;
        flit_crosses(g, l, at);
    }
}

/* Send a flit over resource r if one can go; returns when to look again. Round robin over the
 * channels: worms that share a link get turns, flit by flit. */
static sim_ps resource_send(struct flits *g, int r, sim_ps now)
{
    struct crossing *x = &g->crossing[r];
    int n = g->fabric.nchannel;
    sim_ps again = SIM_NEVER;
    bool waits = x->request != NULL;
    struct leg *go = NULL;
    int owners = 0;
    for (int k = 0; k < n; k++) {
        int i = (x->next + k) % n;
        struct leg *l = x->vc[i].owner;
        if (!l) continue;
        owners++;
        /* Another worm also has the link in mind: look again after this flit. */
        waits = waits || go;
        if (go) continue;
        sim_ps at = flit_ready(g, l, now);
        if (at > now)
            again = sooner(again, at);
        else
            go = l;
    }
    /* Nobody can send now: look again when the first flit or credit is due. */
    if (!go) return again;
    x->next = (go->channel + 1) % n;
    bool more = go->sent + 1 < go->worm->flits;
    flit_send(g, go, now);
    if (more && owners == 1 && !waits && g->bursts && !g->fabric.debt) burst(g, go, now);
    return more || waits || again != SIM_NEVER ? g->fabric.resource[r].free : SIM_NEVER;
}

/* ---- sources ---- */

/* Pools by length of route, as for flights (net_packet_fabric.c). */
static struct worm *worm_take(struct flits *g, struct flight *v)
{
    struct worm **pool = &g->free_worm[v->nhop / WORM_STEP], *w = *pool;
    size_t nleg = (size_t)(v->nhop / WORM_STEP + 1) * WORM_STEP;
    if (w)
        *pool = w->next;
    else
        w = arena_take(g->fabric.net->arena, sizeof *w + nleg * sizeof(struct leg));
    *w = (struct worm){.flight = v, .index = v->injected, .nhop = v->nhop};
    w->flits = flight_packet_flits(v, w->index);
    for (int h = 0; h <= v->nhop; h++)
        w->leg[h] =
            (struct leg){.worm = w, .hop = h, .resource = v->pass[h].resource, .channel = -1};
    return w;
}

/* A free channel with room, round robin; -1: none. */
static int source_channel(struct flits *g, int node)
{
    struct vc *v = vcs_of(g, node);
    int n = g->fabric.nchannel;
    for (int k = 0; k < n; k++) {
        int i = (g->crossing[node].next + k) % n;
        if (!v[i].owner && v[i].in - v[i].out < g->fabric.buffer) return i;
    }
    return -1;
}

/* A node sends one packet at a time. */
static bool source_busy(const struct flits *g, int node)
{
    const struct vc *v = g->crossing[node].vc;
    for (int i = 0; v && i < g->fabric.nchannel; i++)
        if (v[i].owner) return true;
    return false;
}

/* The next packet of a node begins when the one before has gone: packets of one message never
 * overtake each other. */
static void source_next(struct flits *g, int node, sim_ps now)
{
    struct source *z = &g->fabric.source[node];
    struct flight *m = z->front;
    if (!m || m->m->ready > now || source_busy(g, node)) return;
    int channel = source_channel(g, node);
    if (channel < 0) return; /* a credit will wake us */
    struct worm *w = worm_take(g, m);
    w->leg[0].ask = m->injected == 0 ? m->m->ready : g->fabric.resource[node].free;
    if (++m->injected == m->npacket && !(z->front = m->next)) z->back = NULL;
    own(g, &w->leg[0], channel);
}

/* when to look again for the next packet of a node */
static sim_ps source_again(const struct flits *g, int node, sim_ps now)
{
    const struct flight *m = g->fabric.source[node].front;
    if (!m || source_busy(g, node)) return SIM_NEVER;
    sim_ps at = later(m->m->ready, g->fabric.resource[node].free);
    return at > now ? at : SIM_NEVER;
}

/* ---- events ---- */

static void flits_look(void *subject, uint64_t argument, sim_ps now)
{
    struct flits *g = subject;
    struct fabric *f = &g->fabric;
    int r = (int)argument;
    struct resource *o = &f->resource[r];
    /* An event that an earlier one has made unnecessary. */
    if (o->wake != now + 1) return;
    o->wake = 0;
    if (o->free > now) {
        packet_wake(f, r, o->free);
        return;
    }
    /* Channels first, then flits: a head that gets its channel now may send now. */
    bool source = net_is_injection(f->net, r);
    sim_ps again = SIM_NEVER;
    if (source)
        source_next(g, r, now);
    else
        again = channels_give(g, r, now);
    if (g->crossing[r].vc) again = sooner(again, resource_send(g, r, now));
    if (source) again = sooner(again, source_again(g, r, now));
    if (again != SIM_NEVER) packet_wake(f, r, later(again, o->free));
}

/* ---- the way ---- */

static struct fabric *flits_create(struct net *n, struct err *e)
{
    struct flits *g = (struct flits *)(void *)fabric_create(n, sizeof *g, flits_look, e);
    if (!g) return NULL;
    g->fabric.occupied = packet_occupied;
    n->hop_bytes += sizeof(struct leg);
    n->resource_bytes = size_product((size_t)g->fabric.nchannel,
                                     sizeof(struct vc) + (size_t)g->fabric.buffer * sizeof(sim_ps));
    g->crossing = TAKE(n->arena, n->nresource, struct crossing);
    g->free_worm = TAKE(n->arena, (n->topology->max_hops + 2) / WORM_STEP + 1, struct worm *);
    g->queued = TAKE(n->arena, n->topology->nrouter, int);
    g->bursts = n->machine->noise.background_load <= 0 && n->credit > 0;
    return &g->fabric;
}

/* The front of a FIFO behind resource r, on channel `channel` (-1: any), that has not gone on. */
static const struct leg *front_at(const struct flits *g, int r, int channel)
{
    const struct vc *v = g->crossing[r].vc;
    for (int i = 0; v && i < g->fabric.nchannel; i++)
        if ((channel < 0 || i == channel) && v[i].front) return v[i].front;
    return NULL;
}

static bool flits_deadlock(const struct net *n, char *text, int size)
{
    const struct flits *g = n->state;
    const struct leg *l = NULL;
    for (int i = n->nnode; i < n->nresource && !l; i++) l = front_at(g, i, -1);
    struct arena_mark mark = arena_mark(n->arena);
    int *way = TAKE(n->arena, n->nresource, int), *seen = TAKE(n->arena, n->nresource, int),
        count = 0;
    while (l && !seen[l->resource]) {
        way[count++] = l->resource;
        seen[l->resource] = count;
        /* It waits for its next resource: there, whoever stands in the FIFO of its channel. */
        const struct leg *to = l + 1;
        l = front_at(g, to->resource, to->channel >= 0 ? to->channel : pass_of(to)->channel);
    }
    if (l)
        packet_name_cycle(n, way + seen[l->resource] - 1, count - seen[l->resource] + 1, text,
                          size);
    arena_release(n->arena, mark);
    return l != NULL;
}

const struct flit_way flit_event = {flits_create, flits_deadlock};
