/* test_column.c - one table of columns gives the same values to SQL, JSON and the terminal. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "measure/run_row.h"

enum fruit { APPLE, PEAR };
static const char *const fruit_word[] = {"apple", "pear"};

struct inner {
    int64_t large;
};
struct made {
    double real;
    int count;
    enum fruit fruit;
    bool ripe;
    char name[16];
    const char *note;
    uint64_t mark;
    const struct inner *inner;
};

static bool is_pear(const void *row) { return ((const struct made *)row)->fruit == PEAR; }

static void twice(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    v->kind = VALUE_INT;
    v->integer = 2 * ((const struct made *)row)->count;
}

static void list(const struct column *c, const void *row, struct json *j)
{
    (void)c;
    json_array(j);
    json_int(j, ((const struct made *)row)->count);
    json_end(j);
}

#define MADE(member) .offset = offsetof(struct made, member)

static const struct column made_column[] = {
    {"real_s", COLUMN_REAL, MADE(real), .flags = COLUMN_NULL, .doc = "a time", .title = "real ms",
     .width = 9,
     .style = 'f', .digits = 2, .scale = 1e3},
    {"count", COLUMN_INT, MADE(count), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,
     .doc = "a count",
     .title = "n", .width = 4},
    {"fruit", COLUMN_WORD, MADE(fruit), WORDS(fruit_word), .doc = "a word", .title = "fruit",
     .before = "  ",
     .width = -7},
    {"ripe", COLUMN_BOOL, MADE(ripe), .doc = "a truth"},
    {"name", COLUMN_CHARS, MADE(name), .doc = "a text", .key = "called", .title = "name"},
    {"note", COLUMN_STRING, MADE(note), .known = is_pear, .flags = COLUMN_NULL | COLUMN_OPTIONAL,
     .doc = "a text that may be missing"},
    {"mark", COLUMN_HEX, MADE(mark), .flags = COLUMN_NO_JSON, .doc = "a digest"},
    {"large", COLUMN_INT64, .part = PART(struct made, inner),
     .offset = offsetof(struct inner, large),
     .known = is_pear, .flags = COLUMN_NULL, .doc = "elsewhere"},
    {"twice", COLUMN_INT, .value = twice, .flags = COLUMN_NO_SQL, .doc = "computed"},
    {"list", COLUMN_INT, .json = list, .flags = COLUMN_NO_SQL, .doc = "a list"},
};
static const struct column_table made_columns = COLUMNS(made_column);

static const struct inner inner = {1234567890123};
static const struct made full = {0.25, 3, PEAR, true, "n\"1\"", "so", 0xab, &inner};
static const struct made empty = {.real = NAN, .count = -1, .inner = &inner};

/* What `write` puts into a file, read back. */
static const char *written(void (*write)(FILE *out))
{
    static char buffer[1024];
    FILE *f = tmpfile();
    assert_non_null(f);
    write(f);
    rewind(f);
    buffer[fread(buffer, 1, sizeof buffer - 1, f)] = '\0';
    fclose(f);
    return buffer;
}

static void write_json(FILE *out)
{
    const struct made row[] = {full, empty};
    struct json j = json_make(out);
    columns_json_list(&made_columns, row, 2, sizeof *row, &j);
    json_finish(&j);
}

static void write_text(FILE *out)
{
    columns_title(&made_columns, out);
    columns_print(&made_columns, &full, out);
    columns_print(&made_columns, &empty, out);
}

static void json_has_sorted_keys_and_null_for_what_is_absent(void **state)
{
    (void)state;
    assert_string_equal(written(write_json),
                        "[{\"called\": \"n\\\"1\\\"\", \"count\": 3, \"fruit\": \"pear\", "
                        "\"large\": 1234567890123, \"list\": [3], \"note\": \"so\", \"real_s\": "
                        "0.25, \"ripe\": true, \"twice\": 6}, {\"called\": \"\", \"count\": null, "
                        "\"fruit\": \"apple\", \"large\": null, \"list\": [-1], \"real_s\": null, "
                        "\"ripe\": false, \"twice\": -2}]\n");
}

static void the_terminal_gets_aligned_cells_and_dashes(void **state)
{
    (void)state;
    assert_string_equal(written(write_text), "  real ms   n  fruit  name\n"
                                             "   250.00   3  pear   n\"1\"\n"
                                             "        -   -  apple  \n");
}

static void the_database_gets_definitions_with_types_and_comments(void **state)
{
    struct text t = {0};
    (void)state;
    columns_define(&made_columns, &t);
    assert_string_equal(t.s, "    real_s REAL, -- a time\n"
                             "    count INTEGER, -- a count\n"
                             "    fruit TEXT NOT NULL CHECK (fruit IN ('apple', 'pear')), -- a "
                             "word\n"
                             "    ripe INTEGER NOT NULL, -- a truth\n"
                             "    name TEXT NOT NULL, -- a text\n"
                             "    note TEXT, -- a text that may be missing\n"
                             "    mark TEXT NOT NULL, -- a digest\n"
                             "    large INTEGER, -- elsewhere\n");
    text_free(&t);
    assert_int_equal(columns_list(&made_columns, &t), 8);
    assert_string_equal(t.s, ", real_s, count, fruit, ripe, name, note, mark, large");
    text_free(&t);
}

static void a_digest_is_sixteen_digits(void **state)
{
    struct column_value v = {0};
    (void)state;
    column_read(&made_column[6], &full, &v);
    assert_int_equal(v.kind, VALUE_TEXT);
    assert_string_equal(v.text, "00000000000000ab");
}

/* A stage's sum over ranks is absent where it does not fit; the extremes stand. */
static void a_sum_that_wraps_is_absent(void **state)
{
    struct stage_time t[2] = {{.compute_ps = INT64_MAX - 1},
                              {.compute_ps = 2, .messages = 5, .work.sqrt = 7}};
    struct run_result r = {.nrank = 2, .nstage = 1, .stage = t};
    const struct stage_row row = stage_row_make(&r, 0);
    struct column_value v = {0};
    (void)state;
    assert_false(row.compute.fits);
    assert_int_equal(row.compute.min, 2);
    assert_int_equal(row.all.messages, 5);
    assert_int_equal(row.all.work.sqrt, 7);
    column_read(&stage_row_columns.column[1], &row, &v);
    assert_int_equal(v.kind, VALUE_ABSENT);
    column_read(&stage_row_columns.column[3], &row, &v);
    assert_int_equal(v.integer, INT64_MAX - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_has_sorted_keys_and_null_for_what_is_absent),
        cmocka_unit_test(the_terminal_gets_aligned_cells_and_dashes),
        cmocka_unit_test(the_database_gets_definitions_with_types_and_comments),
        cmocka_unit_test(a_digest_is_sixteen_digits),
        cmocka_unit_test(a_sum_that_wraps_is_absent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
