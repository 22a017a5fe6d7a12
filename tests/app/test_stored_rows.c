/* test_stored_rows.c - what studies keep in the database and find there again: ladders and what
 * follows from them, families, grades of stability, points of load curves, recorded messages. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "../support/made_run.h"
#include "../support/scratch.h"
#include "app/keep.h"
#include "app/known_error.h"
#include "app/levels.h"
#include "app/load_curve.h"
#include "base/random.h"
#include "base/text.h"
#include "study/level_choice.h"

static struct store *database;

static int open_database(void **state)
{
    struct err e;
    err_clear(&e);
    make_arena(state);
    database = store_open("rows", STORE_SCRATCH, &e);
    return database == NULL;
}

static int close_database(void **state)
{
    store_close(database);
    return drop_arena(state);
}

static bool take_text(void *context, int n, const char *const *name, const char *const *value)
{
    (void)n, (void)name;
    text_add(context, "%s ", value[0] ? value[0] : "null");
    return true;
}

static const char *answer(const char *sql)
{
    struct text t = {0};
    struct err e;
    err_clear(&e);
    text_add(&t, "%s", "");
    if (!store_select(database, sql, 0, NULL, take_text, &t, &e)) fail_msg("%s", e.text);
    const char *kept = arena_text(arena, t.s);
    text_free(&t);
    return kept;
}

/* ---- ladders */

static struct accuracy_rung rung(const char *family, const char *at, const char *method,
                                 double error)
{
    struct accuracy_rung r = {.error = error, .host_s = 0.5, .machine_ps = 1000};
    snprintf(r.ladder, sizeof r.ladder, "network");
    snprintf(r.at, sizeof r.at, "%s", at);
    snprintf(r.family, sizeof r.family, "%s", family);
    snprintf(r.method, sizeof r.method, "%s", method);
    snprintf(r.quantity, sizeof r.quantity, "makespan");
    return r;
}

static bool keep(const char *scenario, struct accuracy_rung *r, int n, struct err *e)
{
    struct accuracy_report report = {.nrung = n, .rung = r};
    snprintf(report.scenario, sizeof report.scenario, "%s", scenario);
    if (n > 1) { /* the first is what was chosen of all */
        report.nchoice = 1;
        report.choice[0] = (struct accuracy_choice){.ladder = "network",
                                                    .at = r[0].at,
                                                    .quantity = "makespan",
                                                    .tolerance = 0.02,
                                                    .rung = &r[0],
                                                    .finest = &r[n - 1],
                                                    .cost_ratio = 4};
    }
    return keep_accuracy(database, &report, e);
}

/* Those of one scenario are replaced whole. */
static void ladders_replace_older_ones_of_their_scenario(void **state)
{
    struct accuracy_rung r[] = {rung("f", "n=P=8", "loggp", 0.1), rung("f", "n=P=8", "link", 0.05),
                                rung("f", "n=P=8", "flit", 0)};
    struct err e;
    (void)state;
    err_clear(&e);
    assert_true(keep("a", r, 3, &e) && keep("b", r, 2, &e));
    assert_string_equal(answer("SELECT scenario || ordinal || method FROM ladder ORDER BY "
                               "scenario, ordinal"),
                        "a0loggp a1link a2flit b0loggp b1link ");
    assert_string_equal(answer("SELECT scenario FROM ladder_choice ORDER BY 1"), "a b ");
    assert_true(keep("a", r + 1, 1, &e));
    assert_string_equal(answer("SELECT scenario || ordinal || method FROM ladder ORDER BY "
                               "scenario, ordinal"),
                        "a0link b0loggp b1link ");
    assert_string_equal(answer("SELECT scenario FROM ladder_choice ORDER BY 1"), "b ");
    assert_true(keep("a", r, 0, &e) && keep("b", r, 0, &e));
    assert_string_equal(answer("SELECT count(*) FROM ladder"), "0 ");
}

static struct run_spec asking(int n, int nrank, double tolerance)
{
    struct run_spec spec = made_spec(arena, "t3e-300", n, nrank, 0);
    spec.machine.network.level = LEVEL_AUTO_TOLERANCE;
    spec.machine.network.tolerance = tolerance;
    made_identity(&spec, arena);
    return spec;
}

/* The cheapest level whose largest error of all points is within the tolerance. */
static void levels_are_settled_by_stored_ladders(void **state)
{
    static const struct {
        double tolerance;
        enum network_level level;
        const char *at;
    } row[] = {{0.5, LEVEL_LOGGP, "n=P=8"},    {0.2, LEVEL_LOGGP, "n=P=8"},
               {0.199, LEVEL_LINK, "n=P=16"},  {0.05, LEVEL_LINK, "n=P=16"},
               {0.049, LEVEL_PACKET, "n=P=8"}, {0.01, LEVEL_PACKET, "n=P=8"},
               {0.001, LEVEL_FLIT, "n=P=8"}};
    enum { N = sizeof row / sizeof *row };
    struct run_spec run[N + 2];
    struct run_order order[N + 2];
    char family[65];
    struct err e;
    (void)state;
    err_clear(&e);
    memset(order, 0, sizeof order);
    const struct run_spec one = asking(8, 8, 0.1);
    level_family(&one, family);
    struct accuracy_rung r[] = {
        rung(family, "n=P=8", "loggp", 0.2),   rung(family, "n=P=8", "link", 0.01),
        rung(family, "n=P=16", "loggp", 0.1),  rung(family, "n=P=16", "link", 0.05),
        rung(family, "n=P=8", "packet", 0.01), rung(family, "n=P=8", "flit", 0),
        rung("other", "n=P=8", "link", 0.9),   rung(family, "n=P=4", "auto", NAN)};
    assert_true(keep("ladders", r, 8, &e));
    for (int i = 0; i < N; i++) run[i] = asking(16 << i, 4 << i, row[i].tolerance);
    run[N] = made_spec(arena, "t3e-300", 16, 4, 0); /* names its level itself */
    const struct run_spec before = run[N];
    if (!levels_settle(database, run, order, N + 1, true, arena, &e)) fail_msg("%s", e.text);
    for (int i = 0; i < N; i++) {
        if (run[i].machine.network.level != row[i].level)
            fail_msg("row %d: %d", i, (int)run[i].machine.network.level);
        const struct level_choice *c = &order[i].level_choice;
        assert_true(c->made && c->tolerance == row[i].tolerance);
        assert_true(c->error <= row[i].tolerance);
        assert_string_equal(c->at, row[i].at);
        /* the run that asks for this level at once is the same one */
        struct run_spec same = made_spec(arena, "t3e-300", 16 << i, 4 << i, 0);
        same.machine.network.level = row[i].level;
        made_identity(&same, arena);
        assert_string_equal(run[i].config_hash, same.config_hash);
    }
    assert_string_equal(run[N].config_hash, before.config_hash);
    assert_false(order[N].level_choice.made);
    /* where no level is good enough nothing is settled */
    assert_true(keep("ladders", r, 2, &e));
    struct run_spec two[] = {asking(8, 8, 0.5), asking(8, 8, 0.009)};
    const struct run_spec was = two[1];
    assert_false(levels_settle(database, two, order, 2, true, arena, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "is known to be within 0.9 %"));
    assert_int_equal(two[0].machine.network.level, LEVEL_AUTO_TOLERANCE);
    assert_string_equal(two[1].config_hash, was.config_hash);
    err_clear(&e);
    assert_true(keep("ladders", r, 0, &e));
}

/* The family of each stored run, by which its level's error is known. */
static void families_make_errors_known(void **state)
{
    struct err e;
    struct run_spec spec[3];
    char family[65];
    (void)state;
    err_clear(&e);
    for (int i = 0; i < 3; i++) {
        spec[i] = made_spec(arena, "t3e-300", 16 << i, 4, 0);
        const struct run_result r = made_result(arena, &spec[i]);
        if (i < 2) assert_true(store_put(database, &spec[i], NULL, &r, &e));
    }
    struct identity *by = identity_of_runs();
    /* the last is not stored */
    assert_true(known_error_note(database, NULL, spec, 1, &e));
    assert_true(known_error_note(database, by, spec, 3, &e));
    assert_true(known_error_note(database, NULL, spec, 3, &e)); /* again: no row twice */
    identity_destroy(by);
    level_family(&spec[0], family);
    char expected[160];
    snprintf(expected, sizeof expected, "%s %s ", family, family); /* alike but for their size */
    assert_string_equal(answer("SELECT family FROM run_family"), expected);
    assert_string_equal(answer("SELECT level_error FROM v_known_error"), "null null ");
    struct accuracy_rung r[] = {rung(family, "n=P=8", "link", 0.25),
                                rung(family, "n=P=16", "link", 0.5),
                                rung(family, "n=P=16", "loggp", 0.75)};
    assert_true(keep("known", r, 3, &e));
    assert_string_equal(answer("SELECT level_error FROM v_known_error"), "0.5 0.5 ");
    assert_string_equal(answer("SELECT level_at FROM v_known_error"), "n=P=16 n=P=16 ");
}

static void grades_replace_older_ones_of_their_suite(void **state)
{
    struct stability_row row[3];
    struct stability_report r = {.nrow = 3, .row = row};
    struct err e;
    (void)state;
    err_clear(&e);
    memset(row, 0, sizeof row);
    for (int i = 0; i < 3; i++) {
        snprintf(row[i].subject, sizeof row[i].subject, "scene %d", 2 - i);
        snprintf(row[i].algorithm, sizeof row[i].algorithm, "aba");
        snprintf(row[i].precision, sizeof row[i].precision, "double");
        row[i].status = (enum stability_status)i;
        row[i].error = i == 2 ? NAN : 1e-9 * i;
    }
    snprintf(r.suite, sizeof r.suite, "suite");
    assert_true(keep_stability(database, &r, &e));
    snprintf(r.suite, sizeof r.suite, "other");
    assert_true(keep_stability(database, &r, &e));
    assert_string_equal(answer("SELECT subject FROM stability WHERE suite = 'other' ORDER BY "
                               "ordinal"),
                        "scene 2 scene 1 scene 0 ");
    assert_string_equal(answer("SELECT status FROM stability WHERE suite = 'other' ORDER BY "
                               "ordinal"),
                        "ok degraded failed ");
    r.nrow = 1;
    assert_true(keep_stability(database, &r, &e));
    assert_string_equal(answer("SELECT suite FROM stability ORDER BY suite, ordinal"),
                        "other suite suite suite ");
    /* two rows of one key are one row, the later one */
    row[1] = row[0], row[1].status = STABILITY_FAILED, r.nrow = 2;
    assert_true(keep_stability(database, &r, &e));
    assert_string_equal(answer("SELECT status FROM stability WHERE suite = 'other'"), "failed ");
}

/* ---- load curves */

static struct load_point made_point(struct random *r, double offered, bool probe)
{
    struct load_point p = {.offered = offered,
                           .probe = probe,
                           .status = (enum load_status)random_below(r, 4),
                           .created = random_uniform(r, 0, 1),
                           .accepted = random_uniform(r, 0, 1),
                           .mean_ps = random_uniform(r, 0, 1e9),
                           .half_ps = random_uniform(r, 0, 1e6),
                           .p50_ps = (int64_t)random_below(r, 1000000),
                           .p99_ps = (int64_t)random_below(r, 1000000),
                           .max_ps = INT64_MAX,
                           .messages = (int64_t)random_below(r, 1000000),
                           .warmup_ps = (int64_t)random_below(r, 1000),
                           .length_ps = 1LL << 53,
                           .lag = random_uniform(r, -1, 1),
                           .events = (int64_t)random_below(r, 1000),
                           .host_s = 2};
    if (p.status == LOAD_UNSTABLE) p.mean_ps = p.half_ps = NAN, p.p50_ps = p.p99_ps = p.max_ps = -1;
    if (p.status == LOAD_DEADLOCK) snprintf(p.text, sizeof p.text, "0 -> 1 -> 0");
    return p;
}

static bool same(double x, double y) { return x == y || (isnan(x) && isnan(y)); }

static void points_are_found_as_they_were_stored(void **state)
{
    enum { POINTS = 200 };
    struct load_series x = {.series = "one",
                            .saturation = NAN,
                            .low = NAN,
                            .high = NAN,
                            .bound = NAN},
                       y = x;
    struct load_point p[POINTS], q;
    struct random r = random_make(1, 2, 3);
    struct err e;
    bool found;
    (void)state;
    err_clear(&e);
    snprintf(y.series, sizeof y.series, "two");
    for (int i = 0; i < POINTS; i++) { /* loads that no decimal of few digits is */
        p[i] = made_point(&r, (i / 2 + 1) / 300.0, i % 2);
        assert_true(load_store_point(database, &x, &p[i], &e));
    }
    for (int i = 0; i < POINTS; i++) {
        assert_true(load_find_point(database, &x, p[i].offered, p[i].probe, &found, &q, &e));
        assert_true(found && q.offered == p[i].offered && q.probe == p[i].probe);
        assert_int_equal(q.status, p[i].status);
        assert_true(same(q.created, p[i].created) && same(q.accepted, p[i].accepted));
        assert_true(same(q.mean_ps, p[i].mean_ps) && same(q.half_ps, p[i].half_ps));
        assert_true(q.p50_ps == p[i].p50_ps && q.p99_ps == p[i].p99_ps);
        assert_true(q.max_ps == p[i].max_ps && q.messages == p[i].messages);
        assert_true(q.warmup_ps == p[i].warmup_ps && q.length_ps == p[i].length_ps);
        assert_true(same(q.lag, p[i].lag) && q.events == p[i].events && q.host_s == 2);
        assert_string_equal(q.text, p[i].text);
    }
    /* another load, another series: nothing is there */
    assert_true(load_find_point(database, &x, nextafter(p[0].offered, 1), false, &found, &q, &e));
    assert_false(found);
    assert_true(load_find_point(database, &y, p[0].offered, false, &found, &q, &e));
    assert_true(!found && q.offered == p[0].offered && !q.probe);
    p[0].messages = 77; /* a point takes the place of the older one */
    assert_true(load_store_point(database, &x, &p[0], &e));
    assert_true(load_find_point(database, &x, p[0].offered, false, &found, &q, &e));
    assert_true(found && q.messages == 77);
    assert_string_equal(answer("SELECT count(*) FROM load_point"), "200 ");
}

static void a_series_stays_unless_it_is_replaced(void **state)
{
    struct load_series x = {.series = "one",
                            .machine = "m",
                            .nodes = 8,
                            .saturation = NAN,
                            .low = NAN,
                            .high = NAN,
                            .bound = NAN},
                       y = x;
    struct err e;
    (void)state;
    err_clear(&e);
    snprintf(y.series, sizeof y.series, "two");
    assert_true(load_add_series(database, &x, &e) && load_add_series(database, &y, &e));
    x.saturation = 0.5, x.probes = 9;
    assert_true(load_add_series(database, &x, &e)); /* what is there stays */
    assert_string_equal(answer("SELECT saturation FROM load_series ORDER BY series"), "null null ");
    assert_true(load_store_series(database, &x, &e)); /* or is replaced */
    assert_string_equal(answer("SELECT saturation FROM load_series ORDER BY series"), "0.5 null ");
    assert_true(load_forget(database, &x, &e));
    assert_string_equal(answer("SELECT series FROM load_series"), "two ");
    assert_string_equal(answer("SELECT count(*) FROM load_point WHERE series = 'one'"), "0 ");
}

/* ---- recordings */

static void words_with_a_colon_are_recordings(void **state)
{
    static const char *const wrong[] = {":1",      "a.db:",   "a.db:x",  "a.db:0",
                                        "a.db:-1", "a.db:1x", "a.db:1.5"};
    struct load_recording x;
    struct err e;
    (void)state;
    assert_true(load_is_recording("a.db:1") && load_is_recording(":"));
    assert_false(load_is_recording("uniform") || load_is_recording(""));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        err_clear(&e);
        assert_false(load_recording_read(wrong[i], &x, arena, &e));
        if (e.kind != ERR_USAGE || !strstr(e.text, "DATABASE:RUN"))
            fail_msg("%s: %d '%s'", wrong[i], e.kind, e.text);
    }
    err_clear(&e);
    assert_false(load_recording_read("nowhere.db:1", &x, arena, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
}

/* Sends of a stored run, in the order of time, each as it was. */
static void messages_of_a_run_are_read(void **state)
{
    char folder[192], path[512], word[600];
    struct run_spec spec = made_spec(arena, "t3e-300", 16, 4, 0);
    struct load_recording x;
    struct err e;
    (void)state;
    err_clear(&e);
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "a:b.db"); /* the last colon counts */
    spec.record.spans = true;
    made_identity(&spec, arena);
    struct run_result r = made_result(arena, &spec);
    made_spans(&r, arena);
    for (int64_t i = 0; i < r.nspan; i++) { /* two of one time, and one at the end of the run */
        if (r.span[i].kind == SPAN_SEND && r.span[i].rank == 3) r.span[i].end_ps -= 2000;
        if (r.span[i].kind == SPAN_SEND && r.span[i].stage == 6 && r.span[i].rank == 0)
            r.span[i].end_ps = r.makespan_ps;
    }
    struct store *s = store_open(path, STORE_WRITE, &e);
    assert_non_null(s);
    if (!store_put(s, &spec, NULL, &r, &e)) fail_msg("%s", e.text);
    const int64_t id = store_run_id(s, &spec);
    store_close(s);
    snprintf(word, sizeof word, "%s:%d", path, (int)id);
    if (!load_recording_read(word, &x, arena, &e)) fail_msg("%s", e.text);
    assert_true(x.nrank == 4 && x.period == r.makespan_ps);
    int sends = 0;
    for (int64_t i = 0; i < r.nspan; i++) {
        const struct span *p = &r.span[i];
        if (p->kind != SPAN_SEND || p->end_ps >= r.makespan_ps) continue;
        sends++;
        bool found = false;
        for (int m = 0; m < x.nmessage && !found; m++)
            found = x.src[m] == p->rank && x.dst[m] == p->peer && x.bytes[m] == p->bytes &&
                    x.time[m] == p->end_ps;
        assert_true(found);
    }
    assert_int_equal(x.nmessage, sends);
    assert_int_equal(sends, 4 * 7 - 1);
    for (int m = 1; m < x.nmessage; m++)
        assert_true(x.time[m - 1] < x.time[m] ||
                    (x.time[m - 1] == x.time[m] && x.src[m - 1] <= x.src[m]));
    struct text a = {0}, b = {0}; /* what it is follows from every message */
    load_recording_identify(&x, &a);
    x.dst[x.nmessage - 1] ^= 1;
    load_recording_identify(&x, &b);
    assert_string_not_equal(a.s, b.s);
    text_free(&a), text_free(&b);
    snprintf(word, sizeof word, "%s:%d", path, (int)id + 1);
    assert_false(load_recording_read(word, &x, arena, &e));
    assert_true(e.kind == ERR_NO_INPUT || e.kind == ERR_DATA || e.kind == ERR_USAGE);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ladders_replace_older_ones_of_their_scenario),
        cmocka_unit_test(levels_are_settled_by_stored_ladders),
        cmocka_unit_test(families_make_errors_known),
        cmocka_unit_test(grades_replace_older_ones_of_their_suite),
        cmocka_unit_test(points_are_found_as_they_were_stored),
        cmocka_unit_test(a_series_stays_unless_it_is_replaced),
        cmocka_unit_test(words_with_a_colon_are_recordings),
        cmocka_unit_test(messages_of_a_run_are_read),
    };
    return cmocka_run_group_tests(tests, open_database, close_database);
}
