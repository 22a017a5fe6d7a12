/* test_pattern.c - traffic patterns: destinations by hand, mistakes, arrivals, loads of links. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>

#include <cmocka.h>

#include "base/arena.h"
#include "net/pattern.h"
#include "study/netcheck_case.h"

static struct arena *arena;

static int begin(void **state)
{
    (void)state, arena = arena_create();
    return 0;
}
static int end(void **state)
{
    (void)state, arena_destroy(arena);
    return 0;
}

/* the network called `name`, as the reference data call it */
static const struct topology *network(const char *name)
{
    struct topology_spec *s = TAKE(arena, 1, struct topology_spec);
    struct err e;
    err_clear(&e);
    if (!netcheck_topology(name, 0, s, &e)) fail_msg("%s", e.text);
    const struct topology *t = topology_create(s, arena, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

static struct pattern read(const char *text, const struct topology *t)
{
    struct pattern p;
    struct err e;
    err_clear(&e);
    if (!pattern_read(&p, text, t, arena, &e)) fail_msg("%s: %s", text, e.text);
    return p;
}

static void destinations_are_those_of_the_definitions(void **state)
{
    (void)state;
    /* from, to: by hand, 16 nodes; digits to the base 4 where there are any */
    static const struct {
        const char *text;
        int from, to;
    } list[] = {
        {"bitcomp", 0, 15}, {"bitcomp", 5, 10},      {"bitrev", 1, 8},       {"bitrev", 6, 6},
        {"bitrev", 11, 13}, {"transpose", 1, 4},     {"transpose", 6, 9},    {"transpose", 15, 15},
        {"shuffle", 5, 10}, {"shuffle", 9, 3},       {"tornado4_2", 0, 5},   {"tornado(4,2)", 3, 4},
        {"tornado", 15, 0}, {"neighbor(4,2)", 0, 5}, {"neighbor", 7, 8},     {"shift(3)", 14, 1},
        {"xor(6)", 5, 3},   {"tornado(16,1)", 0, 7},
    };
    const struct topology *t = network("mesh4x4");
    struct random r = random_make(1, 2, 3);
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        struct pattern p = read(list[i].text, t);
        int to = pattern_destination(&p, list[i].from, &r);
        if (to != list[i].to)
            fail_msg("%s: %d to %d, not %d", list[i].text, list[i].from, to, list[i].to);
        assert_false(pattern_is_random(&p));
    }
}

/* Without numbers: coordinates of their own, also of routers with two nodes each; elsewhere a ring
 * of all nodes. By hand. */
static void digits_are_those_of_the_network(void **state)
{
    (void)state;
    static const struct {
        const char *network, *text;
        int per_router, from, to;
    } list[] = {
        {"mesh4x8", "tornado", 1, 0, 1 + 4 * 3},
        {"mesh4x8", "tornado", 1, 31, 0 + 4 * 2},
        {"mesh4x8", "neighbor", 1, 31, 0},
        {"torus3x4", "tornado", 1, 2, 0 + 3 * 1},
        {"mesh4x8", "tornado", 2, 1, 3 + 8 * 3},
        {"mesh4x8", "neighbor", 2, 62, 0},
        {"hcube4", "tornado", 1, 3, 10},
        {"hcube4", "neighbor", 1, 15, 0},
        {"dragonfly_p2a4h2", "tornado", 1, 40, 3},
        {"dragonfly_p2a4h2", "neighbor", 1, 71, 0},
        {"dragonfly_p2a4h2", "hotspot", 1, 40, 0},
        {"mesh4x4", "hotspot(15)", 1, 3, 15},
        {"mesh4x4", "hotspot({15})", 1, 3, 15},
        {"dragonfly_p2a4h2", "tornado(8,1)", 1, -1, 0},
    };
    struct random r = random_make(1, 2, 3);
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        struct topology_spec s = *network(list[i].network)->spec;
        struct err e;
        struct pattern p;
        err_clear(&e);
        if (list[i].per_router > 1) s.nodes_per_router = list[i].per_router;
        const struct topology *t = topology_create(&s, arena, &e);
        assert_non_null(t);
        if (list[i].from < 0) {
            assert_false(pattern_read(&p, list[i].text, t, arena, &e));
            continue;
        }
        p = read(list[i].text, t);
        const int to = pattern_destination(&p, list[i].from, &r);
        if (to != list[i].to)
            fail_msg("%s %s: %d to %d, not %d", list[i].network, list[i].text, list[i].from, to,
                     list[i].to);
    }
}

/* Each of the named nodes as often as it is named, nobody else. */
static void hot_spots_are_hit_as_often_as_named(void **state)
{
    (void)state;
    struct pattern p = read("hotspot(3, 9, 9, 0)", network("mesh4x4"));
    struct random r = random_make(1, 2, 3);
    int hit[16] = {0};
    assert_true(pattern_is_random(&p));
    for (int k = 0; k < 4000; k++) hit[pattern_destination(&p, k % 16, &r)]++;
    assert_in_range(hit[3], 880, 1120);
    assert_in_range(hit[0], 880, 1120);
    assert_int_equal(hit[0] + hit[3] + hit[9], 4000);
}

static void permutations_reach_every_node_once(void **state)
{
    (void)state;
    static const char *const list[] = {"bitcomp",     "bitrev",     "transpose", "shuffle",
                                       "tornado",     "neighbor",   "shift(7)",  "xor(9)",
                                       "randperm(1)", "randperm(2)"};
    const struct topology *t = network("mesh8x8");
    struct random r = random_make(1, 2, 3);
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        struct pattern p = read(list[i], t);
        bool seen[64] = {false};
        for (int n = 0; n < 64; n++) {
            int to = pattern_destination(&p, n, &r);
            assert_in_range(to, 0, 63);
            assert_false(seen[to]);
            seen[to] = true;
        }
    }
}

/* The order of all nodes under each seed: two seeds give two orders, and node 0 goes everywhere. */
static void drawn_permutations_differ_by_their_seed(void **state)
{
    (void)state;
    const struct topology *t = network("mesh4x4");
    int count[16] = {0};
    for (int seed = 0; seed < 1600; seed++) {
        char text[32];
        snprintf(text, sizeof text, "randperm(%d)", seed);
        count[read(text, t).permutation[0]]++;
    }
    /* 100 expected, standard deviation 9.7 */
    for (int i = 0; i < 16; i++) assert_in_range(count[i], 60, 140);
}

static void chance_stays_where_it_belongs(void **state)
{
    (void)state;
    const struct topology *t = network("dragonfly_p2a4h2");
    struct pattern far = read("badrandom", t), same = read("bad_dragon", t),
                   any = read("uniform", t);
    struct random r = random_make(1, 2, 3), q = random_make(1, 2, 3);
    int reached[72] = {0};
    assert_true(pattern_is_random(&far) && pattern_is_random(&any));
    assert_int_equal(t->nnode, 72);
    for (int k = 0; k < 7200; k++) {
        int from = k % 72, to = pattern_destination(&far, from, &r);
        assert_int_equal(to / 8, (from / 8 + 1) % 9);
        assert_int_equal(to, pattern_destination(&same, from, &q));
        reached[pattern_destination(&any, from, &r)]++;
        pattern_destination(&any, from, &q);
    }
    for (int i = 0; i < 72; i++) assert_in_range(reached[i], 50, 150);
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *network, *text, *says;
        enum err_kind kind;
    } list[] = {
        {"mesh4x4", "unifrom", "did you mean 'uniform'?", ERR_DATA},
        {"mesh4x4", "spiral",
         "known: uniform, bitcomp, bitrev, transpose, shuffle, tornado, neighbor, shift, xor, "
         "randperm, bad_dragon, hotspot",
         ERR_UNAVAILABLE},
        {"mesh3x4", "transpose", "needs 2^n nodes, not 12", ERR_DATA},
        {"hcube4", "tornado(4,3)", "3 digits to the base 4 do not number 16 nodes", ERR_DATA},
        {"mesh4x8", "tornado(4)", "2 digits to the base 4 do not number 32 nodes", ERR_DATA},
        {"mesh4x4", "neighbor(1,40)", "40 digits to the base 1", ERR_DATA},
        {"mesh4x4", "hotspot(16)", "expected nodes below 16", ERR_DATA},
        {"mesh4x4", "hotspot(1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1)", "17 numbers; expected 0 to 16",
         ERR_DATA},
        {"mesh4x4", "hotspot({1,2},{3,1})", "expected one list of nodes", ERR_DATA},
        {"mesh4x4", "uniform(5)", "'uniform(5)': 1 number; expected none, as in uniform", ERR_DATA},
        {"mesh4x4", "bitcomp1", "'bitcomp1': 1 number; expected none", ERR_DATA},
        {"mesh4x4", "bitrev(0)", "expected none", ERR_DATA},
        {"mesh4x4", "transpose(3)", "expected none, as in transpose", ERR_DATA},
        {"mesh4x4", "shuffle(1,2)", "2 numbers; expected none", ERR_DATA},
        {"mesh4x4", "tornado(4,2,1)", "3 numbers; expected 0 to 2, as in tornado(8,2)", ERR_DATA},
        {"mesh4x4", "neighbor4_2_1", "3 numbers; expected 0 to 2", ERR_DATA},
        {"mesh4x4", "shift(1,2)", "'shift(1,2)': 2 numbers; expected 1, as in shift(1)", ERR_DATA},
        {"mesh4x4", "xor", "0 numbers; expected 1, as in xor(1)", ERR_DATA},
        {"mesh4x4", "randperm(1,2)", "2 numbers; expected 0 to 1", ERR_DATA},
        {"dragonfly_p2a4h2", "bad_dragon(2)", "1 number; expected none", ERR_DATA},
        {"dragonfly_p2a4h2", "badrandom(2)", "expected none, as in badrandom", ERR_DATA},
        {"mesh4x4", "hotspot(-1)", "expected whole numbers in brackets", ERR_DATA},
        {"mesh4x4", "hotspot(1,2,", "expected whole numbers in brackets", ERR_DATA},
        {"mesh4x4", "shift(1.5)", "expected whole numbers in brackets", ERR_DATA},
        {"mesh4x4", "shift", "0 numbers; expected 1, as in shift(1)", ERR_DATA},
        {"mesh4x4", "shift(16)", "expected a distance below the 16 nodes", ERR_DATA},
        {"mesh4x4", "xor(99999999999)", "expected a distance below the 16 nodes", ERR_DATA},
        {"mesh4x4", "badrandom", "needs a dragonfly", ERR_DATA},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        struct pattern p;
        struct err e;
        err_clear(&e);
        assert_false(pattern_read(&p, list[i].text, network(list[i].network), arena, &e));
        assert_int_equal(e.kind, list[i].kind);
        if (!strstr(e.text, list[i].says)) fail_msg("'%s' lacks '%s'", e.text, list[i].says);
    }
}

static const struct pattern_load usual = {.load = 0.3,
                                          .flits = 4,
                                          .bytes = 64,
                                          .cycle_ps = 1000,
                                          .cycles = 20000,
                                          .seed = 1,
                                          .most = 1 << 20};

/* Bernoulli: the number of arrivals of a node is binomial, and no two are in one cycle. */
static void arrivals_are_as_often_as_the_load_says(void **state)
{
    (void)state;
    const struct topology *t = network("mesh8x8");
    struct pattern p = read("transpose", t);
    struct traffic q;
    struct err e;
    err_clear(&e);
    assert_true(pattern_traffic(&p, &usual, arena, &q, &e));
    double mean = 0.3 / 4 * 20000 * 64, deviation = sqrt(mean * (1 - 0.3 / 4));
    assert_true(fabs(q.nmessage - mean) < 4 * deviation);
    for (int m = 0; m < q.nmessage; m++) {
        assert_int_equal(q.time[m] % 1000, 0);
        assert_true(q.time[m] < 20000000 && q.bytes[m] == 64);
        if (m > 0 && q.src[m] == q.src[m - 1]) assert_true(q.time[m] > q.time[m - 1]);
    }
}

/* Node by node the longer list begins with the shorter one. */
static void a_longer_list_begins_with_the_shorter_one(void **state)
{
    (void)state;
    const struct topology *t = network("mesh4x4");
    struct pattern p = read("uniform", t);
    struct traffic one, two;
    struct err e;
    struct pattern_load longer = usual, other = usual;
    longer.cycles *= 2;
    other.seed = 2;
    err_clear(&e);
    assert_true(pattern_traffic(&p, &usual, arena, &one, &e) &&
                pattern_traffic(&p, &longer, arena, &two, &e));
    int k = 0;
    for (int m = 0; m < two.nmessage; m++) {
        if (two.time[m] >= 20000000) continue;
        assert_true(one.src[k] == two.src[m] && one.dst[k] == two.dst[m] &&
                    one.time[k] == two.time[m]);
        k++;
    }
    assert_int_equal(k, one.nmessage);
    assert_true(pattern_traffic(&p, &other, arena, &two, &e));
    assert_false(two.nmessage == one.nmessage &&
                 memcmp(one.time, two.time, (size_t)k * sizeof *one.time) == 0);
}

static void loads_out_of_range_are_refused(void **state)
{
    (void)state;
    struct pattern p = read("uniform", network("mesh4x4"));
    struct pattern_load l[5] = {usual, usual, usual, usual, usual};
    l[0].load = 0, l[1].load = 1.01, l[2].flits = 0, l[3].cycles = 0, l[4].most = 100;
    for (int i = 0; i < 5; i++) {
        struct traffic q;
        struct err e;
        err_clear(&e);
        assert_false(pattern_traffic(&p, &l[i], arena, &q, &e));
        assert_int_equal(e.kind, ERR_DATA);
        assert_non_null(strstr(e.text, i == 4 ? "2.4e+04 messages; expected at most 100"
                                              : "expected a load above 0"));
    }
}

/* Closed forms (Dally and Towles, sections 3.3 and 25.1): uniform traffic crosses the middle of a
 * k-ary mesh with k/4, dimension-order transpose loads a corner with k - 1, complement k/2; a
 * ring's tornado goes k/2 - 1 links one way. */
static void channel_loads_are_the_closed_forms(void **state)
{
    (void)state;
    static const struct {
        const char *network, *text;
        double load;
    } list[] = {
        {"mesh8x8", "uniform", 2},   {"mesh4x4", "uniform", 1},      {"mesh8x8", "transpose", 7},
        {"mesh8x8", "bitcomp", 4},   {"ring8", "tornado(8,1)", 3},   {"torus8x8", "tornado", 3},
        {"torus8x8", "neighbor", 1}, {"ring16", "shift(1)", 1},      {"hcube6", "uniform", 0.5},
        {"hcube6", "bitcomp", 1},    {"ring8", "uniform", 10.0 / 8}, {"mesh8x8", "shift(1)", 1},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        const struct topology *t = network(list[i].network);
        struct pattern p = read(list[i].text, t);
        double load = pattern_channel_load(&p, t, 1, 1e9, arena);
        if (fabs(load - list[i].load) > 1e-9)
            fail_msg("%s %s: %g", list[i].network, list[i].text, load);
    }
}

/* Drawn ones: a dragonfly's group sends all through one link of 8 nodes; random ways up a fat tree
 * share evenly. */
static void channel_loads_of_chance_are_near_their_means(void **state)
{
    (void)state;
    const struct topology *t = network("dragonfly_p2a4h2"), *tree = network("fattree_k4_n3");
    struct pattern far = read("badrandom", t), shift = read("shift(32)", tree);
    assert_true(fabs(pattern_channel_load(&far, t, 64, 1e9, arena) - 8) < 1e-9);
    double load = pattern_channel_load(&shift, tree, 4000, 1e9, arena);
    assert_true(load > 1 && load < 1.1);
    /* A dragonfly+ with two nodes on each of two leaves, one link between groups: four share it. */
    const struct topology_spec plus = {.family = TOPOLOGY_DRAGONFLY_PLUS,
                                       .ndim = 5,
                                       .dims = {2, 2, 2, 1, 3},
                                       .nodes_per_router = 1,
                                       .processors_per_node = 1};
    struct err e;
    err_clear(&e);
    const struct topology *groups = topology_create(&plus, arena, &e);
    assert_non_null(groups);
    struct pattern next = read("badrandom", groups);
    assert_true(fabs(pattern_channel_load(&next, groups, 64, 1e9, arena) - 4) < 1e-9);
    /* too many messages to follow; no links at all */
    assert_true(pattern_channel_load(&far, t, 1 << 22, 1e9, arena) == 0);
    const struct topology *bar = network("crossbar16");
    struct pattern any = read("uniform", bar);
    assert_true(pattern_channel_load(&any, bar, 1, 1e9, arena) == 0);
}

/* A link of twice the rate counts half. */
static void faster_links_bear_more(void **state)
{
    (void)state;
    struct topology_spec s = *network("mesh8x8")->spec;
    struct err e;
    err_clear(&e);
    s.dim_bandwidth[0] = 2e9, s.dim_bandwidth[1] = 1e9;
    const struct topology *t = topology_create(&s, arena, &e);
    assert_non_null(t);
    struct pattern p = read("shift(1)", t), q = read("shift(8)", t);
    assert_true(pattern_channel_load(&p, t, 1, 1e9, arena) <= 1);
    assert_true(fabs(pattern_channel_load(&q, t, 1, 1e9, arena) - 1) < 1e-9);
    struct pattern row = read("xor(1)", t);
    assert_true(fabs(pattern_channel_load(&row, t, 1, 1e9, arena) - 0.5) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(destinations_are_those_of_the_definitions),
        cmocka_unit_test(digits_are_those_of_the_network),
        cmocka_unit_test(hot_spots_are_hit_as_often_as_named),
        cmocka_unit_test(permutations_reach_every_node_once),
        cmocka_unit_test(drawn_permutations_differ_by_their_seed),
        cmocka_unit_test(chance_stays_where_it_belongs),
        cmocka_unit_test(mistakes_are_told),
        cmocka_unit_test(arrivals_are_as_often_as_the_load_says),
        cmocka_unit_test(a_longer_list_begins_with_the_shorter_one),
        cmocka_unit_test(loads_out_of_range_are_refused),
        cmocka_unit_test(channel_loads_are_the_closed_forms),
        cmocka_unit_test(channel_loads_of_chance_are_near_their_means),
        cmocka_unit_test(faster_links_bear_more),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
