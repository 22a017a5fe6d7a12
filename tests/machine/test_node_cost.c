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
    struct work all = {7, 3, 1, 2, 100, 5};
    assert_int_equal(node_cost_ps(&c, &all), 140000 + 220000 + 200000 + 1000000 + 400000 + 200000);
}

static void a_node_without_rates_computes_in_no_time(void **state)
{
    (void)state;
    struct node_spec s = {0};
    struct node_cost c = node_cost_make(&s);
    assert_int_equal(node_cost_ps(&c, &(struct work){1, 2, 3, 4, 5, 6}), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_class_of_operation_costs_its_own),
        cmocka_unit_test(a_node_without_rates_computes_in_no_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
