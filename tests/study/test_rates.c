/* test_rates.c - benchmark codes count what they execute, and a node's costs turn the counts into
 * rates. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "study/rates.h"

/* The sums are those of the executed code, but for daxpys whose multiplier is zero. */
static void test_summed_is_executed(void **state)
{
    (void)state;
    int alike = 0;
    for (int n = 1; n <= RATE_EXECUTED; n += n < 20 ? 1 : 10) {
        struct rate_count run = rate_linpack(n), sum = rate_linpack_summed(n);
        assert_true(run.nominal == sum.nominal);
        assert_int_equal(run.work.div, sum.work.div);
        assert_int_equal(run.work.call, sum.work.call);
        assert_true(run.work.flop <= sum.work.flop &&
                    (double)run.work.flop >= 0.999 * (double)sum.work.flop);
        alike += run.work.flop == sum.work.flop;
    }
    assert_true(alike > 20);
}

/* Order 100: 661,650 additions and multiplications of the factors, 19,800 of the solution; one
 * multiplier is zero. */
static void test_linpack_by_hand(void **state)
{
    (void)state;
    struct rate_count c = rate_linpack(100);
    uint64_t factor = 0;
    for (uint64_t m = 1; m < 100; m++) factor += 2 * m * m + m;
    assert_int_equal(factor, 661650);
    assert_int_equal(c.work.flop, factor + 2 * 2 * 4950 - 180);
    assert_int_equal(c.work.div, 99 + 100);
    assert_int_equal(c.work.call, 99 * 2 + 4950 + 99 + 100);
    assert_int_equal(c.work.bytes, 0);
    assert_true(fabs(c.nominal - (2e6 / 3 + 2e4)) < 1e-6);
}

/* 1 ns a flop, 10 ns a division, 100 ns a call, 2 ns a byte copied. */
static void test_rates_by_hand(void **state)
{
    (void)state;
    struct node_spec node = {
        .flop_rate = 1e9, .clock = 1e9, .div_cycles = 10, .call_time = 100e-9,
        .copy_bandwidth = 0.5e9};
    struct rate_count inner = rate_inner_product(1000);
    assert_true(fabs(rate_of(&node, &inner) - 2000 / 2.1e-6) < 1);
    struct rate_count copy = rate_stream(RATE_COPY, 1000), triad = rate_stream(RATE_TRIAD, 1000);
    assert_true(fabs(rate_of(&node, &copy) - 16000 / 16.1e-6) < 1);
    assert_true(fabs(rate_of(&node, &triad) - 24000 / 26.1e-6) < 1);
    struct rate_count scale = rate_stream(RATE_SCALE, 10), add = rate_stream(RATE_ADD, 10);
    assert_int_equal(scale.work.flop, 10);
    assert_int_equal(scale.work.bytes, 80);
    assert_int_equal(add.work.flop, 10);
    assert_int_equal(add.work.bytes, 120);
    node.flop_rate = 2e9;
    assert_true(rate_of(&node, &triad) > 24000 / 26.1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_summed_is_executed),
        cmocka_unit_test(test_linpack_by_hand),
        cmocka_unit_test(test_rates_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
