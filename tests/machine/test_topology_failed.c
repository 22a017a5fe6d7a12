/* test_topology_failed.c - networks of which something does not work: routes meet nothing of it,
 * are free of deadlock, as long as they have to be, and the same as before where nothing failed. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"
#include "base/random.h"
#include "machine/placement.h"
#include "machine/topology_failed.h"
#include "machine/topology_measure.h"

enum { CHOICES = 3, MAX_ROUTE = 128 };

/* ---- any failures on any network */

/* Cables and routers by chance, so many that most networks still hold together. */
static struct topology_spec broken(const struct topology_spec *s, const struct topology *t,
                                   struct random *r, struct arena *a)
{
    struct topology_spec b = *s;
    int nlink = t->nlink > 40 ? 4 : 1, port;
    b.failed_link = arena_take(a, sizeof(int[8][2]));
    b.failed_router = TAKE(a, 8, int);
    for (b.nfailed_link = 0; b.nfailed_link < nlink; b.nfailed_link++) {
        int l = (int)random_below(r, (uint64_t)t->nlink);
        topology_link_ends(t, l, &b.failed_link[b.nfailed_link][0],
                           &b.failed_link[b.nfailed_link][1], &port);
    }
    if (t->nrouter > 12 && random_below(r, 2) == 0)
        b.failed_router[b.nfailed_router++] = (int)random_below(r, (uint64_t)t->nrouter);
    return b;
}

/* A route of the broken network: it ends where it should and meets only what works; where the whole
 * network's meets only that, it is that one. */
static int check_route(const struct topology *t, const struct topology *whole, int src, int dst,
                       uint64_t choice, struct hop route[MAX_ROUTE])
{
    struct hop before[MAX_ROUTE];
    int n = topology_route(t, src, dst, choice, route), at = topology_router_of(t, src);
    int m = topology_route(whole, src, dst, choice, before), from, to, port;
    bool kept = true;
    assert_true(n <= t->max_hops);
    for (int i = 0; i < n; i++) {
        topology_link_ends(t, route[i].link, &from, &to, &port);
        assert_true(topology_link_works(t, route[i].link));
        assert_int_equal(from, at);
        assert_int_equal(port, route[i].port);
        assert_in_range(route[i].vc_class, 0, t->nclass - 1);
        at = to;
    }
    assert_int_equal(at, topology_router_of(t, dst));
    for (int i = 0; i < m; i++) kept = kept && topology_link_works(t, before[i].link);
    if (kept) {
        assert_int_equal(n, m);
        for (int i = 0; i < n; i++) assert_memory_equal(&route[i], &before[i], sizeof route[i]);
    }
    return n;
}

static bool has_cycle(int n, const bool *after, int at, char *mark)
{
    mark[at] = 1;
    for (int next = 0; next < n; next++) {
        if (!after[(size_t)at * (size_t)n + (size_t)next] || mark[next] == 2) continue;
        if (mark[next] == 1 || has_cycle(n, after, next, mark)) return true;
    }
    mark[at] = 2;
    return false;
}

/* All routes; and the dependencies of (link, class) have no circle (Dally and Seitz). */
static void check_network(const struct topology *t, const struct topology *whole, struct arena *a)
{
    size_t n = (size_t)t->nlink * (size_t)t->nclass;
    bool *after = arena_take(a, n * n + 1);
    char *mark = arena_take(a, n + 1);
    memset(after, 0, n * n + 1);
    memset(mark, 0, n + 1);
    for (int src = 0; src < t->nnode; src++)
        for (int dst = 0; dst < t->nnode; dst++) {
            if (!topology_router_works(t, topology_router_of(t, src)) ||
                !topology_router_works(t, topology_router_of(t, dst)))
                continue;
            for (uint64_t choice = 0; choice < (t->fixed_routes ? 1 : CHOICES); choice++) {
                struct hop h[MAX_ROUTE];
                int hops = check_route(t, whole, src, dst, choice, h);
                for (int i = 0; i + 1 < hops; i++)
                    after[(size_t)(h[i].link * t->nclass + h[i].vc_class) * n +
                          (size_t)(h[i + 1].link * t->nclass + h[i + 1].vc_class)] = true;
            }
        }
    for (int i = 0; i < (int)n; i++)
        assert_false(mark[i] == 0 && has_cycle((int)n, after, i, mark));
}

/* Every family, three times with different failures. A network that is cut says so. */
static void routes_of_every_family_go_around(void **state)
{
    (void)state;
    struct random r = random_make(5, 0, 0);
    int n, held = 0;
    const struct named_topology *all = named_topologies(&n);
    for (int i = 0; i < 3 * n; i++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        const struct topology *whole = topology_made(&all[i / 3].spec, a);
        if (whole->nrouter > 1 && whole->nlink <= 400) {
            struct topology_spec s = broken(&all[i / 3].spec, whole, &r, a);
            const struct topology *t = topology_create(&s, a, &e);
            if (t) check_network(t, whole, a);
            else if (!strstr(e.text, "cuts the network") && !strstr(e.text, "no further cable"))
                fail_msg("%s: %s", all[i / 3].name, e.text);
            held += t != NULL;
        }
        arena_destroy(a);
    }
    /* Most do: else this test would say little. */
    assert_true(held > n);
}

/* ---- particulars */

static struct topology_spec with_link(struct topology_spec s, int pair[1][2])
{
    s.nfailed_link = 1;
    s.failed_link = pair;
    return s;
}

/* A ring with one cable less is a line: its ends are the whole way apart. */
static void a_ring_becomes_a_line(void **state)
{
    (void)state;
    static int pair[1][2] = {{0, 7}};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 1, (int[]){8});
    s = with_link(s, pair);
    const struct topology *t = topology_made(&s, a);
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 8; j++) assert_int_equal(topology_distance(t, i, j), abs(i - j));
    assert_int_equal(t->nclass, 4);
    assert_int_equal(t->max_hops, 7);
    assert_false(topology_whole(t));
    arena_destroy(a);
}

/* Neighbours on a hypercube or a mesh that lost their cable are three links apart, on a full mesh
 * two. */
static void a_lost_cable_costs_what_it_has_to(void **state)
{
    (void)state;
    static int pair[1][2] = {{5, 4}};
    const struct topology_spec whole[] = {topology_spec_of(TOPOLOGY_HYPERCUBE, 1, (int[]){4}),
                                          topology_spec_of(TOPOLOGY_MESH, 2, (int[]){4, 4}),
                                          topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){4, 4}),
                                          topology_spec_of(TOPOLOGY_FULL_MESH, 1, (int[]){9})};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) {
        struct arena *a = arena_create();
        struct topology_spec s = with_link(whole[i], pair);
        const struct topology *t = topology_made(&s, a), *before = topology_made(&whole[i], a);
        assert_int_equal(topology_distance(before, 4, 5), 1);
        assert_int_equal(topology_distance(t, 4, 5), i < 3 ? 3 : 2);
        assert_int_equal(topology_distance(t, 5, 4), i < 3 ? 3 : 2);
        /* Pairs that did not use it are as they were. */
        assert_int_equal(topology_distance(t, 0, 1), 1);
        struct topology_measure m = topology_measure(t, a);
        assert_int_equal(m.ncable, t->nlink / 2 - 1);
        assert_true(m.source == BISECTION_PARTITION);
        arena_destroy(a);
    }
}

/* One of three parallel cables fails, then the next, then there is none. */
static void cables_of_a_bundle_fail_one_by_one(void **state)
{
    (void)state;
    static int three = 3, pairs[4][2] = {{0, 1}, {1, 0}, {0, 1}, {0, 1}};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_HYPERX, 1, (int[]){3});
    s.nbundle = 1;
    s.bundle = &three;
    s.failed_link = pairs;
    for (s.nfailed_link = 1; s.nfailed_link <= 3; s.nfailed_link++) {
        const struct topology *t = topology_made(&s, a);
        assert_int_equal(topology_distance(t, 0, 1), s.nfailed_link < 3 ? 1 : 2);
        assert_int_equal(topology_measure(t, a).ncable, 9 - s.nfailed_link);
    }
    topology_refused(&s, "entry 3, no further cable joins routers 0 and 1; 0 is joined to 1");
    arena_destroy(a);
}

static void what_is_not_there_cannot_fail(void **state)
{
    (void)state;
    static int pair[1][2] = {{0, 5}}, row[3][2] = {{0, 4}, {1, 5}, {2, 6}}, router = 16,
               all[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    struct topology_spec mesh = topology_spec_of(TOPOLOGY_MESH, 2, (int[]){4, 4});
    struct topology_spec s = with_link(mesh, pair);
    topology_refused(&s, "routers 0 and 5; 0 is joined to 1, 4");
    s = mesh;
    s.nfailed_router = 1;
    s.failed_router = &router;
    topology_refused(&s, "no router 16; expected 0 to 15");
    s.nfailed_router = 16;
    s.failed_router = all;
    topology_refused(&s, "no router with nodes is left");
    /* The first column of rows goes but for one cable: still one piece. Then it is two. */
    s = topology_spec_of(TOPOLOGY_MESH, 2, (int[]){4, 2});
    s.nfailed_link = 3;
    s.failed_link = row;
    struct arena *a = arena_create();
    assert_int_equal(topology_distance(topology_made(&s, a), 0, 4), 7);
    arena_destroy(a);
    s = topology_spec_of(TOPOLOGY_MESH, 2, (int[]){3, 2});
    static int column[3][2] = {{0, 3}, {1, 4}, {2, 5}};
    s.nfailed_link = 3;
    s.failed_link = column;
    topology_refused(&s, "router 3 cannot be reached from router 0 (3 of 6");
    s = topology_spec_of(TOPOLOGY_CROSSBAR, 1, (int[]){4});
    s = with_link(s, pair);
    topology_refused(&s, "1 routers");
}

/* A fat tree's spine may lose all it has; no rank notices but by contention. */
static void a_switch_without_nodes_may_be_lost(void **state)
{
    (void)state;
    static int spine = 20;
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_FAT_TREE, 2, (int[]){3, 3});
    s.nfailed_router = 1;
    s.failed_router = &spine;
    const struct topology *t = topology_made(&s, a);
    assert_int_equal(topology_measure(t, a).nnode, 27);
    for (int i = 0; i < 27; i++)
        for (int j = 0; j < 27; j++) assert_true(topology_distance(t, i, j) <= 4);
    arena_destroy(a);
}

/* The memory for ways around is bounded: what is found again after it was given away is the same
 * way. Here for 5 of 256 targets, each of which has 256 x 4 numbers. */
static void ways_are_found_again(void **state)
{
    (void)state;
    static int pair[2][2] = {{0, 1}, {16, 17}};
    struct arena *a = arena_create();
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){16, 16}), all = s;
    struct topology *few = topology_made(&s, a);
    struct err e;
    err_clear(&e);
    s.nfailed_link = all.nfailed_link = 2;
    s.failed_link = all.failed_link = pair;
    assert_true(topology_fail(few, 5 * 4096, a, &e));
    const struct topology *t = topology_made(&all, a);
    for (int i = 0; i < 256; i++) topology_distance(t, 0, i);
    const size_t before = arena_peak(a);
    for (int k = 0; k < 3 * 256; k++)
        assert_int_equal(topology_distance(few, 16 * (k & 1), k % 256),
                         topology_distance(t, 16 * (k & 1), k % 256));
    assert_true(arena_peak(a) - before < 256 * 1024);
    arena_destroy(a);
}

/* One of several threads that ask a network for the lengths of its ways, each in its own order. */
struct asking {
    const struct topology *asked;
    const int *expected; /* (n x n) */
    int n, first, wrong;
};

static void *ask_all(void *argument)
{
    struct asking *x = argument;
    for (int i = 0; i < x->n * x->n; i++) {
        const int k = (i + x->first) % (x->n * x->n), src = k / x->n, dst = k % x->n;
        if (topology_distance(x->asked, src, dst) != x->expected[k]) x->wrong++;
    }
    return NULL;
}

/* Threads of one run ask the same network for ways that nobody has asked for before; of a few that
 * may be kept one thread gives away what another one has found. */
static void threads_find_the_ways_that_one_finds(void **state)
{
    (void)state;
    enum { THREADS = 4, N = 81, TRIALS = 40 };
    static int pair[2][2] = {{0, 1}, {16, 17}};
    for (int trial = 0; trial < TRIALS; trial++) {
        struct arena *a = arena_create(), *other = arena_create();
        const bool failed = trial % 2 == 1;
        struct topology_spec s = failed ? topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){9, 9})
                                        : topology_spec_of(TOPOLOGY_RANDOM_REGULAR, 2,
                                                           (int[]){N, 4});
        s.seed = (uint64_t)trial;
        struct topology *t = topology_made(&s, a), *one = topology_made(&s, other);
        struct err e;
        err_clear(&e);
        if (failed) {
            s.nfailed_link = 2;
            s.failed_link = pair;
            assert_true(topology_fail(t, 3 * N * 16, a, &e));
            assert_true(topology_fail(one, 3 * N * 16, other, &e));
        }
        int expected[N * N];
        for (int k = 0; k < N * N; k++) expected[k] = topology_distance(one, k / N, k % N);
        struct asking x[THREADS];
        pthread_t thread[THREADS];
        for (int k = 0; k < THREADS; k++) {
            x[k] = (struct asking){t, expected, N, k * N * N / THREADS / 16, 0};
            assert_int_equal(pthread_create(&thread[k], NULL, ask_all, &x[k]), 0);
        }
        for (int k = 0; k < THREADS; k++) {
            pthread_join(thread[k], NULL);
            assert_int_equal(x[k].wrong, 0);
        }
        arena_destroy(a);
        arena_destroy(other);
    }
}

static void too_many_routers_are_refused(void **state)
{
    (void)state;
    static int pair[1][2] = {{0, 1}};
    struct topology_spec s = topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){2048, 1024});
    s = with_link(s, pair);
    topology_refused(&s, "2097152 routers and");
}

/* ---- placement */

/* Ranks take the processors that work, in order; the others cannot be named. */
static void ranks_are_placed_on_what_works(void **state)
{
    (void)state;
    static int dead[2] = {1, 4}, list[2] = {0, 3}, expected[6] = {0, 2, 3, 5, 6, 7};
    struct arena *a = arena_create();
    struct err e;
    struct placement p;
    struct machine_spec m = {.name = "m",
                             .topology = topology_spec_of(TOPOLOGY_TORUS, 2, (int[]){4, 2})};
    m.topology.nfailed_router = 2;
    m.topology.failed_router = dead;
    const struct topology *t = topology_made(&m.topology, a);
    err_clear(&e);
    for (int spread = 0; spread < 2; spread++) {
        m.placement.spread = spread ? SPREAD_CYCLIC : SPREAD_BLOCK;
        assert_true(placement_create(&p, &m, t, 6, a, &e));
        for (int r = 0; r < 6; r++) assert_int_equal(p.node[r], expected[r]);
    }
    assert_false(placement_create(&p, &m, t, 7, a, &e));
    assert_non_null(strstr(e.text, "6 of its 8 processors work"));
    err_clear(&e);
    m.placement = (struct placement_spec){.kind = PLACEMENT_RANDOM, .seed = 3};
    assert_true(placement_create(&p, &m, t, 6, a, &e));
    bool taken[8] = {false};
    for (int r = 0; r < 6; r++) {
        assert_true(p.node[r] != 1 && p.node[r] != 4 && !taken[p.node[r]]);
        taken[p.node[r]] = true;
    }
    m.placement = (struct placement_spec){.kind = PLACEMENT_LIST, .nlist = 2, .list = list};
    assert_true(placement_create(&p, &m, t, 2, a, &e));
    list[1] = 4;
    assert_false(placement_create(&p, &m, t, 2, a, &e));
    assert_non_null(strstr(e.text, "processor 4 of rank 1 hangs on router 4"));
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(routes_of_every_family_go_around),
        cmocka_unit_test(a_ring_becomes_a_line),
        cmocka_unit_test(a_lost_cable_costs_what_it_has_to),
        cmocka_unit_test(cables_of_a_bundle_fail_one_by_one),
        cmocka_unit_test(what_is_not_there_cannot_fail),
        cmocka_unit_test(a_switch_without_nodes_may_be_lost),
        cmocka_unit_test(ways_are_found_again),
        cmocka_unit_test(threads_find_the_ways_that_one_finds),
        cmocka_unit_test(too_many_routers_are_refused),
        cmocka_unit_test(ranks_are_placed_on_what_works),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
