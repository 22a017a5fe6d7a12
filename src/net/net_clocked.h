/* net_clocked.h - lists of messages on routers of one clock: the levels of net_router.h in whole
 * cycles and small records.
 *
 * Where all times are multiples of one that is not too short, that of a flit or a part of it, and
 * every message is one packet, a list needs no event queue and no picoseconds: a wheel of cycles
 * with a bit for each router and node, and records of a cache line. What is looked at when, in what
 * order, and what comes of it, are those of net_router_gather.c, which plays everything else; the
 * tests compare both. */
#ifndef NET_NET_CLOCKED_H
#define NET_NET_CLOCKED_H

#include "net/net.h"

/* Messages without dependencies. */
struct clocked_list {
    int count;
    const int *src, *dst; /* (count) nodes */
    const int64_t *bytes; /* (count) */
    const sim_ps *time;   /* (count) */
    const int *order;     /* (count) by (time, number); NULL: they are in this order */
    sim_ps stop;          /* nothing that happens later is simulated [ps]; 0: all is */
};

/* What it comes to. */
struct clocked_result {
    sim_ps *arrival, *injected; /* (count) in: SIM_NEVER; NULL: not wanted */
    sim_ps makespan;            /* last arrival */
    int arrived;
    int64_t events;  /* as if cycles were events */
    uint64_t digest; /* of these */
};

/* net_clocked: play `q` on network n, over which nothing has moved yet. False: it is not for this
 * network or list, or messages are left that nothing can move; then n is as it was. */
bool net_clocked(struct net *n, const struct clocked_list *q, struct clocked_result *r);

#endif
