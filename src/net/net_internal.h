/* net_internal.h - what the levels share: resources, their rates, sizes on the wire, accounts and
 * delivery.
 *
 * A message passes resources h = 0 .. R: its node's injection port, its links, the ejection port of
 * the destination; R = links + 1. Its head crosses resource h at x_h, x_0 >= ready and x_{h+1} >=
 * x_h + tau, and its tail is delivered at x_R + tail + end, where tail is the time of all its flits
 * but the first at the slowest rate of the route. With nothing in the way that is ready + R tau +
 * tail + end on every level. Without flits in the spec a flit is a byte. All times are integer
 * picoseconds, converted once by net_create. */
#ifndef NET_NET_INTERNAL_H
#define NET_NET_INTERNAL_H

#include "base/check.h"
#include "base/picoseconds.h"
#include "machine/topology.h"
#include "net/net.h"
#include "net/net_keys.h"

/* How fast a resource moves flits. */
struct net_rate {
    sim_ps flit; /* time of one flit [ps], exact; 0 when a flit is a byte */
    double byte; /* time of one byte [ps], used when flit is 0 */
};

/* net_rate_time: time that `flits` flits take at rate r. */
static inline sim_ps net_rate_time(struct net_rate r, int64_t flits)
{
    return r.flit ? ps_times(flits, r.flit) : ps_rounded((double)flits * r.byte);
}

/* net_rate_slower: the slower of two rates. */
static inline struct net_rate net_rate_slower(struct net_rate a, struct net_rate b)
{
    return a.byte >= b.byte ? a : b;
}

/* What an injection port, and the interfaces at both ends, do with messages of one range of
 * sizes. */
struct net_port {
    int64_t below;       /* the first size of the next range, INT64_MAX: none */
    struct net_rate rate; /* includes the interface's gap per byte */
    sim_ps gap;          /* the software's g [ps] */
    sim_ps end;          /* end latency, with that of the segment [ps] */
};

struct routing;
struct net {
    const struct net_type *type;
    const struct machine_spec *machine; /* borrowed */
    const struct topology *topology;    /* borrowed */
    struct sim *sim;                    /* borrowed */
    struct arena *arena;                /* borrowed */
    net_deliver_fn *deliver;
    void *context, *others_context;
    net_others_fn *others; /* NULL: nobody is asked (net_ask_others) */
    net_early_fn *early;   /* NULL: nobody is told (net_foresee) */
    /* latencies: hop, credit, channel of a head, route and channel [ps] */
    sim_ps tau, credit, allocation, setup;
    int64_t flit_bytes;                        /* >= 1 */
    struct net_rate ejection, link;
    struct net_port port[SOFTWARE_MAX_SEGMENTS]; /* (nport) the injection ports by rising size */
    int nport;
    /* (nlink), NULL when all links have the rate `link` */
    struct net_rate *link_rate;
    int nnode, nlink, nresource;
    /* messages of one node are handed over in the order of their ready times */
    bool port_private;
    int64_t in_flight;       /* messages accepted and not yet delivered */
    struct link_load *load;  /* (njob x nresource), NULL unless wanted; who each is: net_links */
    /* of a network with more than NET_LINKS_WHOLE resources: which parts of NET_LOADS of them are
     * in use; else NULL */
    _Atomic bool *load_used;
    int njob;                /* whose messages are counted apart (net_count_jobs) */
    struct routing *routing; /* NULL: the topology's routes, cables all alike (net_way.h) */
    sim_ps *way;             /* (nrouter x nrouter) 1 + net_way, 0: not known; NULL: not kept */
    sim_ps *wire;            /* (nlink) what cables add to the hop latency; NULL: nothing */
    struct path_log *path;  /* critical paths (net_path.h), NULL unless recorded; borrowed */
    struct net_hold *hold;  /* (nresource) with path */
    /* host memory of a message on its way, of each resource on it, and of a resource from its first
     * use on (net_memory) [B] */
    size_t message_bytes, hop_bytes, resource_bytes;
    void *state;            /* of the level */
};

/* Every level's own. */
#define X(constant, word, stem, cost, fineness) extern const struct net_type net_##stem;
LEVEL_LIST(X)
#undef X

/* net_link_foresee (net_link.c): announce arrivals at level link to n->early. */
void net_link_foresee(struct net *n);

/* Resources are numbered: injection ports of nodes, then links, then ejection ports. */
static inline int net_injection(const struct net *n, int node) { return (void)n, node; }
static inline int net_resource(const struct net *n, int link) { return n->nnode + link; }
static inline int net_ejection(const struct net *n, int node) { return n->nnode + n->nlink + node; }
static inline bool net_is_injection(const struct net *n, int resource)
{
    return resource < n->nnode;
}
static inline bool net_is_ejection(const struct net *n, int resource)
{
    return resource >= n->nnode + n->nlink;
}

/* net_port: how the injection ports serve a message of `bytes` payload. */
static inline const struct net_port *net_port(const struct net *n, int64_t bytes)
{
    const struct net_port *p = n->port;
    while (bytes >= p->below) p++;
    return p;
}

/* net_end: its end latency. */
static inline sim_ps net_end(const struct net *n, int64_t bytes) { return net_port(n, bytes)->end; }

/* net_resource_rate: the rate of a resource for a message of `bytes` payload. */
static inline struct net_rate net_resource_rate(const struct net *n, int resource, int64_t bytes)
{
    if (net_is_injection(n, resource)) return net_port(n, bytes)->rate;
    if (net_is_ejection(n, resource)) return n->ejection;
    return n->link_rate ? n->link_rate[resource - n->nnode] : n->link;
}

/* net_packets: how many packets carry `bytes` of payload (>= 1); net_packet_flits: the flits of
 * packet `index` of them, header included (>= 1). All together: net_flits. */
int64_t net_packets(const struct net *n, int64_t bytes);
int64_t net_packet_flits(const struct net *n, int64_t bytes, int64_t index);

/* net_choice: the number that selects among random routes, a hash of the message's id. */
uint64_t net_choice(const struct net_message *m);

/* net_route: the resources of m's whole way, injection first, ejection last, into route[max_hops +
 * 2] (`link` holds resource numbers); returns R. *slowest becomes the slowest rate of the route. */
int net_route(const struct net *n, const struct net_message *m, struct hop *route,
              struct net_rate *slowest);

/* net_slowest: the slowest rate of m's route, *nhop its number of links. */
struct net_rate net_slowest(const struct net *n, const struct net_message *m, int *nhop);

/* net_head_port: the input port through which a message that comes over `resource` enters the next
 * router. */
int net_head_port(const struct net *n, int resource);

/* net_port_busy: how long the `flits` flits of a message of `bytes` take an injection port, the gap
 * g included. */
static inline sim_ps net_port_busy(const struct net *n, int64_t bytes, int64_t flits)
{
    const struct net_port *p = net_port(n, bytes);
    sim_ps flit = net_rate_time(p->rate, 1);
    return net_rate_time(p->rate, flits - 1) + (p->gap > flit ? p->gap : flit);
}

/* net_arrive: hand m over, its three times filled in. net_path_whole: net_path.h. */
void net_path_whole(const struct net *n, struct net_message *m);
static inline void net_arrive(struct net *n, struct net_message *m)
{
    n->in_flight--;
    if (n->path && !n->type->paths) net_path_whole(n, m);
    n->deliver(n->context, m);
}

#endif
