/* net_link.c - message-level cut-through: every resource serves one message at a time, first come
 * first served.
 *
 * When a message's head arrives at resource h at time t, it crosses at x_h = max(t, free_h), and
 * free_h becomes x_h + S, whatever happens downstream: buffers are unbounded, nobody blocks the one
 * behind. The head is at the next resource at x_h + tau. A resource is never taken before the head
 * is there: reserving a whole path at injection mis-orders messages and is worse than no contention
 * at all. Heads that arrive together go by input port, then id.
 *
 * Events: one per link and one for the ejection port, which already knows the arrival. The
 * injection port of a node with one sender needs none. */
#include <stddef.h>

#include "net/net_account.h"
#include "net/net_path.h"
#include "net/net_way.h"

/* A message on its way: all that its head needs at a resource in one line of the cache, since the
 * message itself lies elsewhere, cold, until it arrives. */
struct flight {
    struct net_message *m;
    int64_t bytes, flits; /* of m */
    struct route_cursor cursor;
    int resource; /* where the head arrives next */
    int port;     /* through which it arrives there */
    /* of m: what net_event_key takes of its number, and its job above (KEY_JOB) */
    uint32_t key;
    /* At the end of the way: */
    struct net_rate slow; /* slowest rate of the route */
    struct route *route;  /* its way by a rule of network.routing, NULL: `cursor` */
    uint32_t path;        /* node at which the head was last, where critical paths are recorded */
    int ejection;         /* the last resource */
} __attribute__((aligned(64)));
_Static_assert(offsetof(struct flight, slow) == 64, "a head touches one line");
enum { KEY_JOB = 24 };
static inline int flight_job(const struct flight *f) { return (int)(f->key >> KEY_JOB); }

struct link_level {
    sim_ps *free; /* (nresource) from when on */
    /* (nnode x processors) injection port had no other processor of the node sent anything */
    sim_ps *own_port;
    int nprocessor;
    struct flight **unused; /* (nunused) of nflight in all, which is the room of the list, too */
    int nunused, nflight;
};

static void head_arrives(void *subject, uint64_t argument, sim_ps now);
static void head_early(void *subject, uint64_t argument, int step);

static bool link_create(struct net *n, struct err *e)
{
    (void)e;
    struct link_level *g = TAKE(n->arena, 1, struct link_level);
    g->nprocessor = n->topology->spec->processors_per_node;
    g->free = TAKE(n->arena, n->nresource, sim_ps);
    g->own_port = g->nprocessor == 1
                      ? g->free
                      : TAKE(n->arena, size_product(n->nnode, g->nprocessor), sim_ps);
    n->state = g;
    n->message_bytes = sizeof(struct flight) + (n->routing ? sizeof(struct route) : 0);
    sim_foresee(n->sim, head_arrives, head_early, 1);
    return true;
}

/* Flights in use are messages in the network: after the busiest moment nothing is allocated any
 * more. The list of unused ones grows by doubling, since an arena gives nothing back. */
static void flights_make(struct net *n)
{
    enum { FIRST = 256 };
    struct link_level *g = n->state;
    const int count = g->nflight > 0 ? g->nflight : FIRST;
    struct flight *more = TAKE(n->arena, count, struct flight);
    struct route *route = n->routing ? TAKE(n->arena, count, struct route) : NULL;
    g->nflight += count;
    g->unused = TAKE(n->arena, g->nflight, struct flight *);
    for (int i = count - 1; i >= 0; i--) {
        if (route) more[i].route = &route[i];
        g->unused[g->nunused++] = &more[i];
    }
}

static struct flight *flight_take(struct net *n)
{
    enum { AHEAD = 4 };
    struct link_level *g = n->state;
    if (g->nunused == 0) flights_make(n);
    struct flight *f = g->unused[--g->nunused];
    /* For messages to come: long unused ones are cold. */
    if (g->nunused >= AHEAD) {
        const char *later = (const char *)g->unused[g->nunused - AHEAD];
        __builtin_prefetch(later, 1);
        __builtin_prefetch(later + 64, 1);
    }
    return f;
}

/* Last in, first out: the record just used is still in the cache. */
static void flight_return(struct net *n, struct flight *f)
{
    struct link_level *g = n->state;
    g->unused[g->nunused++] = f;
}

/* the message of f takes `resource` at `now` or when it is free; returns when */
static sim_ps resource_take(struct net *n, int resource, const struct flight *f, sim_ps now,
                            sim_ps busy)
{
    struct link_level *g = n->state;
    /* Others' messages go by links alone; those that came since a link was last taken are served
     * before. */
    if (n->others && !net_is_injection(n, resource) && !net_is_ejection(n, resource)) {
        const sim_ps before = g->free[resource];
        g->free[resource] = n->others(n->others_context, resource - n->nnode, now, before);
        if (g->free[resource] > before) net_path_others(n, resource);
    }
    sim_ps at = now > g->free[resource] ? now : g->free[resource];
    g->free[resource] = ps_later(at, busy);
    net_account(n, resource, flight_job(f), 1, f->bytes, busy, at - now);
    return at;
}

static void head_arrives(void *subject, uint64_t argument, sim_ps now);

/* What a link is reserved for beyond now, in flits: on this level the load that rules compare. */
struct backlog {
    const struct net *net;
    sim_ps now;
};

static int64_t backlog_used(const void *of, int link)
{
    const struct backlog *b = of;
    const struct link_level *g = b->net->state;
    const sim_ps ahead = g->free[net_resource(b->net, link)] - b->now;
    const struct net_rate r = b->net->link_rate ? b->net->link_rate[link] : b->net->link;
    if (ahead <= 0) return 0;
    return r.flit > 0 ? ahead / r.flit : r.byte > 0 ? (int64_t)((double)ahead / r.byte) : 0;
}

/* By a rule: of several ways on the one of the highest priority, of equals the one that is free
 * first. There are no channels, so that an escape is never needed. */
static bool rule_next(struct net *n, struct flight *f, sim_ps now, struct hop *h)
{
    const struct link_level *g = n->state;
    const struct backlog load = {n, now};
    const struct routing_view view = {backlog_used, &load};
    struct route_option option[ROUTING_MOST_OPTIONS], *best = option;
    int from, to;
    const int count = routing_next(n->routing, f->route, &view, option);
    if (count == 0) return false;
    for (int i = 1; i < count; i++) {
        const bool equal = option[i].priority == best->priority;
        const sim_ps free = g->free[net_resource(n, option[i].link)],
                     least = g->free[net_resource(n, best->link)];
        if (equal ? free < least : option[i].priority > best->priority) best = &option[i];
    }
    routing_take(n->routing, f->route, best, best->first + best->count - 1);
    *h = (struct hop){.link = best->link};
    topology_link_ends(n->topology, h->link, &from, &to, &h->port);
    /* The tail goes at the slowest rate of the way that it took. */
    f->slow = net_rate_slower(f->slow, n->link_rate ? n->link_rate[h->link] : n->link);
    return true;
}

/* the head left its resource at x: it is at the next one tau later */
static void head_sent(struct net *n, struct flight *f, sim_ps x)
{
    struct hop h;
    int port = f->port;
    if (n->path) f->path = net_path_take(n, f->resource, f->path, x, f->bytes);
    sim_ps there = x + n->tau;
    if (n->wire && !net_is_injection(n, f->resource)) {
        const sim_ps wire = n->wire[f->resource - n->nnode];
        there += wire;
        if (n->path) f->path = net_path_cable(n, f->path, wire, f->resource);
    }
    if (n->routing ? rule_next(n, f, x, &h) : topology_next(n->topology, &f->cursor, &h)) {
        f->resource = net_resource(n, h.link);
        f->port = h.port;
    } else {
        f->resource = f->ejection;
    }
    /* The key is the port through which the head entered the resource it leaves. */
    sim_at(n->sim, there, NET_LANE_HEAD, net_event_key(port, f->key), head_arrives, n,
           (uintptr_t)f);
}

static void head_arrives(void *subject, uint64_t argument, sim_ps now)
{
    struct net *n = subject;
    struct flight *f = (struct flight *)(uintptr_t)argument;
    sim_ps busy = net_rate_time(net_resource_rate(n, f->resource, f->bytes), f->flits);
    sim_ps x = resource_take(n, f->resource, f, now, busy);
    if (n->path) f->path = net_path_hops(n, f->path, 1, f->resource);
    if (!net_is_ejection(n, f->resource)) {
        head_sent(n, f, x);
        return;
    }
    struct net_message *m = f->m;
    if (n->path)
        m->path = net_path_tail(n, net_path_take(n, f->resource, f->path, x, m->bytes), f->slow,
                                m->bytes);
    m->arrival = x + net_rate_time(f->slow, f->flits - 1) + net_end(n, m->bytes);
    flight_return(n, f);
    net_arrive(n, m);
}

/* The injection port is taken like any resource, its time with the gap g included. */
static void link_inject(struct net *n, struct net_message *m)
{
    struct link_level *g = n->state;
    struct flight *f = flight_take(n);
    struct net_rate slow;
    const sim_ps way = net_way(n, m, &slow);
    f->m = m;
    f->bytes = m->bytes;
    f->flits = net_flits(n, m->bytes);
    f->key = (uint32_t)(m->id & 0xffffff) | (uint32_t)net_job(m) << KEY_JOB;
    f->ejection = net_ejection(n, m->dst);
    f->slow = slow;
    if (n->routing) {
        *f->route = net_route_begin(n, m);
        f->slow = net_rate_slower(net_port(n, m->bytes)->rate, n->ejection);
    } else {
        f->cursor = topology_start(n->topology, m->src, m->dst, net_choice(m));
    }
    f->port = topology_injection_port(n->topology, m->src);
    f->resource = net_injection(n, m->src);
    f->path = m->path;
    sim_ps busy = net_port_busy(n, m->bytes, f->flits), own = 0;
    /* When the port would have been free for this processor alone. */
    if (g->nprocessor > 1) {
        sim_ps *port = &g->own_port[m->src * g->nprocessor + m->processor];
        own = m->ready > *port ? m->ready : *port;
        *port = ps_later(own, busy);
    }
    m->injected = resource_take(n, f->resource, f, m->ready, busy);
    if (g->nprocessor == 1) own = m->injected;
    /* The closed form of the empty network from there on. */
    m->uncontended = own + way + net_rate_time(slow, f->flits - 1) + net_end(n, m->bytes);
    head_sent(n, f, m->injected);
}

static void link_start(void *subject, uint64_t argument, sim_ps now)
{
    (void)now;
    link_inject(subject, (struct net_message *)(uintptr_t)argument);
}

static void link_send(struct net *n, struct net_message *m)
{
    if (n->port_private) link_inject(n, m);
    else
        sim_at(n->sim, m->ready, NET_LANE_START, net_start_key(m->id), link_start, n, (uintptr_t)m);
}

/* The event queue has asked for the flight before. What its head needs next: the other line, the
 * time of its resource; at the end of its way the message, last touched when it was sent. */
static void head_early(void *subject, uint64_t argument, int step)
{
    const struct net *n = subject;
    const struct link_level *g = n->state;
    const struct flight *f = (const struct flight *)(uintptr_t)argument;
    const bool last = net_is_ejection(n, f->resource);
    if (step > 0) {
        if (last) n->early(f->m);
        return;
    }
    __builtin_prefetch(&f->slow);
    __builtin_prefetch(&g->free[f->resource]);
    net_account_early(n, f->resource, flight_job(f));
    for (int line = 0; last && line < 3; line++) __builtin_prefetch((const char *)f->m + 64 * line);
}

void net_link_foresee(struct net *n) { sim_foresee(n->sim, head_arrives, head_early, 2); }

/* Others' traffic queues like a message, without one. */
static void link_occupy(struct net *n, int link, sim_ps now, sim_ps busy)
{
    struct link_level *g = n->state;
    sim_ps *free = &g->free[net_resource(n, link)];
    *free = ps_later(now > *free ? now : *free, busy);
    net_path_others(n, net_resource(n, link));
}

const struct net_type net_link = {"link",      LEVEL_LINK, link_create, link_send,
                                  link_occupy, NULL,       true,        true};
