/* test_topology_measure.c - distances, ways and cuts of networks against closed forms, and every
 * bisection against a search through all halves of small networks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"
#include "machine/topology_measure.h"

static struct topology_measure measured(const struct topology_spec *s, struct arena *a)
{
    return topology_measure(topology_made(s, a), a);
}

static bool close_to(double x, double y) { return x > y - 1e-9 && x < y + 1e-9; }

/* ---- cuts */

/* The fewest cables between halves with equally many nodes (or one router's more), by trying all
 * sets of routers. */
static int64_t least_cut(const struct topology *t, struct arena *a)
{
    int n = t->nrouter, *from = TAKE(a, t->nlink + 1, int), *to = TAKE(a, t->nlink + 1, int), port;
    int with_nodes = t->nnode / t->nodes_per_router;
    int64_t least = INT64_MAX;
    for (int l = 0; l < t->nlink; l++) topology_link_ends(t, l, &from[l], &to[l], &port);
    for (unsigned set = 0; set < 1u << n; set++) {
        int inside = __builtin_popcount(set & ((1u << with_nodes) - 1));
        if (inside != with_nodes / 2) continue;
        int64_t cut = 0;
        for (int l = 0; l < t->nlink; l++) cut += (set >> from[l] & 1) && !(set >> to[l] & 1);
        if (cut < least) least = cut;
    }
    return least;
}

struct small {
    enum topology_family family;
    int ndim, dims[5];
    bool exact; /* it has a closed form */
};

static const struct small small_ones[] = {
    {TOPOLOGY_TORUS, 1, {8}, true},
    {TOPOLOGY_TORUS, 1, {9}, true},
    {TOPOLOGY_TORUS, 2, {4, 4}, true},
    {TOPOLOGY_TORUS, 2, {5, 3}, true},
    {TOPOLOGY_TORUS, 2, {3, 4}, true},
    {TOPOLOGY_TORUS, 2, {5, 2}, true},
    {TOPOLOGY_TORUS, 3, {2, 3, 2}, true},
    {TOPOLOGY_TORUS, 4, {2, 2, 2, 2}, true},
    {TOPOLOGY_TORUS, 3, {1, 7, 2}, true},
    {TOPOLOGY_MESH, 1, {7}, true},
    {TOPOLOGY_MESH, 2, {4, 4}, true},
    {TOPOLOGY_MESH, 2, {3, 5}, true},
    {TOPOLOGY_MESH, 2, {5, 2}, true},
    {TOPOLOGY_MESH, 3, {3, 3, 1}, true},
    {TOPOLOGY_MESH, 3, {2, 2, 3}, true},
    {TOPOLOGY_HYPERCUBE, 1, {4}, true},
    {TOPOLOGY_FULL_MESH, 1, {7}, true},
    {TOPOLOGY_FULL_MESH, 1, {10}, true},
    {TOPOLOGY_FAT_TREE, 2, {2, 3}, true},
    {TOPOLOGY_FAT_TREE, 2, {4, 2}, true},
    {TOPOLOGY_FAT_TREE, 2, {3, 2}, false},
    {TOPOLOGY_HYPERX, 2, {4, 4}, true},
    {TOPOLOGY_HYPERX, 2, {3, 5}, true},
    {TOPOLOGY_HYPERX, 2, {5, 2}, true},
    {TOPOLOGY_HYPERX, 3, {2, 3, 2}, true},
    {TOPOLOGY_HYPERX, 2, {3, 3}, true},
    {TOPOLOGY_DRAGONFLY, 4, {1, 2, 1, 3}, false},
    {TOPOLOGY_DRAGONFLY, 4, {2, 4, 1, 4}, false},
    {TOPOLOGY_DRAGONFLY_PLUS, 5, {1, 2, 2, 1, 3}, false},
    {TOPOLOGY_SLIM_FLY, 1, {3}, false},
    {TOPOLOGY_RANDOM_REGULAR, 2, {14, 4}, false},
};

/* The closed forms are the least cut, and partitioning finds it on everything that is small. */
static void bisections_are_the_least_cuts(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof small_ones / sizeof *small_ones; i++) {
        const struct small *w = &small_ones[i];
        struct arena *a = arena_create();
        struct topology_spec s = topology_spec_of(w->family, w->ndim, w->dims);
        const struct topology *t = topology_made(&s, a);
        const int64_t least = least_cut(t, a), exact = topology_bisection(t);
        bool *half = TAKE(a, t->nrouter, bool);
        assert_int_equal(topology_partition(t, half, a), least);
        assert_int_equal(exact >= 0, w->exact);
        if (exact >= 0 && exact != least)
            fail_msg("case %zu: closed form %d, least cut %d", i, (int)exact, (int)least);
        arena_destroy(a);
    }
}

static void xpress_links_widen_the_cut(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        struct arena *a = arena_create();
        struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERCUBE, 1, &n);
        s.xpress = true;
        const struct topology *t = topology_made(&s, a);
        assert_int_equal(topology_bisection(t), 1 << n);
        assert_int_equal(least_cut(t, a), 1 << n);
        arena_destroy(a);
    }
}

/* Bundles multiply where they are alike; where they are not, no form is claimed. */
static void bundles_of_a_hyperx_count(void **state)
{
    (void)state;
    static int bundle[2] = {3, 3};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 2, (int[]){4, 3});
    s.nbundle = 2;
    s.bundle = bundle;
    const struct topology *t = topology_made(&s, a);
    assert_int_equal(topology_bisection(t), least_cut(t, a));
    bundle[1] = 1;
    t = topology_made(&s, a);
    assert_int_equal(topology_bisection(t), -1);
    bool *half = TAKE(a, t->nrouter, bool);
    assert_int_equal(topology_partition(t, half, a), least_cut(t, a));
    arena_destroy(a);
}

/* The halves that are handed out have the cut that is told, and equally many nodes. */
static void the_halves_are_the_ones_that_were_counted(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_DRAGONFLY, 4, (int[]){2, 4, 2, 9});
    const struct topology *t = topology_made(&s, a);
    struct topology_measure m = topology_measure(t, a);
    int64_t cut = 0;
    int balance = 0, from, to, port;
    assert_int_equal(m.source, BISECTION_PARTITION);
    assert_non_null(m.half);
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &to, &port);
        cut += m.half[from] && !m.half[to];
    }
    for (int r = 0; r < t->nrouter; r++) balance += m.half[r] ? 1 : -1;
    assert_int_equal(cut, m.bisection);
    assert_int_equal(balance, 0);
    /* Four groups and a half against as many: 4 x 4 global links and what the ninth group costs. */
    assert_true(m.bisection >= 16 + 4 && m.bisection <= 26);
    arena_destroy(a);
}

/* Known from the literature: q = 5 has 50 routers of degree 7; a random cut would take 89 of its
 * 175 cables, and the expander mixing bound (second eigenvalue 2) leaves no cut below 50 x (7 - 2)
 * / 4 = 62.5. */
static void a_slim_fly_has_no_narrow_cut(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_SLIM_FLY, 1, (int[]){5});
    struct topology_measure m = measured(&s, a);
    assert_true(m.bisection >= 63 && m.bisection <= 75);
    arena_destroy(a);
}

/* ---- distances and ways */

/* A torus of even radices: the mean over all pairs is the sum of k / 4, of different pairs that
 * times N / (N - 1). */
static void distances_of_a_torus(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 3, (int[]){8, 4, 4});
    struct topology_measure m = measured(&s, a);
    assert_int_equal(m.diameter, 8);
    assert_int_equal(m.longest_route, 8);
    assert_true(close_to(m.mean, 4.0 * 128 / 127));
    assert_true(close_to(m.mean_route, m.mean));
    assert_int_equal(m.ncable, 3 * 128);
    assert_int_equal(m.bisection, 2 * 16);
    assert_int_equal(m.source, BISECTION_EXACT);
    assert_int_equal(m.ports, 7);
    assert_false(m.sampled);
    arena_destroy(a);
}

/* Two nodes on a router are no link apart, which the mean over pairs of nodes counts. */
static void nodes_of_one_router_are_near(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_FULL_MESH, 1, (int[]){4});
    s.nodes_per_router = 3;
    struct topology_measure m = measured(&s, a);
    assert_true(close_to(m.mean, 9.0 / 11));
    assert_true(close_to(m.mean_route, 9.0 / 11));
    assert_int_equal(m.diameter, 1);
    assert_int_equal(m.ports, 6);
    arena_destroy(a);
}

/* h! ways between routers of a hypercube that differ in h places; on a fat tree k^l ways by level
 * l; on a mesh a binomial number. */
static void shortest_ways_are_counted(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERCUBE, 1, (int[]){3});
    struct topology_measure m = measured(&s, a);
    assert_true(close_to(m.mean_ways, (3 * 1 + 3 * 2 + 6) / 7.0));
    assert_true(close_to(m.least_ways, 1));
    s = topology_spec_of(TOPOLOGY_FAT_TREE, 2, (int[]){4, 3});
    m = measured(&s, a);
    assert_true(close_to(m.mean_ways, (3 * 4 + 12 * 16) / 15.0));
    assert_true(close_to(m.least_ways, 4));
    assert_int_equal(m.diameter, 4);
    assert_int_equal(m.least_ports, 4);
    s = topology_spec_of(TOPOLOGY_MESH, 2, (int[]){2, 2});
    m = measured(&s, a);
    assert_true(close_to(m.mean_ways, (1 + 1 + 2) / 3.0));
    arena_destroy(a);
}

/* A dragonfly's minimal route takes the one global link between two groups, though two may be
 * nearer. */
static void routes_may_be_longer_than_distances(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_DRAGONFLY, 4, (int[]){2, 4, 2, 9});
    struct topology_measure m = measured(&s, a);
    assert_true(m.mean_route > m.mean);
    assert_int_equal(m.longest_route, 3);
    arena_destroy(a);
}

/* From 64 of 32,768 routers: the torus looks alike from each, so that the sample is exact. */
static void large_networks_are_sampled(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 3, (int[]){16, 16, 32});
    struct topology_measure m = measured(&s, a);
    assert_true(m.sampled);
    assert_int_equal(m.nsource, 64);
    assert_int_equal(m.diameter, 8 + 8 + 16);
    assert_true(close_to(m.mean, 16.0 * 8192 / 8191));
    assert_int_equal(m.bisection, 2 * 256);
    arena_destroy(a);
}

/* Every route of a ring of 2^18 routers has 2^16 links in the mean: walking all of them from 64
 * routers would take half an hour. */
static void long_routes_are_walked_to_a_part(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 1, (int[]){1 << 18});
    struct topology_measure m = measured(&s, a);
    assert_true(m.sampled && m.nsource == 64);
    assert_int_equal(m.longest_route, 1 << 17);
    assert_true(m.mean_route > 0.99 * m.mean && m.mean_route < 1.01 * m.mean);
    arena_destroy(a);
}

static void one_router_has_nothing_to_cut(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_CROSSBAR, 1, (int[]){9});
    struct topology_measure m = measured(&s, a);
    assert_int_equal(m.source, BISECTION_NONE);
    assert_int_equal(m.ncable, 0);
    assert_true(close_to(m.mean, 0));
    s = topology_spec_of(TOPOLOGY_BUS, 1, (int[]){4});
    m = measured(&s, a);
    assert_int_equal(m.ncable, 1);
    assert_int_equal(m.source, BISECTION_NONE);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bisections_are_the_least_cuts),
        cmocka_unit_test(xpress_links_widen_the_cut),
        cmocka_unit_test(bundles_of_a_hyperx_count),
        cmocka_unit_test(the_halves_are_the_ones_that_were_counted),
        cmocka_unit_test(a_slim_fly_has_no_narrow_cut),
        cmocka_unit_test(distances_of_a_torus),
        cmocka_unit_test(nodes_of_one_router_are_near),
        cmocka_unit_test(shortest_ways_are_counted),
        cmocka_unit_test(routes_may_be_longer_than_distances),
        cmocka_unit_test(large_networks_are_sampled),
        cmocka_unit_test(long_routes_are_walked_to_a_part),
        cmocka_unit_test(one_router_has_nothing_to_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
