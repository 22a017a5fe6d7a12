/* test_topology_families.c - HyperX, Slim Fly, Dragonfly+ and folded Clos against their closed
 * forms: numbers of routers and links, how many routers are at which distance, loads, what is
 * refused.
 *
 * That routes join their ends, are shortest and free of deadlock is tested for all families alike
 * in test_topology.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"

/* ---- HyperX */

/* At distance h: the sum over all choices of h dimensions of the product of S - 1. */
static void hyperx_distances_are_symmetric_sums(void **state)
{
    (void)state;
    static const int dims[4] = {5, 4, 3, 2};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 4, dims);
    struct topology *t = topology_made(&s, a);
    int expected[5] = {1}, count[TOPOLOGY_FARTHEST];
    for (int d = 0; d < 4; d++)
        for (int h = 4; h > 0; h--) expected[h] += expected[h - 1] * (dims[d] - 1);
    assert_int_equal(t->nrouter, 120);
    assert_int_equal(t->nlink, 120 * (4 + 3 + 2 + 1));
    assert_int_equal(t->max_hops, 4);
    for (int node = 0; node < 120; node += 17) {
        topology_distances(t, node, count);
        for (int h = 0; h <= 4; h++) assert_int_equal(count[h], expected[h]);
    }
    arena_destroy(a);
}

/* From all to all, each link of dimension d carries what comes from the routers that agree with it
 * above d and goes to those that agree below: N / S_d pairs, on whichever dimension. */
static void hyperx_loads_are_even(void **state)
{
    (void)state;
    static const int dims[3] = {4, 3, 5};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 3, dims);
    struct topology *t = topology_made(&s, a);
    static int load[TOPOLOGY_MANY];
    topology_loads(t, load);
    for (int l = 0, d = 0, left = 60 * 3; l < t->nlink; l++, left--) {
        if (left == 0) d++, left = 60 * (dims[d] - 1);
        assert_int_equal(load[l], 60 / dims[d]);
    }
    arena_destroy(a);
}

/* Of three cables each gets its share: the ends of the routes of one line name all alike. */
static void hyperx_bundles_share_what_they_carry(void **state)
{
    (void)state;
    static const int dims[2] = {3, 3};
    static int bundle[2] = {3, 1}, load[TOPOLOGY_MANY];
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 2, dims);
    s.nbundle = 2;
    s.bundle = bundle;
    s.nodes_per_router = 3;
    struct topology *t = topology_made(&s, a);
    assert_int_equal(t->nlink, 9 * (2 * 3 + 2));
    assert_int_equal(t->nport, 8);
    topology_loads(t, load);
    /* 9 sources' nodes times 3 x 3 pairs of routers on each line, over three cables */
    for (int l = 0; l < 9 * 6; l++) assert_int_equal(load[l], 3 * 9 / 3);
    for (int l = 9 * 6; l < t->nlink; l++) assert_int_equal(load[l], 3 * 9);
    arena_destroy(a);
}

static void hyperx_of_one_dimension_is_the_full_mesh(void **state)
{
    (void)state;
    static const int six[1] = {6};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 1, six),
                         m = topology_spec_of(TOPOLOGY_FULL_MESH, 1, six);
    struct topology *t = topology_made(&s, a), *full = topology_made(&m, a);
    assert_int_equal(t->nlink, full->nlink);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            struct hop p[2], q[2];
            int n = topology_route(t, i, j, 0, p);
            assert_int_equal(n, topology_route(full, i, j, 0, q));
            if (n > 0) assert_memory_equal(&p[0], &q[0], sizeof p[0]);
        }
    arena_destroy(a);
}

static void hyperx_that_cannot_be_is_refused(void **state)
{
    (void)state;
    static int bundle[3] = {1, 1, 1};
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 2, (int[]){4, 1});
    topology_refused(&s, "dimension 1; expected at least 2");
    s = topology_spec_of(TOPOLOGY_HYPERX, 2, (int[]){4, 4});
    s.nbundle = 3;
    s.bundle = bundle;
    topology_refused(&s, "topology.bundle has 3 numbers for 2 dimensions");
    s = topology_spec_of(TOPOLOGY_HYPERX, 3, (int[]){4096, 4096, 4096});
    topology_refused(&s, "numbered");
    s = topology_spec_of(TOPOLOGY_HYPERX, 0, NULL);
    topology_refused(&s, "0 dimensions");
}

/* ---- Slim Fly */

/* Every prime power up to 49, of all three kinds: degree (3 q - delta) / 2, diameter 2, and each
 * router reaches all others in two links, which is what the sets X and X' are made for. */
static void slim_flies_have_diameter_two(void **state)
{
    (void)state;
    static const int q[] = {3, 4, 5, 7, 8, 9, 11, 13, 16, 17, 25, 27, 49};
    for (size_t i = 0; i < sizeof q / sizeof *q; i++) {
        struct arena *a = arena_create();
        struct topology_spec s = topology_spec_of(TOPOLOGY_SLIM_FLY, 1, &q[i]);
        struct topology *t = topology_made(&s, a);
        int delta = q[i] % 4 == 3 ? -1 : q[i] % 4, degree = (3 * q[i] - delta) / 2;
        int count[TOPOLOGY_FARTHEST], routers = 2 * q[i] * q[i];
        assert_int_equal(t->nrouter, routers);
        assert_int_equal(t->nlink, routers * degree);
        for (int node = 0; node < routers; node += routers / 5) {
            struct hop route[2];
            topology_distances(t, node, count);
            assert_int_equal(count[1], degree);
            assert_int_equal(count[2], routers - 1 - degree);
            /* The distance is a promise; the links have to keep it. */
            for (int to = 0; to < routers; to++) {
                int n = topology_route(t, node, to, 0, route), at = node, from, port;
                for (int k = 0; k < n; k++) {
                    topology_link_ends(t, route[k].link, &from, &at, &port);
                    if (k == 0) assert_int_equal(from, node);
                }
                assert_int_equal(at, to);
            }
        }
        arena_destroy(a);
    }
}

/* The graph with q = 5 as a reference simulator was given it: neighbours of some routers. */
static void the_slim_fly_of_order_5_is_the_reference_s(void **state)
{
    (void)state;
    static const int five = 5, expected[4][8] = {{0, 1, 4, 25, 30, 35, 40, 45},
                                                 {7, 6, 8, 27, 31, 35, 44, 48},
                                                 {12, 11, 13, 27, 30, 38, 41, 49},
                                                 {15, 16, 19, 25, 32, 39, 41, 48}};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_SLIM_FLY, 1, &five);
    struct topology *t = topology_made(&s, a);
    for (int i = 0; i < 4; i++)
        for (int k = 1; k < 8; k++)
            assert_int_equal(topology_distance(t, expected[i][0], expected[i][k]), 1);
    arena_destroy(a);
}

static void orders_that_are_no_prime_powers_are_refused(void **state)
{
    (void)state;
    static const int bad[] = {1, 2, 6, 10, 12, 15, 100, 1009};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct topology_spec s = topology_spec_of(TOPOLOGY_SLIM_FLY, 1, &bad[i]);
        topology_refused(&s, "prime power");
    }
}

/* ---- Dragonfly+ */

/* With 4 spines of 2 global links 9 groups have one link each; with 3 groups there are 4. Routes
 * from all to all use every cable between groups alike. */
static void dragonfly_plus_has_the_same_links_between_groups(void **state)
{
    (void)state;
    static int load[TOPOLOGY_MANY];
    for (int groups = 3; groups <= 9; groups += 6) {
        struct arena *a = arena_create();
        struct topology_spec s =
            topology_spec_of(TOPOLOGY_DRAGONFLY_PLUS, 5, (int[]){2, 4, 4, 2, groups});
        struct topology *t = topology_made(&s, a);
        int count[TOPOLOGY_FARTHEST], copies = 8 / (groups - 1);
        assert_int_equal(t->nnode, 8 * groups);
        assert_int_equal(t->nrouter, 8 * groups);
        assert_int_equal(t->nlink, 2 * 16 * groups + groups * (groups - 1) * copies);
        topology_distances(t, 0, count);
        assert_int_equal(count[0], 2);
        assert_int_equal(count[2], 6);
        assert_int_equal(count[3], 8 * (groups - 1));
        topology_loads(t, load);
        for (int l = 2 * 16 * groups; l < t->nlink; l++) assert_int_equal(load[l], 64 / copies);
        arena_destroy(a);
    }
}

static void dragonfly_plus_that_cannot_be_is_refused(void **state)
{
    (void)state;
    struct topology_spec s = topology_spec_of(TOPOLOGY_DRAGONFLY_PLUS, 5, (int[]){2, 4, 4, 2, 10});
    topology_refused(&s, "10 groups");
    s = topology_spec_of(TOPOLOGY_DRAGONFLY_PLUS, 5, (int[]){2, 0, 4, 2, 3});
    topology_refused(&s, "0 leaves");
    s = topology_spec_of(TOPOLOGY_DRAGONFLY_PLUS, 5,
                         (int[]){1 << 20, 1 << 20, 1 << 20, 1 << 20, 3});
    topology_refused(&s, "numbered");
}

/* ---- folded Clos */

/* The k-ary tree is the one with m = w = k everywhere: the same routes, link by link. */
static void a_clos_of_one_radix_is_the_fat_tree(void **state)
{
    (void)state;
    static int up[2] = {4, 4};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_FOLDED_CLOS, 3, (int[]){4, 4, 4});
    struct topology_spec k = topology_spec_of(TOPOLOGY_FAT_TREE, 2, (int[]){4, 3});
    s.nup = 2;
    s.up = up;
    struct topology *t = topology_made(&s, a), *tree = topology_made(&k, a);
    assert_int_equal(t->nrouter, tree->nrouter);
    assert_int_equal(t->nlink, tree->nlink);
    for (int i = 0; i < 64; i++)
        for (int j = 0; j < 64; j++)
            assert_int_equal(topology_distance(t, i, j), topology_distance(tree, i, j));
    /* Shifts share no link there, nor here. */
    for (int shift = 1; shift < 64; shift++) {
        int load[256] = {0};
        for (int i = 0; i < 64; i++) {
            struct hop route[4];
            int n = topology_route(t, i, (i + shift) % 64, 0, route);
            for (int h = 0; h < n; h++) assert_int_equal(load[route[h].link]++, 0);
        }
    }
    arena_destroy(a);
}

/* 12 nodes on a leaf and 4 cables up: a permutation out of each leaf puts 3 messages on each. */
static void oversubscription_is_the_load_of_the_cables_up(void **state)
{
    (void)state;
    static int up[1] = {2}, bundle[1] = {2}, load[TOPOLOGY_MANY];
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_FOLDED_CLOS, 2, (int[]){12, 5});
    s.nup = s.nbundle = 1;
    s.up = up;
    s.bundle = bundle;
    struct topology *t = topology_made(&s, a);
    assert_int_equal(t->nnode, 60);
    assert_int_equal(t->nrouter, 5 + 2);
    assert_int_equal(t->nlink, 2 * 5 * 4);
    for (int i = 0; i < 60; i++) {
        struct hop route[2];
        assert_int_equal(topology_route(t, i, (i + 12) % 60, 0, route), 2);
        load[route[0].link]++;
        load[route[1].link]++;
    }
    for (int l = 0; l < t->nlink; l++) assert_int_equal(load[l], 3);
    arena_destroy(a);
}

static void a_clos_that_cannot_be_is_refused(void **state)
{
    (void)state;
    static int up[8] = {1 << 20, 1 << 20, 0};
    struct topology_spec s = topology_spec_of(TOPOLOGY_FOLDED_CLOS, 2, (int[]){4, 4});
    topology_refused(&s, "0 numbers in topology.up");
    s.nup = 1;
    s.up = &up[2];
    topology_refused(&s, "0 above");
    s = topology_spec_of(TOPOLOGY_FOLDED_CLOS, 3, (int[]){1 << 20, 1, 1});
    s.nup = 2;
    s.up = up;
    topology_refused(&s, "numbered");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hyperx_distances_are_symmetric_sums),
        cmocka_unit_test(hyperx_loads_are_even),
        cmocka_unit_test(hyperx_bundles_share_what_they_carry),
        cmocka_unit_test(hyperx_of_one_dimension_is_the_full_mesh),
        cmocka_unit_test(hyperx_that_cannot_be_is_refused),
        cmocka_unit_test(slim_flies_have_diameter_two),
        cmocka_unit_test(the_slim_fly_of_order_5_is_the_reference_s),
        cmocka_unit_test(orders_that_are_no_prime_powers_are_refused),
        cmocka_unit_test(dragonfly_plus_has_the_same_links_between_groups),
        cmocka_unit_test(dragonfly_plus_that_cannot_be_is_refused),
        cmocka_unit_test(a_clos_of_one_radix_is_the_fat_tree),
        cmocka_unit_test(oversubscription_is_the_load_of_the_cables_up),
        cmocka_unit_test(a_clos_that_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
