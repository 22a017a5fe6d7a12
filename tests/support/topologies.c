/* topologies.c - see topologies.h. */
#include "topologies.h"

static const int petersen[15][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {0, 5}, {1, 6}, {2, 7},
                                    {3, 8}, {4, 9}, {5, 7}, {7, 9}, {9, 6}, {6, 8}, {8, 5}};
static const int star_and_tail[6][2] = {{3, 0}, {3, 1}, {2, 3}, {3, 4}, {4, 5}, {6, 5}};

static const int bundle_2_3[] = {2, 3};

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
