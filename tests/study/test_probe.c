/* test_probe.c - quantities measured on machines whose answers follow from their numbers by
 * hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "study/probe.h"

/* 16 nodes; 1 ns a byte, 3 us a hop, 5 us at the ends; o_s 10 us, o_r 20 us. */
static struct machine_spec mesh(void)
{
    struct machine_spec m = {.name = "hand"};
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_MESH, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.node = (struct node_spec){.flop_rate = 1e9, .clock = 1e9, .copy_bandwidth = 1e9};
    m.network = (struct network_spec){.link_bandwidth = 1e9,
                                      .hop_latency = 3e-6,
                                      .end_latency = 5e-6,
                                      .flit_bytes = 1,
                                      .virtual_channels = 1,
                                      .buffer_flits = 64};
    m.software =
        (struct software_spec){.send_overhead = 10e-6, .recv_overhead = 20e-6, .eager_bytes = -1};
    return m;
}

static double measured(const struct machine_spec *m, enum probe_quantity q, double at)
{
    struct err e;
    double value = NAN;
    err_clear(&e);
    if (!probe_measure(m, q, at, 0, &value, &e)) fail_msg("%s: %s", probe_name(q), e.text);
    return value;
}

static void is(double found, double expected)
{
    if (!(fabs(found - expected) <= 1e-9 * fabs(expected)))
        fail_msg("%.12g, not %.12g", found, expected);
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

/* Two ranks and three never share a link in a total exchange; four do in its second step, where
 * messages come late by a whole one; without contention nobody does. */
static void test_exchange(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    m.network.level = LEVEL_LINK;
    is(measured(&m, PROBE_EXCHANGE, 2), 1e9);
    is(measured(&m, PROBE_EXCHANGE, 3), 1e9);
    assert_in_range((uint64_t)(measured(&m, PROBE_EXCHANGE, 4) + 0.5), 750000000, 850000000);
    /* in a row of four the middle link carries two of the halves' messages */
    is(measured(&m, PROBE_HALVES, 2), 1e9);
    is(measured(&m, PROBE_HALVES, 4), 0.5e9);
    m.network.level = LEVEL_LOGGP;
    is(measured(&m, PROBE_EXCHANGE, 4), 1e9);
    is(measured(&m, PROBE_HALVES, 4), 1e9);
    assert_true(probe_contends(PROBE_EXCHANGE, 4, 0) && probe_contends(PROBE_BARRIER, 16, 0));
    assert_false(probe_contends(PROBE_EXCHANGE, 2, 0) || probe_contends(PROBE_ONE_WAY, 1024, 0));
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
    assert_false(probe_measure(&m, PROBE_WIRE, 7, 0, &value, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
}

/* Links that a halving cuts: 4 cables of the mesh, 8 of the torus, 8 of the 4-cube; 3 x 2 / 2 x 4
 * between 3 groups. */
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
        .family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    is(measured(&m, PROBE_BISECTION, 0), 16e9);
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2, 3}, .nodes_per_router = 1,
        .processors_per_node = 1};
    is(measured(&m, PROBE_GLOBAL, 0), 12e9); /* 8 ports a group, 3 groups, 2 ends a cable */
}

static void test_names(void **state)
{
    (void)state;
    for (int q = 0; q < PROBE_QUANTITIES; q++)
        assert_int_equal(probe_find(probe_name((enum probe_quantity)q)), q);
    assert_int_equal(probe_find("one-wya"), PROBE_QUANTITIES);
}

static double of_ranks(const struct machine_spec *m, enum probe_quantity q, double at, int ranks)
{
    struct err e;
    double value = NAN;
    err_clear(&e);
    if (!probe_measure(m, q, at, ranks, &value, &e)) fail_msg("%s: %s", probe_name(q), e.text);
    return value;
}

/* Two ranks: a message of 8 bytes takes 41.007 us, of 1000 bytes 41.999 us; a sum 1 ns. */
static void test_collectives(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    struct err e;
    double value;
    is(of_ranks(&m, PROBE_BROADCAST, 8, 2), 41.007e-6);
    is(of_ranks(&m, PROBE_REDUCE, 8, 2), 41.008e-6);
    is(of_ranks(&m, PROBE_ALLREDUCE, 1000, 2), 41.999e-6 + 125e-9);
    is(of_ranks(&m, PROBE_ALLTOALL, 8, 2), 41.007e-6);
    strcpy(m.software.collectives, "broadcast linear");
    /* the second message, a link further */
    is(of_ranks(&m, PROBE_BROADCAST, 8, 3), 10e-6 + 41.007e-6 + 3e-6);
    /* two sends, and of what comes 21.007 us after them the receiver takes the first while the
     * second is on its way */
    is(of_ranks(&m, PROBE_RING, 8, 2), 2 * 2 * 8 / (10e-6 + 11.007e-6 + 2 * 20e-6));
    is(of_ranks(&m, PROBE_RANDOM_RING, 8, 2), 2 * 2 * 8 / (10e-6 + 11.007e-6 + 2 * 20e-6));
    err_clear(&e);
    assert_false(probe_measure(&m, PROBE_RING, 8, 1, &value, &e));
    assert_true(probe_contends(PROBE_ALLREDUCE, 8, 16));
    assert_false(probe_contends(PROBE_ALLREDUCE, 8, 2) || probe_contends(PROBE_ALLREDUCE, 8, 1536));
}

/* The wire of 11.007 us and what the caller does; a get asks first. */
static void test_one_sided(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    struct err e;
    double value;
    m.software.put_overhead = 1e-6;
    is(measured(&m, PROBE_PUT, 8), 1e-6 + 11.007e-6);
    err_clear(&e);
    assert_false(probe_measure(&m, PROBE_GET, 8, 0, &value, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    m.software.get_overhead = 2e-6;
    is(measured(&m, PROBE_GET, 8), 2e-6 + 11e-6 + 11.007e-6);
}

/* Of two ranks all twelve patterns are one: the mean over the 21 sizes. */
static void test_effective_bandwidth(void **state)
{
    (void)state;
    struct machine_spec m = mesh();
    double sum = 0;
    for (int k = 0; k < 21; k++) {
        double size = k < 13 ? 1 << k : floor(4096 * pow(256, (k - 12) / 8.0) + 0.5);
        sum += of_ranks(&m, PROBE_RING, size, 2);
    }
    is(of_ranks(&m, PROBE_B_EFF, 1 << 20, 2), sum / 21);
    assert_true(of_ranks(&m, PROBE_B_EFF, 1 << 20, 16) < 8 * sum / 21);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_messages),
        cmocka_unit_test(test_collectives),
        cmocka_unit_test(test_effective_bandwidth),
        cmocka_unit_test(test_one_sided),
        cmocka_unit_test(test_loggp),
        cmocka_unit_test(test_exchange),
        cmocka_unit_test(test_wire),
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
