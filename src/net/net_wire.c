/* net_wire.c - what every level asks of the wire: sizes in packets and flits, routes, the slowest
 * rate of a route.
 *
 * A message is cut into packets, each with a header, in whole flits: for b bytes of payload in
 * packets of at most p bytes, header h and flits of f bytes, floor((b-1)/p) ceil((p+h)/f) +
 * ceil((last+h)/f) flits. */
#include "net/net_internal.h"
#include "net/net_way.h"

enum { MOST_KEPT = 512 }; /* routers of a network whose ways are kept */

int64_t net_packets(const struct net *n, int64_t bytes)
{
    int64_t most = n->machine->network.packet_bytes;
    return most > 0 && bytes > most ? (bytes + most - 1) / most : 1;
}

/* Payload and header in whole flits; an empty message is still one flit. */
static int64_t wire_flits(const struct net *n, int64_t payload)
{
    int64_t flits =
        (payload + n->machine->network.header_bytes + n->flit_bytes - 1) / n->flit_bytes;
    return flits > 0 ? flits : 1;
}

int64_t net_packet_flits(const struct net *n, int64_t bytes, int64_t index)
{
    int64_t most = n->machine->network.packet_bytes, packets = net_packets(n, bytes);
    CHECK(index >= 0 && index < packets);
    /* All packets are full but the last, which carries the rest. */
    return wire_flits(n, index < packets - 1 ? most : bytes - (packets - 1) * most * (packets > 1));
}

/* Every packet has a header of its own, hence not the flits of the sum of bytes. */
int64_t net_flits(const struct net *n, int64_t bytes)
{
    int64_t most = n->machine->network.packet_bytes;
    if (most <= 0 || bytes <= most) return wire_flits(n, bytes);
    int64_t full = (bytes + most - 1) / most - 1;
    return full * wire_flits(n, most) + wire_flits(n, bytes - full * most);
}

/* Random routes must not depend on how many numbers others have drawn: a hash, no stream. */
uint64_t net_choice(const struct net_message *m)
{
    uint64_t z = ((uint64_t)m->id + 1) * 0x9e3779b97f4a7c15u; /* splitmix64 */
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* One walk along the route serves both: the resources, and the rate that spreads the flits. */
int net_route(const struct net *n, const struct net_message *m, struct hop *route,
              struct net_rate *slowest)
{
    struct route_cursor c = topology_start(n->topology, m->src, m->dst, net_choice(m));
    struct net_rate slow = net_rate_slower(net_port(n, m->bytes)->rate, n->ejection);
    int h = 0;
    route[h++] =
        (struct hop){net_injection(n, m->src), 0, topology_injection_port(n->topology, m->src)};
    while (topology_next(n->topology, &c, &route[h])) {
        int link = route[h].link;
        slow = net_rate_slower(slow, n->link_rate ? n->link_rate[link] : n->link);
        route[h++].link = net_resource(n, link);
    }
    route[h] = (struct hop){net_ejection(n, m->dst), 0, 0};
    *slowest = slow;
    return h;
}

/* Where all links are alike and routes are fixed, the distance is known without a walk. */
struct net_rate net_slowest(const struct net *n, const struct net_message *m, int *nhop)
{
    struct net_rate slow = net_rate_slower(net_port(n, m->bytes)->rate, n->ejection);
    if (!n->link_rate && n->topology->fixed_routes) {
        *nhop = topology_distance(n->topology, m->src, m->dst);
        return *nhop > 0 ? net_rate_slower(slow, n->link) : slow;
    }
    struct route_cursor c = topology_start(n->topology, m->src, m->dst, net_choice(m));
    struct hop h;
    for (*nhop = 0; topology_next(n->topology, &c, &h); ++*nhop)
        slow = net_rate_slower(slow, n->link_rate ? n->link_rate[h.link] : n->link);
    return slow;
}

struct route net_route_begin(const struct net *n, const struct net_message *m)
{
    return routing_start(n->routing, m->src, m->dst, net_choice(m));
}

/* By a rule: the way of its first packet were there nobody else, and how many links it has. */
static sim_ps ruled_way(const struct net *n, const struct net_message *m, struct net_rate *slow)
{
    int nhop = 0, link;
    /* Where all links are alike only their number counts. */
    if (n->routing->minimal && !n->link_rate && !n->wire)
        return (topology_distance(n->topology, m->src, m->dst) + 1) * n->tau;
    struct route p = net_route_begin(n, m);
    sim_ps cables = 0;
    for (; routing_empty(n->routing, &p, &link); nhop++) {
        if (n->link_rate) *slow = net_rate_slower(*slow, n->link_rate[link]);
        if (n->wire) cables += n->wire[link];
    }
    return ps_later((nhop + 1) * n->tau, cables);
}

void net_keep_ways(struct net *n)
{
    const struct routing *r = n->routing;
    const int routers = n->topology->nrouter;
    const bool alike = !n->link_rate && (r->fixed || (r->minimal && !n->wire));
    if (alike && routers <= MOST_KEPT)
        n->way = TAKE_FULL(n->arena, size_product((size_t)routers, (size_t)routers), sim_ps, true);
}

sim_ps net_way(const struct net *n, const struct net_message *m, struct net_rate *slow)
{
    const struct topology *t = n->topology;
    int nhop;
    if (!n->routing) {
        *slow = net_slowest(n, m, &nhop);
        return (nhop + 1) * n->tau;
    }
    const int from = topology_router_of(t, m->src), to = topology_router_of(t, m->dst);
    *slow = net_rate_slower(net_port(n, m->bytes)->rate, n->ejection);
    if (!n->link_rate && from != to) *slow = net_rate_slower(*slow, n->link);
    if (!n->way) return ruled_way(n, m, slow);
    /* Zero is memory as it comes, and a way may take no time. */
    sim_ps *way = &n->way[from * t->nrouter + to];
    if (*way == 0) *way = 1 + ruled_way(n, m, slow);
    return *way - 1;
}

/* Walked anew: only who records a path asks. */
sim_ps net_cables(const struct net *n, const struct net_message *m)
{
    sim_ps cables = 0;
    int link;
    struct route p = net_route_begin(n, m);
    while (n->wire && routing_empty(n->routing, &p, &link)) cables += n->wire[link];
    return cables;
}

int net_head_port(const struct net *n, int resource)
{
    int from, to, port;
    if (net_is_injection(n, resource)) return topology_injection_port(n->topology, resource);
    CHECK(!net_is_ejection(n, resource));
    topology_link_ends(n->topology, resource - n->nnode, &from, &to, &port);
    return port;
}
