/* test_topology.c - routes against breadth-first search, link ends, and freedom from deadlock, on
 * every family. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"

enum { CHOICES = 5, MAX_ROUTE = 64 };

static struct topology *make(const struct topology_spec *s, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(s, a, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

/* call `check` with every small network */
static void on_all(void (*check)(const struct named_topology *, const struct topology *,
                                 struct arena *))
{
    int n;
    const struct named_topology *all = named_topologies(&n);
    for (int i = 0; i < n; i++) {
        struct arena *a = arena_create();
        check(&all[i], make(&all[i].spec, a), a);
        arena_destroy(a);
    }
}

/* ---- links ---- */

static void check_links(const struct named_topology *named, const struct topology *t,
                        struct arena *a)
{
    bool *port_taken = TAKE(a, t->nrouter * t->nport + 1, bool);
    int64_t balance = 0;
    (void)named;
    for (int l = 0; l < t->nlink; l++) {
        int from, to, port;
        topology_link_ends(t, l, &from, &to, &port);
        assert_in_range(from, 0, t->nrouter - 1);
        assert_in_range(to, 0, t->nrouter - 1);
        assert_in_range(port, 0, t->nport - 1);
        assert_false(port_taken[to * t->nport + port]);
        port_taken[to * t->nport + port] = true;
        /* each router has as many links out as in */
        balance += (int64_t)from * from - (int64_t)to * to;
    }
    assert_int_equal(balance, 0);
}

static void every_link_ends_at_a_port_of_its_own(void **state)
{
    (void)state;
    on_all(check_links);
}

static void check_ports(const struct named_topology *named, const struct topology *t,
                        struct arena *a)
{
    (void)named;
    (void)a;
    for (int node = 0; node < t->nnode; node++) {
        int router = topology_router_of(t, node), port = topology_injection_port(t, node);
        assert_in_range(router, 0, t->nrouter - 1);
        assert_true(port >= t->nport);
        if (node > 0 && router == topology_router_of(t, node - 1))
            assert_int_equal(port, topology_injection_port(t, node - 1) + 1);
    }
}

static void injection_ports_follow_those_of_links(void **state)
{
    (void)state;
    on_all(check_ports);
}

/* ---- routes ---- */

/* distances from router `from`, by breadth-first search over the links */
static void search(const struct topology *t, int from, int *distance, int *queue)
{
    int head = 0, tail = 0;
    for (int r = 0; r < t->nrouter; r++) distance[r] = -1;
    distance[from] = 0;
    queue[tail++] = from;
    while (head < tail) {
        int r = queue[head++];
        for (int l = 0; l < t->nlink; l++) {
            int a, b, port;
            topology_link_ends(t, l, &a, &b, &port);
            if (a != r || distance[b] >= 0) continue;
            distance[b] = distance[r] + 1;
            queue[tail++] = b;
        }
    }
}

static void check_route(const struct topology *t, int src, int dst, uint64_t choice)
{
    struct hop route[MAX_ROUTE];
    int n = topology_route(t, src, dst, choice, route), at = topology_router_of(t, src);
    assert_true(n <= t->max_hops);
    for (int i = 0; i < n; i++) {
        int from, to, port;
        topology_link_ends(t, route[i].link, &from, &to, &port);
        assert_int_equal(from, at);
        assert_int_equal(port, route[i].port);
        assert_in_range(route[i].vc_class, 0, t->nclass - 1);
        at = to;
    }
    assert_int_equal(at, topology_router_of(t, dst));
    if (t->fixed_routes) assert_int_equal(n, topology_distance(t, src, dst));
}

static void check_routes(const struct named_topology *named, const struct topology *t,
                         struct arena *a)
{
    int *distance = TAKE(a, t->nrouter, int), *queue = TAKE(a, t->nrouter, int), longest = 0;
    assert_true(t->max_hops <= MAX_ROUTE);
    for (int src = 0; src < t->nnode; src++) {
        search(t, topology_router_of(t, src), distance, queue);
        for (int dst = 0; dst < t->nnode; dst++) {
            int hops = topology_distance(t, src, dst);
            for (uint64_t choice = 0; choice < (t->fixed_routes ? 1 : CHOICES); choice++)
                check_route(t, src, dst, choice);
            assert_true(hops >= distance[topology_router_of(t, dst)]);
            if (named->shortest) assert_int_equal(hops, distance[topology_router_of(t, dst)]);
            if (hops > longest) longest = hops;
        }
    }
    if (t->fixed_routes) assert_int_equal(longest, t->max_hops);
}

static void routes_join_their_ends_and_are_shortest(void **state)
{
    (void)state;
    on_all(check_routes);
}

static void check_metric(const struct named_topology *named, const struct topology *t,
                         struct arena *a)
{
    (void)a;
    int step = t->nnode > 40 ? t->nnode / 17 : 1;
    if (!named->shortest) return;
    for (int i = 0; i < t->nnode; i += step)
        for (int j = 0; j < t->nnode; j += step) {
            int d = topology_distance(t, i, j);
            assert_int_equal(d, topology_distance(t, j, i));
            assert_true((d == 0) == (topology_router_of(t, i) == topology_router_of(t, j)));
            for (int k = 0; k < t->nnode; k += step)
                assert_true(d <= topology_distance(t, i, k) + topology_distance(t, k, j));
        }
}

static void distance_is_a_metric(void **state)
{
    (void)state;
    on_all(check_metric);
}

/* ---- Dally and Seitz: no deadlock if the dependencies between (link, class) have no cycle ---- */

static bool has_cycle(int n, const bool *after, int at, char *mark)
{
    mark[at] = 1;
    for (int next = 0; next < n; next++) {
        if (!after[at * n + next] || mark[next] == 2) continue;
        if (mark[next] == 1 || has_cycle(n, after, next, mark)) return true;
    }
    mark[at] = 2;
    return false;
}

static bool may_deadlock(const struct topology *t, bool classes, struct arena *a)
{
    int n = t->nlink * t->nclass;
    bool *after = TAKE(a, n * n + 1, bool);
    char *mark = TAKE(a, n + 1, char);
    for (int src = 0; src < t->nnode; src++)
        for (int dst = 0; dst < t->nnode; dst++)
            for (uint64_t choice = 0; choice < (t->fixed_routes ? 1 : 3 * CHOICES); choice++) {
                struct hop route[MAX_ROUTE];
                int hops = topology_route(t, src, dst, choice, route);
                for (int i = 0; i + 1 < hops; i++) {
                    int from = route[i].link * t->nclass + (classes ? route[i].vc_class : 0);
                    after[from * n + route[i + 1].link * t->nclass +
                          (classes ? route[i + 1].vc_class : 0)] = true;
                }
            }
    for (int i = 0; i < n; i++)
        if (mark[i] == 0 && has_cycle(n, after, i, mark)) return true;
    return false;
}

static void check_deadlock(const struct named_topology *named, const struct topology *t,
                           struct arena *a)
{
    if (may_deadlock(t, true, a)) fail_msg("%s: its routes can deadlock", named->name);
}

static void classes_free_every_family_of_deadlock(void **state)
{
    (void)state;
    on_all(check_deadlock);
}

static void a_ring_without_classes_could_deadlock(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_TORUS, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    assert_true(may_deadlock(make(&s, a), false, a));
    arena_destroy(a);
}

/* ---- particulars ---- */

static void ties_go_up_or_by_parity(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_TORUS, .ndim = 1, .dims = {8}, .nodes_per_router = 1,
        .processors_per_node = 1};
    for (int rule = 0; rule < 2; rule++) {
        s.tie = rule == 0 ? TIE_POSITIVE : TIE_PARITY;
        struct topology *t = make(&s, a);
        for (int i = 0; i < 8; i++) {
            struct hop route[4];
            int from, to, port;
            assert_int_equal(topology_route(t, i, (i + 4) % 8, 0, route), 4);
            topology_link_ends(t, route[0].link, &from, &to, &port);
            assert_int_equal(to, rule == 1 && i % 2 == 1 ? (i + 7) % 8 : (i + 1) % 8);
        }
    }
    arena_destroy(a);
}

static void ties_may_be_broken_by_chance(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {.family = TOPOLOGY_TORUS,
                              .ndim = 2,
                              .dims = {8, 4},
                              .nodes_per_router = 1,
                              .processors_per_node = 1,
                              .tie = TIE_RANDOM};
    struct topology *t = make(&s, a);
    assert_false(t->fixed_routes);
    for (int choice = 0; choice < 4; choice++) { /* bit d decides in dimension d */
        struct hop route[6];
        int from, to, port;
        assert_int_equal(topology_route(t, 0, 4 + 8 * 2, (uint64_t)choice, route), 6);
        topology_link_ends(t, route[0].link, &from, &to, &port);
        assert_int_equal(to, choice & 1 ? 7 : 1);
        topology_link_ends(t, route[4].link, &from, &to, &port);
        assert_int_equal(to, 4 + 8 * (choice & 2 ? 3 : 1));
        assert_int_equal(topology_route(t, 0, 1, (uint64_t)choice, route), 1);
    }
    arena_destroy(a);
}

static void a_million_nodes_route_by_arithmetic(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_TORUS, .ndim = 3, .dims = {128, 128, 64}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct topology *t = make(&s, a);
    struct hop route[160];
    assert_int_equal(t->nnode, 1 << 20);
    assert_int_equal(t->nlink, 6 << 20);
    assert_int_equal(topology_route(t, 0, 64 + 128 * (64 + 128 * 32), 0, route), 64 + 64 + 32);
    assert_int_equal(topology_distance(t, 1, 127), 2);
    assert_true(arena_peak(a) < 4 << 20);
    arena_destroy(a);
}

static void the_mean_route_of_a_dragonfly_is_the_reference_s(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 0}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct topology *t = make(&s, a);
    double routers = 0, worst = 0;
    assert_int_equal(t->nnode, 72);
    for (int i = 0; i < 72; i++)
        for (int j = 0; j < 72; j++) routers += 1 + topology_distance(t, i, j);
    for (int i = 0; i < 72; i++) /* all to the next group */
        for (int j = 0; j < 8; j++) worst += 1 + topology_distance(t, i, (i / 8 * 8 + 8) % 72 + j);
    /* measured under load: 3.30 .. 3.33 */
    assert_true(routers / 72 / 72 > 3.28 && routers / 72 / 72 < 3.36);
    assert_true(worst / 72 / 8 > 3.45 && worst / 72 / 8 < 3.53);       /* 3.47 .. 3.50 */
    arena_destroy(a);
}

/* Group 3 of 9 with four routers of two global links: its own number is left out of the order.
 * Relative numbers begin with the next group. */
static void absolute_numbers_lead_to_the_groups_in_order(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {.family = TOPOLOGY_DRAGONFLY,
                              .ndim = 4,
                              .dims = {2, 4, 2, 0},
                              .nodes_per_router = 1,
                              .processors_per_node = 1};
    static const int leads[2][8] = {{4, 5, 6, 7, 8, 0, 1, 2}, {0, 1, 2, 4, 5, 6, 7, 8}};
    for (int absolute = 0; absolute < 2; absolute++) {
        s.absolute = absolute;
        const struct topology *t = make(&s, a);
        const int first = t->nlink - 72 + 3 * 8;
        for (int q = 0; q < 8; q++) {
            int from, to, port;
            topology_link_ends(t, first + q, &from, &to, &port);
            assert_int_equal(from, 3 * 4 + q / 2);
            assert_int_equal(to / 4, leads[absolute][q]);
        }
    }
    arena_destroy(a);
}

static void shifts_on_a_fat_tree_share_no_link(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {4, 3}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct topology *t = make(&s, a);
    for (int shift = 1; shift < 64; shift++) {
        int load[256] = {0};
        for (int i = 0; i < 64; i++) {
            struct hop route[4];
            int n = topology_route(t, i, (i + shift) % 64, 0, route);
            for (int k = 0; k < n; k++) assert_int_equal(load[route[k].link]++, 0);
        }
    }
    arena_destroy(a);
}

static void rates_belong_to_dimensions(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {.family = TOPOLOGY_TORUS,
                              .ndim = 2,
                              .dims = {4, 4},
                              .dim_bandwidth = {0, 300e6},
                              .nodes_per_router = 1,
                              .processors_per_node = 1};
    struct topology *t = make(&s, a);
    struct hop route[4];
    topology_route(t, 0, 5, 0, route);
    assert_true(topology_link_bandwidth(t, route[0].link, 600e6) == 1);
    assert_true(topology_link_bandwidth(t, route[1].link, 600e6) == 0.5);
    arena_destroy(a);
}

static void links_of_a_graph_have_rates_there_and_back(void **state)
{
    (void)state;
    static const int cables[2][2] = {{1, 0}, {1, 2}};
    int each[] = {50, 200}, both[] = {50, 25, 200, 100};
    struct topology_spec s = {.family = TOPOLOGY_GRAPH,
                              .ndim = 1,
                              .dims = {3},
                              .nlink = 2,
                              .link = (int(*)[2])cables,
                              .nodes_per_router = 1,
                              .processors_per_node = 1};
    /* routes 0 to 2 and back: over cable 0 backwards, cable 1 forwards, and the reverse */
    static const double expected[3][4] = {{1, 1, 1, 1}, {0.5, 2, 2, 0.5}, {0.25, 2, 1, 0.5}};
    for (int k = 0; k < 3; k++) {
        struct arena *a = arena_create();
        struct hop out[2], back[2];
        s.nlink_percent = 2 * k;
        s.link_percent = k == 1 ? each : both;
        struct topology *t = make(&s, a);
        assert_int_equal(topology_route(t, 0, 2, 0, out) + topology_route(t, 2, 0, 0, back), 4);
        assert_int_equal(topology_uniform(t), k == 0);
        for (int i = 0; i < 4; i++) {
            int link = i < 2 ? out[i].link : back[i - 2].link;
            assert_true(topology_link_bandwidth(t, link, 1e9) == expected[k][i]);
        }
        arena_destroy(a);
    }
}

static void impossible_networks_are_refused(void **state)
{
    (void)state;
    static const int self[1][2] = {{1, 1}}, twice[2][2] = {{0, 1}, {1, 0}}, apart[1][2] = {{0, 1}};
    int rates[3] = {100, 100, 100};
    const struct topology_spec bad[] = {
        {.family = TOPOLOGY_TORUS, .ndim = 0},
        {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {4, 0}},
        {.family = TOPOLOGY_TORUS, .ndim = 4, .dims = {2000, 2000, 2000, 2000}},
        {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {31}},
        {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {0}, .xpress = true},
        {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {1, 3}},
        {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {64, 8}},
        {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 10}},
        {.family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {0}},
        {.family = TOPOLOGY_FULL_MESH, .ndim = 1, .dims = {100000}},
        {.family = TOPOLOGY_GRAPH, .ndim = 1, .dims = {2}, .nlink = 1, .link = (int(*)[2])self},
        {.family = TOPOLOGY_GRAPH, .ndim = 1, .dims = {2}, .nlink = 2, .link = (int(*)[2])twice},
        {.family = TOPOLOGY_GRAPH, .ndim = 1, .dims = {3}, .nlink = 1, .link = (int(*)[2])apart},
        {.family = TOPOLOGY_GRAPH,
         .ndim = 1,
         .dims = {2},
         .nlink = 1,
         .link = (int(*)[2])apart,
         .nlink_percent = 3,
         .link_percent = rates},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct arena *a = arena_create();
        struct topology_spec s = bad[i];
        struct err e;
        err_clear(&e);
        s.nodes_per_router = s.processors_per_node = 1;
        assert_null(topology_create(&s, a, &e));
        assert_int_equal(e.kind, ERR_CONFIG);
        assert_true(strlen(e.text) > 10);
        arena_destroy(a);
    }
}

/* The Origin's square: two links beside each other on every side, one for the even nodes of a
 * router and one for the odd; opposite corners are two links apart, on a cube of eight one. */
static void test_xpress(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct topology_spec s = {.family = TOPOLOGY_HYPERCUBE,
                              .ndim = 1,
                              .dims = {2},
                              .xpress = true,
                              .nodes_per_router = 2,
                              .processors_per_node = 2};
    err_clear(&e);
    const struct topology *t = topology_create(&s, a, &e);
    assert_non_null(t);
    assert_int_equal(t->nlink, 16);
    assert_int_equal(t->max_hops, 2);
    assert_int_equal(topology_distance(t, 0, 6), 2);
    struct hop even[2], odd[2];
    assert_int_equal(topology_route(t, 0, 2, 0, even), 1);
    assert_int_equal(topology_route(t, 0, 3, 0, odd), 1);
    int from[2], to[2], port[2];
    topology_link_ends(t, even[0].link, &from[0], &to[0], &port[0]);
    topology_link_ends(t, odd[0].link, &from[1], &to[1], &port[1]);
    assert_true(even[0].link != odd[0].link && port[0] != port[1]);
    assert_true(from[0] == from[1] && to[0] == to[1]);
    assert_true(port[0] == even[0].port && port[1] == odd[0].port);
    s.dims[0] = 3;
    t = topology_create(&s, a, &e);
    assert_non_null(t);
    assert_int_equal(topology_distance(t, 0, 14), 1);
    assert_int_equal(topology_distance(t, 0, 6), 2);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_xpress),
        cmocka_unit_test(every_link_ends_at_a_port_of_its_own),
        cmocka_unit_test(injection_ports_follow_those_of_links),
        cmocka_unit_test(routes_join_their_ends_and_are_shortest),
        cmocka_unit_test(distance_is_a_metric),
        cmocka_unit_test(classes_free_every_family_of_deadlock),
        cmocka_unit_test(a_ring_without_classes_could_deadlock),
        cmocka_unit_test(ties_go_up_or_by_parity),
        cmocka_unit_test(ties_may_be_broken_by_chance),
        cmocka_unit_test(a_million_nodes_route_by_arithmetic),
        cmocka_unit_test(the_mean_route_of_a_dragonfly_is_the_reference_s),
        cmocka_unit_test(absolute_numbers_lead_to_the_groups_in_order),
        cmocka_unit_test(shifts_on_a_fat_tree_share_no_link),
        cmocka_unit_test(rates_belong_to_dimensions),
        cmocka_unit_test(links_of_a_graph_have_rates_there_and_back),
        cmocka_unit_test(impossible_networks_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
