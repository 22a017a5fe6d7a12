/* test_argument_line.c - words become a line and the line the same words again, whatever is in
 * them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "base/argument_line.h"
#include "base/random.h"

enum { MOST_WORDS = 8, MOST_LETTERS = 12 };

static void words_come_back_as_they_were(void **state)
{
    (void)state;
    static const char letters[] = "ab \t'\"\\[]$*-\n";
    struct random random = random_make(11, 0, 0);
    char why[128];
    for (int round = 0; round < 3000; round++) {
        char word[MOST_WORDS][MOST_LETTERS + 1];
        struct arena *a = arena_create();
        struct text line = {0};
        char **argv;
        const int n = (int)random_below(&random, MOST_WORDS);
        text_add(&line, "%s", "");
        for (int i = 0; i < n; i++) {
            const int length = (int)random_below(&random, MOST_LETTERS + 1);
            for (int k = 0; k < length; k++)
                word[i][k] = letters[random_below(&random, sizeof letters - 1)];
            word[i][length] = '\0';
            argument_line_add(&line, word[i]);
        }
        assert_int_equal(argument_line_split("name", line.s, &argv, a, why, sizeof why), n + 1);
        assert_string_equal(argv[0], "name");
        for (int i = 0; i < n; i++) assert_string_equal(argv[i + 1], word[i]);
        assert_null(argv[n + 1]);
        text_free(&line);
        arena_destroy(a);
    }
}

static void lines_are_divided_as_a_shell_divides_them(void **state)
{
    (void)state;
    char why[128] = "", **argv;
    struct arena *a = arena_create();
    assert_int_equal(argument_line_split("p", "  -n 10 'a b'\"c d\" e\\ f \"\\\"\" '\\' \"\" ",
                                         &argv, a, why, sizeof why),
                     8);
    assert_string_equal(argv[3], "a bc d");
    assert_string_equal(argv[4], "e f");
    assert_string_equal(argv[5], "\"");
    assert_string_equal(argv[6], "\\");
    assert_string_equal(argv[7], "");
    assert_int_equal(argument_line_split("p", "one 'two", &argv, a, why, sizeof why), -1);
    assert_non_null(strstr(why, "a quote has no end"));
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(words_come_back_as_they_were),
        cmocka_unit_test(lines_are_divided_as_a_shell_divides_them),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
