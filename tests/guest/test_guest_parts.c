/* test_guest_parts.c - what ranks of people's programs write and publish, and parameters that they
 * declare: each limit, each refusal, and random texts and pieces against plain copies. */
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
#include "guest/guest_lines.h"
#include "guest/guest_results.h"
#include "guest/guest_world.h"
#include "spec/field.h"

/* --- lines --- */

static void lines_are_kept_as_they_are_written(void **state)
{
    struct text said = {0};
    struct guest_line line = {0};
    const enum program_output keep = PROGRAM_OUTPUT_KEEP;
    (void)state;
    guest_line_add(&line, 3, 1, "first\nsec", 9, keep, &said);
    assert_string_equal(said.s, "3 1 first\n");
    guest_line_add(&line, 3, 1, "", 0, keep, &said);
    guest_line_add(&line, 3, 1, "ond\n\nx\0y\n", 9, keep, &said);
    assert_string_equal(said.s, "3 1 first\n3 1 second\n3 1 \n3 1 x?y\n");
    guest_line_add(&line, 3, 2, "no end", 6, keep, &said);
    guest_line_end(&line, 3, 2, keep, &said);
    assert_string_equal(said.s, "3 1 first\n3 1 second\n3 1 \n3 1 x?y\n3 2 no end\n");
    assert_null(line.text);
    assert_int_equal(line.n, 0);
    /* nothing begun: nothing more */
    guest_line_end(&line, 3, 2, keep, &said);
    assert_int_equal(said.length, 45);
    text_free(&said);
    /* nobody keeps it */
    guest_line_add(&line, 3, 1, "gone\n", 5, keep, NULL);
    guest_line_end(&line, 3, 1, keep, NULL);
}

/* Any text in any pieces: the same lines, those that are too long cut. */
static void pieces_do_not_matter(void **state)
{
    struct random r = random_make(101, 0, 0);
    (void)state;
    for (int round = 0; round < 30; round++) {
        enum { N = 20000 };
        static char data[N];
        struct text said = {0}, expected = {0};
        struct guest_line line = {0};
        const uint64_t length = round % 3 ? 40 : 6000; /* of lines, about */
        for (int i = 0; i < N; i++)
            data[i] = random_below(&r, length) ? (char)('a' + random_below(&r, 26)) : '\n';
        /* a cut line goes on in the next; of exactly the limit, its end makes an empty one */
        size_t begin = 0;
        for (size_t i = 0; i < N; i++) {
            const bool ends = data[i] == '\n', full = !ends && i + 1 - begin == GUEST_LINE;
            if (!ends && !full) continue;
            text_add(&expected, "7 2 %.*s\n", (int)(i - begin + full), data + begin);
            begin = i + 1;
        }
        if (begin < N) text_add(&expected, "7 2 %.*s\n", (int)(N - begin), data + begin);
        for (size_t i = 0; i < N;) {
            size_t n = random_below(&r, 3000);
            if (n > N - i) n = N - i;
            guest_line_add(&line, 7, 2, data + i, n, PROGRAM_OUTPUT_KEEP, &said);
            i += n;
        }
        guest_line_end(&line, 7, 2, PROGRAM_OUTPUT_KEEP, &said);
        assert_string_equal(said.s, expected.s);
        text_free(&said);
        text_free(&expected);
    }
}

static void what_is_kept_has_a_limit(void **state)
{
    struct text said = {0};
    struct guest_line line = {0};
    char one[1000];
    (void)state;
    memset(one, 'x', sizeof one - 1);
    one[sizeof one - 1] = '\n';
    for (int i = 0; i < 2000; i++)
        guest_line_add(&line, 0, 1, one, sizeof one, PROGRAM_OUTPUT_KEEP, &said);
    guest_line_end(&line, 0, 1, PROGRAM_OUTPUT_KEEP, &said);
    /* whole lines: the last one begins below the limit */
    assert_true(said.length >= GUEST_SAID_MOST && said.length < GUEST_SAID_MOST + sizeof one + 4);
    assert_int_equal(said.s[said.length - 1], '\n');
    text_free(&said);
}

/* What the function shows on a descriptor, through a pipe. */
static void shown(int descriptor, enum program_output output, char seen[200])
{
    int end[2];
    struct guest_line line = {0};
    const int stream = descriptor == 2 ? 2 : 1;
    fflush(NULL);
    const int kept = dup(descriptor);
    assert_int_equal(pipe(end), 0);
    assert_true(dup2(end[1], descriptor) >= 0);
    guest_line_add(&line, 12, stream, "one\n\033[1mtw", 10, output, NULL);
    guest_line_add(&line, 12, stream, "o\n", 2, output, NULL);
    guest_line_end(&line, 12, stream, output, NULL);
    fflush(NULL);
    dup2(kept, descriptor);
    close(kept);
    close(end[1]);
    const ssize_t n = read(end[0], seen, 199);
    seen[n > 0 ? n : 0] = '\0';
    close(end[0]);
}

/* Shown at once and as they are, each line whole, with its rank where that is asked for; on the
 * stream that they were written to. */
static void lines_are_shown_as_asked(void **state)
{
    static const char *const wanted[] = {
        [PROGRAM_OUTPUT_KEEP] = "",
        [PROGRAM_OUTPUT_SHOW] = "one\n\033[1mtwo\n",
        [PROGRAM_OUTPUT_LABEL] = "[12] one\n[12] \033[1mtwo\n",
    };
    (void)state;
    for (int descriptor = 1; descriptor <= 2; descriptor++)
        for (int output = 0; output < 3; output++) {
            char seen[200];
            shown(descriptor, (enum program_output)output, seen);
            assert_string_equal(seen, wanted[output]);
        }
}

/* --- results --- */

static void published_pieces_make_a_result(void **state)
{
    struct random r = random_make(102, 0, 0);
    (void)state;
    for (int round = 0; round < 200; round++) {
        enum { N = 60 };
        struct guest_results all = {0};
        struct guest_result *g = &all.of[round % MIMDSIM_OUTPUTS];
        double model[N];
        bool given[N] = {false};
        int64_t n = 0;
        for (int tries = 0; tries < 12; tries++) {
            double data[N];
            char why[120] = "";
            const int64_t first = (int64_t)random_below(&r, N),
                          m = (int64_t)random_below(&r, (uint64_t)(N - first) + 1);
            int64_t clash = -1;
            for (int64_t i = 0; i < m; i++) {
                data[i] = (double)random_below(&r, 1000);
                if (clash < 0 && given[first + i]) clash = first + i;
            }
            const bool good = guest_results_put(&all, round % MIMDSIM_OUTPUTS, first, m, data, why,
                                                (int)sizeof why);
            assert_true(good == (clash < 0));
            if (!good) {
                char said[80];
                snprintf(said, sizeof said, "publishes element %d of a result again", (int)clash);
                assert_string_equal(why, said);
                break; /* the run has failed */
            }
            for (int64_t i = 0; i < m; i++) model[first + i] = data[i], given[first + i] = true;
            if (first + m > n) n = first + m;
            assert_int_equal(g->n, n);
            int64_t gap = -1;
            for (int64_t i = n - 1; i >= 0; i--) {
                if (!given[i]) gap = i;
                if (given[i]) assert_true(g->x[i] == model[i]);
                else assert_true(isnan(g->x[i]));
            }
            assert_int_equal(guest_results_gap(g), gap);
        }
        guest_results_clear(&all);
        for (int i = 0; i < MIMDSIM_OUTPUTS; i++) assert_true(all.of[i].n == 0 && !all.of[i].x);
    }
}

static void results_have_their_limits(void **state)
{
    static const struct {
        int64_t first, n;
    } row[] = {
        {-1, 1},        {0, -1},        {GUEST_MOST_NUMBERS, 1}, {GUEST_MOST_NUMBERS - 1, 2},
        {INT64_MAX, 1}, {INT64_MAX, 9}, {1, INT64_MAX},          {INT64_MIN, 1},
        {0, INT64_MIN}, {5, INT64_MIN},
    };
    struct guest_results all = {0};
    char why[160];
    const double nan = NAN;
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        assert_false(
            guest_results_put(&all, 0, row[k].first, row[k].n, NULL, why, (int)sizeof why));
        assert_non_null(strstr(why, "expected 0 to 268435455"));
        assert_int_equal(all.of[0].n, 0);
    }
    assert_true(guest_results_put(&all, 0, GUEST_MOST_NUMBERS, 0, NULL, why, (int)sizeof why) ||
                all.of[0].n == 0);
    guest_results_clear(&all);
    /* a number that is none has come all the same */
    assert_true(guest_results_put(&all, 1, 0, 1, &nan, why, (int)sizeof why));
    assert_int_equal(guest_results_gap(&all.of[1]), -1);
    assert_false(guest_results_put(&all, 1, 0, 1, &nan, why, (int)sizeof why));
    assert_int_equal(guest_results_gap(&all.of[2]), -1);
    guest_results_clear(&all);
}

static void differences_are_relative_to_the_largest(void **state)
{
    static const struct {
        int n, m;
        double x[3], y[3], difference;
    } row[] = {
        {0, 0, {0}, {0}, 0},
        {1, 1, {3}, {3}, 0},
        {1, 1, {3}, {4}, 0.25},
        {1, 1, {4}, {-4}, 2},
        {3, 3, {1, 2, 8}, {1, 3, 8}, 0.125},
        {3, 3, {1, 2, -8}, {1, 3, -8}, 0.125},
        {2, 2, {0, 0.5}, {0, 0}, 0.5}, /* of zeros the difference itself */
        {2, 2, {1e-300, 0}, {0, 0}, 1e-300},
        {2, 3, {1, 2}, {1, 2, 3}, NAN},
        {0, 1, {0}, {1}, NAN},
        {2, 2, {1, NAN}, {1, 2}, NAN},
        {2, 2, {1, 2}, {NAN, 2}, NAN},
        {2, 2, {1, INFINITY}, {1, INFINITY}, NAN},
        {2, 2, {1, 2}, {1, INFINITY}, NAN},
        {2, 2, {1, INFINITY}, {1, 2}, INFINITY},
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        double x[3], y[3];
        memcpy(x, row[k].x, sizeof x), memcpy(y, row[k].y, sizeof y);
        const struct guest_result a = {.n = row[k].n, .x = x}, b = {.n = row[k].m, .x = y};
        const double d = guest_results_difference(&a, &b), e = row[k].difference;
        if (!(isnan(e) ? isnan(d) : d == e)) fail_msg("row %d: %g", (int)k, d);
    }
}

/* --- parameters --- */

static int64_t whole = 12;
static double real = 2e-6;
static int flag = 1, choice = 1;

static int64_t nine = 9;
static int two = 2, minus = -1;
static double no_number = NAN;

static void declarations_become_fields_or_are_refused(void **state)
{
    const int W = MIMDSIM_WHOLE, R = MIMDSIM_REAL, F = MIMDSIM_FLAG, C = MIMDSIM_CHOICE;
    const char *const name31 = "a23456789012345678901234567890b",
                      *const name32 = "a234567890123456789012345678901b";
    const struct {
        struct mimdsim_parameter p;
        const char *fallback, *why;
    } row[] = {
        {{"n", W, 0, &whole, "", NULL, 0, 100, "doc"}, "12", NULL},
        {{"n", W, 0, &whole, NULL, NULL, 12, 12, NULL}, "12", NULL},
        {{"t", R, 0, &real, "s", NULL, 0, 1, ""}, "2 us", NULL},
        {{"f", F, 0, &flag, "", NULL, 0, 0, ""}, "true", NULL},
        {{"c", C, 0, &choice, "", "ring|tree", 0, 0, ""}, "tree", NULL},
        {{name31, W, 0, &whole, "", NULL, 0, 100, ""}, "12", NULL},
        {{"A_9", W, 0, &whole, "", NULL, 0, 100, ""}, "12", NULL},
        {{name32, W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters, digits and _"},
        {{"9a", W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters, digits and _"},
        {{"_a", W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters, digits and _"},
        {{"", W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters, digits and _"},
        {{"a-b", W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters, digits and _"},
        {{"\xc3\xa9", W, 0, &whole, "", NULL, 0, 100, ""}, NULL, "a name is letters"},
        {{"n", 0, 0, &whole, "", NULL, 0, 100, ""}, NULL, "it has no such kind"},
        {{"n", 5, 0, &whole, "", NULL, 0, 100, ""}, NULL, "it has no such kind"},
        {{"n", -1, 0, &whole, "", NULL, 0, 100, ""}, NULL, "it has no such kind"},
        {{"n", W, 0, NULL, "", NULL, 0, 100, ""}, NULL, "it has no variable"},
        {{"n", W, 0, &whole, "furlong", NULL, 0, 100, ""}, NULL, "its unit is not known"},
        {{"n", W, 0, &whole, "s", NULL, 0, 100, ""}, NULL, "whole numbers have no unit but B"},
        {{"c", C, 0, &choice, "", NULL, 0, 0, ""}, NULL, "its choices are not words between bars"},
        {{"c", C, 0, &choice, "", "", 0, 0, ""}, NULL, "its choices are not words between bars"},
        {{"c", C, 0, &choice, "", "a||b", 0, 0, ""}, NULL, "its choices are not words"},
        {{"c", C, 0, &choice, "", "a|b|", 0, 0, ""}, NULL, "its choices are not words"},
        {{"c", C, 0, &choice, "", "|a|b", 0, 0, ""}, NULL, "its choices are not words"},
        {{"c", C, 0, &two, "", "a|b", 0, 0, ""}, NULL, "with a place in its choices"},
        {{"c", C, 0, &minus, "", "a|b", 0, 0, ""}, NULL, "with a place in its choices"},
        {{"n", W, 0, &nine, "", NULL, 10, 100, ""}, NULL, "its variable is initialised with 9: "},
        {{"n", W, 0, &nine, "", NULL, 0, 8, ""}, NULL, "its variable is initialised with 9: "},
        {{"t", R, 0, &real, "s", NULL, 1, 2, ""}, NULL, "its variable is initialised with 2 us: "},
        {{"t", R, 0, &no_number, "", NULL, 0, 1, ""}, NULL, "its variable is initialised with "},
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct arena *a = arena_create();
        struct field f;
        char why[300] = "";
        const bool good = guest_parameter_field(&row[k].p, &f, a, why, (int)sizeof why);
        if (good != (row[k].fallback != NULL)) fail_msg("row %d: '%s'", (int)k, why);
        if (good) {
            assert_string_equal(f.key, row[k].p.name);
            if (strcmp(f.fallback, row[k].fallback) != 0)
                fail_msg("row %d: '%s'", (int)k, f.fallback);
            assert_true(f.key != row[k].p.name); /* the image goes away */
        } else if (strncmp(why, row[k].why, strlen(row[k].why)) != 0 && !strstr(why, row[k].why)) {
            fail_msg("row %d: '%s'", (int)k, why);
        }
        arena_destroy(a);
    }
}

static void values_are_written_into_the_variables(void **state)
{
    static int64_t n = 1, bytes = 1, untouched = 5;
    static double t = 1;
    static int f = 1, c = 0;
    const struct mimdsim_program p = {
        .parameter = {{"n", MIMDSIM_WHOLE, 0, &n, "", NULL, -1e18, 1e18, ""},
                      {"size", MIMDSIM_WHOLE, 0, &bytes, "B", NULL, 0, 1e12, ""},
                      {"other", MIMDSIM_WHOLE, 0, &untouched, "", NULL, 0, 9, ""},
                      {"t", MIMDSIM_REAL, 0, &t, "s", NULL, 0, 10, ""},
                      {"f", MIMDSIM_FLAG, 0, &f, "", NULL, 0, 0, ""},
                      {"c", MIMDSIM_CHOICE, 0, &c, "", "ring|tree|star", 0, 0, ""}}};
    struct arena *a = arena_create();
    (void)state;
    guest_parameters_set(&p, "n = -12345678901\nsize = 64 KiB\nt = 250 ns\nf = false\nc = star\n",
                         a);
    assert_true(n == -12345678901 && bytes == 65536 && untouched == 5);
    assert_true(t == 250e-9 && f == 0 && c == 2);
    guest_parameters_set(&p, "f = true\nc = ring\n", a);
    assert_true(n == -12345678901 && f == 1 && c == 0);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_are_kept_as_they_are_written),
        cmocka_unit_test(pieces_do_not_matter),
        cmocka_unit_test(what_is_kept_has_a_limit),
        cmocka_unit_test(lines_are_shown_as_asked),
        cmocka_unit_test(published_pieces_make_a_result),
        cmocka_unit_test(results_have_their_limits),
        cmocka_unit_test(differences_are_relative_to_the_largest),
        cmocka_unit_test(declarations_become_fields_or_are_refused),
        cmocka_unit_test(values_are_written_into_the_variables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
