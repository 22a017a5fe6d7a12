/* test_store.c - what is put into the database comes out of it, whole and once; views compute what
 * they say. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <sqlite3.h>

#include "base/arena.h"
#include "base/digest.h"
#include "base/text.h"
#include "../support/made_run.h"
#include "../support/store_fixture.h"
#include "store/build.h"
#include "store/store.h"

static bool take_cell(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn;
    (void)name;
    text_copy(context, 8192, value[0] ? value[0] : "NULL");
    return false;
}

/* The first cell of a query's first row. */
static const char *cell(struct store_fixture *f, const char *sql)
{
    char *buffer = arena_take(f->a, 8192);
    strcpy(buffer, "no row");
    assert_true(store_select(f->s, sql, 0, NULL, take_cell, buffer, &f->e));
    return buffer;
}

#define assert_close(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static double number(struct store_fixture *f, const char *sql)
{
    return strtod(cell(f, sql), NULL);
}

static void put(struct store_fixture *f, const struct run_spec *spec, const struct run_result *r)
{
    if (!store_put(f->s, spec, NULL, r, &f->e)) fail_msg("%s", f->e.text);
}

static void a_run_comes_back_as_it_was_put(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 128, 128, 3);
    struct run_result r = made_result(f->a, &spec);
    r.status = RUN_INVALID;
    strcpy(r.text, "tau is wrong: 'x' \"y\" \xc3\xa9");
    r.nomission = 2;
    r.omission[0] = (struct omission){.what = "base terms", .why = "the base is fixed"};
    r.omission[1] = (struct omission){.what = "joints", .why = "all are fixed", .bound = 0.25};
    r.digest = UINT64_C(0xfedcba9876543210);
    put(f, &spec, &r);
    assert_string_equal(cell(f, "SELECT config_hash FROM run"), spec.config_hash);
    assert_string_equal(cell(f, "SELECT config_text FROM run"), spec.config_text);
    assert_string_equal(cell(f, "SELECT status || '|' || text FROM run"),
                        "invalid|tau is wrong: 'x' \"y\" \xc3\xa9");
    assert_string_equal(cell(f, "SELECT digest FROM run"), "fedcba9876543210");
    assert_string_equal(cell(f, "SELECT left_out FROM run"),
                        "base terms: the base is fixed; joints: all are fixed");
    assert_string_equal(
        cell(f, "SELECT group_concat(what||'|'||why||'|'||class||'|'||ifnull(bound, 'NULL'), '; ')"
                " FROM (SELECT * FROM run_omission ORDER BY what)"),
        "base terms|the base is fixed|exact|NULL; joints|all are fixed|bounded|0.25");
    assert_string_equal(
        cell(f, "SELECT machine||level||topology||kernel||formulation||solver||operators||precision"
                "||model||base||joint||n||'/'||P||'/'||rep FROM run"),
        "t3e-300linkcrossbardynamicspaperpcr-symmetric"
        "structureddoubleserial-chainfixedrevolute128/128/3");
    assert_int_equal(number(f, "SELECT makespan_ps FROM run"), r.makespan_ps);
    assert_int_equal(number(f, "SELECT count(*) FROM rank_stage"), 128 * 7);
    assert_int_equal(number(f, "SELECT count(*) FROM stage"), 7);
    assert_int_equal(number(f, "SELECT recv_ps FROM rank_stage WHERE rank = 5 AND stage = 2"),
                     r.stage[5 * 7 + 2].recv_ps);
    /* The text that holds them is what SQLite itself would make of the rows, so both are one thing
     * after a merge or an upgrade. */
    assert_int_equal(
        number(f, "SELECT (SELECT entries FROM rank_times) = (SELECT "
                  "json_group_array(json_array(rank, stage, compute_ps, send_ps, recv_ps, wait_ps, "
                  "contention_ps, messages, sent_bytes, flops)) FROM rank_stage)"),
        1);
    assert_string_equal(cell(f, "SELECT name FROM stage WHERE stage = 6"), "CFA[3]");
    assert_string_equal(
        cell(f, "SELECT quantity || reference || passed FROM error_check WHERE ordinal = 1"),
        "qddaba1");
    assert_string_equal(cell(f, "SELECT created_utc LIKE '20__-__-__T__:__:__Z' FROM run"), "1");
}

static void provenance_names_this_build(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    put(f, &spec, &r);
    struct build build = store_build();
    assert_string_equal(cell(f, "SELECT version FROM v_provenance"), build.version);
    assert_string_equal(cell(f, "SELECT git FROM v_provenance"), build.git);
    assert_true(strlen(build.git) >= 12 && strlen(build.compiler) > 4);
    assert_int_equal(number(f, "SELECT count(*) FROM build"), 1);
}

static void putting_a_run_again_replaces_it(void **state)
{
    struct store_fixture *f = *state;
    static const char *const table[] = {"run",      "run_setting", "stage", "rank_stage",
                                        "baseline", "error_check", "span"};
    struct run_spec spec = made_spec(f->a, "t3e-300", 8, 8, 0),
                    other = made_spec(f->a, "t3e-300", 8, 8, 1);
    struct run_result r = made_result(f->a, &spec);
    made_spans(&r, f->a);
    put(f, &other, &r);
    put(f, &spec, &r);
    int64_t count[7];
    for (int i = 0; i < 7; i++) {
        char sql[64];
        snprintf(sql, sizeof sql, "SELECT count(*) FROM %s", table[i]);
        count[i] = (int64_t)number(f, sql);
    }
    r.nbaseline = 1;
    r.makespan_ps += 7;
    put(f, &spec, &r);
    for (int i = 0; i < 7; i++) {
        char sql[64];
        snprintf(sql, sizeof sql, "SELECT count(*) FROM %s", table[i]);
        assert_int_equal(number(f, sql), count[i] - (i == 4 ? 3 : 0));
    }
    assert_int_equal(number(f, "SELECT makespan_ps FROM run WHERE rep = 0"), r.makespan_ps);
    assert_int_equal(number(f, "SELECT count(*) FROM pragma_foreign_key_check"), 0);
}

static void only_a_good_run_need_not_run_again(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0),
                    next = made_spec(f->a, "t3e-300", 4, 4, 1);
    struct run_result r = made_result(f->a, &spec);
    assert_false(store_has(f->s, &spec));
    static const enum run_status bad[] = {RUN_INVALID, RUN_DEADLOCK, RUN_FAILED};
    for (int i = 0; i < 3; i++) {
        r.status = bad[i];
        put(f, &spec, &r);
        assert_false(store_has(f->s, &spec));
    }
    r.status = RUN_OK;
    put(f, &spec, &r);
    assert_true(store_has(f->s, &spec));
    assert_false(store_has(f->s, &next));
    spec.seed++;
    assert_false(store_has(f->s, &spec));
    spec.seed = UINT64_MAX;
    put(f, &spec, &r);
    assert_true(store_has(f->s, &spec));
    assert_int_equal(store_run_id(f->s, &spec), number(f, "SELECT max(id) FROM run"));
}

static void a_sweep_can_be_pivoted_by_what_it_varies(void **state)
{
    struct store_fixture *f = *state;
    for (int p = 2; p <= 8; p *= 2) {
        struct run_spec spec = made_spec(f->a, "t3e-300", p, p, 0);
        spec.machine.network.link_bandwidth = p < 8 ? 480e6 : 960e6;
        made_identity(&spec, f->a);
        struct run_result r = made_result(f->a, &spec);
        put(f, &spec, &r);
    }
    assert_string_equal(
        cell(
            f,
            "SELECT group_concat(key, ',') FROM (SELECT DISTINCT key FROM v_itervar ORDER BY key)"),
        "machine.network.link.bandwidth,model.n,ranks");
    assert_string_equal(
        cell(f, "SELECT group_concat(value, ', ') FROM (SELECT value FROM v_itervar WHERE key = "
                "'machine.network.link.bandwidth' ORDER BY run_id)"),
        "480 MB/s, 480 MB/s, 960 MB/s");
    assert_int_equal(number(f, "SELECT count(*) FROM setting WHERE key = 'kernel.solver'"), 1);
}

static void speedup_efficiency_and_fraction_are_those_of_amdahl(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 16, 16, 0);
    struct run_result r = made_result(f->a, &spec);
    /* S = 10 on 16: f = (1 - 1/10) / (1 - 1/16) = 0.96 */
    r.makespan_ps = 400000000;
    r.nbaseline = 1;
    r.baseline[0].time_ps = 4000000000;
    put(f, &spec, &r);
    assert_close(number(f, "SELECT speedup FROM v_speedup"), 10.0, 1e-12);
    assert_close(number(f, "SELECT efficiency FROM v_speedup"), 0.625, 1e-12);
    assert_close(number(f, "SELECT parallel_fraction FROM v_speedup"), 0.96, 1e-12);
    spec = made_spec(f->a, "t3e-300", 16, 1, 0);
    r = made_result(f->a, &spec);
    put(f, &spec, &r);
    assert_string_equal(cell(f, "SELECT parallel_fraction FROM v_speedup WHERE P = 1"), "NULL");
    r.status = RUN_INVALID;
    put(f, &spec, &r);
    assert_int_equal(number(f, "SELECT count(*) FROM v_speedup WHERE P = 1"), 0);
}

static void stages_hold_sums_and_extremes_of_all_ranks(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 1000, 1000, 0);
    struct run_result r = made_result(f->a, &spec);
    put(f, &spec, &r);
    assert_int_equal(number(f, "SELECT count(*) FROM rank_stage"), 0);
    for (int i = 0; i < r.nstage; i++) {
        int64_t sum = 0, most = 0;
        for (int k = 0; k < r.nrank; k++) {
            int64_t c = r.stage[k * r.nstage + i].compute_ps;
            sum += c;
            if (c > most) most = c;
        }
        char sql[160];
        snprintf(
            sql, sizeof sql,
            "SELECT compute_sum_ps = %lld AND compute_max_ps = %lld FROM stage WHERE stage = %d",
            (long long)sum, (long long)most, i);
        assert_string_equal(cell(f, sql), "1");
    }
    assert_close(number(f, "SELECT sum(total_mean_ps) FROM v_stage"), (double)r.makespan_ps, 1.0);
    assert_int_equal(number(f, "SELECT messages FROM stage WHERE stage = 3"), 3000);
    double compute = number(f, "SELECT 1.0 * sum(compute_sum_ps) FROM stage");
    double all = 1000.0 * (double)r.makespan_ps;
    assert_close(number(f, "SELECT compute_share FROM v_indicator"), compute / all, 1e-12);
    assert_close(number(f, "SELECT rc_ratio FROM v_indicator"), all / (all - compute), 1e-9);
}

static void accounting_is_exact_and_a_lost_picosecond_is_seen(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 600, 600, 0);
    struct run_result r = made_result(f->a, &spec);
    put(f, &spec, &r);
    assert_string_equal(
        cell(f, "SELECT difference_ps || ',' || accounting_error_ps FROM v_accounting"), "0,0");
    r.stage[123 * 7 + 4].send_ps -= 1;
    r.stage[124 * 7 + 4].send_ps += 1;
    put(f, &spec, &r);
    assert_string_equal(
        cell(f, "SELECT difference_ps || ',' || accounting_error_ps FROM v_accounting"), "0,1");
    r.stage[124 * 7 + 4].send_ps -= 1;
    put(f, &spec, &r);
    assert_string_equal(
        cell(f, "SELECT difference_ps || ',' || accounting_error_ps FROM v_accounting"), "-1,1");
}

static void numbers_that_are_not_finite_are_null_and_fail(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    r.error[0].relative = NAN;
    r.error[1].relative = INFINITY;
    r.host_s = -INFINITY;
    put(f, &spec, &r);
    assert_int_equal(
        number(f, "SELECT count(*) FROM v_errors WHERE relative_error IS NULL AND passed = 0"), 2);
    assert_string_equal(cell(f, "SELECT host_s FROM run"), "NULL");
}

static void a_sum_beyond_64_bits_is_null_not_wrong(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    for (int k = 0; k < 4; k++) r.stage[k * 7].wait_ps = INT64_MAX / 3;
    put(f, &spec, &r);
    assert_string_equal(cell(f, "SELECT wait_sum_ps FROM stage WHERE stage = 0"), "NULL");
    assert_string_not_equal(cell(f, "SELECT send_sum_ps FROM stage WHERE stage = 0"), "NULL");
}

static void links_and_spans_are_kept_within_their_limits(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    r.nlink = 20000;
    r.link = TAKE(f->a, r.nlink, struct link_load);
    for (int i = 0; i < r.nlink; i++)
        r.link[i] = (struct link_load){i - 1, i % 50 ? i : -1,          i % 50 ? -1 : i, 1, 8,
                                       10,    (int64_t)i * 7919 % 20000};
    made_spans(&r, f->a);
    put(f, &spec, &r);
    assert_int_equal(number(f, "SELECT count(*) FROM link_load"), 16384);
    assert_int_equal(number(f, "SELECT min(queue_ps) FROM link_load"), 20000 - 16384);
    assert_int_equal(number(f, "SELECT links FROM run"), 20000);
    assert_int_equal(
        number(f, "SELECT (SELECT entries FROM link_loads) = (SELECT "
                  "json_group_array(json_array(link, from_router, to_router, node, messages, "
                  "sent_bytes, busy_ps, queue_ps)) FROM (SELECT * FROM link_load ORDER BY link))"),
        1);
    assert_string_equal(
        cell(f, "SELECT to_router IS NULL AND node = 50 FROM link_load WHERE link = 50"), "1");
    assert_int_equal(number(f, "SELECT count(*) FROM span"), r.nspan);
    assert_int_equal(
        number(
            f,
            "SELECT count(*) FROM span a JOIN span b USING (run_id, message) WHERE a.kind = 'send' "
            "AND b.kind = 'recv' AND a.peer = b.rank AND b.peer = a.rank"),
        4 * 7);
    r.nspan = 20001;
    put(f, &spec, &r);
    assert_int_equal(number(f, "SELECT count(*) FROM span"), 0);
}

static void every_view_answers_on_an_empty_database(void **state)
{
    struct store_fixture *f = *state;
    static const char *const view[] = {"v_speedup",    "v_stage",    "v_accounting", "v_errors",
                                       "v_indicator",  "v_setting",  "v_itervar",    "v_claims",
                                       "v_provenance", "v_link_top", "v_repetition",
                                       "v_machine_state",
                                       "v_shown", "rank_stage", "link_load", "v_label", "v_run",
                                       "v_known_error"};
    for (size_t i = 0; i < sizeof view / sizeof *view; i++) {
        char sql[64];
        snprintf(sql, sizeof sql, "SELECT count(*) FROM %s", view[i]);
        assert_string_equal(cell(f, sql), "0");
    }
    /* v_unlimited lists keys, whatever the database holds */
    assert_int_equal(number(f, "SELECT count(*) FROM v_unlimited"), 9);
    assert_int_equal(number(f, "SELECT count(*) FROM sqlite_schema WHERE type = 'view'"),
                     (double)(sizeof view / sizeof *view + 1));
    assert_int_equal(
        number(
            f,
            "SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' AND "
            "strict = 0 AND name NOT LIKE 'sqlite_%'"),
        0);
}

static void generic_rows_replace_their_like_and_obey_the_schema(void **state)
{
    struct store_fixture *f = *state;
    static const char *const name[] = {"suite", "subject",   "quantity", "at",
                                       "unit",  "reference", "value",    "relative_error",
                                       "class", "verdict",   "source"};
    struct store_value v[] = {store_text("closed"), store_text("ring"),   store_text("time"),
                              store_text("P=8"),    store_text("s"),      store_real(1.5),
                              store_real(NAN),      store_real(0.25),     store_text("exact"),
                              store_text("pass"),   store_text("by hand")};
    for (int i = 0; i < 2; i++) assert_true(store_insert(f->s, "check_point", 11, name, v, &f->e));
    assert_string_equal(cell(f, "SELECT count(*) || ifnull(max(value), ' null') || "
                                "max(relative_error) FROM check_point"),
                        "1 null0.25");
    v[9] = store_text("perhaps");
    assert_false(store_insert(f->s, "check_point", 11, name, v, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    err_clear(&f->e);
    assert_false(store_insert(f->s, "no_such_table", 11, name, v, &f->e));
    assert_non_null(strstr(f->e.text, "no_such_table"));
    err_clear(&f->e);
    assert_true(store_delete(f->s, "check_point", "suite", store_text("closed"), &f->e));
    assert_int_equal(number(f, "SELECT count(*) FROM check_point"), 0);
}

static void a_transaction_is_kept_or_forgotten_as_a_whole(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    assert_true(store_begin(f->s, &f->e));
    put(f, &spec, &r);
    store_rollback(f->s);
    assert_int_equal(number(f, "SELECT count(*) FROM run"), 0);
    assert_true(store_begin(f->s, &f->e));
    put(f, &spec, &r);
    assert_true(store_commit(f->s, &f->e));
    assert_int_equal(number(f, "SELECT count(*) FROM run"), 1);
}

static void a_run_that_fails_half_way_leaves_no_row(void **state)
{
    struct store_fixture *f = *state;
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0),
                    next = made_spec(f->a, "t3e-300", 4, 4, 1);
    struct run_result r = made_result(f->a, &spec);
    put(f, &next, &r);
    sqlite3 *db;
    assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db,
                                  "CREATE UNIQUE INDEX stop ON error_check (run_id) WHERE run_id > "
                                  "1",
                                  NULL, NULL, NULL),
                     SQLITE_OK);
    assert_false(store_put(f->s, &spec, NULL, &r, &f->e));
    assert_non_null(strstr(f->e.text, "UNIQUE constraint failed"));
    assert_int_equal(number(f, "SELECT count(*) FROM run"), 1);
    assert_int_equal(number(f, "SELECT count(DISTINCT run_id) FROM rank_stage"), 1);
    assert_int_equal(sqlite3_exec(db, "DROP INDEX stop", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    err_clear(&f->e);
    put(f, &spec, &r);
    assert_int_equal(number(f, "SELECT count(*) FROM run"), 2);
}

static void commits_go_to_the_log_without_waiting_for_the_disk(void **state)
{
    struct store_fixture *f = *state;
    assert_string_equal(cell(f, "PRAGMA journal_mode"), "wal");
    assert_string_equal(cell(f, "PRAGMA synchronous"), "1");
    assert_string_equal(cell(f, "PRAGMA foreign_keys"), "1");
}

static bool count_kinds(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    int *seen = context;
    assert_int_equal(ncolumn, 4);
    assert_string_equal(name[3], "d");
    if (value == NULL) {
        seen[4]++;
        return true;
    }
    for (int i = 0; i < 4; i++) seen[value[i].kind]++;
    return true;
}

static void a_passing_store_leaves_no_file_and_keeps_what_claims_ask(void **state)
{
    struct store_fixture *f = *state;
    struct store *passing = store_open("nowhere/at-all", STORE_MEMORY, &f->e);
    assert_non_null(passing);
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    char answer[8192];
    assert_true(store_put(passing, &spec, NULL, &r, &f->e));
    assert_true(store_has(passing, &spec));
    assert_true(store_select(passing, "SELECT count(*) > 0 FROM v_speedup", 0, NULL, take_cell,
                             answer, &f->e));
    assert_string_equal(answer, "1");
    assert_true(store_select(
        passing, "SELECT (SELECT count(*) FROM rank_stage) + (SELECT count(*) FROM run_setting)", 0,
        NULL, take_cell, answer, &f->e));
    assert_string_equal(answer, "0");
    /* the next set of runs begins with none, also for a query that was asked before */
    for (int k = 0; k < 2; k++) {
        assert_true(store_clear(passing, &f->e));
        assert_false(store_has(passing, &spec));
        assert_true(store_select(passing, "SELECT count(*) > 0 FROM v_speedup", 0, NULL, take_cell,
                                 answer, &f->e));
        assert_string_equal(answer, "0");
        assert_true(store_put(passing, &spec, NULL, &r, &f->e));
    }
    store_close(passing);
    assert_int_equal(access("nowhere", F_OK), -1);
}

static void queries_keep_the_kinds_of_values_and_bind_parameters(void **state)
{
    struct store_fixture *f = *state;
    int seen[5] = {0};
    const char *param[] = {"x'; DROP TABLE run; --"};
    assert_true(store_query(
        f->s, "SELECT 1 AS a, 2.5 AS b, NULL AS c, ?1 AS d UNION ALL SELECT 2, 1.0, 3, 'y'", 1,
        param, count_kinds, count_kinds, seen, &f->e));
    assert_int_equal(seen[STORE_INT], 3);
    assert_int_equal(seen[STORE_REAL], 2);
    assert_int_equal(seen[STORE_NULL], 1);
    assert_int_equal(seen[STORE_TEXT], 2);
    assert_int_equal(seen[4], 1);
    assert_false(store_select(f->s, "SELECT nonsense FROM run", 0, NULL, take_cell, seen, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    assert_non_null(strstr(f->e.text, "nonsense"));
    err_clear(&f->e);
    assert_false(store_select(f->s, "SELECT ?1", 0, NULL, take_cell, seen, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_store, drop_store)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_run_comes_back_as_it_was_put),
        TEST(provenance_names_this_build),
        TEST(putting_a_run_again_replaces_it),
        TEST(only_a_good_run_need_not_run_again),
        TEST(a_sweep_can_be_pivoted_by_what_it_varies),
        TEST(speedup_efficiency_and_fraction_are_those_of_amdahl),
        TEST(stages_hold_sums_and_extremes_of_all_ranks),
        TEST(accounting_is_exact_and_a_lost_picosecond_is_seen),
        TEST(numbers_that_are_not_finite_are_null_and_fail),
        TEST(a_sum_beyond_64_bits_is_null_not_wrong),
        TEST(links_and_spans_are_kept_within_their_limits),
        TEST(every_view_answers_on_an_empty_database),
        TEST(generic_rows_replace_their_like_and_obey_the_schema),
        TEST(a_transaction_is_kept_or_forgotten_as_a_whole),
        TEST(a_run_that_fails_half_way_leaves_no_row),
        TEST(commits_go_to_the_log_without_waiting_for_the_disk),
        TEST(a_passing_store_leaves_no_file_and_keeps_what_claims_ask),
        TEST(queries_keep_the_kinds_of_values_and_bind_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
