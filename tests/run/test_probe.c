/* test_probe.c - quantities measured on machines whose answers follow from their numbers by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "run/probe.h"

/* 16 nodes; 1 ns a byte, 3 us a hop, 5 us at the ends; o_s 10 us, o_r 20 us. */
static struct machine_spec mesh(void)
{
    struct machine_spec m = {.name = "hand"};
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_MESH, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 1, .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.link_bandwidth = 1e9,
                                      .hop_latency = 3e-6,
                                      .end_latency = 5e-6,
                                      .flit_bytes = 1,
                                      .virtual_channels = 1,
                                      .buffer_flits = 64};
    m.software = (struct software_spec){.send_overhead = 10e-6, .recv_overhead = 20e-6, .eager_bytes = -1};
    return m;
}

static double measured(const struct machine_spec *m, enum probe_quantity q, double at)
{
    struct err e;
    double value = NAN;
    err_clear(&e);
    if (!probe_measure(m, q, at, &value, &e)) fail_msg("%s: %s", probe_name(q), e.text);
    return value;
}

static void is(double found, double expected)
{
    if (!(fabs(found - expected) <= 1e-9 * fabs(expected))) fail_msg("%.12g, not %.12g", found, expected);
}

/* o_s + 2 hops + (n - 1) G + end + o_r */
static void test_messages(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    is(measured(&m, PROBE_ONE_WAY, 1), 41e-6);
    is(measured(&m, PROBE_ONE_WAY, 1001), 42e-6);
    is(measured(&m, PROBE_ROUND_TRIP, 1001), 84e-6);
    is(measured(&m, PROBE_BANDWIDTH, 1001), 1001 / 42e-6);
    is(measured(&m, PROBE_R_INF, 0), 1e9);
    /* n / (41 us + (n - 1) ns) = 0.5 GB/s at n = 40999 */
    is(measured(&m, PROBE_N_HALF, 0), 40999);
}

static void test_loggp(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    is(measured(&m, PROBE_SEND_OVERHEAD, 0), 10e-6);
    is(measured(&m, PROBE_RECV_OVERHEAD, 0), 20e-6);
    is(measured(&m, PROBE_LATENCY, 0), 11.007e-6);
    is(measured(&m, PROBE_GAP, 0), 20e-6); /* the receiver is the slowest */
    m.software.gap = 50e-6;
    is(measured(&m, PROBE_GAP, 0), 50.007e-6); /* 7 bytes more than LogGP's one */
    m.software.gap = 0;
    m.software.send_overhead = 30e-6;
    is(measured(&m, PROBE_GAP, 0), 30e-6);
}

/* Two ranks and three never share a link in a total exchange; four do in its second step, where messages come late by
 * a whole one; without contention nobody does. */
static void test_exchange(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    m.network.level = LEVEL_LINK;
    is(measured(&m, PROBE_EXCHANGE, 2), 1e9);
    is(measured(&m, PROBE_EXCHANGE, 3), 1e9);
    assert_in_range((uint64_t)measured(&m, PROBE_EXCHANGE, 4), 750000000, 850000000);
    /* in a row of four the middle link carries two of the halves' messages */
    is(measured(&m, PROBE_HALVES, 2), 1e9);
    is(measured(&m, PROBE_HALVES, 4), 0.5e9);
    m.network.level = LEVEL_LOGGP;
    is(measured(&m, PROBE_EXCHANGE, 4), 1e9);
    is(measured(&m, PROBE_HALVES, 4), 1e9);
    assert_true(probe_contends(PROBE_EXCHANGE, 4) && probe_contends(PROBE_BARRIER, 16));
    assert_false(probe_contends(PROBE_EXCHANGE, 2) || probe_contends(PROBE_ONE_WAY, 1024));
}

static void test_wire(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    is(measured(&m, PROBE_WIRE, 1), 11e-6);
    is(measured(&m, PROBE_WIRE, 6), 26e-6);
    is(measured(&m, PROBE_READ, 3), 18e-6); /* there and back over two links: 3 hops each */
    double value;
    struct err e;
    err_clear(&e);
    assert_false(probe_measure(&m, PROBE_WIRE, 7, &value, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
}

/* Links that a halving cuts: 4 cables of the mesh, 8 of the torus, 8 of the 4-cube; 3 x 2 / 2 x 4 between 3 groups. */
static void test_cuts(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    is(measured(&m, PROBE_BISECTION, 0), 8e9);
    m.topology.family = TOPOLOGY_TORUS;
    is(measured(&m, PROBE_BISECTION, 0), 16e9);
    m.topology.dims[0] = 8;
    is(measured(&m, PROBE_BISECTION, 0), 16e9); /* across the longer side */
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {4}, .nodes_per_router = 1, .processors_per_node = 1};
    is(measured(&m, PROBE_BISECTION, 0), 16e9);
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2, 3}, .nodes_per_router = 1, .processors_per_node = 1};
    is(measured(&m, PROBE_GLOBAL, 0), 12e9); /* 8 ports a group, 3 groups, 2 ends a cable */
}

static void test_names(void **state)
{
    (void)state;
    for (int q = 0; q < PROBE_QUANTITIES; q++) assert_int_equal(probe_find(probe_name((enum probe_quantity)q)), q);
    assert_int_equal(probe_find("one-wya"), PROBE_QUANTITIES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_messages), cmocka_unit_test(test_loggp), cmocka_unit_test(test_wire),
        cmocka_unit_test(test_cuts),     cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
