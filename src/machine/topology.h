/* topology.h - routers, links and routes of every family; no time in here.
 *
 * Nodes hang on routers (`nodes_per_router`), ranks on the processors of nodes (placement.h). A
 * route is a sequence of directed links. Dimension 0 is fastest in the numbering: router = x0 + k0
 * (x1 + k1 (x2 ...)). */
#ifndef MACHINE_TOPOLOGY_H
#define MACHINE_TOPOLOGY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "spec/machine_spec.h"

/* A directed link between two routers, one step of a route. */
struct hop {
    int link;     /* 0 .. nlink-1 */
    int vc_class; /* dateline class to use on it, 0 .. nclass-1 */
    int port;     /* the input port at the router that it leads to, as of topology_link_ends */
};

/* A walk along one route: begun by topology_start, advanced by topology_next. Plain data, may be
 * copied. */
struct route_cursor {
    int router;   /* where the head is */
    int target;   /* the destination's router */
    int stage;    /* of the family: dimension, level, leg; negative: topology_failed.c */
    int left;     /* of the family: steps left in this stage */
    int step, at; /* of the family: direction, coordinate */
    int via;      /* of the family: intermediate group or router, -1: none */
};

struct topology {
    const struct topology_spec *spec; /* borrowed */
    int nnode, nrouter, nlink;        /* links are directed */
    int nodes_per_router;             /* nodes i nodes_per_router .. on router i */
    /* largest number of links into a router; injection ports are numbered from here */
    int nport;
    int nclass;        /* virtual-channel classes that its routes need to be free of deadlock */
    int max_hops;      /* longest route in links */
    bool fixed_routes; /* a route depends on its ends alone, not on `choice` */
    const struct topology_type *type;
    void *state; /* of the family */
};

/* topology_create: the network of `s`, memory from `a`. Returns NULL with ERR_CONFIG when the
 * numbers do not fit. */
struct topology *topology_create(const struct topology_spec *s, struct arena *a, struct err *e);

/* topology_route: the links from node `src` to node `dst` into route[max_hops]; returns how many
 * (0: same router). `choice` selects among equally good random routes where the family has them
 * (Valiant), else ignored. */
int topology_route(const struct topology *t, int src, int dst, uint64_t choice, struct hop *route);

/* topology_start, topology_next: the same route step by step. topology_next returns false when the
 * walk is over. */
struct route_cursor topology_start(const struct topology *t, int src, int dst, uint64_t choice);
bool topology_next(const struct topology *t, struct route_cursor *c, struct hop *h);

/* topology_distance: number of links of that route without writing it. */
int topology_distance(const struct topology *t, int src, int dst);

/* topology_link_ends: the routers that directed link `link` joins, and its input-port number at
 * *to's router (dimension order: from +, from - of dimension 0, then 1, ...; injection is last). */
void topology_link_ends(const struct topology *t, int link, int *from, int *to, int *port);

/* topology_uniform: all links have the same rate. */
bool topology_uniform(const struct topology *t);

/* topology_link_bandwidth: rate of a link relative to the machine's link rate (1 unless the file
 * says otherwise). */
double topology_link_bandwidth(const struct topology *t, int link, double link_bandwidth);

/* topology_link_latency: what its cable takes longer than network.hop_latency [s]. */
double topology_link_latency(const struct topology *t, int link);

/* topology_injection_port: number of node `node`'s input port at its router, after those of all
 * links. */
int topology_injection_port(const struct topology *t, int node);

/* topology_router_of: the router of node `node`. */
int topology_router_of(const struct topology *t, int node);

/* The routers that the working links of each router lead to, one for each of parallel links, in the
 * order of their numbers: of router r to[first[r]] .. to[first[r + 1] - 1]. */
struct topology_neighbours {
    const int *first, *to;
};

/* topology_neighbours: of all routers of t, memory from `a`. */
struct topology_neighbours topology_neighbours(const struct topology *t, struct arena *a);

/* topology_parts: sizes of the parts that the network consists of besides single routers and the
 * whole, in nodes, as its family knows them; parts are blocks of consecutive nodes. Into size
 * (TOPOLOGY_PARTS); returns how many. */
enum { TOPOLOGY_PARTS = 32 };
int topology_parts(const struct topology *t, int64_t *size);

/* topology_link_works, topology_router_works: whether nothing of network.failed says otherwise. A
 * route never meets what does not work; no node of such a router may take part in one.
 * topology_whole: everything works. */
bool topology_link_works(const struct topology *t, int link);
bool topology_router_works(const struct topology *t, int router);
bool topology_whole(const struct topology *t);

#endif
