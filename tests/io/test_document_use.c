/* test_document_use.c - what is asked of a tree: entries by key, numbers, integers, lists of lists,
 * and settings as one line again. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "base/text.h"
#include "document_fixture.h"

/* --- what is asked of a tree --- */

static void entries_are_found_by_key(void **state)
{
    const struct node *map = good_data("{\"b\": 1, \"a\": {\"b\": 2}, \"\": 3, \"list\": [4]}");
    struct err e;
    (void)state;
    assert_true(document_find(map, "b")->number == 1);
    assert_true(document_find(document_find(map, "a"), "b")->number == 2);
    assert_true(document_find(map, "")->number == 3);
    assert_null(document_find(map, "B"));
    assert_null(document_find(map, "bb"));
    assert_null(document_find(NULL, "b"));
    assert_null(document_find(document_find(map, "b"), "b"));
    assert_null(document_find(document_find(map, "list"), "b"));
    err_clear(&e);
    assert_ptr_equal(document_need(map, "b", path, &e), document_find(map, "b"));
    assert_int_equal(e.kind, ERR_NONE);
    assert_null(document_need(map, "c", path, &e));
    expect_error(&e, 1, "'c' is missing");
    err_clear(&e);
    assert_null(document_need(NULL, "c", "y.json", &e));
    expect_error(&e, 0, "'c' is missing");
    assert_string_equal(e.file, "y.json");
    /* the line of the mapping whose key it is */
    map = good_data("x: 1\ny:\n  z: 2\n");
    err_clear(&e);
    assert_null(document_need(document_find(map, "y"), "c", path, &e));
    expect_error(&e, 2, "'c' is missing");
}

/* What is no finite number, as the single value `x` and in the list of two, `l`. */
static void numbers_are_finite_and_as_many_as_asked(void **state)
{
    static const char *const wrong[] = {"\"1\"", "word",  "null",   ".inf", "inf",
                                        "nan",   "1e999", "-1e999", "true", "{a: 1}",
                                        "[1]",   "[]",    "[1, 2]", "[[1]]"};
    struct err e;
    double x = 7, l[3] = {7, 7, 7};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char s[100];
        snprintf(s, sizeof s, "\nx: %s\nl:\n  [1,\n  %s]\n", wrong[i], wrong[i]);
        const struct node *map = good_data(s);
        err_clear(&e);
        if (document_number(map, "x", path, &x, &e)) fail_msg("x: %s is a number", wrong[i]);
        expect_error(&e, 2, "'x'");
        err_clear(&e);
        if (document_numbers(map, "l", path, l, 2, &e)) fail_msg("l: %s is a number", wrong[i]);
        expect_error(&e, 5, "'l'");
        int n = 7;
        err_clear(&e);
        assert_false(document_integer(map, "x", path, -10, 10, &n, &e));
        assert_int_equal(n, 7);
    }
    const struct node *map = good_data("x: -2.5\nl: [1, 2]\nempty: []\n");
    err_clear(&e);
    assert_true(document_number(map, "x", path, &x, &e) && x == -2.5);
    assert_true(document_numbers(map, "l", path, l, 2, &e));
    assert_true(l[0] == 1 && l[1] == 2 && l[2] == 7);
    assert_true(document_numbers(map, "empty", path, l, 0, &e));
    assert_false(document_number(map, "y", path, &x, &e));
    expect_error(&e, 1, "'y' is missing");
    static const struct {
        const char *key;
        int n;
        const char *said;
    } row[] = {
        {"l", 1, "'l' must be a list of 1 numbers; it has 2"},
        {"l", 3, "'l' must be a list of 3 numbers; it has 2"},
        {"empty", 1, "'empty' must be a list of 1 numbers; it has 0"},
        {"x", 1, "'x' must be a list of 1 numbers; it has 0"},
        {"z", 1, "'z' is missing"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        err_clear(&e);
        assert_false(document_numbers(map, row[i].key, path, l, row[i].n, &e));
        assert_non_null(strstr(e.text, row[i].said));
    }
}

static void integers_lie_in_their_range(void **state)
{
    const struct node *map =
        good_data("a: 3\nb: 3.0\nc: 30e-1\nd: 3.5\ne: -3\nf: 2147483647\ng: 2147483648\n"
                  "h: -2147483648\ni: 1e300\nj: -0.0\n");
    static const struct {
        const char *key;
        int lo, hi;
        bool good;
        int i;
    } row[] = {
        {"a", 3, 3, true, 3},
        {"a", 4, 9, false, 0},
        {"a", 0, 2, false, 0},
        {"b", 0, 9, true, 3},
        {"c", 0, 9, true, 3},
        {"d", 0, 9, false, 0},
        {"e", -3, 9, true, -3},
        {"e", -2, 9, false, 0},
        {"f", INT32_MIN, INT32_MAX, true, INT32_MAX},
        {"g", INT32_MIN, INT32_MAX, false, 0},
        {"h", INT32_MIN, INT32_MAX, true, INT32_MIN},
        {"i", INT32_MIN, INT32_MAX, false, 0},
        {"j", 0, 0, true, 0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct err e;
        int i = -77;
        err_clear(&e);
        const bool good = document_integer(map, row[k].key, path, row[k].lo, row[k].hi, &i, &e);
        if (good != row[k].good) fail_msg("row %d: %d, %s", (int)k, i, e.text);
        assert_int_equal(i, good ? row[k].i : -77);
        if (good) continue;
        char said[80];
        snprintf(said, sizeof said, "'%s' must be an integer from %d to %d, not ", row[k].key,
                 row[k].lo, row[k].hi);
        expect_error(&e, row[k].key[0] - 'a' + 1, said);
    }
}

static void nested_lists_are_flat_in_their_order(void **state)
{
    const struct node *map = good_data("m: [[1, 2], [3, [4]], [], 5]\n"
                                       "bad: [1,\n [2,\n word]]\n"
                                       "map: [1, {a: 2}]\none: 9\n");
    double x[7] = {-1, -1, -1, -1, -1, -1, -1};
    struct err e;
    (void)state;
    const struct node *m = document_find(map, "m");
    assert_int_equal(document_count(m), 5);
    assert_int_equal(document_count(document_find(map, "bad")), 3);
    assert_int_equal(document_count(document_find(map, "map")), 2);
    assert_int_equal(document_count(document_find(map, "one")), 1);
    err_clear(&e);
    assert_true(document_flat(m, "M", path, x, 5, &e));
    for (int i = 0; i < 5; i++) assert_true(x[i] == i + 1);
    assert_true(x[5] == -1);
    /* never written beyond what was asked for */
    for (int i = 0; i < 7; i++) x[i] = -1;
    assert_false(document_flat(m, "M", path, x, 4, &e));
    expect_error(&e, 1, "'M' has more than the 4 numbers expected");
    assert_true(x[4] == -1);
    err_clear(&e);
    assert_false(document_flat(m, "M", path, x, 6, &e));
    expect_error(&e, 1, "'M' has 5 of the 6 numbers expected");
    err_clear(&e);
    assert_false(document_flat(document_find(map, "bad"), "B", path, x, 3, &e));
    expect_error(&e, 4, "'B' must hold finite numbers");
    err_clear(&e);
    assert_false(document_flat(document_find(map, "map"), "N", path, x, 2, &e));
    expect_error(&e, 5, "'N' must hold finite numbers");
    err_clear(&e);
    assert_true(document_flat(document_find(map, "one"), "one", path, x, 1, &e) && x[0] == 9);
}

static void texts_may_be_missing(void **state)
{
    const struct node *map = good_data("a: word\nb: 5\nc: ~\nd: \"5\"\ne: [x]\n");
    (void)state;
    assert_string_equal(document_text(map, "a"), "word");
    assert_string_equal(document_text(map, "b"), "");
    assert_string_equal(document_text(map, "c"), "");
    assert_string_equal(document_text(map, "d"), "5");
    assert_string_equal(document_text(map, "e"), "");
    assert_string_equal(document_text(map, "f"), "");
    assert_string_equal(document_text(NULL, "a"), "");
}

static void settings_go_back_to_one_line(void **state)
{
    static const struct {
        const char *written, *flow, *maps; /* NULL: refused */
    } row[] = {
        {"8", "8", NULL},
        {"", "", NULL},
        {"\"a: b\"", "a: b", NULL},
        {"[]", "[]", "[]"},
        {"[1]", "[1]", NULL},
        {"[1, 2 us,   [c, [d], []], '']", "[1, 2 us, [c, [d], []], ]", NULL},
        {"\n  - 1\n  - [2, 3]", "[1, [2, 3]]", NULL},
        {"{b: 1}", NULL, NULL},
        {"[1, {b: 2}]", NULL, NULL},
        {"[{b: 2}, 1]", NULL, NULL},
        {"[[{b: 2}]]", NULL, NULL},
        {"[{b: 2}]", NULL, "[{b: 2}]"},
        {"[{}]", NULL, "[{}]"},
        {"[{b: 2,   c: 1 us}, {d: x}]", NULL, "[{b: 2, c: 1 us}, {d: x}]"},
        {"\n  - b: 2\n    c: 3\n  - d:", NULL, "[{b: 2, c: 3}, {d: }]"},
        {"[{b: [1]}]", NULL, NULL},
        {"[{b: {c: 1}}]", NULL, NULL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char s[200];
        struct err e;
        snprintf(s, sizeof s, "# first\na: %s\n", row[i].written);
        const struct node *a = good_settings(s)->child;
        err_clear(&e);
        const char *flow = document_flow(a, "KEY", "x.yaml", arena, &e),
                   *maps = document_flow_maps(a, arena);
        if (!row[i].flow) {
            assert_null(flow);
            assert_true(e.line >= 2 && e.line <= 4);
            expect_error(&e, e.line, "KEY: a mapping '{");
            assert_string_equal(e.file, "x.yaml");
        } else {
            assert_string_equal(flow, row[i].flow);
            /* and from one line again to the same */
            snprintf(s, sizeof s, "a: %s\n", flow);
            if (a->kind == NODE_LIST && !strstr(flow, ", ]"))
                assert_string_equal(
                    document_flow(good_settings(s)->child, "KEY", "x.yaml", arena, &e), flow);
        }
        if (!row[i].maps) assert_null(maps);
        else assert_string_equal(maps, row[i].maps);
    }
    struct err e;
    err_clear(&e);
    assert_null(
        document_flow(good_settings("a:\n - 1\n - - 2\n   - b: 3\n")->child, "a", "f", arena, &e));
    expect_error(&e, 4, "a: a mapping '{b: ...}' where a value is expected");
    err_clear(&e);
    assert_null(document_flow(good_settings("a: {}\n")->child, "a", "f", arena, &e));
    expect_error(&e, 1, "a: a mapping '{: ...}'");
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin, end)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(entries_are_found_by_key),    TEST(numbers_are_finite_and_as_many_as_asked),
        TEST(integers_lie_in_their_range), TEST(nested_lists_are_flat_in_their_order),
        TEST(texts_may_be_missing),        TEST(settings_go_back_to_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
