/* test_upgrade.c - databases of older versions: upgraded whole or not at all, read without a
 * change, nothing lost. */
#include "config.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sqlite3.h>

#include "base/digest.h"
#include "base/random.h"
#include "base/text.h"
#include "../support/made_run.h"
#include "../support/scratch.h"
#include "database_file.h"
#include "spec/identity.h"
#include "store/store.h"

/* The first value of a query on the file as it is, without this program; in a buffer that the next
 * call overwrites. */
static const char *value(const char *path, const char *query)
{
    static char buffer[4096];
    sqlite3 *db;
    sqlite3_stmt *q;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_prepare_v2(db, query, -1, &q, NULL) != SQLITE_OK)
        fail_msg("%s: %s", query, sqlite3_errmsg(db));
    const bool row = sqlite3_step(q) == SQLITE_ROW;
    text_copy(buffer, sizeof buffer,
              row && sqlite3_column_text(q, 0) ? (const char *)sqlite3_column_text(q, 0) : "");
    sqlite3_finalize(q);
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
    return buffer;
}

static void is(const char *path, const char *query, const char *expected)
{
    const char *found = value(path, query);
    if (strcmp(found, expected) != 0) fail_msg("%s: '%s', expected '%s'", query, found, expected);
}

/* A database that the program of that version made. */
static void make_old(struct fixture *f, int version)
{
    struct text name = {0}, dump = {0};
    const char *source = getenv("srcdir");
    text_add(&name, "%s/tests/data/store/version-%d.sql", source ? source : ".", version);
    if (!text_read_file(&dump, name.s, &f->e)) fail_msg("%s", f->e.text);
    unlink(f->path);
    sql(f->path, dump.s);
    snprintf(f->kept, sizeof f->kept, "%s.v%d", f->path, version);
    unlink(f->kept);
    text_free(&name);
    text_free(&dump);
}

/* SHA-256 of a file's bytes. */
static void hash_file(const char *path, char hex[65])
{
    struct text bytes = {0};
    struct err e;
    err_clear(&e);
    if (!text_read_file(&bytes, path, &e)) fail_msg("%s", e.text);
    digest_sha256_hex(bytes.s, bytes.length, hex);
    text_free(&bytes);
}

static struct store *open_or_fail(struct fixture *f, enum store_mode mode)
{
    struct store *s = store_open(f->path, mode, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    return s;
}

/* All rows of a table, one text; columns that both versions have. */
static const char rows_of_runs[] =
    "SELECT group_concat(id || ' ' || seed || ' ' || rep || ' ' || level || ' ' || n || ' ' || P "
    "|| ' ' || makespan_ps || ' ' || digest || ' ' || residual || ' ' || ifnull(level_asked, '-') "
    "|| ' ' || created_utc, ';') FROM (SELECT * FROM run ORDER BY id)";
static const char count_of_rows[] =
    "SELECT (SELECT count(*) FROM stage) || ' ' || (SELECT sum(total_sum_ps) FROM stage) || ' ' || "
    "(SELECT count(*) FROM rank_stage) || ' ' || (SELECT count(*) FROM baseline) || ' ' || (SELECT "
    "count(*) FROM error_check) || ' ' || (SELECT count(*) FROM run_omission) || ' ' || (SELECT "
    "count(*) FROM run_setting) || ' ' || (SELECT count(*) FROM ladder) || ' ' || (SELECT count(*) "
    "FROM build)";

/* Every value with weights of its own, in the order of the rows. */
static const char sums_of_ranks[] =
    "SELECT group_concat(x, ';') FROM (SELECT run_id || ' ' || sum(rank * 3 + stage * 5) || ' ' || "
    "sum(rank * compute_ps) || ' ' || sum(rank * send_ps) || ' ' || sum(stage * recv_ps) || ' ' || "
    "sum(rank * wait_ps) || ' ' || sum(contention_ps) || ' ' || sum(rank * messages) || ' ' || "
    "sum(stage * sent_bytes) || ' ' || sum(rank * flops) AS x FROM rank_stage GROUP BY run_id "
    "ORDER BY run_id)";

static const char sums_of_links[] =
    "SELECT group_concat(x, ';') FROM (SELECT run_id || ' ' || count(*) || ' ' || sum(link * link) "
    "|| ' ' || sum(link * ifnull(from_router, 77)) || ' ' || sum(link * ifnull(to_router, 77)) || "
    "' ' || sum(link * ifnull(node, 77)) || ' ' || sum(link * messages) || ' ' || sum(link * "
    "sent_bytes) || ' ' || sum(link * busy_ps) || ' ' || sum(link * queue_ps) AS x FROM link_load "
    "GROUP BY run_id ORDER BY run_id)";

/* Ports and links of two runs, not in the order of their numbers. */
static const char some_links[] =
    "INSERT INTO link_load (run_id, link, from_router, to_router, node, messages, sent_bytes, "
    "busy_ps, queue_ps) VALUES (2, 2, 0, 1, NULL, 5, 40, 600, 0), (2, 0, NULL, 0, 0, 7, 56, 840, "
    "9223372036854775), (1, 9, 1, NULL, 1, 1, 8, 120, 3), (2, 1, NULL, 1, 1, 0, 0, 0, 0)";

static void nothing_is_lost(void **state)
{
    struct fixture *f = *state;
    for (int version = 4; version <= 5; version++) {
        char runs[4096], count[4096];
        make_old(f, version);
        sql(f->path, some_links);
        snprintf(runs, sizeof runs, "%s", value(f->path, rows_of_runs));
        snprintf(count, sizeof count, "%s", value(f->path, count_of_rows));
        struct store *s = open_or_fail(f, STORE_WRITE);
        assert_non_null(store_remark(s));
        assert_non_null(strstr(store_remark(s), f->kept));
        store_close(s);
        is(f->path, "PRAGMA user_version", "10");
        is(f->path, rows_of_runs, runs);
        is(f->path, count_of_rows, count);
        /* Rows of ranks, now entries of one text a run, keep every value. */
        char ranks[4096];
        snprintf(ranks, sizeof ranks, "%s", value(f->kept, sums_of_ranks));
        is(f->path, sums_of_ranks, ranks);
        char links[4096];
        snprintf(links, sizeof links, "%s", value(f->kept, sums_of_links));
        is(f->path, sums_of_links, links);
        is(f->path, "SELECT entries FROM link_loads WHERE run_id = 1", "[[9,1,null,1,1,8,120,3]]");
        is(f->path, "SELECT group_concat(type) FROM sqlite_schema WHERE name IN ('rank_stage', "
                    "'link_load')", "view,view");
        is(f->path, "PRAGMA integrity_check", "ok");
        is(f->path, "SELECT count(*) FROM pragma_foreign_key_check", "0");
        is(f->path, "SELECT count(*) FROM sqlite_schema WHERE name LIKE 'older%'", "0");
        is(f->path, "SELECT count(*) FROM run_older", "0");
        is(f->path, "SELECT count(*) FROM run WHERE label <> machine OR length(machine_key) <> 16",
           "0");
        is(f->path,
           "SELECT number || unit FROM setting WHERE key = 'machine.network.hop_latency' AND value "
           "= '60 ns'",
           "6.0e-08s");
        is(f->path, "SELECT value FROM meta WHERE key = 'rank_rows_limit'", "256");
        is(f->path, "SELECT group_concat(DISTINCT state) FROM v_machine_state",
           version < 5 ? "older" : "as shipped");
        /* The old one beside is what it was. */
        is(f->kept, "PRAGMA user_version", version == 4 ? "4" : "5");
        is(f->kept, rows_of_runs, runs);
        is(f->kept, count_of_rows, count);
        /* Once is enough. */
        s = open_or_fail(f, STORE_WRITE);
        assert_null(store_remark(s));
        store_close(s);
    }
}

/* Tables, columns, keys and views are those of a new database. */
static void the_schema_is_that_of_a_new_database(void **state)
{
    struct fixture *f = *state;
    static const char schema[] =
        "SELECT count(*) || group_concat(type || name || replace(sql, '\n', ' '), '|') FROM"
        " (SELECT * FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY type, name)";
    char path[256], hash[2][65];
    scratch_path(path, sizeof path, f->folder, "new.db");
    store_close(store_open(path, STORE_WRITE, &f->e));
    make_old(f, 4);
    store_close(open_or_fail(f, STORE_WRITE));
    for (int i = 0; i < 2; i++) {
        sqlite3 *db;
        sqlite3_stmt *q;
        assert_int_equal(sqlite3_open(i ? path : f->path, &db), SQLITE_OK);
        assert_int_equal(sqlite3_prepare_v2(db, schema, -1, &q, NULL), SQLITE_OK);
        assert_int_equal(sqlite3_step(q), SQLITE_ROW);
        digest_sha256_hex(sqlite3_column_text(q, 0), (size_t)sqlite3_column_bytes(q, 0), hash[i]);
        sqlite3_finalize(q);
        sqlite3_close(db);
    }
    assert_string_equal(hash[0], hash[1]);
}

static void identities_are_those_that_runs_have_now(void **state)
{
    struct fixture *f = *state;
    struct arena *a = arena_create();
    char query[64], why[200];
    make_old(f, 4);
    store_close(open_or_fail(f, STORE_WRITE));
    for (int id = 1; id <= 6; id++) {
        struct run_spec spec;
        snprintf(query, sizeof query, "SELECT config_text FROM run WHERE id = %d", id);
        struct text config = {0};
        sqlite3 *db;
        sqlite3_stmt *q;
        assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
        assert_int_equal(sqlite3_prepare_v2(db, query, -1, &q, NULL), SQLITE_OK);
        assert_int_equal(sqlite3_step(q), SQLITE_ROW);
        text_add(&config, "%s", (const char *)sqlite3_column_text(q, 0));
        sqlite3_finalize(q);
        sqlite3_close(db);
        if (!run_from_text(&spec, config.s, a, why, sizeof why)) fail_msg("%s", why);
        text_free(&config);
        run_identify(&spec, a);
        snprintf(query, sizeof query, "SELECT config_hash FROM run WHERE id = %d", id);
        is(f->path, query, spec.config_hash);
        /* Run 5 asked for level auto-tolerance and took loggp. */
        assert_int_equal(spec.machine.network.level,
                         id == 1 || id == 2 || id == 6 ? LEVEL_LINK : LEVEL_LOGGP);
        struct store *s = open_or_fail(f, STORE_READ);
        assert_int_equal(store_run_id(s, &spec), id);
        assert_true(store_has(s, &spec));
        store_close(s);
    }
    is(f->path, "SELECT value FROM v_setting WHERE run_id = 5 AND key = 'machine.network.level'",
       "loggp");
    is(f->path, "SELECT count(*) - count(DISTINCT key) FROM v_setting WHERE run_id = 5", "0");
    arena_destroy(a);
}

static void runs_that_nobody_can_describe_any_more_are_kept_and_marked(void **state)
{
    struct fixture *f = *state;
    make_old(f, 4);
    char hash[65], same[65];
    sql(f->path, "UPDATE run SET config_text = config_text || 'kernel.colour = red' || char(10) "
                 "WHERE id = 2;UPDATE run SET config_text = replace(config_text, 'seed = 1', 'seed "
                 "= none') WHERE id = 3;UPDATE run SET config_text = (SELECT config_text FROM run "
                 "WHERE id = 1) WHERE id = 4");
    snprintf(hash, sizeof hash, "%s", value(f->path, "SELECT config_hash FROM run WHERE id = 2"));
    snprintf(same, sizeof same, "%s", value(f->path, "SELECT config_hash FROM run WHERE id = 4"));
    struct store *s = open_or_fail(f, STORE_WRITE);
    assert_non_null(strstr(store_remark(s), "3 runs cannot be described by this program any more"));
    store_close(s);
    is(f->path, "SELECT count(*) FROM run", "6");
    is(f->path, "SELECT config_hash FROM run WHERE id = 2", hash);
    is(f->path, "SELECT config_hash FROM run WHERE id = 4", same);
    is(f->path, "SELECT group_concat(run_id || ' ' || version, ',') FROM run_older", "2 4,3 4,4 4");
    is(f->path, "SELECT reason FROM run_older WHERE run_id = 2",
       "there is no setting 'kernel.colour' any more");
    is(f->path, "SELECT reason LIKE 'seed = none: not a seed%' FROM run_older WHERE run_id = 3",
       "1");
    is(f->path, "SELECT reason FROM run_older WHERE run_id = 4",
       "another stored run has the same settings");
}

static void reading_changes_nothing(void **state)
{
    struct fixture *f = *state;
    char before[65], after[65];
    make_old(f, 4);
    hash_file(f->path, before);
    struct store *s = open_or_fail(f, STORE_READ);
    assert_non_null(strstr(store_remark(s), "is of version 4: read through an upgraded copy"));
    store_close(s);
    hash_file(f->path, after);
    assert_string_equal(before, after);
    assert_int_not_equal(access(f->kept, F_OK), 0);
}

static void a_users_own_tables_and_views_stay(void **state)
{
    struct fixture *f = *state;
    make_old(f, 4);
    sql(f->path, "CREATE TABLE mine (x); INSERT INTO mine VALUES (7);"
                 "CREATE VIEW my_runs AS SELECT id + (SELECT x FROM mine) AS y FROM run ORDER BY "
                 "id");
    store_close(open_or_fail(f, STORE_WRITE));
    is(f->path, "SELECT y FROM my_runs", "8");
}

static void old_databases_never_take_each_others_place(void **state)
{
    struct fixture *f = *state;
    char second[280];
    make_old(f, 4);
    sql(f->kept, "CREATE TABLE precious (x)");
    snprintf(second, sizeof second, "%s.1", f->kept);
    struct store *s = open_or_fail(f, STORE_WRITE);
    assert_non_null(strstr(store_remark(s), second));
    store_close(s);
    is(f->kept, "SELECT name FROM sqlite_schema", "precious");
    is(second, "SELECT count(*) FROM run", "6");
}

static void what_cannot_be_upgraded_stays_as_it_was(void **state)
{
    struct fixture *f = *state;
    char before[65], after[65];
    make_old(f, 4);
    sql(f->path,
        "PRAGMA ignore_check_constraints = ON; UPDATE run SET status = 'lost' WHERE id = 3");
    snprintf(before, sizeof before, "%s",
             value(f->path, "SELECT count(*) || status FROM run WHERE id = 3"));
    assert_null(store_open(f->path, STORE_WRITE, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    snprintf(after, sizeof after, "%s",
             value(f->path, "SELECT count(*) || status FROM run WHERE id = 3"));
    assert_string_equal(before, after);
    is(f->path, "PRAGMA user_version", "4");
    assert_int_not_equal(access(f->kept, F_OK), 0);
    /* Another program writes: it is busy, and stays as it is, too. */
    make_old(f, 4);
    sqlite3 *db;
    assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
    assert_int_equal(
        sqlite3_exec(db, "PRAGMA journal_mode = WAL; BEGIN IMMEDIATE", NULL, NULL, NULL),
        SQLITE_OK);
    err_clear(&f->e);
    assert_null(store_open(f->path, STORE_WRITE, &f->e));
    assert_int_equal(f->e.kind, ERR_BUSY);
    sqlite3_close(db);
    is(f->path, "PRAGMA user_version", "4");
}

static void versions_before_the_oldest_are_refused_with_a_way_out(void **state)
{
    struct fixture *f = *state;
    make_old(f, 4);
    sql(f->path, "PRAGMA user_version = 3");
    assert_null(store_open(f->path, STORE_READ, &f->e));
    assert_non_null(strstr(
        f->e.text,
        "has schema version 3, this program knows versions 4 to 10; run its scenarios again"));
}

#ifdef SANITIZERS /* slow: a child begins by copying their memory */
enum { KILLS = 24 };
#else
enum { KILLS = 60 };
#endif

/* Upgrade in a child that is killed after `delay` seconds; whether it had ended before. */
static bool upgrade_and_kill(struct fixture *f, double delay)
{
    int status;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        struct err e = {0};
        store_close(store_open(f->path, STORE_WRITE, &e));
        _exit(0);
    }
    usleep((useconds_t)(1e6 * delay));
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status);
}

static void kill_9_leaves_the_old_database_or_the_new_one(void **state)
{
    struct fixture *f = *state;
    struct random random = random_make(17, 0, 0);
    char runs[4096], count[4096];
    int old = 0, new = 0, whole = 0;
    make_old(f, 4);
    snprintf(runs, sizeof runs, "%s", value(f->path, rows_of_runs));
    snprintf(count, sizeof count, "%s", value(f->path, count_of_rows));
    double once = 0.05; /* follows how long an upgrade takes here */
    /* Where others take the processor, moments are found more slowly. */
    const int enough = KILLS / 6;
    for (int i = 0; i < KILLS || (i < 10 * KILLS && (old <= enough || new <= enough)); i++) {
        make_old(f, 4);
        whole += upgrade_and_kill(f, random_uniform(&random, 0, once));
        const bool upgraded = strcmp(value(f->path, "PRAGMA user_version"), "10") == 0;
        upgraded ? new ++ : old++;
        if (!upgraded) is(f->path, "PRAGMA user_version", "4");
        is(f->path, "PRAGMA integrity_check", "ok");
        is(f->path, rows_of_runs, runs);
        is(f->path, count_of_rows, count);
        is(f->path, "SELECT count(*) FROM sqlite_schema WHERE name LIKE 'older%'", "0");
        /* The old one beside is whole or not there. */
        if (access(f->kept, F_OK) == 0) is(f->kept, rows_of_runs, runs);
        else assert_false(upgraded);
        if (old > new + 4) once *= 1.2;
        if (new > old + 4) once *= 0.9;
        /* The next one who comes finishes it. */
        if (i % 8) continue;
        store_close(open_or_fail(f, STORE_WRITE));
        is(f->path, "PRAGMA user_version", "10");
        is(f->path, rows_of_runs, runs);
    }
    print_message("%d old, %d new, %d not killed\n", old, new, whole);
    assert_true(old > enough && new > enough);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest test[] = {
        TEST(nothing_is_lost),
        TEST(the_schema_is_that_of_a_new_database),
        TEST(identities_are_those_that_runs_have_now),
        TEST(runs_that_nobody_can_describe_any_more_are_kept_and_marked),
        TEST(reading_changes_nothing),
        TEST(a_users_own_tables_and_views_stay),
        TEST(old_databases_never_take_each_others_place),
        TEST(what_cannot_be_upgraded_stays_as_it_was),
        TEST(versions_before_the_oldest_are_refused_with_a_way_out),
        TEST(kill_9_leaves_the_old_database_or_the_new_one),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
