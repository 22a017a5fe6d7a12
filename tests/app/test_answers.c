/* test_answers.c - points of the space that failed claims are searched in: a point is what its text
 * says; and notes of stored answers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "app/explain_space.h"
#include "app/stored.h"
#include "base/random.h"
#include "spec/identity.h"
#include "store/store.h"

/* A space of four axes by hand, one of each map: 50 Mflop/s (35 .. 100 published), ... */
static void make_space(struct explain_space *s)
{
    static const char *const key[] = {"node.flop_rate", "node.serial_rate", "noise.background.load",
                                      "noise.compute"};
    static const enum explain_map map[] = {EXPLAIN_FACTOR, EXPLAIN_RELATIVE, EXPLAIN_SHARE,
                                           EXPLAIN_SPREAD};
    *s = (struct explain_space){.machine = "hand", .n = 4};
    for (int i = 0; i < 4; i++) {
        struct explain_axis *x = &s->axis[i];
        const struct field_table *t;
        char full[80];
        snprintf(full, sizeof full, "machine.%s", key[i]);
        *x = (struct explain_axis){.words = "it is",
                                   .after = "",
                                   .map = map[i],
                                   .nkey = 1,
                                   .key = {key[i]},
                                   .field = {field_find_full(full, &t)},
                                   .least = i < 2 ? -2.3026 : 0,
                                   .most = i < 3 ? 2.3026 : 0.6931};
        assert_non_null(x->field[0]);
    }
    s->axis[0].nominal[0] = 50e6, s->axis[0].low[0] = 35e6, s->axis[0].high[0] = 100e6;
    s->axis[1].low[0] = 35e6, s->axis[1].high[0] = 100e6;
}

static void near(double x, double y)
{
    if (!(fabs(x - y) <= 1e-12 * fabs(y))) fail_msg("%.17g, not %.17g", x, y);
}

static void changes_are_numbers(void **state)
{
    (void)state;
    struct explain_space s;
    make_space(&s);
    const double none[4] = {0};
    near(explain_space_value(&s, none, 0, 0), 50e6);
    assert_true(explain_space_value(&s, none, 1, 0) == 0);
    const double u[4] = {log(2), -log(4), log(2), log(1.5)};
    near(explain_space_value(&s, u, 0, 0), 100e6);
    near(explain_space_value(&s, u, 1, 0), 25e6); /* of the first axis's 100, not of 50 */
    near(explain_space_value(&s, u, 2, 0), 0.5);
    near(explain_space_value(&s, u, 3, 0), 0.5);
    near(explain_space_distance(&s, u), log(2) + log(4) + log(2) + log(1.5));
    /* three digits, whole per cent */
    const double v[4] = {log(1.23456), 0, -log(1 - 0.1234), 0};
    near(explain_space_value(&s, v, 0, 0), 61.7e6);
    near(explain_space_value(&s, v, 2, 0), 0.12);
    assert_true(explain_space_published(&s, none));
    assert_true(explain_space_published(&s, (const double[4]){log(2), 0, 0, 0}));
    assert_false(explain_space_published(&s, (const double[4]){log(2.1), 0, 0, 0}));
    assert_false(explain_space_published(&s, (const double[4]){-log(1.5), 0, 0, 0}));
    assert_false(explain_space_published(&s, (const double[4]){0, 0, 0.5, 0})); /* has none */
}

static void points_are_what_their_text_says(void **state)
{
    (void)state;
    struct explain_space s;
    struct random r = random_make(14, 0, 0);
    struct run_spec run;
    make_space(&s);
    for (int round = 0; round < 500; round++) {
        double u[4], again[4];
        for (int i = 0; i < 4; i++) {
            u[i] = random_below(&r, 3) ? random_uniform(&r, -3, 3) : 0;
            if (random_below(&r, 4) == 0) u[i] /= 1000; /* less than the last digit */
        }
        explain_space_snap(&s, u);
        memcpy(again, u, sizeof again);
        explain_space_snap(&s, again);
        for (int i = 0; i < 4; i++) {
            assert_true(u[i] >= s.axis[i].least - 0.006 && u[i] <= s.axis[i].most + 0.006);
            assert_true(fabs(again[i] - u[i]) < 0.006); /* at the border by the last digit */
            assert_true(u[i] == 0 || fabs(u[i]) >= 0.003);
        }
        /* settings read back are the numbers of the point */
        struct text settings = {0};
        int changed = 0, told = 0;
        text_add(&settings, "%s", "");
        explain_space_settings(&s, u, &settings);
        for (int i = 0; i < 4; i++) {
            changed += u[i] != 0;
            if (u[i] == 0) continue;
            char full[80], why[160], value[64];
            snprintf(full, sizeof full, "machine.%s=", s.axis[i].key[0]);
            const char *at = strstr(settings.s, full);
            assert_non_null(at);
            at += strlen(full);
            snprintf(value, sizeof value, "%.*s", (int)strcspn(at, ","), at);
            memset(&run, 0, sizeof run);
            assert_true(field_set(s.axis[i].field[0], &run.machine, value, arena, why, 160));
            double number = -1;
            assert_true(field_number(s.axis[i].field[0], &run.machine, &number));
            assert_true(number == explain_space_value(&s, u, i, 0));
        }
        for (const char *c = settings.s; *c; c++) told += *c == '=';
        assert_int_equal(told, changed);
        text_free(&settings);
    }
}

static void runs_at_a_point_have_another_identity(void **state)
{
    (void)state;
    struct explain_space s;
    struct run_spec run, same;
    make_space(&s);
    run_spec_defaults(&run, arena);
    run.machine.node.flop_rate = 50e6;
    run_identify(&run, arena);
    same = run;
    explain_space_apply(&s, (const double[4]){0}, &same, arena);
    assert_string_equal(same.config_hash, run.config_hash);
    explain_space_apply(&s, (const double[4]){log(2), log(3), 0, log(1.25)}, &same, arena);
    near(same.machine.node.flop_rate, 100e6);
    near(same.machine.node.serial_rate, 300e6);
    near(same.machine.noise.compute_cv, 0.25);
    assert_true(same.machine.noise.background_load == 0);
    assert_string_not_equal(same.config_hash, run.config_hash);
    assert_non_null(strstr(same.config_text, "machine.node.flop_rate = 100 Mflop/s\n"));
}

static void phrase_is(const struct explain_space *s, int i, double change, bool brief,
                      const char *expected)
{
    struct text t = {0};
    double u[4] = {0};
    u[i] = change;
    explain_space_phrase(s, u, i, brief, &t);
    assert_string_equal(t.s, expected);
    text_free(&t);
}

static void points_in_words(void **state)
{
    (void)state;
    struct explain_space s;
    make_space(&s);
    phrase_is(&s, 0, -log(2.5), false,
              "it is 20 Mflop/s (2.5 times below nominal, outside the "
              "published range of 35 Mflop/s to 100 Mflop/s)");
    phrase_is(&s, 0, log(1.6), false,
              "it is 80 Mflop/s (1.6 times above nominal, within the "
              "published range of 35 Mflop/s to 100 Mflop/s)");
    phrase_is(&s, 0, log(2), true, "it is 100 Mflop/s");
    phrase_is(&s, 1, log(2), true, "it is 100 Mflop/s");
    phrase_is(&s, 2, log(2), false, "it is 50 % (nominal none, no published range)");
    phrase_is(&s, 3, log(1.5), false, "it is 50 % (nominal none, no published range)");
    s.axis[0].low[0] = s.axis[0].high[0] = 0;
    s.axis[0].after = " each";
    phrase_is(&s, 0, log(2), false,
              "it is 100 Mflop/s each (2 times above nominal, no published range)");
}

static void stored_answers_have_digests(void **state)
{
    (void)state;
    static struct run_spec spec[2];
    static const struct claim_rule rule = {.id = "a", .sql = "SELECT 1"},
                                   other = {.id = "a", .sql = "SELECT 2"};
    struct text t = {0};
    char hex[5][65];
    strcpy(spec[0].config_hash, "one");
    strcpy(spec[1].config_hash, "two");
    stored_add_runs(&t, spec, 2);
    stored_digest(&t, hex[0]);
    assert_true(t.s == NULL && t.length == 0); /* freed, and can be used again */
    stored_add_runs(&t, spec + 1, 1);
    stored_add_runs(&t, spec, 1);
    stored_digest(&t, hex[1]);
    stored_add_runs(&t, spec, 2);
    stored_add_claim(&t, &rule);
    stored_digest(&t, hex[2]);
    stored_add_runs(&t, spec, 2);
    stored_add_claim(&t, &other);
    stored_digest(&t, hex[3]);
    stored_add_runs(&t, spec, 2);
    stored_digest(&t, hex[4]);
    assert_string_equal(hex[0], hex[4]);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++) assert_string_not_equal(hex[i], hex[k]);
}

static void a_note_is_the_last_one_kept(void **state)
{
    (void)state;
    struct err e;
    char value[65] = "before";
    err_clear(&e);
    struct store *s = store_open("notes", STORE_MEMORY, &e);
    if (s == NULL) fail_msg("%s", e.text);
    assert_true(stored_note(s, "answer", value, &e));
    assert_string_equal(value, "");
    assert_false(stored_is(s, "answer", "abc"));
    assert_true(stored_is(s, "answer", "")); /* what is not there is the empty note */
    assert_true(stored_keep(s, "answer", "abc", &e));
    assert_true(stored_is(s, "answer", "abc"));
    assert_false(stored_is(s, "answer", "abcd"));
    assert_false(stored_is(s, "other", "abc"));
    assert_true(stored_keep(s, "answer", "def", &e)); /* in place of the older one */
    assert_true(stored_is(s, "answer", "def"));
    store_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changes_are_numbers),
        cmocka_unit_test(points_are_what_their_text_says),
        cmocka_unit_test(runs_at_a_point_have_another_identity),
        cmocka_unit_test(points_in_words),
        cmocka_unit_test(stored_answers_have_digests),
        cmocka_unit_test(a_note_is_the_last_one_kept),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
