/* test_node_cost.c - counted operations as time, against the sum written out by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "machine/node_cost.h"

static void each_class_of_operation_costs_its_own(void **state)
{
    (void)state;
    struct node_spec s = {.flop_rate = 50e6,
                          .clock = 300e6,
                          .div_cycles = 22,
                          .sqrt_cycles = 60,
                          .trig_cycles = 150,
                          .call_time = 40e-9,
                          .copy_bandwidth = 250e6};
    struct node_cost c = node_cost_make(&s);
    /* 20 ns a flop; 1e12/300e6 ps a cycle; 4 ns a byte; 40 ns a call */
    assert_int_equal(node_cost_ps(&c, &(struct work){.flop = 7}), 7 * 20000);
    assert_int_equal(node_cost_ps(&c, &(struct work){.div = 3}), 220000);
    assert_int_equal(node_cost_ps(&c, &(struct work){.sqrt = 1}), 200000);
    assert_int_equal(node_cost_ps(&c, &(struct work){.trig = 2}), 1000000);
    assert_int_equal(node_cost_ps(&c, &(struct work){.bytes = 100}), 400000);
    assert_int_equal(node_cost_ps(&c, &(struct work){.call = 5}), 200000);
    struct work all = {7, 3, 1, 2, 100, 5, 0};
    assert_int_equal(node_cost_ps(&c, &all), 140000 + 220000 + 200000 + 1000000 + 400000 + 200000);
}

static void a_node_without_rates_computes_in_no_time(void **state)
{
    (void)state;
    struct node_spec s = {0};
    struct node_cost c = node_cost_make(&s);
    assert_int_equal(node_cost_ps(&c, &(struct work){1, 2, 3, 4, 5, 6, 7}), 0);
}

static void code_takes_the_longest_of_arithmetic_instructions_and_memory(void **state)
{
    (void)state;
    struct node_spec s = {
        .flop_rate = 50e6, .clock = 100e6, .div_cycles = 4, .copy_bandwidth = 250e6};
    struct node_cost c = node_cost_make(&s); /* 20 ns a flop, 40 ns a division, 4 ns a byte */
    /* 2.5 in the time of a flop: less than the cycle of 10 ns */
    assert_float_equal(c.instruction, 8000, 1e-3);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 2}, 5), 40000, 1e-3);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 2}, 6), 48000, 1e-3);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 2, .div = 1, .bytes = 24}, 6),
                       80000, 1e-3);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.flop = 2, .bytes = 24}, 5), 48000,
                       1e-3);
    assert_float_equal(node_cost_code_ps(&c, &(struct work){.call = 9}, 5), 40000, 1e-3);
    s.clock = 200e6;
    assert_float_equal(node_cost_make(&s).instruction, 5000, 1e-3); /* a cycle */
    s.instruction_cycles = 3;
    assert_float_equal(node_cost_make(&s).instruction, 15000, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_class_of_operation_costs_its_own),
        cmocka_unit_test(a_node_without_rates_computes_in_no_time),
        cmocka_unit_test(code_takes_the_longest_of_arithmetic_instructions_and_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
