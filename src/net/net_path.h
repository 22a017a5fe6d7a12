/* net_path.h - what binds on a message's way, for levels that record critical paths: all of it
 * where n->path is. */
#ifndef NET_NET_PATH_H
#define NET_NET_PATH_H

#include "measure/path.h"
#include "net/net_internal.h"

/* net_path_take: a message of `bytes`, whose head is at `resource` at node `own`, takes it at time
 * `at`, now or when it is free; returns that node. net_path_others: the resource serves other
 * users' messages first. */
uint32_t net_path_take(struct net *n, int resource, uint32_t own, sim_ps at, int64_t bytes);
void net_path_others(struct net *n, int resource);

/* net_path_hops: `hops` hop latencies later, towards `resource` (-1: all of a route).
 * net_path_cable: `wire` later, what the link `resource` (-1: all of a route) adds to one.
 * net_path_way: `way` later, which is what net_way says of m: hop latencies, then cables.
 * net_path_tail: the tail's arrival when its head crossed the last resource at `before`.
 * net_path_whole (net_internal.h): m->path from ready to arrival, on levels that do not say more.
 */
uint32_t net_path_hops(const struct net *n, uint32_t before, int hops, int resource);
uint32_t net_path_cable(const struct net *n, uint32_t before, sim_ps wire, int resource);
uint32_t net_path_way(const struct net *n, uint32_t before, const struct net_message *m,
                      sim_ps way);
uint32_t net_path_tail(const struct net *n, uint32_t before, struct net_rate slow, int64_t bytes);

#endif
