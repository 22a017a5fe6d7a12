/* test_loads.c - what passed each link: all of a small network, of a huge one what was used,
 * without the memory of the rest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>
#include <sys/resource.h>

#include "base/arena.h"
#include "config.h"
#include "net/traffic.h"

enum { BYTES = 1000 };

/* A mesh of dims[0] x dims[1], at level link. */
static struct machine_spec mesh(int x, int y)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){.family = TOPOLOGY_MESH,
                                        .ndim = 2,
                                        .dims = {x, y},
                                        .nodes_per_router = 1,
                                        .processors_per_node = 1};
    m.network = (struct network_spec){
        .level = LEVEL_LINK, .link_bandwidth = 1e9, .hop_latency = 1e-7, .end_latency = 1e-6};
    m.software.eager_bytes = -1;
    return m;
}

/* One message from a corner to a node `dx` and `dy` away. */
static struct traffic_result send_one(const struct machine_spec *m, int to, bool want,
                                      struct arena *a)
{
    static int src, dst;
    static int64_t bytes = BYTES;
    static sim_ps none;
    struct err e;
    err_clear(&e);
    dst = to;
    struct traffic_result r = {0};
    struct topology *t = topology_create(&m->topology, a, &e);
    assert_non_null(t);
    const struct traffic q = {
        .nmessage = 1, .src = &src, .dst = &dst, .bytes = &bytes, .time = &none, .delay = &none};
    assert_true(traffic_run(&q, m, t, a, want, &r, &e));
    assert_int_equal(r.arrived, 1);
    return r;
}

/* Port, links from router to router without a gap, port. */
static void is_a_way(const struct link_load **l, int n, int to)
{
    int at = 0;
    assert_int_equal(l[0]->node, 0);
    assert_int_equal(l[0]->from, -1);
    assert_int_equal(l[0]->to, 0);
    for (int i = 1; i < n - 1; i++) {
        assert_int_equal(l[i]->node, -1);
        assert_int_equal(l[i]->from, at);
        at = l[i]->to;
    }
    assert_int_equal(at, to);
    assert_int_equal(l[n - 1]->node, to);
    assert_int_equal(l[n - 1]->from, to);
    assert_int_equal(l[n - 1]->to, -1);
    for (int i = 0; i < n; i++) {
        assert_int_equal(l[i]->messages, 1);
        assert_int_equal(l[i]->bytes, BYTES);
        assert_true(l[i]->busy_ps > 0);
    }
}

/* Links are numbered by router, so those of a way along x come in its order. */
static void small_networks_list_all(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct machine_spec m = mesh(4, 4);
    const struct traffic_result r = send_one(&m, 3, true, a);
    /* 16 ports in, 16 out, 2 x 2 x 4 x 3 links */
    assert_int_equal(r.nlink, 32 + 48);
    const struct link_load *way[5] = {NULL};
    int n = 0;
    for (int i = 0; i < r.nlink; i++) {
        const struct link_load *l = &r.link[i];
        if (l->messages > 0 && n < 5) way[n++] = l;
        else assert_true(l->bytes == 0 && l->busy_ps == 0 && l->queue_ps == 0);
        assert_true(l->node < 0 ? l->from >= 0 && l->to >= 0 : (l->from < 0) != (l->to < 0));
    }
    assert_int_equal(n, 5);
    is_a_way(way, n, 3);
    arena_destroy(a);
}

static int64_t peak_kb(void)
{
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return u.ru_maxrss;
}

/* 2 x 2^20 ports and 4 x 2^20 links: an account of each would take 300 MB. */
static void huge_networks_list_what_was_used(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct machine_spec m = mesh(1024, 1024);
    const int64_t before = peak_kb();
    const struct traffic_result r = send_one(&m, 6, true, a);
    assert_int_equal(r.nlink, 8);
    const struct link_load *way[8];
    for (int i = 0; i < 8; i++) way[i] = &r.link[i];
    is_a_way(way, 8, 6);
#ifndef SANITIZERS /* which have memory of their own */
    assert_true(peak_kb() - before < 50000);
#else
    (void)before;
#endif
    arena_destroy(a);
}

static void nothing_is_listed_unasked(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct machine_spec m = mesh(4, 4);
    const struct traffic_result r = send_one(&m, 3, false, a);
    assert_null(r.link);
    assert_int_equal(r.nlink, 0);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_networks_list_all),
        cmocka_unit_test(huge_networks_list_what_was_used),
        cmocka_unit_test(nothing_is_listed_unasked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
