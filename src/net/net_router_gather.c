/* net_router_gather.c - all routers and sources that are to be looked at in one instant, in one
 * event.
 *
 * Routers of one clock have their events in the same instants: at a load of 0.1 some ten an
 * instant, each of which would be queued, sorted and taken by itself. Here an instant is a slot of
 * a wheel with a bit for each router and node, and the first bit posts the event. The bits are
 * taken in the order in which single events would be dispatched: nodes, then routers, then those
 * that are looked at again, each by number; so every time comes out the same.
 *
 * What lies beyond the wheel, or between the instants of its clock, waits as an event of its own.
 */
#include "net/net_router_front.h"

enum {
    MOST = 1 << 16,
    SLOTS = 256,
    MOST_SLOTS = 1 << 13,
    LEAST_CYCLE = 10 /* [ps] below it most cycles are empty */
};

/* Before what is looked at in an instant: what waited outside comes into its slot. */
enum { LANE_ENTER = NET_LANE_ARBITRATE - 1 };

/* ---- sets ---- */

static void set_make(struct gather_set *s, int n, struct arena *a)
{
    const int words = n / GATHER_WORD + 1;
    s->nfull = words / GATHER_WORD + 1;
    s->word = TAKE(a, words, uint64_t);
    s->full = TAKE(a, s->nfull, uint64_t);
}

/* The lowest number out of the set; -1: it is empty. */
static inline int set_take(struct gather_set *s)
{
    uint64_t *full = s->full, *const end = full + s->nfull;
    while (!*full)
        if (++full == end) return -1;
    const int w = (int)(full - s->full) * GATHER_WORD + __builtin_ctzll(*full);
    const uint64_t word = s->word[w], rest = word & (word - 1);
    s->word[w] = rest;
    if (!rest) *full &= *full - 1;
    return w * GATHER_WORD + __builtin_ctzll(word);
}

/* ---- looks ---- */

static inline void look_source(struct routers *g, int node, sim_ps now)
{
    struct resource *o = &g->fabric.resource[node];
    if (o->wake == now + 1) router_source_look(g, node, now);
}

/* The nodes of slot s. */
static void look_sources(struct routers *g, struct gather_slot *s, sim_ps now)
{
    g->gather->sources = false;
    for (int i; (i = set_take(&s->source)) >= 0;) look_source(g, i, now);
}

/* The routers of a slot, word by word: none is added to the slot whose time has come. Of the router
 * that comes next, the lane that will be asked first is fetched already. Nodes that can go on at
 * once go first. */
static void look_routers(struct routers *g, struct gather_slot *s, sim_ps now)
{
    struct gather_set *t = &s->router;
    for (int f = 0; f < t->nfull; f++)
        for (uint64_t full = t->full[f]; full; full &= full - 1) {
            const int w = f * GATHER_WORD + __builtin_ctzll(full);
            uint64_t word = t->word[w];
            const struct router *first = &g->router[w * GATHER_WORD];
            t->word[w] = 0;
            while (word) {
                const int i = __builtin_ctzll(word);
                word &= word - 1;
                if (word) {
                    const struct router *o = &first[__builtin_ctzll(word)];
                    const struct lane *v = o->next < o->end ? o->coming[o->next].lane : o->busy;
                    if (v) __builtin_prefetch(&v->of);
                }
                router_look_at(g, w * GATHER_WORD + i, false, now);
                if (g->gather->sources) look_sources(g, s, now);
            }
        }
    for (int f = 0; f < t->nfull; f++) t->full[f] = 0;
}

/* Event: the slot `argument` has come. What is added meanwhile for this very instant is looked at,
 * too. */
static void look_all(void *subject, uint64_t argument, sim_ps now)
{
    struct routers *g = subject;
    struct gather *q = g->gather;
    struct gather_slot *s = &q->slot[argument];
    q->base = now;
    q->at = (unsigned)argument;
    /* Nodes, routers, then those that had a second look coming. */
    look_sources(g, s, now);
    look_routers(g, s, now);
    for (int i; (i = set_take(&q->again)) >= 0;) {
        router_look_at(g, i, true, now);
        if (q->sources) look_sources(g, s, now);
    }
    s->posted = false;
    q->posted--;
}

/* ---- what is to come ---- */

/* The slot of time `at`, whose event is posted; NULL: it has none. */
static struct gather_slot *slot_of(struct routers *g, sim_ps at)
{
    struct gather *q = g->gather;
    const struct net *n = g->fabric.net;
    /* An empty wheel begins now. */
    if (q->posted == 0) q->base = sim_now(n->sim);
    const int k = gather_steps(q, at);
    if (k < 0) return NULL;
    const unsigned i = (q->at + (unsigned)k) & q->last;
    struct gather_slot *s = &q->slot[i];
    if (s->posted) return s;
    if (!s->source.word) {
        set_make(&s->source, n->nnode, n->arena);
        set_make(&s->router, n->topology->nrouter, n->arena);
    }
    s->posted = true;
    q->posted++;
    sim_at(n->sim, at, NET_LANE_ARBITRATE, 0, look_all, g, i);
    return s;
}

static void alone_source(void *subject, uint64_t argument, sim_ps now)
{
    look_source(subject, (int)argument, now);
}

static void alone_router(void *subject, uint64_t argument, sim_ps now)
{
    router_look_at(subject, (int)argument, false, now);
}

static void alone_again(void *subject, uint64_t argument, sim_ps now)
{
    router_look_at(subject, (int)argument, true, now);
}

/* Event: the time of something that had no slot has come. If it still has none, it is looked at by
 * itself. argument: the number of a resource (of a node's port), then of routers. */
static void enter(void *subject, uint64_t argument, sim_ps now)
{
    struct routers *g = subject;
    const struct net *n = g->fabric.net;
    const uint64_t resources = (uint64_t)n->nresource;
    const bool source = argument < resources;
    const int i = (int)(source ? argument : argument - resources);
    if ((source ? g->fabric.resource[i].wake : g->router[i].wake) != now + 1) return;
    struct gather_slot *s = slot_of(g, now);
    if (s) gather_set_add(source ? &s->source : &s->router, i);
    else
        sim_at(n->sim, now, NET_LANE_ARBITRATE, argument, source ? alone_source : alone_router, g,
               (uint64_t)i);
}

static void post_source(struct fabric *f, int node, sim_ps at)
{
    struct routers *g = (struct routers *)(void *)f;
    struct gather_slot *s = slot_of(g, at);
    struct sim *sim = f->net->sim;
    if (s) {
        gather_set_add(&s->source, node);
        if (at == g->gather->base) g->gather->sources = true;
    } else if (at > sim_now(sim))
        sim_at(sim, at, LANE_ENTER, (uint64_t)node, enter, g, (uint64_t)node);
    else sim_at(sim, at, NET_LANE_ARBITRATE, (uint64_t)node, alone_source, g, (uint64_t)node);
}

/* Second look at a router at the same time: after all others. */
static void post_gathered(struct routers *g, int r, sim_ps at)
{
    struct sim *sim = g->fabric.net->sim;
    struct gather_slot *s = slot_of(g, at);
    const uint64_t number = (uint64_t)g->fabric.net->nresource + (uint64_t)r;
    const bool later = at > sim_now(sim);
    g->router[r].second = !later;
    if (s) gather_set_add(later ? &s->router : &g->gather->again, r);
    else if (later) sim_at(sim, at, LANE_ENTER, number, enter, g, number);
    else sim_at(sim, at, ROUTER_LANE_AGAIN, number, alone_again, g, (uint64_t)r);
}

/* The common measure of `cycle` and a duration (Euclid), and the longer one of `longest` and it. */
static void measure_with(sim_ps *cycle, sim_ps *longest, sim_ps duration)
{
    if (duration > *longest) *longest = duration;
    while (duration > 0) {
        const sim_ps rest = *cycle % duration;
        *cycle = duration;
        duration = rest;
    }
}

sim_ps router_cycle(const struct net *n, sim_ps *longest)
{
    const sim_ps duration[] = {n->tau, n->credit, n->setup, n->allocation};
    sim_ps cycle = *longest = n->link.flit;
    for (int i = 0; i < 4; i++) measure_with(&cycle, longest, duration[i]);
    for (int i = 0; i < n->nport; i++) measure_with(&cycle, longest, n->port[i].gap);
    for (int l = 0; n->wire && l < n->nlink; l++) measure_with(&cycle, longest, n->wire[l]);
    return cycle >= LEAST_CYCLE || cycle == n->link.flit ? cycle : 0;
}

/* A slot for each cycle where a hop is no whole number of flits and the wheel is long enough for
 * it, so that heads have slots; else one for each flit. */
static void wheel_make(struct routers *g, struct gather *q)
{
    const struct net *n = g->fabric.net;
    sim_ps longest;
    unsigned slots = SLOTS;
    const sim_ps cycle = router_cycle(n, &longest);
    q->unit = n->link.flit;
    if (g->tau % q->unit != 0 && cycle > 0 && 2 * g->tau / cycle < MOST_SLOTS) {
        q->unit = cycle;
        while (slots < 2 * g->tau / cycle) slots *= 2;
    }
    q->per_unit = 1.0 / (double)q->unit;
    q->last = slots - 1;
    q->slot = TAKE(n->arena, slots, struct gather_slot);
}

/* Sets of all slots take a bit for each node and router: not for the largest networks. */
bool router_gather(struct net *n)
{
    struct routers *g = n->state;
    if (n->nnode > MOST || n->topology->nrouter > MOST || n->in_flight > 0) return false;
    g->gather = TAKE(n->arena, 1, struct gather);
    wheel_make(g, g->gather);
    g->gather->hop = -1; /* while it is found */
    g->gather->hop_steps = gather_steps(g->gather, g->tau);
    g->gather->hop = g->tau;
    set_make(&g->gather->again, n->topology->nrouter, n->arena);
    routing_keep(n->routing, n->arena);
    net_keep_ways(n);
    g->fabric.wake = post_source;
    g->post = post_gathered;
    g->fabric.ahead = true;
    /* At different rates who lost comes back too late for some turns, and where packets must fit,
     * who finds no room does not know when to come back: there a look without need is none. */
    g->spares = g->even && !n->routing->fits;
    g->quick = g->spares && g->single;
    return true;
}
