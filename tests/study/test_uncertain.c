/* test_uncertain.c - which parameters of a machine are uncertain, from which ranges, and what is
 * drawn. */
#include "study/uncertain.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct arena *arena;

/* The uncertain parameters of a shipped machine. */
static int list_of(const char *machine, enum uncertain_ranges which, struct uncertain **list,
                   struct machine_spec *m)
{
    struct plan_options none = {0};
    struct origin *origin;
    struct err e;
    int n;
    err_clear(&e);
    if (!plan_machine(m, machine, &none, arena, &origin, &n, &e)) fail_msg("%s", e.text);
    return uncertain_list(origin, n, m, which, arena, list);
}

static const struct uncertain *find(const struct uncertain *list, int n, const char *key)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].key, key) == 0) return &list[i];
    return NULL;
}

static void printed_ranges_come_from_the_file(void **state)
{
    (void)state;
    struct machine_spec m;
    struct uncertain *list;
    const int n = list_of("t3e-300", UNCERTAIN_PRINTED, &list, &m);
    const struct uncertain *u = find(list, n, "node.flop_rate");
    assert_non_null(u);
    assert_true(u->printed && u->low == 35e6 && u->high == 100e6);
    /* without a range, without a number, not used by any run */
    assert_null(find(list, n, "network.ejection.bandwidth"));
    assert_null(find(list, n, "topology.tie"));
    assert_null(find(list, n, "published.linpack_100"));
    for (int i = 0; i < n; i++) assert_true(list[i].printed && list[i].low < list[i].high);
}

static void classes_give_ranges_where_none_is_printed(void **state)
{
    (void)state;
    struct machine_spec m;
    struct uncertain *list;
    const int n = list_of("t3e-300", UNCERTAIN_ALL, &list, &m);
    const struct uncertain *u = find(list, n, "network.ejection.bandwidth");
    assert_non_null(u);
    assert_false(u->printed);
    assert_true(fabs(u->low - 480e6 / 1.15) < 1 && fabs(u->high - 480e6 * 1.15) < 1);
    /* a clock and a count are facts; what is 0, or a default, is not drawn */
    assert_null(find(list, n, "node.clock"));
    assert_null(find(list, n, "network.flit"));
    assert_null(find(list, n, "software.rendezvous.latency"));
    assert_null(find(list, n, "noise.compute"));
}

static void mixed_classes_are_as_wide_as_the_weakest(void **state)
{
    (void)state;
    assert_true(uncertain_class_factor("P") == 1.15);
    assert_true(uncertain_class_factor("PR") == 1.4);
    assert_true(uncertain_class_factor("D") == 1.6 && uncertain_class_factor("E") == 1.7);
    assert_true(uncertain_class_factor("P/PR") == 1.4);
    assert_true(uncertain_class_factor("D/E") == 1.7 && uncertain_class_factor("E/D") == 1.7);
    assert_true(uncertain_class_factor("") == 0 && uncertain_class_factor("X") == 0);
}

static void values_are_drawn_and_applied(void **state)
{
    (void)state;
    struct machine_spec m;
    struct uncertain *list;
    const int n = list_of("t3e-300", UNCERTAIN_PRINTED, &list, &m);
    const struct uncertain *rate = find(list, n, "node.flop_rate"),
                           *buffer = find(list, n, "network.buffer");
    assert_non_null(buffer);
    /* the middle of a logarithm is the geometric mean */
    assert_true(fabs(uncertain_value(rate, 0.5) - sqrt(35e6 * 100e6)) < 1);
    assert_true(uncertain_value(rate, 0) == 35e6);
    for (double x = 0; x < 1; x += 0.01) {
        const double v = uncertain_value(buffer, x);
        assert_true(v == round(v) && v >= 12 && v <= 34);
    }
    for (int i = 0; i < n; i++) {
        const double v = uncertain_value(&list[i], 0.37);
        uncertain_apply(&list[i], v, &m);
        assert_true(uncertain_number(&list[i], &m) == v);
    }
    const struct uncertain from_zero = {.field = rate->field, .low = 0, .high = 8};
    assert_true(uncertain_value(&from_zero, 0.25) == 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(printed_ranges_come_from_the_file),
        cmocka_unit_test(classes_give_ranges_where_none_is_printed),
        cmocka_unit_test(mixed_classes_are_as_wide_as_the_weakest),
        cmocka_unit_test(values_are_drawn_and_applied),
    };
    arena = arena_create();
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_destroy(arena);
    return failed;
}
