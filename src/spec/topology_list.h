/* topology_list.h - the families of topologies, one line each: all that rooms above need to know of
 * one.
 *
 * A new family is a line here and a file topology_WORD.c in room machine that defines
 * `topology_STEM`. Columns of X: constant, word in files, stem, how many numbers topology.dims has
 * (0: any), number of routers of `t` (a struct topology_spec, counted without overflow), traits. */
#ifndef SPEC_TOPOLOGY_LIST_H
#define SPEC_TOPOLOGY_LIST_H

#define TOPOLOGY_LIST(X)                                                                           \
    /* every node has one port; nothing shared but injection and ejection */                       \
    X(TOPOLOGY_CROSSBAR, "crossbar", crossbar, 1, t->dims[0], TOPOLOGY_NO_LINKS)                   \
    /* k-ary n-cube of mixed radix, dimension-order routes */                                      \
    X(TOPOLOGY_TORUS, "torus", torus, 0, product(t->dims, t->ndim),                                \
      TOPOLOGY_GRID | TOPOLOGY_RINGS)                                                              \
    /* the same without wrap links */                                                              \
    X(TOPOLOGY_MESH, "mesh", mesh, 0, product(t->dims, t->ndim), TOPOLOGY_GRID)                    \
    /* e-cube routes; `nodes_per_router` for bristled ones; dims: log2(routers) */                 \
    X(TOPOLOGY_HYPERCUBE, "hypercube", hypercube, 1, power(2, t->dims[0]), TOPOLOGY_CUBE)          \
    /* one shared resource */                                                                      \
    X(TOPOLOGY_BUS, "bus", bus, 1, t->dims[0], TOPOLOGY_NO_LINKS | TOPOLOGY_SHARED)                \
    /* a link between every two routers */                                                         \
    X(TOPOLOGY_FULL_MESH, "full-mesh", full_mesh, 1, t->dims[0], 0)                                \
    /* k-ary n-tree; dims: arity, levels */                                                        \
    X(TOPOLOGY_FAT_TREE, "fat-tree", fat_tree, 2, power(t->dims[0], t->dims[1]),                   \
      TOPOLOGY_OWN_NODES | TOPOLOGY_CHOOSES | TOPOLOGY_ABOVE)                                      \
    /* groups of routers, all-to-all inside and between groups; dims: terminals a router, routers  \
     * a group, global links a router, groups */                                                   \
    X(TOPOLOGY_DRAGONFLY, "dragonfly", dragonfly, 4,                                               \
      size_count(size_count(t->dims[0], t->dims[1]), t->dims[3]),                                  \
      TOPOLOGY_OWN_NODES | TOPOLOGY_CHOOSES)                                                       \
    /* all routers that differ in one coordinate are joined (flattened butterfly)        */        \
    X(TOPOLOGY_HYPERX, "hyperx", hyperx, 0, product(t->dims, t->ndim), TOPOLOGY_BUNDLES)           \
    /* McKay-Miller-Siran graphs of diameter 2; dims: q, a prime power */                          \
    X(TOPOLOGY_SLIM_FLY, "slim-fly", slim_fly, 1,                                                  \
      size_count(2, size_count(t->dims[0], t->dims[0])), 0)                                        \
    /* groups of leaves and spines; dims: nodes a leaf, leaves a group, spines a group, global     \
     * links a spine, groups */                                                                    \
    X(TOPOLOGY_DRAGONFLY_PLUS, "dragonfly-plus", dragonfly_plus, 5,                                \
      size_count(size_count(t->dims[0], t->dims[1]), t->dims[4]), TOPOLOGY_OWN_NODES)              \
    /* any radix and oversubscription; dims: nodes a leaf, switches below one of level 2, ... */   \
    X(TOPOLOGY_FOLDED_CLOS, "folded-clos", folded_clos, 0, product(t->dims, t->ndim),              \
      TOPOLOGY_OWN_NODES | TOPOLOGY_CHOOSES | TOPOLOGY_BUNDLES | TOPOLOGY_LEVELS | TOPOLOGY_ABOVE) \
    /* meshes and tori with further links between every i-th router */                             \
    X(TOPOLOGY_EXPRESS_MESH, "express-mesh", express_mesh, 0, product(t->dims, t->ndim),           \
      TOPOLOGY_GRID | TOPOLOGY_EXPRESS)                                                            \
    X(TOPOLOGY_EXPRESS_TORUS, "express-torus", express_torus, 0, product(t->dims, t->ndim),        \
      TOPOLOGY_GRID | TOPOLOGY_EXPRESS)                                                            \
    /* tori whose wrap links are shifted in dimension 0 */                                         \
    X(TOPOLOGY_TWISTED_TORUS, "twisted-torus", twisted_torus, 0, product(t->dims, t->ndim),        \
      TOPOLOGY_GRID | TOPOLOGY_TWISTED)                                                            \
    /* cables by chance; dims: routers, cables a router */                                         \
    X(TOPOLOGY_RANDOM_REGULAR, "random-regular", random_regular, 2, t->dims[0], TOPOLOGY_SEEDED)   \
    /* routers and links given in the file */                                                      \
    X(TOPOLOGY_GRAPH, "graph", graph, 1, t->dims[0], TOPOLOGY_LISTED | TOPOLOGY_BUNDLES)

/* What settings can act on a family. */
enum topology_trait {
    TOPOLOGY_NO_LINKS = 1,   /* there are no links between routers */
    TOPOLOGY_GRID = 2,       /* neighbours along dimensions: placement snake */
    TOPOLOGY_RINGS = 4,      /* two ways round, which may be equally long: topology.tie */
    TOPOLOGY_CUBE = 8,       /* binary numbers of routers: Xpress links, placement gray */
    TOPOLOGY_SHARED = 16,    /* one resource for all: every network level does the same */
    TOPOLOGY_OWN_NODES = 32, /* dims say how many nodes a router has */
    TOPOLOGY_CHOOSES = 64,   /* several routes: topology.routing */
    TOPOLOGY_LISTED = 128,   /* links come from the file: topology.links */
    TOPOLOGY_BUNDLES = 256,  /* several cables between two routers: topology.bundle */
    TOPOLOGY_LEVELS = 512,   /* levels of any number of switches: topology.up */
    TOPOLOGY_EXPRESS = 1024, /* further links of one length: topology.express */
    TOPOLOGY_TWISTED = 2048, /* shifted wrap links: topology.twist */
    TOPOLOGY_SEEDED = 4096,  /* drawn by chance: topology.seed */
    TOPOLOGY_ABOVE = 8192    /* switches above those with nodes: a way is half up, half down */
};

#endif
