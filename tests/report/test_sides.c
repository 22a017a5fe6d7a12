/* test_sides.c - what is told of several runs at once: sheets of columns, sides held against each
 * other, how far their times are known, which of them a figure shows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/made_run.h"
#include "../support/refused.h"
#include "../support/store_fixture.h"
#include "base/random.h"
#include "base/text.h"
#include "report/compare.h"
#include "report/csv.h"
#include "report/figure_rows.h"
#include "report/how_sure.h"
#include "report/plot_sheet.h"
#include "report/report.h"
#include "report/stamp.h"

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_store, drop_store)

static void refused(struct store_fixture *f, enum err_kind kind, const char *part)
{
    is_refused(&f->e, kind, part);
}

/* A run of `seconds` on a machine with that latency of a hop; its number in the database. */
static int64_t put(struct store_fixture *f, const char *machine, int n, int rep, double hop,
                   double seconds)
{
    struct run_spec spec = made_spec(f->a, machine, n, 4, rep);
    spec.machine.network.hop_latency = hop;
    made_identity(&spec, f->a);
    struct run_result r = made_result(f->a, &spec);
    r.makespan_ps = llround(seconds * 1e12);
    r.error[1].relative = 2.5e-14 * n; /* the larger one */
    if (!store_put(f->s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
    return store_run_id(f->s, &spec);
}

static bool near(double x, double wanted) { return fabs(x - wanted) <= 1e-9 * fabs(wanted); }

/* ---- documents and tables ---- */

static char *answer(struct store_fixture *f, const char *sql)
{
    char *s = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&s, &size);
    if (!report_query(f->s, sql, 0, NULL, true, out, &f->e)) fail_msg("%s", f->e.text);
    fclose(out);
    return s;
}

static int count(const char *s, const char *part)
{
    int n = 0;
    for (; (s = strstr(s, part)) != NULL; s++) n++;
    return n;
}

/* No two keys of an object are equal, whatever columns are called. */
static void columns_of_one_name_are_keys_of_their_own(void **state)
{
    struct store_fixture *f = *state;
    static const struct {
        const char *sql, *keys[4];
    } row[] = {
        {"SELECT 1 AS x, 2 AS x", {"x", "x:1"}},
        {"SELECT 1 AS x, 2 AS x, 3 AS \"x:1\"", {"x", "x:1", "x:2"}},
        {"SELECT 1 AS \"x:1\", 2 AS x, 3 AS x, 4 AS \"x:2\"", {"x", "x:1", "x:2", "x:3"}},
        {"SELECT 1 AS x, 2 AS \"x!\", 3 AS x", {"x", "x!", "x:1"}},
        {"SELECT 1 AS x, 2 AS X", {"X", "x"}},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char *s = answer(f, row[i].sql), key[16];
        const char *at = s;
        int keys = 0;
        for (; keys < 4 && row[i].keys[keys] != NULL; keys++) {
            snprintf(key, sizeof key, "\"%s\":", row[i].keys[keys]);
            if (count(s, key) != 1) fail_msg("%s in %s", key, s);
            /* in their order */
            at = strstr(at, key);
            if (at == NULL) fail_msg("%s stands too early in %s", key, s);
        }
        assert_int_equal(count(s, "\":"), keys);
        free(s);
    }
}

static void keep_id(void *context, int64_t id) { text_add(context, "%lld ", (long long)id); }

/* All digits of a number, one record a row, and whose rows these are. */
static void rows_become_records(void **state)
{
    struct store_fixture *f = *state;
    static const struct {
        const char *sql, *csv, *ids;
    } row[] = {
        {"SELECT 7 AS run_id, 0.1 AS \"a,b\", NULL AS c", "run_id,\"a,b\",c\r\n7,0.1,\r\n", "7 "},
        {"SELECT 1 AS a WHERE 0", "a\r\n", ""},
        {"SELECT 1.0 / 3 AS x", "x\r\n0.3333333333333333\r\n", ""},
        {"SELECT -9223372036854775807 AS x, 1e300 AS y", "x,y\r\n-9223372036854775807,1e+300\r\n",
         ""},
        /* quotes and control characters would not reach gnuplot */
        {"SELECT 'a\"b' || char(10) || 'c' AS x", "x\r\na'b c\r\n", ""},
        /* numbers of runs alone; other kinds are none */
        {"SELECT 'x' AS run_id UNION ALL SELECT 3 UNION ALL SELECT NULL",
         "run_id\r\nx\r\n3\r\n\r\n", "3 "},
        {"SELECT 3 AS RUN_ID", "RUN_ID\r\n3\r\n", ""},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char *s = NULL;
        size_t size = 0;
        int64_t nrow = -1;
        struct text ids = {0};
        FILE *out = open_memstream(&s, &size);
        assert_true(csv_write(f->s, row[i].sql, 0, NULL, out, keep_id, &ids, &nrow, &f->e));
        fclose(out);
        assert_string_equal(s, row[i].csv);
        assert_string_equal(ids.s != NULL ? ids.s : "", row[i].ids);
        text_free(&ids);
        free(s);
    }
    int64_t nrow;
    const char *const bound[] = {"two"};
    FILE *nowhere = fopen("/dev/null", "w");
    assert_non_null(nowhere);
    assert_true(csv_write(f->s, "SELECT ?1 AS x UNION ALL SELECT 1", 1, bound, nowhere, NULL, NULL,
                          &nrow, &f->e));
    assert_int_equal(nrow, 2);
    assert_false(csv_write(f->s, "SELECT", 0, NULL, nowhere, NULL, NULL, &nrow, &f->e));
    refused(f, ERR_DATA, "");
    fclose(nowhere);
}

/* ---- sheets ---- */

static void a_query_is_a_sheet(void **state)
{
    struct store_fixture *f = *state;
    struct plot_sheet t;
    assert_true(
        plot_sheet_query(&t, f->s,
                         "SELECT 5 AS run_id, 1.5 AS time_s, 'a' AS word, NULL AS \"x.none\", "
                         "4096 AS sent_bytes, 'x' AS mixed UNION ALL SELECT NULL, NULL, 'b', "
                         "NULL, 1, 1",
                         &f->e));
    assert_false(t.runs);
    assert_int_equal(t.ncolumn, 6);
    assert_int_equal(t.nrow, 2);
    static const struct {
        const char *key;
        bool number;
        enum unit unit;
    } column[] = {{"run_id", true, UNIT_NONE},      {"time_s", true, UNIT_TIME},
                  {"word", false, UNIT_NONE},       {"x.none", false, UNIT_NONE},
                  {"sent_bytes", true, UNIT_BYTES}, {"mixed", false, UNIT_NONE}};
    for (int i = 0; i < 6; i++) {
        assert_string_equal(t.column[i].key, column[i].key);
        assert_int_equal(t.column[i].number, column[i].number);
        assert_int_equal(t.column[i].unit, column[i].unit);
        assert_int_equal(plot_sheet_find(&t, column[i].key, &f->e), i);
    }
    assert_int_equal(t.run_id[0], 5);
    assert_int_equal(t.run_id[1], 0);
    assert_string_equal(plot_sheet_at(&t, 1, 2)->text, "b");
    assert_true(isnan(plot_sheet_at(&t, 1, 2)->number));
    assert_string_equal(plot_sheet_at(&t, 1, 1)->text, "");
    assert_true(plot_sheet_at(&t, 0, 4)->number == 4096);
    /* in a query other words and ends of keys mean nothing */
    assert_int_equal(plot_sheet_find(&t, "time", &f->e), -1);
    refused(f, ERR_USAGE, "'time' is no column of the query");
    assert_int_equal(plot_sheet_find(&t, "none", &f->e), -1);
    err_clear(&f->e);
    assert_int_equal(plot_sheet_find(&t, "wrod", &f->e), -1);
    refused(f, ERR_USAGE, "did you mean 'word'");
    plot_sheet_free(&t);
    plot_sheet_free(&t);
    /* it may only read, as the store is open for reading, and be one statement */
    char path[300];
    store_close(f->s);
    f->s = store_open(scratch_path(path, sizeof path, f->folder, "t.db"), STORE_READ, &f->e);
    assert_non_null(f->s);
    static const char *const wrong[] = {"DELETE FROM run", "SELECT 1; SELECT 2", "SELECT x"};
    for (int i = 0; i < 3; i++) {
        assert_false(plot_sheet_query(&t, f->s, wrong[i], &f->e));
        assert_int_not_equal(f->e.kind, ERR_NONE);
        err_clear(&f->e);
        assert_null(t.arena);
    }
}

static void runs_are_a_sheet_of_what_was_asked_for(void **state)
{
    struct store_fixture *f = *state;
    struct plot_sheet t;
    static const char *const key[] = {"makespan", "hop_latency", "machine.network.hop_latency",
                                      "ranks",    "machine",     "level"};
    for (int i = 0; i < 3; i++) put(f, "t3e-300", 8 << i, 0, 1e-7 * (i + 1), 1e-3 * (i + 1));
    if (!plot_sheet_runs(&t, f->s, 6, key, &f->e)) fail_msg("%s", f->e.text);
    assert_true(t.runs);
    assert_int_equal(t.nrow, 3);
    const int time = plot_sheet_find(&t, "time", &f->e), hop = plot_sheet_find(&t, key[1], &f->e);
    assert_string_equal(t.column[time].key, "makespan_s");
    assert_string_equal(t.column[time].title, "run time");
    assert_false(t.column[time].trait);
    /* once, by whichever name */
    assert_int_equal(hop, plot_sheet_find(&t, key[2], &f->e));
    assert_int_equal(t.column[hop].unit, UNIT_TIME);
    assert_true(t.column[hop].trait && t.column[hop].number);
    assert_int_equal(plot_sheet_find(&t, "P", &f->e), plot_sheet_find(&t, "processors", &f->e));
    for (int i = 0; i < 3; i++) {
        assert_true(near(plot_sheet_at(&t, i, time)->number, 1e-3 * (i + 1)));
        assert_true(near(plot_sheet_at(&t, i, hop)->number, 1e-7 * (i + 1)));
        assert_true(t.run_id[i] == i + 1);
    }
    plot_sheet_free(&t);
    static const char *const wrong[][2] = {
        {"hop_latenzy", "did you mean 'hop_latency'"},
        {"bandwidth", "may be"},
        {"x' OR 1", "is neither a column of a run nor a setting"}};
    for (int i = 0; i < 3; i++) {
        assert_false(plot_sheet_runs(&t, f->s, 1, &wrong[i][0], &f->e));
        refused(f, ERR_USAGE, wrong[i][1]);
        assert_null(t.arena);
    }
}

/* ---- sides ---- */

static bool make(struct store_fixture *f, struct compare *c, const char *first, const char *second)
{
    const struct compare_side side[] = {{.name = "one", .store = f->s, .run_ids = first},
                                        {.name = "two", .store = f->s, .run_ids = second}};
    return compare_make(c, 2, side, &f->e);
}

static void sides_meet_in_their_points(void **state)
{
    struct store_fixture *f = *state;
    struct compare c;
    double error;
    /* runs 1 to 5, then 6 to 8 */
    put(f, "t3e-300", 16, 0, 1e-7, 4e-3);
    for (int i = 0; i < 3; i++) put(f, "t3e-300", 8, i, 1e-7, 1e-3 * (i + 1));
    put(f, "t3e-300", 32, 0, 1e-7, 9e-3);
    put(f, "paragon", 8, 0, 1e-7, 2e-3);
    put(f, "paragon", 16, 0, 1e-7, 1e-3);
    put(f, "paragon", 64, 0, 1e-7, 1e-3);
    if (!make(f, &c, "[1,2,3,4,5]", "[6,7,8]")) fail_msg("%s", f->e.text);
    assert_int_equal(c.side[0].nrun, 5);
    assert_int_equal(c.side[1].nrun, 3);
    assert_false(c.side[0].machines);
    assert_int_equal(c.npoint, 4);
    assert_int_equal(c.ncommon, 2);
    assert_true(c.x_only);
    assert_string_equal(c.x_name, "n");
    /* common ones first, each group by n */
    static const double x[] = {8, 16, 32, 64};
    for (int i = 0; i < 4; i++) assert_true(c.point[i].x == x[i]);
    assert_string_equal(c.point[0].name, "n 8");
    /* 1, 2 and 3 ms: mean 2, deviation 1, Student's t of two degrees of freedom 4.303 */
    const struct compare_cell *cell = &c.point[0].cell[0];
    assert_int_equal(cell->runs, 3);
    assert_int_equal(cell->run, 2);
    assert_true(near(cell->makespan, 2e-3));
    assert_true(fabs(cell->half - 4.303e-3 / sqrt(3)) < 1e-6);
    assert_true(near(compare_ratio(&c.point[0], 1, &error), 1));
    assert_true(fabs(error - 4.303 / sqrt(3) / 2) < 1e-3);
    assert_true(near(compare_ratio(&c.point[1], 1, &error), 0.25));
    assert_true(error == 0);
    assert_true(isnan(compare_ratio(&c.point[2], 1, &error)));
    assert_true(isnan(compare_ratio(&c.point[3], 1, &error)));
    assert_int_equal(c.ndifference, 1);
    assert_string_equal(c.difference[0].key, "machine.name");
    assert_string_equal(c.difference[0].value[1], "paragon");
    compare_free(&c);
    compare_free(&c);
}

static void sides_that_do_not_meet_are_told(void **state)
{
    struct store_fixture *f = *state;
    struct compare c;
    put(f, "t3e-300", 8, 0, 1e-7, 1e-3);
    put(f, "t3e-300", 16, 0, 1e-7, 1e-3);
    put(f, "paragon", 32, 0, 1e-7, 1e-3);
    put(f, "paragon", 64, 0, 1e-7, 1e-3);
    assert_false(make(f, &c, "[1,2]", "[3,4]"));
    refused(f, ERR_NO_INPUT, "agree");
    compare_free(&c);
    assert_false(make(f, &c, "[1,2]", "[]"));
    refused(f, ERR_NO_INPUT, "'two' has no run");
    compare_free(&c);
    assert_false(make(f, &c, "[77]", "[1]"));
    refused(f, ERR_NO_INPUT, "'one' has no run");
    compare_free(&c);
    /* a side against itself: the same everywhere, and nothing differs */
    assert_true(make(f, &c, "[1,2]", "[1,2]"));
    assert_int_equal(c.ndifference, 0);
    assert_int_equal(c.ncommon, 2);
    compare_free(&c);
}

/* What a machine was set to is a difference of the sides; of several machines the name is one of
 * the point. */
static void machines_are_what_is_compared(void **state)
{
    struct store_fixture *f = *state;
    struct compare c;
    for (int i = 0; i < 2; i++) put(f, "t3e-300", 8 << i, 0, 1e-7, 1e-3);
    for (int i = 0; i < 2; i++) put(f, "t3e-300", 8 << i, 0, 2e-7, 2e-3);
    put(f, "paragon", 8, 0, 1e-7, 5e-3);
    assert_true(make(f, &c, "[1,2]", "[3,4]"));
    assert_int_equal(c.ndifference, 1);
    assert_string_equal(c.difference[0].key, "machine.network.hop_latency");
    assert_string_equal(c.difference[0].value[0], "100 ns");
    assert_string_equal(c.difference[0].value[1], "200 ns");
    assert_int_equal(c.ncommon, 2);
    compare_free(&c);
    assert_true(make(f, &c, "[1,2,5]", "[1,5]"));
    assert_true(c.side[0].machines && c.side[1].machines);
    assert_false(c.x_only);
    assert_int_equal(c.ncommon, 2);
    assert_int_equal(c.npoint, 3);
    compare_free(&c);
}

/* ---- how sure, and whose ---- */

/* Joining is the same in any order, and what is not known changes no number. */
static void what_is_known_is_joined_in_any_order(void **state)
{
    (void)state;
    struct random x = random_make(12, 0, 0);
    for (int round = 0; round < 200; round++) {
        struct how_sure part[4], forth = {0}, back = {0};
        double level = 0, low = INFINITY, high = -INFINITY, arithmetic = 0;
        int runs = 0, known[3] = {0};
        for (int i = 0; i < 4; i++) {
            struct how_sure *p = &part[i];
            *p = (struct how_sure){.runs = 1 + (int)random_below(&x, 5)};
            runs += p->runs;
            if (random_below(&x, 2)) {
                known[0] += p->level = p->runs;
                level = fmax(level, p->level_error = random_uniform(&x, 0, 1));
            }
            if (random_below(&x, 2)) {
                known[1] += p->machine = 1;
                /* both may be on one side of 0 */
                p->machine_low = random_uniform(&x, -0.5, 0.5);
                p->machine_high = p->machine_low + random_uniform(&x, 0, 0.5);
                low = fmin(low, p->machine_low);
                high = fmax(high, p->machine_high);
            }
            if (random_below(&x, 2)) {
                known[2] += p->arithmetic = 1;
                arithmetic = fmax(arithmetic, p->arithmetic_error = random_uniform(&x, 0, 1e-9));
            }
        }
        for (int i = 0; i < 4; i++) how_sure_join(&forth, &part[i]);
        for (int i = 3; i >= 0; i--) how_sure_join(&back, &part[i]);
        assert_memory_equal(&forth, &back, sizeof forth);
        assert_int_equal(forth.runs, runs);
        assert_int_equal(forth.level, known[0]);
        assert_int_equal(forth.machine, known[1]);
        assert_int_equal(forth.arithmetic, known[2]);
        if (known[0] > 0) assert_true(forth.level_error == level);
        if (known[1] > 0) assert_true(forth.machine_low == low && forth.machine_high == high);
        if (known[2] > 0) assert_true(forth.arithmetic_error == arithmetic);
    }
}

static void errors_of_stored_runs_are_read(void **state)
{
    struct store_fixture *f = *state;
    struct how_sure h;
    assert_true(how_sure_read(f->s, NULL, &h, &f->e));
    assert_int_equal(h.runs, 0);
    for (int i = 0; i < 3; i++) put(f, "t3e-300", 8 << i, 0, 1e-7, 1e-3);
    assert_true(how_sure_read(f->s, NULL, &h, &f->e));
    assert_int_equal(h.runs, 3);
    assert_int_equal(h.level, 0);
    assert_int_equal(h.machine, 0);
    assert_int_equal(h.arithmetic, 3);
    assert_true(near(h.arithmetic_error, 8e-13)); /* of the run with 32 bodies */
    assert_true(how_sure_read(f->s, "[2, 99]", &h, &f->e));
    assert_int_equal(h.runs, 1);
    assert_false(how_sure_read(f->s, "no list", &h, &f->e));
    assert_int_not_equal(f->e.kind, ERR_NONE);
}

static const char *rows_of(struct store_fixture *f, const char *ids)
{
    struct text t = {0};
    if (!figure_rows(f->s, ids, &t, &f->e)) fail_msg("%s", f->e.text);
    const char *copy = arena_text(f->a, t.s != NULL ? t.s : "");
    text_free(&t);
    return copy;
}

/* No figure chooses among machines in silence. */
static void what_a_figure_leaves_out_is_told(void **state)
{
    struct store_fixture *f = *state;
    put(f, "t3e-300", 8, 0, 1e-7, 1e-3);
    put(f, "t3e-300", 16, 0, 1e-7, 1e-3);
    const char *both = rows_of(f, "[1,2]");
    assert_null(strstr(both, "left out"));
    /* of other sizes of a machine that is shown nothing is said */
    assert_null(strstr(rows_of(f, "[1]"), "left out"));
    put(f, "paragon", 8, 0, 1e-7, 1e-3);
    assert_string_equal(rows_of(f, "[1,2]"), "t3e-300; left out: 1 run on paragon");
    put(f, "paragon", 16, 0, 1e-7, 1e-3);
    put(f, "origin2000", 8, 0, 1e-7, 1e-3);
    assert_string_equal(rows_of(f, "[1,2]"),
                        "t3e-300; left out: 2 runs on paragon; 1 on origin2000");
    put(f, "paragon", 32, 0, 1e-7, 1e-3);
    put(f, "origin2000", 16, 0, 1e-7, 1e-3);
    for (int i = 0; i < 3; i++) put(f, "quad-ppro", 8 << i, 0, 1e-7, 1e-3);
    put(f, "cluster", 8, 0, 1e-7, 1e-3);
    assert_string_equal(rows_of(f, "[1]"),
                        "t3e-300; left out: 3 runs on paragon; 3 on quad-ppro and 2 more (3)");
    assert_string_equal(rows_of(f, "[]"), "");
}

static const char *stamp_of(struct store_fixture *f, const char *ids)
{
    struct text t = {0};
    if (!stamp_make(f->s, ids, &t, &f->e)) fail_msg("%s", f->e.text);
    const char *copy = arena_text(f->a, t.s != NULL ? t.s : "");
    text_free(&t);
    return copy;
}

static void a_stamp_names_whose_numbers_these_are(void **state)
{
    struct store_fixture *f = *state;
    assert_string_equal(stamp_of(f, NULL), "");
    put(f, "t3e-300", 8, 0, 1e-7, 1e-3);
    put(f, "t3e-300", 16, 0, 1e-7, 1e-3);
    const char *one = stamp_of(f, "[1]"), *two = stamp_of(f, "[1,2]"), *none = stamp_of(f, NULL);
    static const char known[] =
        "error of level not known, machine not known, arithmetic <= 2e-13; ";
    assert_int_equal(strncmp(one, known, strlen(known)), 0);
    assert_non_null(strstr(one, ", configuration "));
    assert_null(strstr(one, " runs, "));
    assert_non_null(strstr(two, ", 2 runs, configurations "));
    /* the same runs in another order are the same numbers */
    assert_string_equal(two, stamp_of(f, "[2,1,1]"));
    assert_string_not_equal(one, stamp_of(f, "[2]"));
    assert_int_equal(strncmp(none, "mimdsim ", 8), 0);
    assert_null(strstr(none, "configuration"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(columns_of_one_name_are_keys_of_their_own),
        TEST(rows_become_records),
        TEST(a_query_is_a_sheet),
        TEST(runs_are_a_sheet_of_what_was_asked_for),
        TEST(sides_meet_in_their_points),
        TEST(sides_that_do_not_meet_are_told),
        TEST(machines_are_what_is_compared),
        TEST(what_is_known_is_joined_in_any_order),
        TEST(errors_of_stored_runs_are_read),
        TEST(what_a_figure_leaves_out_is_told),
        TEST(a_stamp_names_whose_numbers_these_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
