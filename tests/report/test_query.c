/* test_query.c - answers as a table for people and as one JSON document. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/store_fixture.h"
#include "report/report.h"

/* What report_query prints, to be freed. */
static char *answer(struct store_fixture *f, const char *sql, bool json)
{
    char *s = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&s, &size);
    bool ok = report_query(f->s, sql, 0, NULL, json, out, &f->e);
    fclose(out);
    if (!ok) fail_msg("%s", f->e.text);
    return s;
}

static void expect(struct store_fixture *f, const char *sql, bool json, const char *text)
{
    char *got = answer(f, sql, json);
    assert_string_equal(got, text);
    free(got);
}

static void columns_are_aligned_numbers_to_the_right(void **state)
{
    expect(*state,
           "SELECT 'a' AS name, 7 AS count, 0.5 AS share UNION ALL SELECT 'longer', 1234, NULL "
           "UNION ALL SELECT 'gr\xc3\xbc\xc3\x9f', 1, 1e-9",
           false,
           "name    count  share\n"
           "a           7    0.5\n"
           "longer   1234      -\n"
           "gr\xc3\xbc\xc3\x9f        1  1e-09\n");
}

static void no_rows_still_show_their_columns(void **state)
{
    expect(*state, "SELECT 1 AS a, 2 AS bcd WHERE 0", false, "a  bcd\n");
    expect(*state, "SELECT 1 AS a WHERE 0", true, "[]\n");
}

static void control_characters_do_not_reach_the_terminal(void **state)
{
    expect(*state, "SELECT 'x' || char(27) || '[2J' || char(10) || 'y' AS t", false,
           "t\nx [2J y\n");
}

static void json_keeps_kinds(void **state)
{
    char *got = answer(*state, "SELECT '12' AS t, 12 AS i, 0.1 AS r, NULL AS n, 'q\"' AS q", true);
    assert_non_null(strstr(got, "\"12\""));
    assert_non_null(strstr(got, "0.1"));
    assert_non_null(strstr(got, "null"));
    assert_non_null(strstr(got, "q\\\""));
    assert_true(got[0] == '[' && got[strlen(got) - 2] == ']');
    free(got);
}

static void wrong_sql_prints_nothing(void **state)
{
    struct store_fixture *f = *state;
    for (int json = 0; json < 2; json++) {
        char *s = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&s, &size);
        assert_false(report_query(f->s, "SELEC 1", 0, NULL, json, out, &f->e));
        assert_int_equal(f->e.kind, ERR_DATA);
        fclose(out);
        assert_int_equal(size, 0);
        free(s);
        err_clear(&f->e);
    }
}

static void an_output_that_cannot_be_written_is_an_error(void **state)
{
    struct store_fixture *f = *state;
    FILE *out = fopen("/dev/full", "w");
    if (out == NULL) skip();
    assert_false(report_query(f->s, "SELECT 1 AS a", 0, NULL, false, out, &f->e));
    assert_int_equal(f->e.kind, ERR_IO);
    fclose(out);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_store, drop_store)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(columns_are_aligned_numbers_to_the_right),
        TEST(no_rows_still_show_their_columns),
        TEST(control_characters_do_not_reach_the_terminal),
        TEST(json_keeps_kinds),
        TEST(wrong_sql_prints_nothing),
        TEST(an_output_that_cannot_be_written_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
