/* net_way.h - ways by a rule of network.routing, for the levels that know one. */
#ifndef NET_NET_WAY_H
#define NET_NET_WAY_H

#include "machine/routing.h"
#include "net/net_internal.h"

/* net_way: how long the head of m takes from its injection to the destination's node in an empty
 * network; *slow becomes the slowest rate of that way. */
sim_ps net_way(const struct net *n, const struct net_message *m, struct net_rate *slow);

/* net_keep_ways: for many messages: keep each answer of net_way, if it depends on both routers
 * alone and the network is small. */
void net_keep_ways(struct net *n);

/* net_cables: the part of it that long links add to the hop latency. */
sim_ps net_cables(const struct net *n, const struct net_message *m);

/* net_route_begin: m's first packet at its source, for levels that follow a rule. */
struct route net_route_begin(const struct net *n, const struct net_message *m);

/* Levels packet (and auto) and flit where a packet may have several ways on (net_router.h). */
extern const struct net_type net_routed_packet, net_routed_flit;

#endif
