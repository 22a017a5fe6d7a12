/* test_views.c - what is shown of a database without changing it: settings as columns, passing
 * copies, tables that live as long as their connection. */
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
#include "database_file.h"
#include "base/digest.h"
#include "base/random.h"
#include "base/text.h"
#include "store/swept.h"
#include "store/temporary.h"

enum { RUNS = 12 };

/* A database with RUNS runs on machines that differ in two settings. */
struct shown {
    struct fixture *file;
    struct arena *a;
    struct store *s;
    struct run_spec spec[RUNS];
    struct err e;
};

static struct store *opened(struct shown *x, enum store_mode mode)
{
    struct store *s = store_open(x->file->path, mode, &x->e);
    if (s == NULL) fail_msg("%s", x->e.text);
    return s;
}

static void put(struct shown *x, struct run_spec *spec, enum run_status status)
{
    made_identity(spec, x->a);
    struct run_result r = made_result(x->a, spec);
    made_spans(&r, x->a);
    r.status = status;
    if (!store_put(x->s, spec, NULL, &r, &x->e)) fail_msg("%s", x->e.text);
}

static int begin(void **state)
{
    struct shown *x = calloc(1, sizeof *x);
    make_folder((void **)&x->file);
    x->a = arena_create();
    x->s = opened(x, STORE_WRITE);
    *state = x;
    return 0;
}

static int end(void **state)
{
    struct shown *x = *state;
    store_close(x->s);
    arena_destroy(x->a);
    remove_folder((void **)&x->file);
    free(x);
    return 0;
}

/* The runs, then the store open for reading. */
static void fill(struct shown *x)
{
    for (int i = 0; i < RUNS; i++) {
        x->spec[i] = made_spec(x->a, "t3e-300", 8, 4, i);
        put(x, &x->spec[i], RUN_OK);
    }
    store_close(x->s);
    x->s = opened(x, STORE_READ);
}

static bool take_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct text *t = context;
    (void)name;
    if (t->length > 0) text_add(t, ";");
    for (int i = 0; i < ncolumn; i++)
        text_add(t, "%s%s", i > 0 ? " " : "", value[i] ? value[i] : "NULL");
    return true;
}

static const char *rows(struct shown *x, struct store *s, const char *query)
{
    struct text t = {0};
    if (!store_select(s, query, 0, NULL, take_row, &t, &x->e)) fail_msg("%s: %s", query, x->e.text);
    char *copy = arena_take(x->a, (int64_t)t.length + 1);
    memcpy(copy, t.s != NULL ? t.s : "", t.length + (t.s != NULL));
    text_free(&t);
    return copy;
}

static const char swept_columns[] =
    "SELECT group_concat(name) FROM (SELECT name FROM pragma_table_info('v_swept') WHERE name NOT "
    "IN ('run_id', 'name', 'scenario', 'machine', 'kernel', 'level', 'n', 'P', 'seed', "
    "'makespan_s') ORDER BY name)";

static void sweep(struct shown *x)
{
    if (!store_swept_view(x->s, &x->e)) fail_msg("%s", x->e.text);
}

/* Columns come as settings begin to differ; numbers are SI, words are words. */
static void what_differs_is_a_column(void **state)
{
    struct shown *x = *state;
    struct run_spec spec = made_spec(x->a, "t3e-300", 8, 4, 0);
    sweep(x);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'"),
                        "0");
    put(x, &spec, RUN_OK);
    spec.rep = 1;
    put(x, &spec, RUN_OK);
    sweep(x);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'"),
                        "0");
    /* n is a column of every run's; it needs no second one */
    spec.model.nbody = 16;
    put(x, &spec, RUN_OK);
    sweep(x);
    assert_string_equal(rows(x, x->s, swept_columns), "NULL");
    spec.machine.network.hop_latency = 2.5e-6;
    put(x, &spec, RUN_OK);
    sweep(x);
    assert_string_equal(rows(x, x->s, swept_columns), "hop_latency");
    spec.machine.network.link_bandwidth = 960e6;
    spec.kernel.precision = PRECISION_QUAD;
    put(x, &spec, RUN_OK);
    /* nothing changes before it is asked for, and asking twice changes nothing */
    assert_string_equal(rows(x, x->s, swept_columns), "hop_latency");
    for (int i = 0; i < 2; i++) {
        sweep(x);
        assert_string_equal(rows(x, x->s, swept_columns), "hop_latency,link_bandwidth,precision");
    }
    assert_string_equal(rows(x, x->s,
                             "SELECT n, hop_latency, link_bandwidth, precision FROM v_swept ORDER "
                             "BY run_id"),
                        "8 0.0 unlimited double;8 0.0 unlimited double;16 0.0 unlimited double;"
                        "16 2.5e-06 unlimited double;16 2.5e-06 960000000.0 quad");
    assert_string_equal(rows(x, x->s,
                             "SELECT count(*), count(DISTINCT run_id), count(precision) "
                             "FROM v_swept"),
                        "5 5 5");
}

/* Settings that nobody has a table of: of strangers, long, and more than there is room for. */
static void any_key_is_a_plain_name_or_no_column(void **state)
{
    enum { LONG = 95, MOST = 64 };
    struct shown *x = *state;
    struct text t = {0}, longest = {0};
    for (int i = 0; i < LONG; i++) text_add(&longest, "k");
    for (int v = 0; v < 2; v++)
        text_add(&t,
                 "INSERT INTO setting (key, value) VALUES ('program.a''b', '%d'), ('program.c\"d', "
                 "'%d'), ('x.y', '%d'), ('%s', '%d'), ('%sk', '%d'), ('label', '%d'), ('ranks', "
                 "'%d'), ('scenario', '%d'), ('n', '%d'), ('MAKESPAN_S', '%d');",
                 v, v, v, longest.s, v, longest.s, v, v, v, v, v, v);
    sql(x->file->path, t.s);
    sweep(x);
    /* beside the ten columns that are always there: x.y, and the key of 95 letters */
    assert_string_equal(rows(x, x->s,
                             "SELECT count(*), total(name = 'x_y'), total(length(name) = 95), "
                             "max(length(name)) FROM pragma_table_info('v_swept')"),
                        "12 1.0 1.0 95");
    text_free(&t);
    text_free(&longest);
    for (int i = 0; i < MOST + 6; i++)
        text_add(&t, "INSERT INTO setting (key, value) VALUES ('q%d', 'a'), ('q%d', 'b');", i, i);
    sql(x->file->path, t.s);
    sweep(x);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM pragma_table_info('v_swept')"), "74");
    text_free(&t);
}

/* Keys that differ in a sign or in capitals alone: no column has the name of another, or the value
 * of another. */
static void keys_of_one_plain_name_are_columns_of_their_own(void **state)
{
    enum { LONG = 95 };
    struct shown *x = *state;
    struct run_spec spec = made_spec(x->a, "t3e-300", 8, 4, 0);
    put(x, &spec, RUN_OK);
    static const char *const key[] = {"X_Y", "x-y", "x.y", "x_y", "x_y_2"};
    struct text t = {0};
    for (int i = 0; i < 5; i++)
        text_add(&t,
                 "INSERT INTO setting (id, key, value) VALUES (%d, '%s', 'v%d'), (%d, '%s', 'w');"
                 "INSERT INTO run_setting (run_id, setting_id) VALUES (1, %d);",
                 9000 + i, key[i], i, 9100 + i, key[i], 9000 + i);
    sql(x->file->path, t.s);
    sweep(x);
    assert_string_equal(rows(x, x->s, swept_columns), "X_Y,x_y_2,x_y_2_2,x_y_3,x_y_4");
    /* in the order of keys, capitals first: each column has the value of its own key */
    assert_string_equal(
        rows(x, x->s, "SELECT X_Y, x_y_2, x_y_3, x_y_4, x_y_2_2 FROM v_swept"), "v0 v1 v2 v3 v4");
    /* as long as a key may be, where a number has no room behind it */
    text_free(&t);
    for (int i = 0; i < 12; i++) {
        char longest[LONG + 1];
        memset(longest, 'k', LONG);
        for (int bit = 0; bit < 4; bit++)
            if (i >> bit & 1) longest[LONG - 1 - bit] = 'K';
        longest[LONG] = '\0';
        text_add(&t, "INSERT INTO setting (key, value) VALUES ('%s', 'a'), ('%s', 'b');", longest,
                 longest);
    }
    sql(x->file->path, t.s);
    sweep(x);
    assert_string_equal(rows(x, x->s,
                             "SELECT count(*), count(DISTINCT lower(name)), total(name LIKE '%:%'),"
                             " max(length(name)) FROM pragma_table_info('v_swept')"),
                        "27 27 0.0 95");
    text_free(&t);
}

/* It is written when something has changed, and goes when nothing differs any more. */
static void the_view_is_written_when_it_changes(void **state)
{
    static const char version[] = "SELECT schema_version FROM pragma_schema_version";
    struct shown *x = *state;
    sql(x->file->path, "INSERT INTO setting (key, value) VALUES ('a', '1'), ('a', '2')");
    sweep(x);
    const char *before = rows(x, x->s, version);
    sweep(x);
    assert_string_equal(rows(x, x->s, version), before);
    sql(x->file->path, "INSERT INTO setting (key, value) VALUES ('b', '1'), ('b', '2')");
    sweep(x);
    assert_string_equal(rows(x, x->s, swept_columns), "a,b");
    sql(x->file->path, "DELETE FROM setting WHERE value = '2'");
    sweep(x);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'"),
                        "0");
}

/* The time of a run and its name as table run has them. */
static void a_row_is_its_run(void **state)
{
    struct shown *x = *state;
    struct run_spec spec = made_spec(x->a, "t3e-300", 8, 4, 0);
    for (int i = 0; i < 4; i++) {
        spec.rep = i;
        spec.machine.network.hop_latency = i * 1e-7;
        put(x, &spec, i == 3 ? RUN_FAILED : RUN_OK);
    }
    sweep(x);
    assert_string_equal(
        rows(x, x->s,
             "SELECT count(*), total(abs(v.makespan_s - r.makespan_ps * 1e-12) < 1e-15), "
             "total(v.name = l.name AND v.P = 4 AND v.level = 'link'), "
             "group_concat(hop_latency, '|') FROM v_swept v JOIN run r ON r.id = v.run_id "
             "JOIN v_label l ON l.run_id = r.id"),
        "3 3.0 3.0 0.0|1.0e-07|2.0e-07");
}

static void a_view_of_a_user_keeps_its_name(void **state)
{
    struct shown *x = *state;
    struct run_spec spec = made_spec(x->a, "t3e-300", 8, 4, 0);
    sql(x->file->path, "CREATE VIEW v_swept AS SELECT 'mine' AS whose");
    for (int i = 0; i < 2; i++) {
        spec.machine.network.hop_latency = 1e-6 * (i + 1);
        put(x, &spec, RUN_OK);
    }
    sweep(x);
    assert_string_equal(rows(x, x->s, "SELECT whose FROM v_swept"), "mine");
}

/* A run is called anew; others, and one that is not there, are left alone. */
static void a_stored_run_is_called_otherwise(void **state)
{
    struct shown *x = *state;
    struct run_spec spec[3];
    for (int i = 0; i < 2; i++) {
        spec[i] = made_spec(x->a, "t3e-300", 8, 4, i);
        put(x, &spec[i], RUN_OK);
    }
    spec[2] = made_spec(x->a, "t3e-300", 8, 4, 2);
    static const char names[] = "SELECT group_concat(label, '|') FROM (SELECT label FROM run ORDER "
                                "BY rep)";
    const char *before = rows(x, x->s, "SELECT label FROM run WHERE rep = 0");
    text_copy(spec[1].label, sizeof spec[1].label, "the 'new' one");
    text_copy(spec[2].label, sizeof spec[2].label, "absent");
    for (int i = 1; i < 3; i++)
        if (!store_call(x->s, &spec[i], &x->e)) fail_msg("%s", x->e.text);
    char wanted[200];
    snprintf(wanted, sizeof wanted, "%s|the 'new' one", before);
    assert_string_equal(rows(x, x->s, names), wanted);
    /* what the plan calls it goes before its own name */
    spec[1].called = "planned";
    assert_true(store_call(x->s, &spec[1], &x->e));
    assert_non_null(strstr(rows(x, x->s, names), "|planned"));
}

/* ---- passing copies ---- */

static void file_hash(const char *path, char hex[65])
{
    struct text bytes = {0};
    struct err e = {0};
    assert_true(text_read_file(&bytes, path, &e));
    digest_sha256_hex(bytes.s, bytes.length, hex);
    text_free(&bytes);
}

/* How many runs each table tells of. */
static const char parts[] =
    "SELECT (SELECT count(*) FROM run), (SELECT count(DISTINCT run_id) FROM stage), (SELECT "
    "count(DISTINCT run_id) FROM run_setting), (SELECT count(DISTINCT run_id) FROM rank_stage), "
    "(SELECT count(DISTINCT run_id) FROM span), (SELECT count(DISTINCT run_id) FROM baseline), "
    "(SELECT count(DISTINCT run_id) FROM error_check), (SELECT count(*) FROM v_run)";

static void a_copy_holds_the_chosen_runs_alone(void **state)
{
    struct shown *x = *state;
    struct random r = random_make(3, 0, 0);
    fill(x);
    for (int round = 0; round < 8; round++) {
        char before[65], after[65];
        bool in[RUNS] = {false};
        int n = 0;
        struct text ids = {0}, list = {0};
        /* round 0: none; 1: all; numbers of no run, in any order, change nothing */
        text_add(&ids, "[9999");
        for (int i = RUNS - 1; i >= 0; i--)
            if ((in[i] = round == 1 || (round > 1 && random_below(&r, 3) == 0)))
                text_add(&ids, ",%d", i + 1), n++;
        text_add(&ids, "]");
        for (int i = 0; i < RUNS; i++)
            if (in[i]) text_add(&list, "%s%d", list.length > 0 ? ";" : "", i);
        file_hash(x->file->path, before);
        /* asked before and after: what is remembered of the file must not answer for the copy */
        for (int i = 0; i < RUNS; i++) assert_int_equal(store_run_id(x->s, &x->spec[i]), i + 1);
        if (!store_only(x->s, ids.s, &x->e)) fail_msg("%s", x->e.text);
        for (int i = 0; i < RUNS; i++) {
            assert_int_equal(store_run_id(x->s, &x->spec[i]), in[i] ? i + 1 : 0);
            assert_int_equal(store_has(x->s, &x->spec[i]), in[i]);
        }
        assert_string_equal(rows(x, x->s, "SELECT rep FROM run ORDER BY rep"), n ? list.s : "");
        char wanted[100];
        snprintf(wanted, sizeof wanted, "%d %d %d %d %d %d %d %d", n, n, n, n, n, n, n, n);
        assert_string_equal(rows(x, x->s, parts), wanted);
        /* the copy is not written to, either */
        assert_false(store_select(x->s, "DELETE FROM run", 0, NULL, take_row, &ids, &x->e));
        assert_int_equal(x->e.kind, ERR_IO);
        err_clear(&x->e);
        store_close(x->s);
        file_hash(x->file->path, after);
        assert_string_equal(after, before);
        x->s = opened(x, STORE_READ);
        assert_string_equal(rows(x, x->s, "SELECT count(*) FROM run"), "12");
        text_free(&ids);
        text_free(&list);
    }
}

static void a_list_that_is_none_is_refused(void **state)
{
    struct shown *x = *state;
    fill(x);
    assert_false(store_only(x->s, "1, 2", &x->e));
    assert_int_not_equal(x->e.kind, ERR_NONE);
    /* what is left of the store can be closed, and the file is whole */
    store_close(x->s);
    err_clear(&x->e);
    x->s = opened(x, STORE_READ);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM run"), "12");
}

/* ---- temporary tables ---- */

static void a_table_lives_as_long_as_its_connection(void **state)
{
    static const char *const columns = "a INTEGER, b REAL, c TEXT, d TEXT";
    struct shown *x = *state;
    char before[65], after[65];
    fill(x);
    file_hash(x->file->path, before);
    for (int round = 0; round < 2; round++) {
        /* the second time it is made anew: empty, with other columns */
        if (!store_temporary(x->s, "order", columns, &x->e)) fail_msg("%s", x->e.text);
        assert_string_equal(rows(x, x->s, "SELECT count(*) FROM temp.\"order\""), "0");
        const struct store_value v[][4] = {
            {store_int(INT64_MIN), store_real(-0.1), store_text("it's \"so\""), store_null()},
            {store_int(INT64_MAX), store_real(NAN), store_text(""), store_text(NULL)}};
        for (int i = 0; i < 2; i++)
            if (!store_temporary_row(x->s, "order", 4, v[i], &x->e)) fail_msg("%s", x->e.text);
        assert_string_equal(
            rows(x, x->s, "SELECT a, b, quote(c), quote(d) FROM temp.\"order\" ORDER BY a"),
            "-9223372036854775808 -0.1 'it''s \"so\"' NULL;9223372036854775807 NULL '' NULL");
    }
    /* one value too few or too many is no row; what was there stays */
    const struct store_value v[5] = {store_int(1), store_int(2), store_int(3), store_int(4),
                                     store_int(5)};
    for (int n = 3; n <= 5; n += 2) {
        assert_false(store_temporary_row(x->s, "order", n, v, &x->e));
        assert_int_not_equal(x->e.kind, ERR_NONE);
        err_clear(&x->e);
    }
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM temp.\"order\""), "2");
    assert_false(store_temporary(x->s, "wrong", "a INTEGER,", &x->e));
    err_clear(&x->e);
    assert_string_equal(rows(x, x->s, "SELECT query_only FROM pragma_query_only"), "1");
    /* and everything but these tables is still only read */
    struct text ignored = {0};
    assert_false(store_select(x->s, "DELETE FROM run", 0, NULL, take_row, &ignored, &x->e));
    assert_int_equal(x->e.kind, ERR_IO);
    err_clear(&x->e);
    text_free(&ignored);
    store_close(x->s);
    file_hash(x->file->path, after);
    assert_string_equal(after, before);
    x->s = opened(x, STORE_READ);
    assert_string_equal(rows(x, x->s, "SELECT count(*) FROM sqlite_schema WHERE name = 'order'"),
                        "0");
}

/* As many values as there is room for. */
static void the_widest_row_arrives_whole(void **state)
{
    enum { MOST = 32 };
    struct shown *x = *state;
    struct text columns = {0}, sum = {0};
    struct store_value v[MOST];
    for (int i = 0; i < MOST; i++) {
        text_add(&columns, "%sc%d INTEGER", i > 0 ? ", " : "", i);
        text_add(&sum, "%s%d * c%d", i > 0 ? " + " : "SELECT ", i + 1, i);
        v[i] = store_int(100 - i);
    }
    text_add(&sum, " FROM temp.wide");
    int64_t wanted = 0;
    for (int i = 0; i < MOST; i++) wanted += (i + 1) * (100 - i);
    /* in a store that is written to as well */
    assert_true(store_temporary(x->s, "wide", columns.s, &x->e));
    assert_true(store_temporary_row(x->s, "wide", MOST, v, &x->e));
    assert_int_equal(strtol(rows(x, x->s, sum.s), NULL, 10), wanted);
    text_free(&columns);
    text_free(&sum);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_differs_is_a_column),
        TEST(any_key_is_a_plain_name_or_no_column),
        TEST(keys_of_one_plain_name_are_columns_of_their_own),
        TEST(the_view_is_written_when_it_changes),
        TEST(a_row_is_its_run),
        TEST(a_view_of_a_user_keeps_its_name),
        TEST(a_stored_run_is_called_otherwise),
        TEST(a_copy_holds_the_chosen_runs_alone),
        TEST(a_list_that_is_none_is_refused),
        TEST(a_table_lives_as_long_as_its_connection),
        TEST(the_widest_row_arrives_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
