/* test_program.c - what programs share: outputs that ranks fill, what is left out, comparisons with
 * references, serial baselines; and that mistakes of a program stop it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/last_words.h"
#include "program/program.h"

static struct arena *arena;
static struct program_run run;
static struct run_result *result;
static const struct program_type plain = {.name = "plain"};

static int begin(void **state)
{
    (void)state;
    arena = arena_create();
    run = (struct program_run){.type = &plain};
    result = TAKE(arena, 1, struct run_result);
    return 0;
}

static int end(void **state)
{
    (void)state;
    arena_destroy(arena);
    return 0;
}

/* --- outputs --- */

static void outputs_begin_as_zeros(void **state)
{
    int64_t n = 7;
    (void)state;
    assert_null(program_output(&run, 0));
    assert_null(program_answer(&run, 0, &n));
    assert_int_equal(n, 0);
    program_want(&run, 0, 5, arena);
    program_want(&run, PROGRAM_OUTPUTS - 1, 0, arena);
    for (int i = 0; i < 5; i++) assert_true(program_output(&run, 0)[i] == 0);
    assert_ptr_equal(program_answer(&run, 0, &n), program_output(&run, 0));
    assert_int_equal(n, 5);
    /* an output of no numbers is wanted, and has no answer */
    assert_non_null(program_output(&run, PROGRAM_OUTPUTS - 1));
    assert_null(program_answer(&run, PROGRAM_OUTPUTS - 1, &n));
    assert_int_equal(n, 0);
    assert_null(program_answer(&run, PROGRAM_OUTPUTS, &n));
    assert_int_equal(n, 0);
}

static void elements_go_to_their_places_or_nowhere(void **state)
{
    static const struct {
        int output;
        int64_t first, n;
        bool good, kept;
    } row[] = {
        {0, 0, 5, true, true},
        {0, 4, 1, true, true},
        {0, 5, 0, true, true},
        {0, 0, 0, true, true},
        {0, 5, 1, false, false},
        {0, 4, 2, false, false},
        {0, 0, 6, false, false},
        {0, 6, 0, false, false},
        {0, -1, 1, false, false},
        {0, 0, -1, false, false},
        {0, 2, -1, false, false},
        {0, INT64_MAX, 1, false, false},
        {0, INT64_MAX, 5, false, false},
        {0, 1, INT64_MAX, false, false},
        {0, INT64_MIN, 1, false, false},
        /* what nobody wants is not kept, wherever it would be */
        {1, 0, 5, true, false},
        {1, -1, 5, true, false},
        {-1, 0, 1, true, false},
        {PROGRAM_OUTPUTS, 0, 1, true, false},
    };
    static const double data[6] = {1, 2, 3, 4, 5, 6};
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        char why[200] = "";
        program_want(&run, 0, 5, arena);
        const bool good =
            program_take(&run, row[k].output, row[k].first, row[k].n, data, why, (int)sizeof why);
        if (good != row[k].good) fail_msg("row %d: %s", (int)k, why);
        assert_true(good == (why[0] == '\0'));
        if (!good) assert_non_null(strstr(why, "of output 0, which has 5"));
        for (int i = 0; i < 5; i++) {
            const bool there = row[k].kept && i >= row[k].first && i < row[k].first + row[k].n;
            assert_true(program_output(&run, 0)[i] == (there ? data[i - row[k].first] : 0));
        }
    }
    char why[24];
    program_want(&run, 0, 5, arena);
    assert_false(program_take(&run, 0, 3, 4, data, why, (int)sizeof why));
    assert_string_equal(why, "elements 3 to 6 of outp"); /* as much as there is room for */
}

static int asked;
static const double own[2] = {8, 9};
static const double *own_answer(const struct program_run *r, int output, int64_t *n)
{
    asked = output + (r == &run ? 100 : 0);
    *n = 2;
    return own;
}
static bool own_take(struct program_run *r, int output, int64_t first, int64_t n, const double *x,
                     char *why, int size)
{
    (void)r, (void)why, (void)size;
    asked = output + (int)(10 * first + 100 * n);
    return x[0] == 8;
}

static void a_program_may_keep_its_outputs_itself(void **state)
{
    static const struct program_type type = {.answer = own_answer, .take = own_take};
    int64_t n;
    char why[10];
    (void)state;
    run.type = &type;
    program_want(&run, 3, 1, arena);
    assert_ptr_equal(program_answer(&run, 3, &n), own);
    assert_true(n == 2 && asked == 103);
    assert_true(program_take(&run, 3, 4, 2, own, why, (int)sizeof why));
    assert_int_equal(asked, 243);
    assert_false(program_take(&run, 3, 4, 1, own + 1, why, (int)sizeof why));
}

static void want_too_many(void) { program_want(&run, PROGRAM_OUTPUTS, 1, arena); }
static void want_below(void) { program_want(&run, -1, 1, arena); }

/* --- lists of the result --- */

static void what_is_put_back_is_not_left_out(void **state)
{
    struct omission item[RUN_MAX_OMISSIONS];
    struct left_out l = {.keep = 4 | 2, .item = item};
    char longer[400];
    (void)state;
    memset(longer, 'x', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    leave_out_add(&l, 2, 0, "put back", "asked for");
    leave_out_add(&l, 4, 0, "put back", "asked for");
    assert_int_equal(l.n, 0);
    leave_out_add(&l, 1, 0.25, "gravity", "there is none");
    leave_out_add(&l, 0, 0, longer, longer);
    assert_int_equal(l.n, 2);
    assert_int_equal(item[0].keep, 1);
    assert_true(item[0].bound == 0.25);
    assert_string_equal(item[0].what, "gravity");
    assert_string_equal(item[0].why, "there is none");
    /* texts are cut to their room, and end */
    assert_true(strlen(item[1].what) == sizeof item[1].what - 1);
    assert_true(strlen(item[1].why) == sizeof item[1].why - 1);
}

static void leave_out_too_many(void)
{
    struct omission item[RUN_MAX_OMISSIONS];
    struct left_out l = {.item = item};
    for (int i = 0; i <= RUN_MAX_OMISSIONS; i++) leave_out_add(&l, 1, 0, "a", "b");
}

static void errors_above_their_tolerance_make_a_run_invalid(void **state)
{
    static const struct {
        double relative, tolerance;
        bool good;
    } row[] = {
        {0, 0, true},    {1e-9, 1e-9, true},  {1.0000001e-9, 1e-9, false},
        {NAN, 1, false}, {1, NAN, false},     {INFINITY, 1, false},
        {-1, 0, true},   {1, INFINITY, true},
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        *result = (struct run_result){.status = RUN_OK};
        program_check_add(result, "tau", "rnea", row[k].relative, row[k].tolerance);
        assert_int_equal(result->status, row[k].good ? RUN_OK : RUN_INVALID);
        assert_true((result->text[0] == '\0') == row[k].good);
        assert_int_equal(result->nerror, 1);
        assert_memory_equal(&result->error[0].relative, &row[k].relative, sizeof(double));
        assert_memory_equal(&result->error[0].tolerance, &row[k].tolerance, sizeof(double));
        assert_string_equal(result->error[0].quantity, "tau");
        assert_string_equal(result->error[0].reference, "rnea");
    }
}

/* The first failure is told; what a run was before is not made better. */
static void the_first_wrong_number_is_told(void **state)
{
    (void)state;
    program_check_add(result, "tau", "rnea", 1e-12, 1e-9);
    program_check_add(result, "qdd", "aba", 0.0125, 1e-9);
    program_check_add(result, "lambda", "direct", 5, 1e-9);
    program_check_add(result, "e", "drift", 0, 1e-9);
    assert_int_equal(result->nerror, 4);
    assert_int_equal(result->status, RUN_INVALID);
    assert_string_equal(result->text, "qdd differs from aba by 0.0125 (relative), more than 1e-09");
    *result = (struct run_result){.status = RUN_DEADLOCK, .text = "a circle"};
    program_check_add(result, "tau", "rnea", 1, 0);
    assert_string_equal(result->text, "a circle");
}

static void check_too_many(void)
{
    for (int i = 0; i <= RUN_MAX_ERRORS; i++) program_check_add(result, "a", "b", 0, 0);
}

/* --- baselines --- */

static int64_t by_flop(const void *context, const struct work *w)
{
    return *(const int64_t *)context * (int64_t)w->flop;
}

static void the_fastest_of_the_last_is_added(void **state)
{
    static const struct {
        int n, first, flop[5], best; /* best: its number, -1: none */
    } row[] = {
        {0, 0, {0}, -1},         {1, 0, {7}, 0},
        {1, 1, {7}, -1},         {3, 0, {5, 3, 9}, 1},
        {3, 0, {5, 3, 3}, 1},    {3, 2, {5, 3, 9}, 2},
        {4, 1, {1, 9, 8, 8}, 2}, {5, 0, {9, 9, 9, 9, 1}, 4},
        {2, 0, {0, 0}, 0},
    };
    const int64_t ps = 3;
    const struct work_price price = {by_flop, &ps};
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        *result = (struct run_result){.status = RUN_OK};
        for (int i = 0; i < row[k].n; i++) {
            const struct work w = {.flop = (uint64_t)row[k].flop[i], .div = (uint64_t)i};
            char name[8] = {(char)('a' + i), '\0'};
            program_baseline_add(result, &price, name, &w);
            assert_int_equal(result->baseline[i].time_ps, 3 * row[k].flop[i]);
            assert_string_equal(result->baseline[i].name, name);
        }
        program_fastest_add(result, row[k].first);
        assert_int_equal(result->nbaseline, row[k].n + (row[k].best >= 0));
        if (row[k].best < 0) continue;
        const struct baseline *b = &result->baseline[row[k].n];
        assert_string_equal(b->name, "fastest serial");
        assert_int_equal(b->work.div, row[k].best);
        assert_int_equal(b->time_ps, 3 * row[k].flop[row[k].best]);
        /* the one it was stays as it was */
        assert_int_equal(result->baseline[row[k].best].name[0], 'a' + row[k].best);
    }
}

static void baselines_too_many(void)
{
    const int64_t ps = 1;
    const struct work_price price = {by_flop, &ps};
    for (int i = 0; i < RUN_MAX_BASELINES; i++)
        program_baseline_add(result, &price, "a", &(struct work){0});
    program_fastest_add(result, 0);
}

static void more_than_there_is_room_for_stops_the_program(void **state)
{
    static void (*const too_many[])(void) = {want_too_many, want_below, leave_out_too_many,
                                             check_too_many, baselines_too_many};
    (void)state;
    for (size_t k = 0; k < sizeof too_many / sizeof *too_many; k++) {
        char words[512];
        expect_abort(too_many[k], words, sizeof words);
        assert_non_null(strstr(words, "CHECK("));
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin, end)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(outputs_begin_as_zeros),
        TEST(elements_go_to_their_places_or_nowhere),
        TEST(a_program_may_keep_its_outputs_itself),
        TEST(what_is_put_back_is_not_left_out),
        TEST(errors_above_their_tolerance_make_a_run_invalid),
        TEST(the_first_wrong_number_is_told),
        TEST(the_fastest_of_the_last_is_added),
        TEST(more_than_there_is_room_for_stops_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
