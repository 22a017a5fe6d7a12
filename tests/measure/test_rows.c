/* test_rows.c - what is known of all ranks together against plain sums; every table of columns is
 * one that a database can have; values are absent where their structs say so. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "measure/load_row.h"
#include "measure/real_row.h"
#include "measure/run_row.h"
#include "measure/study_row.h"

/* --- tables ----------------------------------------------------------------------------------- */

static const struct named_table {
    const char *name;
    const struct column_table *table;
} tables[] = {
    {"outcome", &run_outcome_columns},
    {"refinement", &run_refinement_columns},
    {"stage_row", &stage_row_columns},
    {"stage_time", &stage_time_columns},
    {"baseline", &baseline_columns},
    {"error_check", &error_check_columns},
    {"omission", &omission_columns},
    {"link_load", &link_load_columns},
    {"span", &span_columns},
    {"load_series", &load_series_columns},
    {"load_point", &load_point_columns},
    {"real_result", &real_result_columns},
    {"real_stage", &real_stage_columns},
    {"real_sample", &real_sample_columns},
    {"rung", &accuracy_rung_columns},
    {"choice", &accuracy_choice_columns},
    {"stability", &stability_columns},
    {"saving", &saving_columns},
};
enum { TABLES = sizeof tables / sizeof *tables };

static bool is_name(const char *s)
{
    return *s && strspn(s, "abcdefghijklmnopqrstuvwxyzP0123456789_") == strlen(s);
}

/* Whether the table itself says that the value may be absent. */
static bool may_be_absent(const struct column *c)
{
    return c->known != NULL || c->absent != ABSENT_NEVER;
}

static void a_database_can_have_every_table(void **state)
{
    (void)state;
    for (int t = 0; t < TABLES; t++) {
        const struct column_table *x = tables[t].table;
        int stored = 0;
        for (int i = 0; i < x->n; i++) {
            const struct column *c = &x->column[i];
            if (!is_name(c->name)) fail_msg("%s: '%s'", tables[t].name, c->name);
            if (!c->doc || !*c->doc || strchr(c->doc, '\n'))
                fail_msg("%s.%s: its line of documentation", tables[t].name, c->name);
            /* STRICT tables refuse NULL where it was not announced */
            if (!(c->flags & (COLUMN_NO_SQL | COLUMN_NULL)) && may_be_absent(c))
                fail_msg("%s.%s may be absent", tables[t].name, c->name);
            if (c->kind == COLUMN_WORD && (c->nword < 2 || !c->word))
                fail_msg("%s.%s: its words", tables[t].name, c->name);
            for (int k = 0; k < i; k++)
                if (strcmp(x->column[k].name, c->name) == 0)
                    fail_msg("%s.%s stands twice", tables[t].name, c->name);
            stored += !(c->flags & COLUMN_NO_SQL);
        }
        struct text list = {0}, define = {0};
        assert_int_equal(columns_list(x, &list), stored);
        columns_define(x, &define);
        /* one comma a name, one line a column */
        int commas = 0, lines = 0;
        for (const char *s = list.s; s && *s; s++) commas += *s == ',';
        for (const char *s = define.s; s && *s; s++) lines += *s == '\n';
        assert_int_equal(commas, stored);
        assert_int_equal(lines, stored);
        text_free(&list), text_free(&define);
    }
}

/* --- values by name --------------------------------------------------------------------------- */

static struct column_value value; /* of the last `get`, whose texts it may hold */

static const struct column_value *get(const struct column_table *t, const char *name,
                                      const void *row)
{
    for (int i = 0; i < t->n; i++)
        if (strcmp(t->column[i].name, name) == 0) {
            column_read(&t->column[i], row, &value);
            return &value;
        }
    fail_msg("no column '%s'", name);
    return NULL;
}

static bool absent(const struct column_table *t, const char *name, const void *row)
{
    return get(t, name, row)->kind == VALUE_ABSENT;
}

/* --- all ranks together ----------------------------------------------------------------------- */

enum { RANKS = 7, STAGES = 4 };

static void fill(struct random *r, struct stage_time *t)
{
    t->compute_ps = (int64_t)random_below(r, 1000), t->send_ps = (int64_t)random_below(r, 1000);
    t->recv_ps = (int64_t)random_below(r, 1000), t->wait_ps = (int64_t)random_below(r, 1000);
    t->contention_ps = (int64_t)random_below(r, 1000);
    t->messages = (int64_t)random_below(r, 9), t->bytes = (int64_t)random_below(r, 9);
    t->work = (struct work){random_below(r, 9),
                            random_below(r, 9),
                            random_below(r, 9),
                            random_below(r, 9),
                            random_below(r, 9),
                            random_below(r, 9),
                            0};
}

static int64_t total(const struct stage_time *t)
{
    return t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
}

static void ranks_are_summed_up(void **state)
{
    (void)state;
    struct random r = random_make(51, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct stage_time t[RANKS * STAGES] = {{0}};
        int64_t finish[RANKS], error = 0, least = INT64_MAX, most = 0, first = INT64_MAX, last = 0;
        struct run_result x = {.nrank = RANKS, .nstage = STAGES, .stage = t, .finish_ps = finish};
        x.makespan_ps = 5000 + (int64_t)random_below(&r, 10000);
        for (int k = 0; k < RANKS; k++) {
            int64_t sum = 0, compute = 0;
            for (int i = 0; i < STAGES; i++) {
                fill(&r, &t[k * STAGES + i]);
                sum += total(&t[k * STAGES + i]), compute += t[k * STAGES + i].compute_ps;
            }
            error = llabs(sum - x.makespan_ps) > error ? llabs(sum - x.makespan_ps) : error;
            least = compute < least ? compute : least, most = compute > most ? compute : most;
            finish[k] = (int64_t)random_below(&r, 99999);
            first = finish[k] < first ? finish[k] : first,
            last = finish[k] > last ? finish[k] : last;
        }
        struct run_row row = run_row_make(NULL, NULL, &x);
        const struct column_table *c = &run_outcome_columns;
        assert_int_equal(get(c, "accounting_error_ps", &row)->integer, error);
        assert_int_equal(get(c, "rank_compute_min_ps", &row)->integer, least);
        assert_int_equal(get(c, "rank_compute_max_ps", &row)->integer, most);
        assert_int_equal(get(c, "finish_min_ps", &row)->integer, first);
        assert_int_equal(get(c, "finish_max_ps", &row)->integer, last);
        run_row_free(&row);
    }
}

static void stages_are_summed_up_over_ranks(void **state)
{
    (void)state;
    struct random r = random_make(52, 0, 0);
    struct stage_time t[RANKS * STAGES];
    struct run_result x = {.nrank = RANKS, .nstage = STAGES, .stage = t};
    for (int k = 0; k < RANKS * STAGES; k++) fill(&r, &t[k]);
    strcpy(x.stage_name[2], "solve");
    const struct stage_row row = stage_row_make(&x, 2);
    int64_t wait = 0, most = 0, messages = 0, bytes = 0;
    uint64_t sines = 0;
    for (int k = 0; k < RANKS; k++) {
        const struct stage_time *s = &t[k * STAGES + 2];
        wait += s->wait_ps, messages += s->messages, bytes += s->bytes, sines += s->work.trig;
        most = total(s) > most ? total(s) : most;
        assert_int_equal(stage_time_total(s), total(s));
    }
    const struct column_table *c = &stage_row_columns;
    assert_string_equal(get(c, "name", &row)->text, "solve");
    assert_int_equal(get(c, "wait_sum_ps", &row)->integer, wait);
    assert_int_equal(get(c, "total_max_ps", &row)->integer, most);
    assert_int_equal(get(c, "messages", &row)->integer, messages);
    assert_int_equal(get(c, "sent_bytes", &row)->integer, bytes);
    assert_int_equal(get(c, "sines", &row)->integer, (int64_t)sines);
}

/* A stage that a rank never entered has no time, no message and no work. */
static void any_doing_makes_a_stage_busy(void **state)
{
    (void)state;
    const struct stage_time busy[] = {{.compute_ps = 1}, {.send_ps = 1},       {.recv_ps = 1},
                                      {.wait_ps = 1},    {.contention_ps = 1}, {.messages = 1},
                                      {.work.flop = 1}};
    assert_true(stage_time_idle(&(struct stage_time){0}));
    for (size_t k = 0; k < sizeof busy / sizeof *busy; k++) assert_false(stage_time_idle(&busy[k]));
}

/* Nothing recorded: no extremes; no loops: no drift; nothing refined: no residual before it. */
static void what_was_not_recorded_is_absent(void **state)
{
    (void)state;
    const struct column_table *c = &run_outcome_columns;
    struct run_result x = {
        .residual = NAN, .measured_s = NAN, .loop_rank = -1, .residual_before = 3};
    struct run_row row = run_row_make(NULL, NULL, &x);
    static const char *const missing[] = {
        "finish_min_ps",  "finish_max_ps", "rank_compute_min_ps", "rank_compute_max_ps",
        "residual",       "measured_s",    "loop_rows",           "loop_rank",
        "drift_position", "condition"};
    for (size_t k = 0; k < sizeof missing / sizeof *missing; k++)
        if (!absent(c, missing[k], &row)) fail_msg("'%s' is known", missing[k]);
    assert_true(absent(&run_refinement_columns, "residual_before", &row));
    assert_string_equal(get(&run_refinement_columns, "left_out", &row)->text, "");
    assert_string_equal(get(c, "status", &row)->text, "ok");
    run_row_free(&row);
    /* each by what makes it known */
    x.loop_rows = 6, x.drift_velocity = 0.5, x.twice_added = true, x.condition = 7;
    x.status = RUN_DEADLOCK;
    row = run_row_make(NULL, NULL, &x);
    assert_int_equal(get(c, "loop_rows", &row)->integer, 6);
    assert_true(absent(c, "loop_rank", &row)); /* not asked for */
    assert_true(get(c, "drift_velocity", &row)->real == 0.5);
    assert_true(get(c, "condition", &row)->real == 7);
    assert_true(get(&run_refinement_columns, "residual_before", &row)->real == 3);
    assert_string_equal(get(c, "status", &row)->text, "deadlock");
    x.loop_rank = 0;
    assert_int_equal(get(c, "loop_rank", &row)->integer, 0);
    run_row_free(&row);
}

static void omissions_stand_as_one_text(void **state)
{
    (void)state;
    struct run_result x = {.nomission = 2,
                           .omission = {{.what = "velocities", .why = "all rates are zero"},
                                        {.what = "loads", .why = "there are none", .bound = 1e-9}}};
    struct run_row row = run_row_make(NULL, NULL, &x);
    assert_string_equal(get(&run_refinement_columns, "left_out", &row)->text,
                        "velocities: all rates are zero; loads: there are none");
    run_row_free(&row);
    assert_string_equal(get(&omission_columns, "class", &x.omission[0])->text, "exact");
    assert_string_equal(get(&omission_columns, "class", &x.omission[1])->text, "bounded");
    assert_true(absent(&omission_columns, "bound", &x.omission[0]));
    assert_true(get(&omission_columns, "bound", &x.omission[1])->real == 1e-9);
}

/* --- single structs --------------------------------------------------------------------------- */

static void a_check_passes_within_its_tolerance(void **state)
{
    (void)state;
    static const struct {
        double relative, tolerance;
        bool passed, known;
    } row[] = {{1e-9, 1e-8, true, true},  {1e-8, 1e-8, true, true},    {1.1e-8, 1e-8, false, true},
               {NAN, 1e-8, false, false}, {INFINITY, 1, false, false}, {0, 0, true, true}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const struct error_check e = {.relative = row[k].relative, .tolerance = row[k].tolerance};
        assert_int_equal(get(&error_check_columns, "passed", &e)->integer, row[k].passed);
        assert_int_equal(!absent(&error_check_columns, "relative_error", &e), row[k].known);
    }
}

static void ports_have_nodes_and_links_have_routers(void **state)
{
    (void)state;
    const struct link_load injection = {.from = -1, .to = 4, .node = 0},
                           link = {.from = 0, .to = 5, .node = -1};
    assert_true(absent(&link_load_columns, "from_router", &injection));
    assert_int_equal(get(&link_load_columns, "node", &injection)->integer, 0);
    assert_int_equal(get(&link_load_columns, "from_router", &link)->kind, VALUE_INT);
    assert_true(absent(&link_load_columns, "node", &link));
    const struct span alone = {.kind = SPAN_BARRIER, .peer = -1, .message = -1},
                      pair = {.kind = SPAN_SEND, .peer = 0, .message = 0};
    assert_true(absent(&span_columns, "peer", &alone) && absent(&span_columns, "message", &alone));
    assert_int_equal(get(&span_columns, "peer", &pair)->kind, VALUE_INT);
    assert_string_equal(get(&span_columns, "kind", &alone)->text, "barrier");
}

static void an_unstable_load_has_no_latency(void **state)
{
    (void)state;
    const struct load_point p = {.status = LOAD_UNSTABLE,
                                 .mean_ps = NAN,
                                 .half_ps = NAN,
                                 .p50_ps = -1,
                                 .p99_ps = -1,
                                 .max_ps = -1,
                                 .accepted = 0.5};
    static const char *const none[] = {"mean_ps", "half_ps", "p50_ps", "p99_ps", "max_ps"};
    for (int k = 0; k < 5; k++) assert_true(absent(&load_point_columns, none[k], &p));
    assert_true(get(&load_point_columns, "accepted", &p)->real == 0.5);
    assert_string_equal(get(&load_point_columns, "status", &p)->text, "unstable");
    struct load_series s = {.saturation = 0.4, .low = 0.3, .high = 0.5, .bound = NAN};
    assert_true(absent(&load_series_columns, "saturation", &s)); /* not looked for */
    assert_true(absent(&load_series_columns, "message_bytes", &s));
    s.probes = 1, s.bytes = 64;
    assert_true(get(&load_series_columns, "saturation_high", &s)->real == 0.5);
    assert_true(absent(&load_series_columns, "bound", &s));
    assert_int_equal(get(&load_series_columns, "message_bytes", &s)->integer, 64);
}

/* Quartiles of a few numbers by hand; of any numbers they stand in order. */
static void times_have_quartiles(void **state)
{
    (void)state;
    double five[] = {5, 1, 4, 2, 3}, one[] = {7}, two[] = {3, 1};
    struct real_times t = real_times_of(five, 5);
    assert_true(t.min == 1 && t.lower == 2 && t.median == 3 && t.upper == 4 && t.max == 5);
    for (int i = 0; i < 5; i++) assert_true(five[i] == i + 1);
    t = real_times_of(one, 1);
    assert_true(t.min == 7 && t.lower == 7 && t.median == 7 && t.upper == 7 && t.max == 7);
    t = real_times_of(two, 2);
    assert_true(t.min == 1 && t.median == 2 && t.max == 3);
    struct random r = random_make(53, 0, 0);
    for (int n = 1; n < 60; n++) {
        double x[60];
        int below = 0, above = 0;
        for (int i = 0; i < n; i++) x[i] = random_uniform(&r, -5, 5);
        t = real_times_of(x, n);
        assert_true(t.min <= t.lower && t.lower <= t.median && t.median <= t.upper &&
                    t.upper <= t.max);
        for (int i = 0; i < n; i++) below += x[i]<t.median, above += x[i]> t.median;
        assert_int_equal(below, above);
        assert_int_equal(below, n / 2);
    }
    const struct real_result none = {.time.min = 1}, some = {.time.min = 1, .nsample = 1};
    assert_true(absent(&real_result_columns, "min_s", &none));
    assert_false(absent(&real_result_columns, "min_s", &some));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_database_can_have_every_table),
        cmocka_unit_test(ranks_are_summed_up),
        cmocka_unit_test(stages_are_summed_up_over_ranks),
        cmocka_unit_test(any_doing_makes_a_stage_busy),
        cmocka_unit_test(what_was_not_recorded_is_absent),
        cmocka_unit_test(omissions_stand_as_one_text),
        cmocka_unit_test(a_check_passes_within_its_tolerance),
        cmocka_unit_test(ports_have_nodes_and_links_have_routers),
        cmocka_unit_test(an_unstable_load_has_no_latency),
        cmocka_unit_test(times_have_quartiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
