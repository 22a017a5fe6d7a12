/* test_collective_times.c - which rules follow from made-up times of collectives, and that the
 * rules read and choose what was the fastest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "comm/collective_rules.h"
#include "reality/collective_times.h"

/* allreduce on four ranks: MPICH's choice is recursive-doubling up to 2 KiB, rabenseifner above. */
static void add(struct collective_times *t, const char *algorithm, int64_t bytes, double measured,
                double predicted)
{
    const struct collective_algorithm *a =
        collective_algorithm_find(COLLECTIVE_ALLREDUCE, algorithm);
    assert_non_null(a);
    t->sample[t->n++] = (struct collective_sample){.kind = COLLECTIVE_ALLREDUCE,
                                                   .algorithm = a,
                                                   .bytes = bytes,
                                                   .measured = measured,
                                                   .predicted = predicted};
}

static struct collective_times made(double ring, double ring_long)
{
    struct collective_times t = {.nrank = 4};
    add(&t, "recursive-doubling", 8, 2e-6, 2e-6);
    add(&t, "ring", 8, ring, 2e-6);
    add(&t, "recursive-doubling", 65536, 50e-6, 40e-6);
    add(&t, "rabenseifner", 65536, 30e-6, 30e-6);
    add(&t, "ring", 65536, ring_long, 25e-6);
    return t;
}

static void a_clearly_faster_algorithm_makes_a_rule(void **state)
{
    (void)state;
    struct collective_times t = made(3e-6, 20e-6);
    collective_times_judge(&t);
    assert_string_equal(t.rules, "allreduce ring from 65536 B");
    /* The rule reads, and chooses it. */
    struct collective_rule rule[COLLECTIVE_MAX_RULES];
    char why[200] = "";
    int n;
    assert_true(collective_rules_parse(t.rules, rule, &n, why, (int)sizeof why));
    const struct collective_shape shape = {.kind = COLLECTIVE_ALLREDUCE,
                                           .size = 4,
                                           .count = 8192,
                                           .total = 8192,
                                           .element = 8,
                                           .commutative = true};
    assert_string_equal(collective_choose(&shape, rule, n)->name, "ring");
    /* 0, 1/3, 1/5, 0, 1/4: the median is 1/5. */
    assert_true(t.residual > 0.333 && t.residual < 0.334);
    assert_true(t.median_residual > 0.199 && t.median_residual < 0.201);
}

static void the_smallest_size_stands_for_all_below(void **state)
{
    (void)state;
    struct collective_times t = made(1e-6, 29e-6);
    collective_times_judge(&t);
    /* At 64 KiB the rule for all sizes would choose the ring, which is not clearly slower. */
    assert_string_equal(t.rules, "allreduce ring");
    /* Where it is, the usual one comes back. */
    t = made(1e-6, 60e-6);
    collective_times_judge(&t);
    assert_string_equal(t.rules, "allreduce ring; allreduce rabenseifner from 65536 B");
}

static void what_is_hardly_faster_makes_none(void **state)
{
    (void)state;
    struct collective_times t = made(1.9e-6, 28e-6);
    collective_times_judge(&t);
    assert_string_equal(t.rules, "");
    t.n = 0;
    collective_times_judge(&t);
    assert_string_equal(t.rules, "");
    assert_true(t.residual == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clearly_faster_algorithm_makes_a_rule),
        cmocka_unit_test(the_smallest_size_stands_for_all_below),
        cmocka_unit_test(what_is_hardly_faster_makes_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
