/* test_roofline.c - computing against communication, by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "study/roofline.h"

/* 100 Mflop/s, 200 MB/s, 2 us to send and 3 to receive. */
static struct machine_spec machine(void)
{
    struct machine_spec m = {.node.flop_rate = 1e8, .network.link_bandwidth = 2e8};
    m.software.send_overhead = 2e-6;
    m.software.recv_overhead = 3e-6;
    m.software.eager_bytes = -1;
    return m;
}

static bool near(double a, double b) { return fabs(a - b) <= 1e-9 * fabs(b); }

/* Two ranks and two stages: in one they send 10 messages of 1000 B and compute 1 ms at 100 Mflop/s;
 * in the other nothing is sent. */
static void roofs_are_operations_over_the_time_of_one_part(void **state)
{
    (void)state;
    const struct machine_spec m = machine();
    struct stage_time stage[2 * 3] = {0};
    for (int rank = 0; rank < 2; rank++) {
        stage[rank * 3] = (struct stage_time){.compute_ps = 1000000000,
                                              .send_ps = 10000000,
                                              .recv_ps = 15000000,
                                              .wait_ps = 975000000,
                                              .messages = 5,
                                              .bytes = 5000,
                                              .work.flop = 100000};
        stage[rank * 3 + 1] = (struct stage_time){.compute_ps = 1000000, .work.flop = 50};
    }
    const struct run_result r = {.nrank = 2, .nstage = 3, .stage = stage};
    struct arena *a = arena_create();
    int n;
    const struct roofline_row *row = roofline_rows(&m, &r, &n, a);
    assert_int_equal(n, 3); /* the run and the two stages that compute */
    assert_int_equal(row[0].stage, -1);
    const struct roofline_row *x = &row[1];
    assert_int_equal(x->stage, 0);
    assert_true(near(x->intensity, 20));
    assert_true(near(x->attained, 200000 / 4e-3));  /* 2 ms on each of two processors */
    assert_true(near(x->computing, 1e8));
    assert_true(near(x->bandwidth, 20 * 2e8));      /* flop/B times B/s */
    assert_true(near(x->software, 200000 / 50e-6)); /* 10 messages at 5 us */
    assert_int_equal(x->lowest, ROOF_COMPUTING);
    assert_true(isinf(row[2].intensity) && isinf(row[2].bandwidth) && isinf(row[2].software));
    assert_true(near(row[0].flops, 200100));
    arena_destroy(a);
}

static void the_lowest_roof_is_named(void **state)
{
    (void)state;
    struct machine_spec m = machine();
    struct stage_time stage[2] = {{.compute_ps = 1000000,
                                   .send_ps = 1000000,
                                   .messages = 1,
                                   .bytes = 1000,
                                   .work.flop = 100}};
    const struct run_result r = {.nrank = 1, .nstage = 2, .stage = stage};
    struct arena *a = arena_create();
    int n;
    /* 1 us of computing, 5 us on the wire, 5 us of software: the machine decides */
    assert_int_equal(roofline_rows(&m, &r, &n, a)[1].lowest, ROOF_BANDWIDTH);
    m.network.link_bandwidth = 0; /* unlimited */
    assert_int_equal(roofline_rows(&m, &r, &n, a)[1].lowest, ROOF_SOFTWARE);
    m.software.send_overhead = m.software.recv_overhead = 0;
    assert_int_equal(roofline_rows(&m, &r, &n, a)[1].lowest, ROOF_COMPUTING);
    assert_string_equal(roofline_word(ROOF_SOFTWARE), "message software");
    /* Nothing counted: nothing to draw. */
    stage[0].work.flop = 0;
    roofline_rows(&m, &r, &n, a);
    assert_int_equal(n, 0);
    arena_destroy(a);
}

static void the_slowest_of_port_link_and_software_sends(void **state)
{
    (void)state;
    struct machine_spec m = machine();
    assert_true(near(roofline_bandwidth(&m, 8), 2e8));
    m.network.injection_bandwidth = 1e8;
    assert_true(near(roofline_bandwidth(&m, 8), 1e8));
    m.software.gap_per_byte = 20e-9;
    assert_true(near(roofline_bandwidth(&m, 8), 5e7));
    m.software.gap_per_byte = 0;
    m.network.injection_bandwidth = m.network.link_bandwidth = 0;
    assert_true(isinf(roofline_bandwidth(&m, 8)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roofs_are_operations_over_the_time_of_one_part),
        cmocka_unit_test(the_lowest_roof_is_named),
        cmocka_unit_test(the_slowest_of_port_link_and_software_sends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
