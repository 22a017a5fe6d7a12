/* machine_spec.h - everything that is known of a machine: nodes, network, message software,
 * placement, noise.
 *
 * Plain data in SI units, filled by room plan from machines/NAME.yaml and `--set`; its field table
 * is in machine_spec.c. Semantics of the network numbers: room net, docs/network.md. */
#ifndef SPEC_MACHINE_SPEC_H
#define SPEC_MACHINE_SPEC_H

#include <stdbool.h>
#include <stdint.h>

#include "spec/network_spec.h"
#include "spec/node_spec.h"
#include "spec/price_spec.h"
#include "spec/software_spec.h"
#include "spec/topology_list.h"

enum { MACHINE_MAX_DIMS = 8 };

enum topology_family {
#define X(constant, word, stem, ndim, routers, traits) constant,
    TOPOLOGY_LIST(X)
#undef X
};

enum tie_rule {
    TIE_POSITIVE, /* half-way round a ring: always + */
    TIE_PARITY,   /* + from an even coordinate, - from an odd one */
    TIE_RANDOM    /* either, by chance for each message and dimension */
};

enum dragonfly_routing { ROUTE_MINIMAL, ROUTE_VALIANT }; /* fat tree: d-mod-k, up ports at random */

struct topology_spec {
    enum topology_family family;
    int ndim; /* torus, mesh: number of dimensions; hypercube: 1, dims[0] = log2(routers) */
    int dims[MACHINE_MAX_DIMS]; /* radix of each dimension, dimension 0 fastest; fat tree: {arity,
                                   levels}; dragonfly: {terminals/router, routers/group, global
                                   links/router, groups}; crossbar, bus, full mesh, graph: {routers}
                                 */
    double dim_bandwidth[MACHINE_MAX_DIMS]; /* link rate of each dimension [B/s], 0: the link's */
    double dim_latency[MACHINE_MAX_DIMS];   /* further latency of each dimension's links [s] */
    int nodes_per_router;           /* >= 1 */
    int processors_per_node;        /* >= 1 */
    enum tie_rule tie;
    enum dragonfly_routing routing;
    bool absolute;                  /* dragonfly: global links numbered by the group they lead to */
    bool xpress;                    /* Origin: further links on the routers' spare ports */
    int nbundle;                    /* entries of bundle, 0: one cable everywhere */
    int *bundle;    /* (nbundle) parallel cables, borrowed. hyperx: by dimension; folded-clos: from
                       each level upwards; graph: of each link */
    int nup;
    int *up;        /* folded-clos: (nup) switches above each switch, level by level; borrowed */
    int ntwist;
    int *twist;     /* twisted-torus: (ntwist) shift of the wrap links of dimension 1, 2, ... */
    int express;    /* express-mesh, express-torus: length of an express link in routers */
    uint64_t seed;  /* random-regular */
    int nlink;                      /* graph: number of undirected links, 0 otherwise */
    int (*link)[2]; /* graph: (nlink x 2) router pairs, borrowed from the arena of the plan */
    int nlink_percent;              /* graph: 0, nlink or 2 nlink */
    int *link_percent; /* graph: rate of each link, or there and back of each, in % of the link's */
    int nfailed_link, nfailed_router;
    int (*failed_link)[2]; /* (nfailed_link) joined routers whose cable does not work, borrowed */
    int *failed_router;    /* (nfailed_router) that do not work, borrowed */
    int nlink_weight;  /* graph: 0 or nlink */
    int *link_weight;  /* graph: what a route over each link counts, borrowed */
};

enum placement_kind { PLACEMENT_LINEAR, PLACEMENT_SNAKE, PLACEMENT_GRAY, PLACEMENT_RANDOM,
                      PLACEMENT_LIST, PLACEMENT_GROUPS };
enum spread_kind { SPREAD_BLOCK, SPREAD_CYCLIC };

struct placement_spec {
    enum placement_kind kind;
    enum spread_kind spread;  /* ranks over the processors of a node */
    uint64_t seed;            /* random */
    int nlist;
    int *list;                /* list: (nlist) processor of each rank, borrowed */
};

struct noise_spec {
    double compute_cv;        /* coefficient of variation of each computation, 0: off */
    double background_load;   /* fraction of each link's time taken by others, 0: off */
    int64_t background_bytes; /* size of a background message [B] */
};

struct machine_spec {
    char name[64];            /* the file's stem */
    char label[96]; /* for people: what it is called in tables and figures, "": its name */
    char title[128];          /* for people: one line of description */
    struct topology_spec topology;
    struct node_spec node;
    struct network_spec network;
    struct software_spec software;
    struct placement_spec placement;
    struct noise_spec noise;
    struct price_spec price;
};

/* topology_has: whether a family has a trait (topology_list.h). topology_family_dims: how many
 * numbers topology.dims takes, 0: any. topology_family_name: its word in files. */
bool topology_has(enum topology_family f, enum topology_trait trait);
int topology_family_dims(enum topology_family f);
const char *topology_family_name(enum topology_family f);

/* network_level_name: the word in files, of any level. network_levels_by_cost, _by_fineness,
 * _by_name: all levels, the cheapest first, the finest first, in the order of their words. */
const char *network_level_name(enum network_level level);
void network_levels_by_cost(enum network_level level[LEVELS]);
void network_levels_by_fineness(enum network_level level[LEVELS]);
void network_levels_by_name(enum network_level level[LEVELS]);

/* machine_spec_processors: how many ranks the machine can hold: routers x nodes_per_router x
 * processors_per_node. A fat tree has arity^levels nodes and a dragonfly terminals x routers x
 * groups, whatever nodes_per_router says. */
int64_t machine_spec_processors(const struct machine_spec *m);

#endif
