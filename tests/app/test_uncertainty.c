/* test_uncertainty.c - how many runs a study of uncertain parameters means, before any is made;
 * ranges of parameters in words; levels of a network side by side. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "app/contention.h"
#include "app/parameters.h"
#include "app/uncertainty.h"

static void numbers_of_samples_have_their_limits(void **state)
{
    static const struct {
        const char *word[3];
        int n; /* -1: refused */
        bool shares;
    } row[] = {{{NULL}, 0, true},
               {{"--uncertainty", "4"}, 4, true},
               {{"--uncertainty=10000"}, 10000, true},
               {{"--bands-only", "--uncertainty", "100"}, 100, false},
               {{"--uncertainty=3", "--uncertainty=5"}, 5, true},
               {{"--bands-only"}, -1, false},
               {{"--uncertainty", "3"}, -1, true},
               {{"--uncertainty", "10001"}, -1, true},
               {{"--uncertainty", "5x"}, -1, true},
               {{"--uncertainty", "1e3"}, -1, true},
               {{"--uncertainty", "-5"}, -1, true},
               {{"--uncertainty="}, -1, true},
               {{"--uncertainty"}, -1, true}};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char *argv[8] = {(char *)"mimdsim run", (char *)"scenario"};
        int argc = 2;
        for (int k = 0; k < 3 && row[i].word[k]; k++) argv[argc++] = (char *)row[i].word[k];
        struct uncertainty_options o;
        struct err e;
        err_clear(&e);
        const bool good = uncertainty_take(&argc, argv, &o, &e);
        if (good != (row[i].n >= 0)) fail_msg("row %d: '%s'", (int)i, e.text);
        if (good) assert_true(o.n == row[i].n && o.shares == row[i].shares);
        else assert_int_equal(e.kind, ERR_USAGE);
        assert_int_equal(argc, 2); /* all are taken out, also of what is refused */
    }
}

static void read_plan(struct plan *p, int n, const char *const *set)
{
    struct err e;
    err_clear(&e);
    const struct plan_options o = {.nset = n, .set = set};
    if (!plan_read(p, "speedup-t3e", &o, &e)) fail_msg("%s", e.text);
}

/* Runs of each point: 2 n for bands, n (k + 2) for shares; what is given is not drawn. So n shows
 * how many parameters there are: the largest n that is allowed falls with k. */
static int largest(const struct plan *p, bool shares)
{
    int low = 1, high = UNCERTAINTY_MOST;
    while (low < high) {
        const int middle = low + (high - low + 1) / 2;
        const struct uncertainty_options o = {.n = middle, .shares = shares};
        struct err e;
        err_clear(&e);
        if (uncertainty_count(p, &o, &e)) low = middle;
        else {
            assert_int_equal(e.kind, ERR_CONFIG);
            assert_non_null(strstr(e.text, "expected at most 100000"));
            high = middle - 1;
        }
    }
    return low;
}

static void runs_are_counted_before_any_is_made(void **state)
{
    static const char *const one[] = {"n=16", "ranks=2", "level=loggp"},
                             *const four[] = {"n=16,32", "ranks=2,4", "level=loggp"},
                             *const given[] = {"n=16", "ranks=2", "level=loggp",
                                               "machine.node.flop_rate=61 Mflop/s"};
    struct plan p;
    (void)state;
    read_plan(&p, 3, one);
    assert_int_equal(p.nrun, 1);
    assert_int_equal(largest(&p, false), UNCERTAINTY_MOST / 2);
    const int per_run = UNCERTAINTY_MOST / largest(&p, true), k = per_run - 2;
    assert_in_range(k, 2, 40);
    assert_int_equal(largest(&p, true), UNCERTAINTY_MOST / (k + 2));
    struct err e;
    err_clear(&e);
    const struct uncertainty_options none = {.n = 0, .shares = true};
    assert_true(uncertainty_count(&p, &none, &e));
    plan_free(&p);
    read_plan(&p, 3, four);
    assert_int_equal(p.nrun, 4);
    assert_int_equal(largest(&p, false), UNCERTAINTY_MOST / 8);
    assert_int_equal(largest(&p, true), UNCERTAINTY_MOST / (4 * (k + 2)));
    plan_free(&p);
    read_plan(&p, 4, given); /* one parameter fewer */
    assert_int_equal(largest(&p, true), UNCERTAINTY_MOST / (k + 1));
    plan_free(&p);
}

static void ranges_have_the_unit_of_their_key(void **state)
{
    static const struct {
        struct origin o;
        const char *text;
    } row[] = {
        {{.key = "network.hop_latency", .min = 1e-7, .max = 2e-6}, "100 ns to 2 us"},
        {{.key = "node.flop_rate", .min = 35e6, .max = 100e6}, "35 Mflop/s to 100 Mflop/s"},
        {{.key = "network.link.bandwidth", .min = 0, .max = 0}, ""},
        {{.key = "network.link.bandwidth", .min = 1e6, .max = 1e6}, ""},
        {{.key = "no.such.key", .min = 1, .max = 2}, "1 to 2"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        assert_string_equal(parameters_range(&row[i].o, arena), row[i].text);
}

/* Every value with a class of evidence, of each machine once. */
static void parameters_are_those_with_evidence(void **state)
{
    static const char *const set[] = {"n=16", "ranks=2,4", "level=loggp"};
    struct plan p[2];
    const struct document_parameter *one, *two;
    struct err e;
    int n, m;
    (void)state;
    err_clear(&e);
    read_plan(&p[0], 3, set), read_plan(&p[1], 3, set);
    assert_true(parameters_gather(p, 1, arena, &one, &n, &e));
    assert_true(parameters_gather(p, 2, arena, &two, &m, &e));
    assert_true(n > 0 && n == m);
    struct origin *origin;
    int norigin, expected = 0;
    struct machine_spec machine;
    const struct plan_options none = {0};
    assert_true(
        plan_machine(&machine, p[0].run[0].machine.name, &none, arena, &origin, &norigin, &e));
    for (int i = 0; i < norigin; i++) expected += origin[i].evidence[0] != '\0';
    assert_int_equal(n, expected);
    assert_true(parameters_gather(p, 0, arena, &one, &n, &e));
    assert_int_equal(n, 0);
    plan_free(&p[0]), plan_free(&p[1]);
}

/* On an empty network levels agree; of ranks that meet the finer ones see no more than the coarsest
 * one, which knows no links. */
static void levels_differ_where_messages_meet(void **state)
{
    struct contention row[CONTENTION_ROWS];
    struct err e;
    (void)state;
    err_clear(&e);
    assert_int_equal(contention_measure("no-such-machine", row, arena, &e), -1);
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    const int n = contention_measure("t3e-300", row, arena, &e);
    assert_int_equal(n, CONTENTION_ROWS);
    for (int i = 0; i < n; i++) {
        assert_int_equal(row[i].ranks, CONTENTION_RANKS);
        assert_true(row[i].level[LEVEL_LOGGP] > 0);
        assert_true(row[i].level[LEVEL_LINK] <= row[i].level[LEVEL_LOGGP] * (1 + 1e-9));
    }
    assert_true(row[0].quantity != row[1].quantity);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_samples_have_their_limits),
        cmocka_unit_test(runs_are_counted_before_any_is_made),
        cmocka_unit_test(ranges_have_the_unit_of_their_key),
        cmocka_unit_test(parameters_are_those_with_evidence),
        cmocka_unit_test(levels_differ_where_messages_meet),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
