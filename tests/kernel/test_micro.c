/* test_micro.c - the micro-benchmarks send what they say and measure something on every rank. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "evaluation.h"

static void messages_and_bytes_are_as_announced(void **state)
{
    (void)state;
    static const char *const names[] = {"pingpong", "shift", "bisection", "all-to-all", "hot-spot", "barrier"};
    for (int k = 0; k < 6; k++)
        for (int P = 2; P <= 12; P += 2)
            for (int64_t bytes = 0; bytes <= 100000; bytes = 100 * bytes + 8) {
                struct arena *a = arena_create();
                struct run_spec s = evaluation_spec(names[k], 1, P);
                s.kernel.repeat = 3;
                s.kernel.message_bytes = bytes;
                s.kernel.distance = 5;
                const struct evaluation v = evaluate(&s, a);
                struct kernel_estimate e;
                kernel_find(names[k])->estimate(&s, NULL, NULL, &e);
                assert_int_equal(v.counts.messages, (int64_t)e.messages);
                assert_int_equal(v.counts.bytes, (int64_t)e.bytes);
                assert_int_equal(v.counts.reports, 0);
                arena_destroy(a);
            }
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    struct err e = {0};
    struct run_spec s = evaluation_spec("pingpong", 1, 1);
    assert_false(kernel_find("pingpong")->accepts(&s, NULL, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    err_clear(&e);
    s.nrank = 3;
    assert_false(kernel_find("bisection")->accepts(&s, NULL, &e));
    assert_null(kernel_find("ping"));
}

static void every_kernel_is_complete_in_every_precision(void **state)
{
    (void)state;
    int n;
    const struct kernel_type *const *list = kernel_list(&n);
    assert_true(n >= 9);
    for (int k = 0; k < n; k++)
        for (int precision = 0; precision < 3; precision++) {
            const struct kernel_type *t = kernel_find_precision(list[k]->name, (enum precision)precision);
            assert_non_null(t);
            assert_string_equal(t->name, list[k]->name);
            assert_true(t->title && t->nstage > 0 && t->stage_name && t->accepts && t->prepare && t->workspace_bytes &&
                        t->run && t->estimate);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_and_bytes_are_as_announced),
        cmocka_unit_test(what_makes_no_sense_is_refused),
        cmocka_unit_test(every_kernel_is_complete_in_every_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
