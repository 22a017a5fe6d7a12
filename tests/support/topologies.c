/* topologies.c - see topologies.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "topologies.h"

static const int petersen[15][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {0, 5}, {1, 6}, {2, 7},
                                    {3, 8}, {4, 9}, {5, 7}, {7, 9}, {9, 6}, {6, 8}, {8, 5}};
static const int star_and_tail[6][2] = {{3, 0}, {3, 1}, {2, 3}, {3, 4}, {4, 5}, {6, 5}};

static const int bundle_2_3[] = {2, 3}, up_2[] = {2}, up_2_3[] = {2, 3}, twist_3[] = {3},
                 twist_2_1[] = {2, 1}, weights[15] = {3, 1, 1, 1, 5, 1, 2, 1, 1, 1, 4, 1, 1, 1, 1},
                 cables[6] = {1, 2, 1, 3, 1, 1};

#define LISTS(stem, list) .n##stem = sizeof(list) / sizeof *(list), .stem = (int *)(list)

#define GRAPH(table) .nlink = sizeof(table) / sizeof *(table), .link = (int(*)[2])(table)
#define ONE .nodes_per_router = 1, .processors_per_node = 1

static const struct named_topology all[] = {
    {"crossbar 5", {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {5}, ONE}, true},
    {"ring 4", {.family = TOPOLOGY_TORUS, .ndim = 1, .dims = {4}, ONE}, true},
    {"ring 7", {.family = TOPOLOGY_TORUS, .ndim = 1, .dims = {7}, ONE}, true},
    {"torus 4x4x8", {.family = TOPOLOGY_TORUS, .ndim = 3, .dims = {4, 4, 8}, ONE}, true},
    {"torus 4x4x8 by parity", {.family = TOPOLOGY_TORUS, .ndim = 3, .dims = {4, 4, 8},
     .tie = TIE_PARITY, ONE}, true},
    {"torus 5x1x2x3", {.family = TOPOLOGY_TORUS, .ndim = 4, .dims = {5, 1, 2, 3}, ONE}, true},
    {"torus 2x2 by parity", {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {2, 2},
     .tie = TIE_PARITY, ONE}, true},
    {"torus 6x3, 2 nodes per router",
     {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {6, 3}, .nodes_per_router = 2,
      .processors_per_node = 2},
     true},
    {"mesh 8x8", {.family = TOPOLOGY_MESH, .ndim = 2, .dims = {8, 8}, ONE}, true},
    {"mesh 1x8", {.family = TOPOLOGY_MESH, .ndim = 2, .dims = {1, 8}, ONE}, true},
    {"mesh 3x4x5", {.family = TOPOLOGY_MESH, .ndim = 3, .dims = {3, 4, 5}, ONE}, true},
    {"hypercube 0", {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {0}, ONE}, true},
    {"hypercube 6", {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {6}, ONE}, true},
    {"hypercube 2 with Xpress links, 2 nodes per router",
     {.family = TOPOLOGY_HYPERCUBE,
      .ndim = 1,
      .dims = {2},
      .xpress = true,
      .nodes_per_router = 2,
      .processors_per_node = 2},
     true},
    {"hypercube 1 with Xpress links, 2 nodes per router",
     {.family = TOPOLOGY_HYPERCUBE,
      .ndim = 1,
      .dims = {1},
      .xpress = true,
      .nodes_per_router = 2,
      .processors_per_node = 2},
     true},
    {"hypercube 3 with Xpress links",
     {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {3}, .xpress = true, ONE},
     true},
    {"bus 4", {.family = TOPOLOGY_BUS, .ndim = 1, .dims = {4}, ONE}, false},
    {"full mesh 6", {.family = TOPOLOGY_FULL_MESH, .ndim = 1, .dims = {6}, ONE}, true},
    {"fat tree 4^3", {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {4, 3}, ONE}, true},
    {"fat tree 2^5", {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {2, 5}, ONE}, true},
    {"fat tree 3^3, random",
     {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {3, 3}, .routing = ROUTE_VALIANT, ONE},
     true},
    {"fat tree 3^1", {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {3, 1}, ONE}, true},
    {"dragonfly 2 4 2", {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2,
     0}, ONE}, false},
    {"dragonfly 1 4 2 in 4 groups", {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2,
     4}, ONE}, false},
    {"dragonfly 2 4 2, Valiant",
     {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 0}, .routing = ROUTE_VALIANT, ONE},
     false},
    {"dragonfly 2 4 2, absolute",
     {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 0}, .absolute = true, ONE},
     false},
    {"dragonfly 1 4 2 in 4 groups, absolute",
     {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2, 4}, .absolute = true, ONE},
     false},
    {"hyperx 4x3x2", {.family = TOPOLOGY_HYPERX, .ndim = 3, .dims = {4, 3, 2}, ONE}, true},
    {"hyperx 3x4, bundles, 2 nodes per router",
     {.family = TOPOLOGY_HYPERX,
      .ndim = 2,
      .dims = {3, 4},
      .nbundle = 2,
      .bundle = (int *)bundle_2_3,
      .nodes_per_router = 2,
      .processors_per_node = 1},
     true},
    {"hyperx 7", {.family = TOPOLOGY_HYPERX, .ndim = 1, .dims = {7}, ONE}, true},
    {"slim fly 3", {.family = TOPOLOGY_SLIM_FLY, .ndim = 1, .dims = {3}, ONE}, true},
    {"slim fly 4", {.family = TOPOLOGY_SLIM_FLY, .ndim = 1, .dims = {4}, ONE}, true},
    {"slim fly 5, 2 nodes per router",
     {.family = TOPOLOGY_SLIM_FLY,
      .ndim = 1,
      .dims = {5},
      .nodes_per_router = 2,
      .processors_per_node = 1},
     true},
    {"dragonfly+ 2 3 2 2",
     {.family = TOPOLOGY_DRAGONFLY_PLUS, .ndim = 5, .dims = {2, 3, 2, 2, 5}, ONE},
     true},
    {"dragonfly+ 1 2 3 2 in 3 groups",
     {.family = TOPOLOGY_DRAGONFLY_PLUS, .ndim = 5, .dims = {1, 2, 3, 2, 3}, ONE},
     true},
    {"folded Clos 6-4 with 2 above, 2 cables",
     {.family = TOPOLOGY_FOLDED_CLOS,
      .ndim = 2,
      .dims = {6, 4},
      LISTS(up, up_2),
      LISTS(bundle, up_2),
      ONE},
     true},
    {"folded Clos 2-3-4 with 2 and 3 above",
     {.family = TOPOLOGY_FOLDED_CLOS, .ndim = 3, .dims = {2, 3, 4}, LISTS(up, up_2_3), ONE},
     true},
    {"folded Clos 2-3-4, random",
     {.family = TOPOLOGY_FOLDED_CLOS,
      .ndim = 3,
      .dims = {2, 3, 4},
      LISTS(up, up_2_3),
      LISTS(bundle, bundle_2_3),
      .routing = ROUTE_VALIANT,
      ONE},
     true},
    {"folded Clos 3-2-1, a level to spare",
     {.family = TOPOLOGY_FOLDED_CLOS, .ndim = 3, .dims = {3, 2, 1}, LISTS(up, up_2_3), ONE},
     true},
    {"folded Clos of one switch",
     {.family = TOPOLOGY_FOLDED_CLOS, .ndim = 1, .dims = {5}, ONE},
     true},
    {"express mesh 11x6",
     {.family = TOPOLOGY_EXPRESS_MESH, .ndim = 2, .dims = {11, 6}, .express = 3, ONE},
     false},
    {"express torus 12x1x4",
     {.family = TOPOLOGY_EXPRESS_TORUS, .ndim = 3, .dims = {12, 1, 4}, .express = 2, ONE},
     false},
    {"express torus 16", {.family = TOPOLOGY_EXPRESS_TORUS, .ndim = 1, .dims = {16}, .express = 4,
     ONE}, false},
    {"twisted torus 6x3",
     {.family = TOPOLOGY_TWISTED_TORUS, .ndim = 2, .dims = {6, 3}, LISTS(twist, twist_3), ONE},
     true},
    {"twisted torus 5x4x3, 2 nodes per router",
     {.family = TOPOLOGY_TWISTED_TORUS,
      .ndim = 3,
      .dims = {5, 4, 3},
      LISTS(twist, twist_2_1),
      .nodes_per_router = 2,
      .processors_per_node = 1},
     true},
    {"random regular 20 of degree 4",
     {.family = TOPOLOGY_RANDOM_REGULAR, .ndim = 2, .dims = {20, 4}, .seed = 7, ONE},
     true},
    {"Petersen graph, weighted",
     {.family = TOPOLOGY_GRAPH,
      .ndim = 1,
      .dims = {10},
      GRAPH(petersen),
      LISTS(link_weight, weights),
      ONE},
     false},
    {"star with a tail of bundles",
     {.family = TOPOLOGY_GRAPH,
      .ndim = 1,
      .dims = {7},
      GRAPH(star_and_tail),
      LISTS(bundle, cables),
      ONE},
     true},
    {"Petersen graph", {.family = TOPOLOGY_GRAPH, .ndim = 1,
     .dims = {10}, GRAPH(petersen), ONE}, true},
    {"star with a tail", {.family = TOPOLOGY_GRAPH, .ndim = 1,
     .dims = {7}, GRAPH(star_and_tail), ONE}, true},
};

const struct named_topology *named_topologies(int *n)
{
    *n = sizeof all / sizeof *all;
    return all;
}

struct topology *topology_made(const struct topology_spec *s, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(s, a, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

/* One node on each router unless the test says otherwise. */
struct topology_spec topology_spec_of(enum topology_family f, int ndim, const int *dims)
{
    struct topology_spec s = {
        .family = f, .ndim = ndim, .nodes_per_router = 1, .processors_per_node = 1};
    for (int d = 0; d < ndim; d++) s.dims[d] = dims[d];
    return s;
}

/* The message of a network that cannot be has to name what is wrong with it. */
void topology_refused(const struct topology_spec *s, const char *word)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    assert_null(topology_create(s, a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    if (!strstr(e.text, word)) fail_msg("\"%s\" does not name \"%s\"", e.text, word);
    arena_destroy(a);
}

/* How many nodes are 0, 1, 2, ... links from `node`. */
void topology_distances(const struct topology *t, int node, int count[TOPOLOGY_FARTHEST])
{
    memset(count, 0, TOPOLOGY_FARTHEST * sizeof *count);
    for (int i = 0; i < t->nnode; i++) {
        int d = topology_distance(t, node, i);
        assert_in_range(d, 0, TOPOLOGY_FARTHEST - 1);
        count[d]++;
    }
}

/* How many routes between all pairs of nodes use each link. */
void topology_loads(const struct topology *t, int load[TOPOLOGY_MANY])
{
    assert_true(t->nlink <= TOPOLOGY_MANY);
    memset(load, 0, TOPOLOGY_MANY * sizeof *load);
    for (int i = 0; i < t->nnode; i++)
        for (int j = 0; j < t->nnode; j++) {
            struct hop route[TOPOLOGY_FARTHEST];
            int n = topology_route(t, i, j, 0, route);
            for (int k = 0; k < n; k++) load[route[k].link]++;
        }
}
