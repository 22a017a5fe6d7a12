/* net_clocked.c - which networks and lists are played in cycles, their records, and the wheel.
 *
 * A cycle is looked at as net_router_gather.c does an instant: messages start; then nodes, then
 * routers, each by number; then routers that are looked at again. */
#include "net/net_clocked.h"

#include "base/digest.h"
#include "net/net_clocked_allocate.h"
#include "net/net_router_gather.h"

enum {
    MOST_ROUTERS = 8192,   /* of a cycle all words are looked through */
    MOST_NEAR = 16,        /* flits of a hop latency within which few heads are under way */
    MOST_WHEEL = 1 << 16,  /* cycles from a look to what it may post */
    MOST_LAST = 1 << 30,   /* no cycle from this one on: sums of a few times stay below 2^31 */
    MOST_BYTES = 256 << 20 /* of records; messages take eight more each */
};

/* ---- what can be played ----
 *
 * A network with links of one rate, and rules of one or two ways on, whose times have a common
 * measure: that is the cycle. Of lists those whose messages are a packet each and start on one. */

/* The cycle of the network, if nobody watches or loads it besides; 0: it has none. A credit and the
 * way of a head to its next look take one at least, so that no flit crosses two routers in one
 * cycle. */
static sim_ps cycle_find(const struct net *n, const struct routers *g)
{
    if (!g->even || g->fits || !g->few || n->load || n->path || n->others) return 0;
    if (n->topology->nrouter > MOST_ROUTERS || n->nnode > MOST_ROUTERS) return 0;
    if (n->credit <= 0 || n->tau - n->setup <= 0) return 0;
    for (int i = 0; i < n->nport; i++)
        if (n->port[i].rate.flit != n->link.flit) return 0;
    if (!n->port_private || n->in_flight != 0) return 0;
    sim_ps longest;
    const sim_ps cycle = router_cycle(n, &longest);
    return cycle > 0 && longest / cycle < MOST_WHEEL ? cycle : 0;
}

/* In which cycle each message starts, and how long the longest and the shortest are. False: one
 * starts between two, or too late, or is more than a packet. */
static bool list_is_even(struct clocked *g)
{
    const struct clocked_list *q = g->list;
    const double per_unit = 1.0 / (double)g->unit;
    int64_t flits = 0, bytes = -1;
    g->longest = 1;
    g->shortest = MOST_WHEEL;
    /* Many messages have one size, and a division takes long. */
    for (int m = 0; m < q->count; m++) {
        const sim_ps time = q->time[m];
        const int64_t k =
            time < (sim_ps)MOST_LAST * g->unit ? (int64_t)((double)time * per_unit + 0.5) : -1;
        if (k < 0 || k * g->unit != time) return false;
        g->start[m] = (int32_t)k;
        if (q->bytes[m] != bytes) {
            bytes = q->bytes[m];
            flits =
                net_packets(g->net, bytes) == 1 ? net_packet_flits(g->net, bytes, 0) : MOST_WHEEL;
            if (flits >= MOST_WHEEL || (g->whole && flits > g->buffer)) return false;
            g->longest = clocked_later(g->longest, (int32_t)flits);
            g->shortest = clocked_sooner(g->shortest, (int32_t)flits);
        }
    }
    return true;
}

/* ---- records ---- */

/* Whether the records of so many ports, and `words` words beside them, are not too many bytes. */
static bool are_few(const struct clocked *g, int nport, size_t words)
{
    enum { LANE_WORDS = 24 }; /* a lane with its options and its scratch of an allocation */
    return LANE_WORDS * (size_t)nport * g->nchannel + words <= MOST_BYTES / sizeof(uint64_t);
}

/* How many inputs each router has, and all of them together; false: one has too many lanes. */
static bool inputs_count(struct clocked *g, const struct routers *from, int *input, int *all)
{
    const int nchannel = (int)g->nchannel;
    *all = 0;
    for (int i = 0; i < g->net->nresource; i++) {
        const struct port *p = &from->port[i];
        if (p->to >= 0 && (int)p->in >= input[p->to]) input[p->to] = (int)p->in + 1;
        if (((int)p->out + 1) * nchannel > CLOCKED_LANES || p->out >= CLOCKED_WORD) return false;
    }
    for (int r = 0; r < g->nrouter; r++) {
        if (input[r] * nchannel > CLOCKED_LANES) return false;
        if (input[r] * nchannel > g->sets * CLOCKED_WORD)
            g->sets = (input[r] * nchannel - 1) / CLOCKED_WORD + 1;
        *all += input[r];
    }
    return *all + g->nnode <= UINT16_MAX && are_few(g, *all + g->nnode, 0);
}

/* Ports in the order of the routers that they lead to, each router's by number; then those out of
 * the network. Lanes alike. */
static bool ports_make(struct clocked *g, const struct routers *from)
{
    struct arena *a = g->net->arena;
    int *input = TAKE(a, g->nrouter, int), sink, next = 0;
    if (!inputs_count(g, from, input, &sink)) return false;
    g->nport = sink + g->nnode;
    g->port = TAKE_FULL(a, g->nport, struct clocked_port, true);
    g->lane = TAKE_FULL(a, size_product((size_t)g->nport, g->nchannel), struct clocked_lane, true);
    g->sink = g->port + sink;
    for (int i = 0; i < g->nport; i++) g->port[i].lane = g->lane + i * (int)g->nchannel;
    for (int i = 0; i < g->nport * (int)g->nchannel; i++)
        g->lane[i].port = (uint16_t)(i / (int)g->nchannel);
    struct clocked_coming *coming =
        TAKE_FULL(a, size_product((size_t)sink, g->nchannel), struct clocked_coming, true);
    for (int r = 0; r < g->nrouter; next += input[r++])
        g->router[r] = (struct clocked_router){.lane = g->port[next].lane,
                                               .port = &g->port[next],
                                               .coming = coming + next * (int)g->nchannel,
                                               .room = (uint16_t)(input[r] * (int)g->nchannel),
                                               .wake = CLOCKED_NEVER};
    for (int i = 0; i < CLOCKED_LANES; i++) {
        g->entry[i] = (uint8_t)(i / (int)g->nchannel);
        g->channel[i] = (uint8_t)(i % (int)g->nchannel);
        g->after[i] = clocked_next_channel(g, g->channel[i]);
    }
    return true;
}

/* What they are, by resource: links and ways out by number of the output, too, which is how the
 * table of steps names them. */
static void ports_fill(struct clocked *g, const struct routers *from)
{
    const struct net *n = g->net;
    g->source = TAKE(n->arena, g->nnode, struct clocked_source);
    g->port_of = TAKE(n->arena, n->nlink + 1, int32_t);
    g->exit = TAKE_FULL(n->arena, size_product((size_t)g->nrouter, CLOCKED_WORD),
                        struct clocked_port *, true);
    for (int i = 0; i < n->nresource; i++) {
        const struct port *p = &from->port[i];
        const bool out = net_is_ejection(n, i), in = net_is_injection(n, i);
        struct clocked_port *o =
            out ? g->sink + (i - n->nnode - n->nlink) : g->router[p->to].port + p->in;
        o->wire = (uint16_t)(p->wire / g->unit);
        o->from = (int16_t)(in ? ~i : p->from);
        o->to = (int16_t)p->to;
        o->in = (uint8_t)p->in;
        o->out = (uint8_t)p->out;
        o->lanes_out = (uint8_t)(p->out * g->nchannel);
        o->row = p->to * g->nrouter;
        if (!in) g->exit[p->from * CLOCKED_WORD + (int)p->out] = o;
        if (in)
            g->source[i] =
                (struct clocked_source){.front = -1, .back = -1, .wake = CLOCKED_NEVER, .port = o};
        else if (!out) g->port_of[i - n->nnode] = (int32_t)(o - g->port);
    }
}

/* What the levels' records say, in cycles. They themselves are only read: events may still have to
 * play the list. */
static struct clocked *clocked_make(struct net *n, sim_ps unit, const struct clocked_list *q,
                                    struct clocked_result *r)
{
    struct routers *from = n->state;
    struct clocked *g = TAKE(n->arena, 1, struct clocked);
    *g = (struct clocked){.net = n, .list = q, .result = r, .unit = unit, .routing = n->routing};
    g->flit = (int32_t)(n->link.flit / unit);
    g->tau = (int32_t)(n->tau / unit);
    g->credit = (int32_t)(n->credit / unit);
    g->setup = (int32_t)(n->setup / unit);
    g->reach = g->tau - g->setup;
    g->pause = (int32_t)(n->allocation / unit);
    for (int l = 0; n->wire && l < n->nlink; l++)
        g->longest_wire = clocked_later(g->longest_wire, (int32_t)(n->wire[l] / unit));
    g->buffer = (int32_t)from->buffer;
    g->nchannel = from->nchannel;
    g->whole = from->whole;
    g->queues = !g->whole || g->tau > MOST_NEAR * g->flit;
    g->single = from->single;
    g->strict = from->strict;
    g->priority = from->priority;
    g->looks = from->looks;
    g->looks_on = from->looks_on;
    /* A rule that looks at loads behind the first router does so when the head stands there. */
    g->due = g->looks_on ? g->reach : g->tau;
    g->iterations = from->iterations;
    g->nrouter = n->topology->nrouter;
    g->nnode = n->nnode;
    g->bytes = -1;
    g->start = TAKE_FULL(n->arena, q->count + 1, int32_t, true);
    g->router = TAKE_FULL(n->arena, g->nrouter, struct clocked_router, true);
    return g;
}

/* What a lane remembers at a time: of flits, those that it holds or whose credits are not back, and
 * those that are sent ahead; of packets that have left, as many as these flits may be. */
static int32_t places_needed(const struct clocked *g)
{
    if (!g->whole) return g->buffer + ROUTER_AHEAD;
    return (g->buffer + g->longest) / clocked_later(g->shortest, 1) + 4;
}

/* The wheel and the lanes; false where they would be too many bytes. The wheel has twice the
 * longest time from a look to what it posts: a packet and its gap, and a hop with its credit. */
static bool lanes_make(struct clocked *g, int32_t gap)
{
    struct arena *a = g->net->arena;
    const int64_t ahead = 2 * ((int64_t)(g->longest + ROUTER_AHEAD) * g->flit + gap + g->tau +
                               g->longest_wire + g->credit + g->setup + g->pause);
    const size_t lanes = (size_t)g->nport * g->nchannel;
    if (ahead >= MOST_WHEEL) return false;
    g->wheel = 1;
    g->ring = CLOCKED_ROW - 1;
    while (g->ring + 1 < places_needed(g)) g->ring = 2 * g->ring + 1;
    while (g->wheel < ahead) g->wheel = 2 * g->wheel + 1;
    g->router_words = g->nrouter / CLOCKED_WORD + 1;
    g->words = g->router_words + g->nnode / CLOCKED_WORD + 1;
    while (1 << g->word_shift < g->words) g->word_shift++;
    const size_t slots = ((size_t)g->wheel + 1) << g->word_shift,
                 places = size_product(lanes, (size_t)g->ring + 1);
    if (!are_few(g, g->nport, slots + places)) return false;
    g->slot = TAKE_FULL(a, slots, uint64_t, true);
    for (int r = 0; r < g->nrouter; r++) {
        g->router[r].slot = g->slot + r / CLOCKED_WORD;
        g->router[r].bit = (uint16_t)(r % CLOCKED_WORD);
    }
    g->again = TAKE(a, g->router_words, uint64_t);
    g->stay = TAKE_FULL(a, places, union clocked_stay, true);
    g->stay_row = (int32_t)lanes * CLOCKED_ROW;
    g->option = TAKE_FULL(a, size_product(lanes, CLOCKED_OPTIONS), struct route_option, true);
    g->retry = TAKE_FULL(a, lanes, int32_t, true);
    g->match = TAKE_FULL(a, lanes, struct clocked_match, true);
    g->side = TAKE_FULL(a, g->nport, struct clocked_side, true);
    g->ask = TAKE(a, size_product(CLOCKED_BIDS, g->nchannel), struct clocked_ask);
    g->bid = TAKE(a, CLOCKED_BIDS, struct clocked_bid);
    return true;
}

/* ---- cycles ---- */

/* Message m is the last in the list of its node; if it is the only one, the node is looked at as
 * soon as it is free. */
static void start(struct clocked *g, int m, int32_t now)
{
    const int node = g->list->src[m];
    struct clocked_source *z = &g->source[node];
    g->next[m] = -1;
    if (z->front >= 0) {
        g->next[z->back] = m;
        z->back = m;
        return;
    }
    z->front = z->back = m;
    if (z->sending || z->free > now) {
        clocked_wake_source(g, node, clocked_later(now, z->free));
        return;
    }
    z->wake = now;
    clocked_source_look(g, node, now);
    g->sources = true;
}

/* An event of net_router_gather.c, counted and mixed into the digest as that one would be. */
static void count(struct clocked *g, int32_t now, unsigned lane, int64_t key)
{
    struct clocked_result *r = g->result;
    r->events++;
    r->digest = digest_mix(digest_mix(r->digest, (uint64_t)(now * g->unit)),
                           (uint64_t)lane << 48 | (uint64_t)key);
}

/* Cycle g->now, if anything can happen in it. */
static inline void cycle(struct clocked *g)
{
    uint64_t *slot = &g->slot[(size_t)(g->now & g->wheel) << g->word_shift], any = g->sources;
    for (int w = 0; w < g->words; w++) any |= slot[w];
    if (!any) return;
    count(g, g->now, NET_LANE_ARBITRATE, 0);
    clocked_cycle(g, slot);
}

/* As a cycle; far ones are all alike. */
static int32_t cycle_of(sim_ps k) { return k < MOST_LAST ? (int32_t)k : MOST_LAST; }

/* Cycle after cycle; from one in which nothing can happen to that in which the next message
 * starts.
 *
 * Two limits are watched while it runs, so that no estimate has to be right: the clock, which must
 * not come near the end of 32 bits, and the wheel, on which a look that is posted more than a turn
 * ahead would stand in the slot of an earlier cycle. Past either one the list is given up, and all
 * of it is played by events. */
static bool play(struct clocked *g)
{
    const struct clocked_list *q = g->list;
    const int32_t stop = q->stop > 0 ? cycle_of(q->stop / g->unit) : MOST_LAST;
    int next = 0;
    for (g->now = 0;; g->now++) {
        int m = next < q->count ? q->order ? q->order[next] : next : -1;
        if (g->now > g->last) {
            if (m < 0) break;
            g->now = clocked_later(g->now, g->start[m]);
        }
        if (g->now >= MOST_LAST) return false;
        if (g->now > stop) return true;
        if (m >= 0 && g->start[m] == g->now) count(g, g->now, NET_LANE_START, m);
        while (m >= 0 && g->start[m] == g->now) {
            start(g, m, g->now);
            m = ++next < q->count ? q->order ? q->order[next] : next : -1;
        }
        cycle(g);
        if (g->last - g->now > g->wheel) return false;
    }
    return g->done == q->count;
}

/* Records are made before it is known whether all fits; where it does not, they go with the arena.
 */
bool net_clocked(struct net *n, const struct clocked_list *q, struct clocked_result *r)
{
    if (n->type != &net_routed_packet && n->type != &net_routed_flit) return false;
    const struct routers *from = n->state;
    int32_t gap = 0;
    const sim_ps unit = cycle_find(n, from);
    if (unit == 0) return false;
    struct clocked *g = clocked_make(n, unit, q, r);
    for (int i = 0; i < n->nport; i++)
        gap = clocked_later(gap, (int32_t)(n->port[i].gap / g->unit));
    if (!list_is_even(g) || !ports_make(g, from)) return false;
    ports_fill(g, from);
    if (!lanes_make(g, gap)) return false;
    g->next = TAKE_FULL(n->arena, q->count + 1, int32_t, true);
    routing_keep(n->routing, n->arena);
    /* All steps together take as long as some messages. */
    if (q->count > g->nrouter * g->nrouter / 8) g->steps = routing_steps(n->routing, n->arena);
    for (int i = 0; g->steps && i < g->steps->nstate; i++)
        g->asking[i] =
            (struct clocked_head){LANE_ASKING, 1, g->steps->first[i], g->steps->count[i]};
    r->digest = DIGEST_START;
    return play(g);
}
