/* net.c - makes a net of a level: converts the machine's numbers to picoseconds once, sizes
 * messages, forms the closed form of the empty network. */
#include <stdio.h>
#include <string.h>

#include "base/random.h"
#include "net/net_account.h"
#include "net/net_internal.h"
#include "net/net_router.h"
#include "net/net_way.h"

static const struct net_type *const levels[] = {
#define X(constant, word, stem, cost, fineness) [constant] = &net_##stem,
    LEVEL_LIST(X)
#undef X
};

static bool long_cables(const struct topology_spec *s)
{
    for (int d = 0; d < MACHINE_MAX_DIMS; d++)
        if (s->dim_latency[d] > 0) return true;
    return false;
}

/* Whether a packet's way depends on more than its ends, or cables differ in length. */
static bool routed(const struct machine_spec *m)
{
    return m->network.routing != ROUTING_DETERMINISTIC || long_cables(&m->topology);
}

/* A bus is one resource, served first come first served: all levels mean the same, which is what
 * `link` does. */
static const struct net_type *level_of(const struct machine_spec *m)
{
    enum network_level level =
        topology_has(m->topology.family, TOPOLOGY_SHARED) ? LEVEL_LINK : m->network.level;
    if (routed(m)) {
        if (level == LEVEL_PACKET || level == LEVEL_AUTO) return &net_routed_packet;
        if (level == LEVEL_FLIT) return &net_routed_flit;
    }
    return (size_t)level < sizeof levels / sizeof *levels ? levels[level] : NULL;
}

/* A rate from a bandwidth [B/s] and a floor from the software [s/B]: the slower one counts. With
 * flits the time of a flit is rounded once to whole picoseconds, and the time of a byte follows
 * from it, so that flits and bytes never disagree. */
static struct net_rate rate_make(const struct network_spec *w, double bandwidth,
                                 double least_s_per_byte)
{
    double s_per_byte = bandwidth > 0 ? 1 / bandwidth : 0;
    if (s_per_byte < least_s_per_byte) s_per_byte = least_s_per_byte;
    struct net_rate r = {0, s_per_byte * SIM_PS_PER_S};
    if (w->flit_bytes > 0) {
        r.flit = ps_rounded((double)w->flit_bytes * r.byte);
        /* A flit faster than a picosecond would take no time at all. */
        if (r.flit == 0 && r.byte > 0) r.flit = 1;
        r.byte = (double)r.flit / (double)w->flit_bytes;
    }
    return r;
}

/* Rates of single links, only where they differ: a torus of a million links has one. */
static void link_rates_make(struct net *n, const struct network_spec *w)
{
    if (topology_uniform(n->topology)) return;
    n->link_rate = TAKE(n->arena, n->nlink > 0 ? n->nlink : 1, struct net_rate);
    for (int l = 0; l < n->nlink; l++) {
        double factor = topology_link_bandwidth(n->topology, l, w->link_bandwidth);
        n->link_rate[l] = rate_make(w, factor * w->link_bandwidth, 0);
    }
}

/* The rule, and what cables take longer. Levels without channels are not bound by their number. */
static bool routing_make(struct net *n, const struct machine_spec *m, struct err *e)
{
    if (!routed(m) || topology_has(m->topology.family, TOPOLOGY_NO_LINKS)) {
        if (m->network.routing == ROUTING_DETERMINISTIC) return true;
        return err_set(e, ERR_CONFIG, "network.routing '%s' is not for topology '%s'",
                       routing_rule_name(m->network.routing),
                       topology_family_name(m->topology.family));
    }
    const bool channels = n->type == &net_routed_packet || n->type == &net_routed_flit;
    n->routing = routing_create(n->topology, m->network.routing,
                                channels ? m->network.virtual_channels : 0, n->arena, e);
    if (!n->routing || !long_cables(&m->topology)) return n->routing != NULL;
    n->wire = TAKE(n->arena, n->nlink + 1, sim_ps);
    for (int l = 0; l < n->nlink; l++)
        n->wire[l] = sim_from_seconds(topology_link_latency(n->topology, l));
    return true;
}

/* Injection ports by message size: the software's gap, rate and latency may change with the
 * protocol. Segments that differ in neither share a range. */
static void ports_make(struct net *n, const struct machine_spec *m)
{
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const struct network_spec *w = &m->network;
    const double bandwidth =
        w->injection_bandwidth > 0 ? w->injection_bandwidth : w->link_bandwidth;
    const int nlist = software_segments(&m->software, list);
    n->nport = 0;
    for (int i = 0; i < nlist; i++) {
        struct net_port p = {INT64_MAX, rate_make(w, bandwidth, list[i].gap_per_byte),
                             sim_from_seconds(list[i].gap),
                             sim_from_seconds(w->end_latency) + sim_from_seconds(list[i].latency)};
        struct net_port *last = n->nport > 0 ? &n->port[n->nport - 1] : NULL;
        if (last && last->rate.flit == p.rate.flit && last->rate.byte == p.rate.byte &&
            last->gap == p.gap && last->end == p.end)
            continue;
        if (last) last->below = list[i].from;
        n->port[n->nport++] = p;
    }
}

/* Resources are numbered in an int: two ports for each node and every link. */
static bool sizes_fit(const struct topology *t, struct err *e)
{
    if (2 * (int64_t)t->nnode + t->nlink <= INT32_MAX) return true;
    return err_set(e, ERR_CONFIG,
                   "the network has %d nodes and %d links, more than can be numbered", t->nnode,
                   t->nlink);
}

/* What a router does for a head before its flits go on; the flits behind it do not wait for that.
 * Both parts lie within the hop latency, so that the empty network does not change. */
static bool setup_make(struct net *n, const struct network_spec *w, struct err *e)
{
    n->allocation = sim_from_seconds(w->vc_allocation_latency);
    n->setup = n->allocation + sim_from_seconds(w->routing_latency);
    if (n->setup <= n->tau) return true;
    return err_set(
        e, ERR_CONFIG,
        "network.routing_latency %lld ps and network.vc_allocation_latency %lld ps are parts of "
        "network.hop_latency, which is %lld ps; expected at most that together",
        (long long)(n->setup - n->allocation), (long long)n->allocation, (long long)n->tau);
}

struct net *net_create(const struct machine_spec *m, const struct topology *t, struct sim *s,
                       struct arena *a, net_deliver_fn *deliver, void *context, bool want_links,
                       struct err *e)
{
    const struct network_spec *w = &m->network;
    struct net *n = TAKE(a, 1, struct net);
    if (!level_of(m)) err_set(e, ERR_CONFIG, "there is no network level %d", (int)w->level);
    if (!level_of(m) || !sizes_fit(t, e)) return NULL;
    *n = (struct net){.type = level_of(m),
                      .machine = m,
                      .topology = t,
                      .sim = s,
                      .arena = a,
                      .deliver = deliver,
                      .context = context};
    /* Seconds of the machine's file become picoseconds here, once; no level converts again. */
    n->nnode = t->nnode;
    n->nlink = t->nlink;
    n->nresource = 2 * t->nnode + t->nlink;
    n->tau = sim_from_seconds(w->hop_latency);
    n->credit = sim_from_seconds(w->credit_latency);
    if (!setup_make(n, w, e) || !routing_make(n, m, e)) return NULL;
    /* The levels add (R + 1) tau without a look at the clock: refuse what could wrap. */
    if (ps_times(t->max_hops + 2, n->tau) > PS_LAST) {
        err_set(e, ERR_CONFIG,
                "network.hop_latency: a route of %d routers takes longer than the largest "
                "simulated time, %.3g s",
                t->max_hops + 1, PS_LAST / SIM_PS_PER_S);
        return NULL;
    }
    n->flit_bytes = w->flit_bytes > 0 ? w->flit_bytes : 1;
    n->link = rate_make(w, w->link_bandwidth, 0);
    ports_make(n, m);
    n->ejection =
        rate_make(w, w->ejection_bandwidth > 0 ? w->ejection_bandwidth : w->link_bandwidth, 0);
    link_rates_make(n, w);
    /* An eager message leaves when its sender says so, in the order of the sends. A rendezvous
     * waits for an answer, and another processor of the node may come in between. */
    n->port_private =
        software_eager_most(&m->software) == INT64_MAX && t->spec->processors_per_node == 1;
    /* Zero, and so no memory of the computer until something passes: a machine of a few bytes of
     * text has 10^8 links. */
    n->njob = 1;
    if (want_links) net_loads_make(n);
    return n->type->create(n, e) ? n : NULL;
}

void net_set_in_order(struct net *n, bool in_order)
{
    if (n->type != &net_loggp && n->type != &net_link) return; /* the others need an event anyway */
    n->port_private = in_order && n->topology->spec->processors_per_node == 1;
}

bool net_gather(struct net *n)
{
    return (n->type == &net_routed_packet || n->type == &net_routed_flit) && router_gather(n);
}

void net_foresee(struct net *n, net_early_fn *early)
{
    n->early = early;
    if (n->type == &net_link) net_link_foresee(n);
}

/* Arrivals are known ahead; but who follows a rule sees, when a message is sent, what is on the
 * links by then. */
bool net_defers(const struct net *n) { return n->type == &net_link && !n->routing; }

struct net *net_share(const struct net *n, void *context, struct arena *a)
{
    CHECK(n->type == &net_loggp && n->port_private && !n->path);
    struct net *share = TAKE(a, 1, struct net);
    *share = *n;
    share->context = context;
    return share;
}

bool net_takes(const struct net *n, int64_t bytes, char *text, size_t size)
{
    if (n->type == &net_loggp || n->type == &net_link) return true;
    const int64_t packets = net_packets(n, bytes), buffer = n->machine->network.buffer_flits;
    /* A message in one packet goes in pieces of a buffer's size. */
    const int64_t pieces =
        packets > 1 ? packets : net_packet_flits(n, bytes, 0) / (buffer > 0 ? buffer : 1) + 1;
    if (pieces <= INT32_MAX) return true;
    snprintf(text, size,
             "a message of %lld bytes is of %lld packets; level %s takes at most %d: a larger "
             "network.packet, or level link",
             (long long)bytes, (long long)pieces, n->type->name, INT32_MAX);
    return false;
}

void net_send(struct net *n, struct net_message *m)
{
    n->in_flight++;
    n->type->send(n, m);
}

/* T = R tau + (S - 1) flits + end, the same on every level (net_internal.h). */
sim_ps net_zero_load_of(const struct net *n, const struct net_message *m)
{
    struct net_rate slow;
    const sim_ps way = net_way(n, m, &slow);
    return way + net_rate_time(slow, net_flits(n, m->bytes) - 1) + net_end(n, m->bytes);
}

sim_ps net_zero_load(const struct net *n, int src, int dst, int64_t bytes)
{
    return net_zero_load_of(n, &(struct net_message){.src = src, .dst = dst, .bytes = bytes});
}

/* Without flits the unit is a byte, whose time need not be whole picoseconds. */
double net_flit_ps(const struct net *n)
{
    return n->link.flit ? (double)n->link.flit : n->link.byte;
}

bool net_occupy(struct net *n, int link, sim_ps now, sim_ps busy)
{
    if (!n->type->occupy) return false;
    n->type->occupy(n, link, now, busy);
    return true;
}

bool net_ask_others(struct net *n, net_others_fn *others, void *context)
{
    if (!n->type->asks) return false;
    n->others = others;
    n->others_context = context;
    return true;
}

/* Messages in the network and no event left: a cycle of full buffers, or none of the net's
 * making. */
bool net_deadlock(const struct net *n, char *text, int size)
{
    if (n->in_flight == 0 || !n->type->deadlock) return false;
    return n->type->deadlock(n, text, size);
}
