/* test_guard.c - databases of strangers: schemas that are not ours, rows that break the rules of
 * their table, sums that leave 64 bits, locks that others hold. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>
#include <sqlite3.h>

#include "../support/made_run.h"
#include "../support/folder_fixture.h"
#include "store/store.h"

static int make_fixture(void **state)
{
    struct folder_fixture *f = folder_of(sizeof *f, "t.db");
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 0);
    struct run_result r = made_result(f->a, &spec);
    assert_true(store_put(s, &spec, NULL, &r, &f->e));
    store_close(s);
    *state = f;
    return 0;
}

/* What somebody else does to the file, without any of our rules. */
static void do_to(struct folder_fixture *f, const char *sql)
{
    sqlite3 *db;
    char *why = NULL;
    assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
    sqlite3_exec(db, "PRAGMA ignore_check_constraints = ON; PRAGMA writable_schema = ON", NULL,
                 NULL, NULL);
    if (sqlite3_exec(db, sql, NULL, NULL, &why) != SQLITE_OK) fail_msg("%s: %s", sql, why);
    sqlite3_close(db);
}

/* Both ways of opening refuse it with a text that says `what`. */
static void refused(struct folder_fixture *f, const char *sql, bool reader_only, const char *what)
{
    do_to(f, sql);
    for (int mode = 0; mode < (reader_only ? 1 : 2); mode++) {
        err_clear(&f->e);
        struct store *s = store_open(f->path, mode == 0 ? STORE_READ : STORE_WRITE, &f->e);
        if (s != NULL) fail_msg("%s: opened", sql);
        if (f->e.kind != ERR_DATA || !strstr(f->e.text, what)) fail_msg("%s: %s", sql, f->e.text);
    }
}

static void a_view_of_ours_that_says_something_else_is_refused(void **state)
{
    refused(*state, "DROP VIEW v_speedup; CREATE VIEW v_speedup AS SELECT 1 AS run_id", false,
            "view 'v_speedup' is not the one that mimdsim makes");
}

static void a_view_in_the_place_of_a_table_is_refused(void **state)
{
    refused(*state,
            "DROP TABLE span; CREATE VIEW span AS SELECT 1 AS run_id, random() AS span, random() "
            "AS rank, random() AS stage, 'compute' AS kind, random() AS begin_ps, random() AS "
            "end_ps, 0 AS peer, 0 AS bytes, 0 AS message",
            false, "view 'span' is not the one that mimdsim makes");
}

static void a_table_of_ours_with_other_rules_is_refused(void **state)
{
    refused(*state, "DROP TABLE error_check; CREATE TABLE error_check (run_id, ordinal, passed)",
            false, "table 'error_check' is not the one that mimdsim makes");
}

static void a_trigger_is_refused(void **state)
{
    refused(*state, "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM run; END", false,
            "a trigger 't'");
}

/* Only blanks and comments may differ: what a later version of this program says of a column. */
static void comments_and_blanks_of_a_schema_are_free(void **state)
{
    struct folder_fixture *f = *state;
    do_to(f,
          "UPDATE sqlite_schema SET sql = replace(sql, '-- ', '--  say: ') WHERE sql LIKE '%-- %'");
    struct store *s = store_open(f->path, STORE_READ, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    store_close(s);
}

static void a_users_own_tables_indices_and_views_are_let_be(void **state)
{
    struct folder_fixture *f = *state;
    do_to(f, "CREATE TABLE mine (x); CREATE VIEW my_runs AS SELECT n FROM run; CREATE INDEX own ON "
             "run (n)");
    for (int mode = 0; mode < 2; mode++) {
        struct store *s = store_open(f->path, mode == 0 ? STORE_READ : STORE_WRITE, &f->e);
        if (s == NULL) fail_msg("%s", f->e.text);
        store_close(s);
    }
}

static void rows_that_break_their_rules_are_refused_by_table_and_column(void **state)
{
    struct folder_fixture *f = *state;
    refused(f, "UPDATE run SET status = 'gone'", true, "CHECK constraint failed in run");
    do_to(f, "UPDATE run SET status = 'ok'");
    /* the column may be NULL for one statement */
    do_to(f, "UPDATE sqlite_schema SET sql = replace(sql, 'kind TEXT NOT NULL', 'kind TEXT') WHERE "
             "name = 'span'");
    refused(f,
            "UPDATE sqlite_schema SET sql = replace(sql, 'verdict        TEXT NOT NULL', 'verdict "
            "TEXT') WHERE name = 'check_point'",
            false, "is not the one that mimdsim makes");
}

static bool take_text(void *context, int n, const char *const *name, const char *const *value)
{
    (void)name;
    text_add(context, "%s", n > 0 && value[0] ? value[0] : "NULL");
    return true;
}

static void asked(struct store *s, const char *sql, const char *answer)
{
    struct text t = {0};
    struct err e = {0};
    if (!store_select(s, sql, 0, NULL, take_text, &t, &e)) fail_msg("%s: %s", sql, e.text);
    if (strcmp(t.s ? t.s : "", answer) != 0) fail_msg("%s: %s", sql, t.s);
    text_free(&t);
}

static void sums_go_on_beyond_64_bits(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = store_open(f->path, STORE_READ, &f->e);
    asked(s,
          "WITH t(x) AS (VALUES (9223372036854775807), (9223372036854775807), (1)) SELECT sum(x) "
          "FROM t",
          "1.84467440737096e+19");
    asked(s, "WITH t(x) AS (VALUES (9223372036854775807), (1), (-1)) SELECT sum(x) FROM t",
          "9223372036854775807");
    asked(s, "SELECT sum(x) FROM (SELECT 1 AS x WHERE 0)", "NULL");
    asked(s, "WITH t(x) AS (VALUES (1), (NULL), (2.5), ('3')) SELECT sum(x) FROM t", "6.5");
    asked(s,
          "WITH t(x) AS (VALUES (1), (2), (3)) SELECT group_concat(y) FROM (SELECT sum(x) OVER "
          "(ORDER BY x ROWS 1 PRECEDING) AS y FROM t)",
          "1,3,5");
    store_close(s);
    /* 4096 ranks for 51 minutes: the view tells it exactly */
    do_to(f, "UPDATE run SET P = 4096, makespan_ps = 3057537485410955; DELETE FROM stage WHERE "
             "stage > 0;UPDATE stage SET compute_sum_ps = 9000000000000000000, total_sum_ps = "
             "9000000000000000000, send_sum_ps = 3523673540243271681, recv_sum_ps = 0, wait_sum_ps "
             "= 0, contention_sum_ps = 0");
    s = store_open(f->path, STORE_READ, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    asked(s, "SELECT difference_ps FROM v_accounting", "1");
    asked(s, "SELECT compute_share BETWEEN 0.718 AND 0.719 FROM v_indicator", "1");
    store_close(s);
}

/* Somebody writes again and again, and holds the lock in between: who waits does not give up. */
static void a_lock_is_waited_for_as_long_as_its_holders_write(void **state)
{
    struct folder_fixture *f = *state;
    pid_t child = fork();
    if (child == 0) {
        sqlite3 *db;
        if (sqlite3_open(f->path, &db) != SQLITE_OK) _exit(1);
        sqlite3_busy_timeout(db, 10000);
        for (int i = 0; i < 5; i++) {
            sqlite3_exec(db, "BEGIN IMMEDIATE; INSERT INTO meta VALUES ('x' || random(), 'y')",
                         NULL, NULL, NULL);
            usleep(900000);
            /* the next one begins before anybody else wakes up */
            sqlite3_exec(db, "COMMIT", NULL, NULL, NULL);
        }
        _exit(0);
    }
    usleep(100000);
    struct run_spec spec = made_spec(f->a, "t3e-300", 4, 4, 1);
    struct run_result r = made_result(f->a, &spec);
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    if (s == NULL || !store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
    store_close(s);
    waitpid(child, NULL, 0);
}

static void a_lock_whose_holder_does_nothing_is_given_up(void **state)
{
    struct folder_fixture *f = *state;
    sqlite3 *db;
    assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_OK);
    const time_t begin = time(NULL);
    assert_null(store_open(f->path, STORE_WRITE, &f->e));
    assert_int_equal(f->e.kind, ERR_BUSY);
    assert_true(time(NULL) - begin < 10);
    sqlite3_close(db);
}

int main(void)
{
#define TEST(f) cmocka_unit_test_setup_teardown(f, make_fixture, drop_folder)
    const struct CMUnitTest tests[] = {
        TEST(a_view_of_ours_that_says_something_else_is_refused),
        TEST(a_view_in_the_place_of_a_table_is_refused),
        TEST(a_table_of_ours_with_other_rules_is_refused),
        TEST(a_trigger_is_refused),
        TEST(comments_and_blanks_of_a_schema_are_free),
        TEST(a_users_own_tables_indices_and_views_are_let_be),
        TEST(rows_that_break_their_rules_are_refused_by_table_and_column),
        TEST(sums_go_on_beyond_64_bits),
        TEST(a_lock_is_waited_for_as_long_as_its_holders_write),
        TEST(a_lock_whose_holder_does_nothing_is_given_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
