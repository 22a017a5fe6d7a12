/* test_zero_load.c - a message alone takes the closed form's time, exactly, on every family at
 * every level. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../support/topologies.h"
#include "base/arena.h"
#include "net/traffic.h"

static struct machine_spec machine(const struct topology_spec *s)
{
    struct machine_spec m = {.name = "test", .topology = *s};
    m.network = (struct network_spec){
        .link_bandwidth = 16e9,
        .hop_latency = 3e-9,
        .end_latency = 2e-9,
        .credit_latency = 2e-9,
        .flit_bytes = 16,
        .packet_bytes = 512,
        .virtual_channels = 8,
        .buffer_flits = 64,
    };
    m.software.eager_bytes = -1;
    return m;
}

/* when one message, ready at `ready`, arrives in the empty network [ps]; *zero: what net_zero_load
 * says */
static sim_ps arrival_alone(const struct machine_spec *m, const struct topology *t, int src,
                            int dst, int64_t bytes, sim_ps ready)
{
    struct arena *a = arena_create();
    struct err e;
    sim_ps arrival = 0, injected = 0, uncontended = 0;
    struct traffic q = {.nmessage = 1, .src = &src, .dst = &dst, .bytes = &bytes, .time = &ready};
    struct traffic_result r = {
        .arrival = &arrival, .injected = &injected, .uncontended = &uncontended};
    err_clear(&e);
    if (!traffic_run(&q, m, t, a, false, &r, &e))
        fail_msg("level %d: %s", m->network.level, e.text);
    assert_false(r.deadlock);
    assert_int_equal(injected, ready);
    assert_int_equal(uncontended, arrival);
    arena_destroy(a);
    return arrival;
}

static sim_ps zero_load(const struct machine_spec *m, const struct topology *t, int src, int dst,
                        int64_t bytes)
{
    struct arena *a = arena_create();
    struct sim *s = sim_create();
    struct err e;
    err_clear(&e);
    struct net *n = net_create(m, t, s, a, NULL, NULL, false, &e);
    if (!n) fail_msg("level %d: %s", m->network.level, e.text);
    sim_ps ps = net_zero_load(n, src, dst, bytes);
    sim_destroy(s);
    arena_destroy(a);
    return ps;
}

static void check_pair(struct machine_spec *m, const struct topology *t, int src, int dst)
{
    static const int64_t sizes[] = {0, 1, 16, 17, 288, 512, 513, 5000};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
            m->network.level = (enum network_level)level;
            int64_t flits = sizes[i] > 0 ? (sizes[i] + 15) / 16 : 1;
            sim_ps arrival = arrival_alone(m, t, src, dst, sizes[i], 77777) - 77777;
            sim_ps head = arrival - 2000 - 1000 * (flits - 1);
            if (t->fixed_routes) {
                assert_int_equal(head, 3000 * (topology_distance(t, src, dst) + 1));
                assert_int_equal(arrival, zero_load(m, t, src, dst, sizes[i]));
            }
            assert_int_equal(head % 3000, 0);
            assert_in_range(head, 3000, 3000 * (t->max_hops + 1));
        }
}

static void a_message_alone_takes_the_closed_form_s_time(void **state)
{
    (void)state;
    int n;
    const struct named_topology *all = named_topologies(&n);
    for (int i = 0; i < n; i++) {
        struct arena *a = arena_create();
        struct err e;
        struct machine_spec m = machine(&all[i].spec);
        err_clear(&e);
        struct topology *t = topology_create(&m.topology, a, &e);
        assert_non_null(t);
        for (int k = 0; k < 6; k++)
            check_pair(&m, t, 7 * k % t->nnode, (11 * k + t->nnode / 2) % t->nnode);
        check_pair(&m, t, 0, t->nnode - 1);
        arena_destroy(a);
    }
}

static void headers_count_with_every_packet(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct topology_spec s = {
        .family = TOPOLOGY_MESH, .ndim = 1, .dims = {8}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct machine_spec m = machine(&s);
    struct err e;
    err_clear(&e);
    m.network.packet_bytes = 64;
    m.network.header_bytes = 8;
    struct topology *t = topology_create(&m.topology, a, &e);
    for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
        m.network.level = (enum network_level)level;
        /* 150 = 64 + 64 + 22: 72, 72 and 30 bytes are 5 + 5 + 2 flits */
        assert_int_equal(arrival_alone(&m, t, 0, 3, 150, 0), 4 * 3000 + 11 * 1000 + 2000);
        assert_int_equal(arrival_alone(&m, t, 0, 3, 0, 0), 4 * 3000 + 2000);
    }
    arena_destroy(a);
}

static void the_slowest_rate_of_the_route_rules(void **state)
{
    (void)state;
    static const enum network_level levels[] = {LEVEL_LOGGP, LEVEL_LINK};
    struct arena *a = arena_create();
    struct topology_spec s = {.family = TOPOLOGY_MESH,
                              .ndim = 2,
                              .dims = {4, 4},
                              .dim_bandwidth = {0, 250e6},
                              .nodes_per_router = 1,
                              .processors_per_node = 1};
    struct machine_spec m = machine(&s);
    struct err e;
    err_clear(&e);
    m.network.flit_bytes = 0;
    m.network.packet_bytes = 0;
    m.network.link_bandwidth = 500e6;
    m.network.injection_bandwidth = 400e6;
    struct topology *t = topology_create(&m.topology, a, &e);
    for (int i = 0; i < 2; i++) {
        m.network.level = levels[i];
        m.network.ejection_bandwidth = 0;
        m.software.gap_per_byte = 0;
        /* injection */
        assert_int_equal(arrival_alone(&m, t, 0, 3, 1001, 0), 4 * 3000 + 1000 * 2500 + 2000);
        /* dimension 1 */
        assert_int_equal(arrival_alone(&m, t, 0, 12, 1001, 0), 4 * 3000 + 1000 * 4000 + 2000);
        m.software.gap_per_byte = 5e-9;
        /* interface */
        assert_int_equal(arrival_alone(&m, t, 0, 12, 1001, 0), 4 * 3000 + 1000 * 5000 + 2000);
        m.network.ejection_bandwidth = 100e6;
        assert_int_equal(arrival_alone(&m, t, 0, 12, 1001, 0), 4 * 3000 + 1000 * 10000 + 2000);
    }
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_message_alone_takes_the_closed_form_s_time),
        cmocka_unit_test(headers_count_with_every_packet),
        cmocka_unit_test(the_slowest_rate_of_the_route_rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
