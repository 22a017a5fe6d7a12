/* test_json.c - the JSON writer: commas, nesting, escapes, and numbers that JSON does not have. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/json.h"

static void a_nested_document_is_written(void **state)
{
    (void)state;
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    struct json j = json_make(f);
    json_object(&j);
    json_key(&j, "empty");
    json_array(&j);
    json_end(&j);
    json_key(&j, "list");
    json_array(&j);
    json_int(&j, INT64_MIN);
    json_real(&j, 0.1);
    json_object(&j);
    json_key(&j, "x");
    json_null(&j);
    json_end(&j);
    json_object(&j);
    json_end(&j);
    json_bool(&j, true);
    json_bool(&j, false);
    json_end(&j);
    json_key(&j, "last");
    json_text(&j, "");
    json_end(&j);
    json_finish(&j);
    fclose(f);
    assert_string_equal(
        out,
        "{\"empty\": [], \"list\": [-9223372036854775808, 0.1, {\"x\": null}, {}, true, false], "
        "\"last\": \"\"}\n");
    free(out);
}

static char *one_text(const char *s)
{
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    struct json j = json_make(f);
    json_text(&j, s);
    json_finish(&j);
    fclose(f);
    return out;
}

static void texts_are_escaped(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"a\"b\\c", "\"a\\\"b\\\\c\"\n"},
        {"\n\t\r\001\177", "\"\\n\\t\\u000d\\u0001\\u007f\"\n"},
        {"\303\244 \342\202\254 \360\237\230\200", "\"\303\244 \342\202\254 \360\237\230\200\"\n"},
        {"\377 \300\200 \355\240\200 \342\202",
         "\"\\ufffd \\ufffd\\ufffd \\ufffd\\ufffd\\ufffd \\ufffd\\ufffd\"\n"},
        {"\340\200\200\364\220\200\200\303",
         "\"\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\"\n"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        char *out = one_text(pairs[i][0]);
        assert_string_equal(out, pairs[i][1]);
        free(out);
    }
}

static void numbers_that_json_does_not_have_are_null(void **state)
{
    (void)state;
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    struct json j = json_make(f);
    json_array(&j);
    json_real(&j, NAN);
    json_real(&j, INFINITY);
    json_real(&j, -1e300);
    json_real(&j, 1.0 / 3);
    json_end(&j);
    json_finish(&j);
    fclose(f);
    assert_string_equal(out, "[null, null, -1e+300, 0.3333333333333333]\n");
    free(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_nested_document_is_written),
        cmocka_unit_test(texts_are_escaped),
        cmocka_unit_test(numbers_that_json_does_not_have_are_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
