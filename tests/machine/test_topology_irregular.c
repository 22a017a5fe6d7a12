/* test_topology_irregular.c - express cubes, twisted tori, random graphs, and graphs with weights
 * and bundles against closed forms: counts, distances, loads, what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"

/* ---- express cubes */

/* On a line of 17 with express links of 4: 0 to 16 in 4 links instead of 16, 1 to 15 in 3 + 2 + 3.
 */
static void express_links_shorten_lines(void **state)
{
    (void)state;
    static const int line = 17, ring = 16;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_EXPRESS_MESH, 1, &line);
    s.express = 4;
    struct topology *t = topology_made(&s, a);
    assert_int_equal(t->nlink, 2 * (16 + 4));
    assert_int_equal(topology_distance(t, 0, 16), 4);
    assert_int_equal(topology_distance(t, 16, 0), 4);
    assert_int_equal(topology_distance(t, 1, 15), 3 + 2 + 3);
    assert_int_equal(topology_distance(t, 3, 5), 2);
    assert_int_equal(t->max_hops, 8);
    /* On a ring the way down from 1 to 14 is 1 + 2 links, or 1 + 1 + ... by the wrap. */
    s = topology_spec_of(TOPOLOGY_EXPRESS_TORUS, 1, &ring);
    s.express = 4;
    t = topology_made(&s, a);
    assert_int_equal(t->nlink, 2 * (16 + 4));
    assert_int_equal(topology_distance(t, 0, 8), 2);
    assert_int_equal(topology_distance(t, 1, 14), 3);
    assert_int_equal(topology_distance(t, 2, 10), 2 + 1 + 2);
    arena_destroy(a);
}

static void express_cubes_that_cannot_be_are_refused(void **state)
{
    (void)state;
    struct topology_spec s = topology_spec_of(TOPOLOGY_EXPRESS_TORUS, 2, (int[]){16, 6});
    topology_refused(&s, "interval of at least 2");
    s.express = 4;
    topology_refused(&s, "radix 6 in dimension 1");
    s = topology_spec_of(TOPOLOGY_EXPRESS_TORUS, 1, (int[]){4});
    s.express = 4;
    topology_refused(&s, "at least twice");
    s = topology_spec_of(TOPOLOGY_EXPRESS_MESH, 3, (int[]){2000, 2000, 2000});
    s.express = 4;
    topology_refused(&s, "numbered");
}

/* ---- twisted tori */

/* 2a x a with twist a: 4 d routers at each distance d < a, 2 a - 1 at distance a, which is the
 * diameter (Camara et al. 2010); the torus of the same dims has 3 a / 2. */
static void the_rectangular_twisted_torus_has_diameter_a(void **state)
{
    (void)state;
    for (int half = 2; half <= 8; half++) {
        int count[TOPOLOGY_FARTHEST];
        struct arena *a = arena_create();
        struct topology_spec s =
            topology_spec_of(TOPOLOGY_TWISTED_TORUS, 2, (int[]){2 * half, half});
        s.ntwist = 1;
        s.twist = &half;
        struct topology *t = topology_made(&s, a);
        assert_int_equal(t->max_hops, half);
        for (int node = 0; node < t->nnode; node += 5) {
            topology_distances(t, node, count);
            for (int d = 1; d < half; d++) assert_int_equal(count[d], 4 * d);
            assert_int_equal(count[half], 2 * half - 1);
        }
        arena_destroy(a);
    }
}

/* A twist of nothing is the torus. */
static void without_twist_it_is_the_torus(void **state)
{
    (void)state;
    static int none = 0;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TWISTED_TORUS, 2, (int[]){6, 5});
    struct topology_spec p = topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){6, 5});
    s.ntwist = 1;
    s.twist = &none;
    struct topology *t = topology_made(&s, a), *torus = topology_made(&p, a);
    assert_int_equal(t->max_hops, torus->max_hops);
    assert_int_equal(t->nlink, torus->nlink);
    for (int i = 0; i < 30; i++)
        for (int j = 0; j < 30; j++)
            assert_int_equal(topology_distance(t, i, j), topology_distance(torus, i, j));
    arena_destroy(a);
}

static void twists_that_cannot_be_are_refused(void **state)
{
    (void)state;
    static int twist[2] = {6, 1};
    struct topology_spec s = topology_spec_of(TOPOLOGY_TWISTED_TORUS, 2, (int[]){6, 3});
    topology_refused(&s, "0 numbers in topology.twist");
    s.ntwist = 2;
    s.twist = twist;
    topology_refused(&s, "2 numbers in topology.twist");
    s.ntwist = 1;
    topology_refused(&s, "twist 6 of dimension 1");
    s = topology_spec_of(TOPOLOGY_TWISTED_TORUS, 2, (int[]){6, 1});
    s.ntwist = 1;
    s.twist = &twist[1];
    topology_refused(&s, "radix 1 in dimension 1");
}

/* ---- random regular graphs */

/* Every router has its degree, no two are joined twice, all are reached; another seed is another
 * graph, the same seed the same one. Nearly complete graphs and odd sums of degrees work, too. */
static void random_graphs_are_regular_and_connected(void **state)
{
    (void)state;
    static const int shape[][2] = {{20, 3}, {64, 7}, {500, 12}, {9, 7}, {7, 3}, {6, 5}};
    for (size_t i = 0; i < sizeof shape / sizeof *shape; i++)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct arena *a = arena_create();
            int n = shape[i][0], k = shape[i][1], from, to, port;
            struct topology_spec s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, shape[i]);
            s.seed = seed;
            struct topology *t = topology_made(&s, a), *again = topology_made(&s, a);
            int *degree = TAKE(a, n, int), last[2] = {-1, -1};
            assert_int_equal(t->nlink, n * k / 2 * 2);
            for (int l = 0; l < t->nlink; l++) {
                int f, o, p;
                topology_link_ends(t, l, &from, &to, &port);
                topology_link_ends(again, l, &f, &o, &p);
                assert_true(from == f && to == o && port == p && from != to);
                assert_false(from == last[0] && to == last[1]);
                last[0] = from;
                last[1] = to;
                degree[from]++;
            }
            for (int r = 0; r < n; r++) assert_in_range(degree[r], k - n * k % 2, k);
            arena_destroy(a);
        }
}

static void another_seed_draws_another_graph(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){64, 6}), o = s;
    s.seed = 1;
    o.seed = 2;
    struct topology *t = topology_made(&s, a), *other = topology_made(&o, a);
    int same = 0, ends[4], port;
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &ends[0], &ends[1], &port);
        topology_link_ends(other, l, &ends[2], &ends[3], &port);
        same += ends[0] == ends[2] && ends[1] == ends[3];
    }
    assert_true(same < t->nlink / 4);
    arena_destroy(a);
}

/* Of n routers of degree k a random graph has the diameter that its size allows or one more:
 * Jellyfish's short ways, which are the reason for the family. */
static void random_graphs_have_short_ways(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){686, 23});
    s.seed = 1;
    struct topology *t = topology_made(&s, a);
    double sum = 0;
    for (int i = 0; i < 686; i += 49)
        for (int j = 0; j < 686; j++) sum += topology_distance(t, i, j);
    assert_int_equal(t->max_hops, 3);
    /* Moore's bound on the mean: 23 at 1, 506 at 2, the rest at 3. */
    double bound = (23 + 2 * 506 + 3 * (685 - 529)) / 686.0, mean = sum / 14 / 686;
    assert_true(mean > bound && mean < 1.12 * bound);
    arena_destroy(a);
}

static void random_graphs_that_cannot_be_are_refused(void **state)
{
    (void)state;
    struct topology_spec s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){8, 8});
    topology_refused(&s, "8 routers of degree 8");
    s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){8, 2});
    topology_refused(&s, "degree 2");
    s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){1 << 20, 1 << 19});
    topology_refused(&s, "at most 16777216 ports");
    /* a few bytes that ask for minutes of drawing */
    s = topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2, (int[]){1 << 14, 1 << 10});
    topology_refused(&s, "routers x degree^2 up to 2147483648");
}

/* ---- graphs with weights and bundles */

/* A square with one heavy side: its ends go round, over three links. */
static void weights_decide_which_way_is_shortest(void **state)
{
    (void)state;
    static int square[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, weight[4] = {10, 3, 3, 3};
    for (int heavy = 0; heavy < 2; heavy++) {
        struct arena *a = arena_create();
        struct topology_spec s = topology_spec_of(TOPOLOGY_GRAPH, 1, (int[]){4});
        s.nlink = 4;
        s.link = square;
        s.nlink_weight = 4;
        weight[0] = heavy ? 10 : 9; /* 9 is as long as the way round: the lower neighbour */
        s.link_weight = weight;
        struct topology *t = topology_made(&s, a);
        assert_int_equal(topology_distance(t, 0, 1), heavy ? 3 : 1);
        assert_int_equal(topology_distance(t, 1, 0), heavy ? 3 : 1);
        assert_int_equal(topology_distance(t, 1, 3), 2);
        assert_int_equal(t->max_hops, heavy ? 3 : 2);
        assert_int_equal(t->nclass, t->max_hops);
        arena_destroy(a);
    }
}

/* Above 1,024 routers the longest route is a bound: of a weighted ring no route is longer. */
static void the_longest_weighted_route_is_bounded(void **state)
{
    (void)state;
    enum { RING = 1100 };
    static int ring[RING][2], weight[RING];
    struct arena *a = arena_create();
    for (int i = 0; i < RING; i++) {
        ring[i][0] = i;
        ring[i][1] = (i + 1) % RING;
        weight[i] = i < 5 ? 200 : 2;
    }
    struct topology_spec s = topology_spec_of(TOPOLOGY_GRAPH, 1, (int[]){RING});
    s.nlink = s.nlink_weight = RING;
    s.link = ring;
    s.link_weight = weight;
    struct topology *t = topology_made(&s, a);
    int longest = 0;
    for (int j = 0; j < RING; j++) {
        int d = topology_distance(t, 5, j);
        if (d > longest) longest = d;
    }
    /* from 5 up to where the heavy side is as near: further than half way round */
    assert_true(longest > RING / 2 + 100);
    assert_true(t->max_hops >= longest);
    /* A line with router 0 in its middle: 1 to 550 one way, 551 to 1099 the other. */
    for (int i = 0; i < RING - 1; i++) {
        ring[i][0] = i == 550 ? 0 : i;
        ring[i][1] = i + 1;
    }
    s.nlink = RING - 1;
    s.nlink_weight = 0;
    t = topology_made(&s, a);
    assert_int_equal(topology_distance(t, 550, RING - 1), RING - 1);
    assert_int_equal(t->max_hops, RING - 1);
    arena_destroy(a);
}

static void parallel_cables_share_what_they_carry(void **state)
{
    (void)state;
    static int pair[1][2] = {{0, 1}}, four = 4;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_GRAPH, 1, (int[]){2});
    int load[8] = {0};
    s.nlink = s.nbundle = 1;
    s.link = pair;
    s.bundle = &four;
    s.nodes_per_router = 8;
    struct topology *t = topology_made(&s, a);
    assert_int_equal(t->nlink, 8);
    assert_int_equal(t->nport, 4);
    for (int i = 0; i < 16; i++) {
        struct hop route[1];
        assert_int_equal(topology_route(t, i, (i + 8) % 16, 0, route), 1);
        load[route[0].link]++;
    }
    for (int l = 0; l < 8; l++) assert_int_equal(load[l], 2);
    arena_destroy(a);
}

static void graphs_with_wrong_lists_are_refused(void **state)
{
    (void)state;
    static int triangle[3][2] = {{0, 1}, {1, 2}, {2, 0}}, twice[2][2] = {{0, 1}, {1, 0}},
               ones[3] = {1, 1, 0};
    struct topology_spec s = topology_spec_of(TOPOLOGY_GRAPH, 1, (int[]){3});
    s.nlink = 3;
    s.link = triangle;
    s.nlink_weight = 2;
    s.link_weight = ones;
    topology_refused(&s, "2 weights and 0 numbers in topology.bundle for 3");
    s.nlink_weight = 3;
    topology_refused(&s, "link 2 has weight 0");
    s.nlink_weight = 0;
    s.nbundle = 1;
    s.bundle = ones;
    topology_refused(&s, "1 numbers in topology.bundle");
    s.nbundle = 0;
    s.nlink = 2;
    s.link = twice;
    topology_refused(&s, "topology.bundle");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(express_links_shorten_lines),
        cmocka_unit_test(express_cubes_that_cannot_be_are_refused),
        cmocka_unit_test(the_rectangular_twisted_torus_has_diameter_a),
        cmocka_unit_test(without_twist_it_is_the_torus),
        cmocka_unit_test(twists_that_cannot_be_are_refused),
        cmocka_unit_test(random_graphs_are_regular_and_connected),
        cmocka_unit_test(another_seed_draws_another_graph),
        cmocka_unit_test(random_graphs_have_short_ways),
        cmocka_unit_test(random_graphs_that_cannot_be_are_refused),
        cmocka_unit_test(weights_decide_which_way_is_shortest),
        cmocka_unit_test(the_longest_weighted_route_is_bounded),
        cmocka_unit_test(parallel_cables_share_what_they_carry),
        cmocka_unit_test(graphs_with_wrong_lists_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
