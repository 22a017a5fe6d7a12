/* test_merge.c - databases joined: a model of a few lines says what each merge must do, and what is
 * refused changes nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sqlite3.h>

#include "../support/made_run.h"
#include "../support/folder_fixture.h"
#include "base/random.h"
#include "base/text.h"
#include "store/merge.h"
#include "store/real_rows.h"

static struct store *opened(struct folder_fixture *f, const char *path)
{
    struct store *s = store_open(path, STORE_WRITE, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    return s;
}

/* Statements on a file behind the program's back. */
static void sql(const char *path, const char *text)
{
    sqlite3 *db;
    char *why = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, text, NULL, NULL, &why) != SQLITE_OK) fail_msg("%s: %s", text, why);
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

static bool take_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)name;
    for (int i = 0; i < ncolumn; i++) text_add(context, "%s ", value[i] ? value[i] : "NULL");
    text_add(context, "\n");
    return true;
}

/* All rows of a query, a line each; in the test's arena. */
static const char *rows(struct folder_fixture *f, struct store *s, const char *query)
{
    struct text t = {0};
    if (!store_select(s, query, 0, NULL, take_row, &t, &f->e)) fail_msg("%s", f->e.text);
    char *copy = arena_take(f->a, (int64_t)t.length + 1);
    memcpy(copy, t.s != NULL ? t.s : "", t.length + (t.s != NULL));
    text_free(&t);
    return copy;
}

static long number(struct folder_fixture *f, struct store *s, const char *query)
{
    return strtol(rows(f, s, query), NULL, 10);
}

/* A run by what identifies it; its makespan tells who made it. */
static void put(struct folder_fixture *f, struct store *s, int rep, enum run_status status,
                int maker)
{
    const struct run_spec spec =
        made_spec(f->a, rep % 3 ? "t3e-300" : "paragon", 4 + 4 * (rep % 2), 4, rep);
    struct run_result r = made_result(f->a, &spec);
    if (rep % 4 == 1) made_spans(&r, f->a);
    r.status = status;
    r.host_s = maker;
    r.baseline[0].time_ps += maker;
    /* only runs that ended well must have one digest everywhere */
    if (status != RUN_OK) r.digest += (uint64_t)maker, r.nbaseline = 2;
    if (!store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
}

/* Everything that belongs to the run of this repetition, without numbers of rows. */
static const char *run_rows(struct folder_fixture *f, struct store *s, int rep)
{
    struct text t = {0};
    text_add(&t,
             "SELECT r.config_hash, r.status, r.digest, r.host_s, r.makespan_ps, b.git, (SELECT "
             "group_concat(stage || ' ' || name || ' ' || total_sum_ps) FROM stage WHERE run_id = "
             "r.id), (SELECT group_concat(ordinal || ' ' || name || ' ' || time_ps) FROM baseline "
             "WHERE run_id = r.id), (SELECT group_concat(quantity || relative_error) FROM "
             "error_check WHERE run_id = r.id), (SELECT entries FROM rank_times WHERE run_id = "
             "r.id), (SELECT count(*) || ' ' || total(end_ps) FROM span WHERE run_id = r.id), "
             "(SELECT group_concat(x) FROM (SELECT key || '=' || value AS x FROM v_setting WHERE "
             "run_id = r.id ORDER BY key)) FROM run r JOIN build b ON b.id = r.build_id WHERE rep "
             "= %d",
             rep);
    const char *found = rows(f, s, t.s);
    text_free(&t);
    return found;
}

enum { REPS = 10, SOURCES = 4 };

/* What a database is to hold: of each repetition all rows as one text, "": none. */
struct model {
    const char *run[REPS];
    bool ok[REPS];
};

/* A database with some of the runs, made by a build of its own; its model. */
static struct model make_source(struct folder_fixture *f, const char *path, int maker,
                                struct random *r)
{
    static const enum run_status status[] = {RUN_OK, RUN_OK, RUN_INVALID, RUN_DEADLOCK, RUN_FAILED};
    struct model m = {0};
    struct store *s = opened(f, path);
    for (int rep = 0; rep < REPS; rep++) {
        m.run[rep] = "";
        if (random_below(r, 2)) continue;
        const enum run_status how = status[random_below(r, 5)];
        m.ok[rep] = how == RUN_OK;
        put(f, s, rep, how, maker);
    }
    store_close(s);
    char text[80];
    snprintf(text, sizeof text, "UPDATE build SET git = 'maker-%d'", maker);
    sql(path, text);
    s = opened(f, path);
    for (int rep = 0; rep < REPS; rep++) m.run[rep] = run_rows(f, s, rep);
    store_close(s);
    return m;
}

/* The model's merge; what it counts. */
static struct store_merged join(struct model *here, const struct model *there)
{
    struct store_merged done = {0};
    for (int rep = 0; rep < REPS; rep++) {
        if (*there->run[rep] == '\0') continue;
        const bool absent = *here->run[rep] == '\0',
                   better = !absent && !here->ok[rep] && there->ok[rep];
        done.added += absent, done.replaced += better, done.present += !absent && !better;
        if (!absent && !better) continue;
        here->run[rep] = there->run[rep], here->ok[rep] = there->ok[rep];
    }
    return done;
}

static void assert_counts(const struct store_merged *is, const struct store_merged *wanted)
{
    assert_int_equal(is->added, wanted->added);
    assert_int_equal(is->replaced, wanted->replaced);
    assert_int_equal(is->present, wanted->present);
    assert_int_equal(is->studies, wanted->studies);
}

static void any_merges_do_what_the_model_does(void **state)
{
    struct folder_fixture *f = *state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct random r = random_make(seed, 11, 0);
        char path[SOURCES][256];
        struct model source[SOURCES];
        for (int k = 0; k < SOURCES; k++) {
            char name[32];
            snprintf(name, sizeof name, "%d-%d.db", (int)seed, k);
            scratch_path(path[k], sizeof path[k], f->folder, name);
            source[k] = make_source(f, path[k], k, &r);
        }
        /* the first one takes in the others, some of them more than once */
        struct store *s = opened(f, path[0]);
        for (int step = 0; step < 6; step++) {
            const int k = 1 + (int)(random_below(&r, SOURCES - 1));
            const struct store_merged wanted = join(&source[0], &source[k]);
            struct store_merged done;
            if (!store_merge(s, path[k], &done, &f->e)) fail_msg("%s", f->e.text);
            assert_counts(&done, &wanted);
            for (int rep = 0; rep < REPS; rep++)
                assert_string_equal(run_rows(f, s, rep), source[0].run[rep]);
            assert_int_equal(number(f, s, "SELECT count(*) FROM pragma_foreign_key_check"), 0);
        }
        /* no row of a run that was replaced is left */
        assert_int_equal(number(f, s,
                                "SELECT count(*) FROM stage WHERE run_id NOT IN (SELECT id "
                                "FROM run)"),
                         0);
        assert_int_equal(number(f, s,
                                "SELECT count(*) - count(DISTINCT run_id || ' ' || stage) "
                                "FROM stage"),
                         0);
        store_close(s);
    }
}

/* What each file that is no such database is refused with. */
struct refusal {
    const char *what, *sql, *says;
    enum err_kind kind;
};

static const struct refusal refusals[] = {
    {"a trigger", "CREATE TRIGGER greedy AFTER INSERT ON run BEGIN DELETE FROM stage; END",
     "greedy", ERR_DATA},
    {"a table that is not there", "DROP TABLE error_check", "lacks 1 of the tables", ERR_DATA},
    {"a view in the place of a table",
     "PRAGMA foreign_keys = OFF; DROP TABLE omission; CREATE VIEW omission AS SELECT 1 AS a",
     "omission", ERR_DATA},
    {"a newer version", "PRAGMA user_version = 1000", "1000", ERR_DATA},
    {"another program's", "PRAGMA application_id = 77", "another program", ERR_DATA},
    {"a rule that a row breaks",
     "PRAGMA ignore_check_constraints = ON; UPDATE error_check SET passed = 7", "error_check",
     ERR_DATA},
};

static void what_is_refused_changes_nothing(void **state)
{
    static const char all[] =
        "SELECT (SELECT group_concat(id || ' ' || config_hash || host_s) FROM run), (SELECT "
        "count(*) "
        "FROM build), (SELECT count(*) FROM setting), (SELECT total(total_sum_ps) FROM stage)";
    struct folder_fixture *f = *state;
    struct store *s = opened(f, f->path);
    put(f, s, 0, RUN_OK, 1);
    const char *before = rows(f, s, all);
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        const struct refusal *r = &refusals[i];
        struct store_merged done;
        struct store *other = opened(f, f->other);
        put(f, other, 1, RUN_OK, 2);
        store_close(other);
        sql(f->other, r->sql);
        assert_false(store_merge(s, f->other, &done, &f->e));
        if (f->e.kind != r->kind || strstr(f->e.text, r->says) == NULL)
            fail_msg("%s: %d %s", r->what, (int)f->e.kind, f->e.text);
        err_clear(&f->e);
        assert_string_equal(rows(f, s, all), before);
        unlink(f->other);
    }
    store_close(s);
}

static void files_that_are_none_are_told_apart(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, f->path);
    struct store_merged done;
    put(f, s, 0, RUN_OK, 1);
    /* not there; no database */
    assert_false(store_merge(s, f->other, &done, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    assert_non_null(strstr(f->e.text, f->other));
    assert_int_equal(access(f->other, F_OK), -1);
    err_clear(&f->e);
    FILE *out = fopen(f->other, "w");
    fputs("runs: many of them, but in another format than that of a database\n", out);
    fclose(out);
    assert_false(store_merge(s, f->other, &done, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    err_clear(&f->e);
    unlink(f->other);
    /* itself, by each name that a file can have */
    char dotted[300];
    snprintf(dotted, sizeof dotted, "%s/./t.db", f->folder);
    assert_int_equal(symlink(f->path, f->other), 0);
    char hard[300];
    snprintf(hard, sizeof hard, "%s/hard.db", f->folder);
    assert_int_equal(link(f->path, hard), 0);
    const char *const same[] = {f->path, dotted, f->other, hard};
    for (int i = 0; i < 4; i++) {
        assert_false(store_merge(s, same[i], &done, &f->e));
        assert_int_equal(f->e.kind, ERR_USAGE);
        assert_non_null(strstr(f->e.text, same[i]));
        err_clear(&f->e);
    }
    assert_int_equal(number(f, s, "SELECT count(*) FROM run"), 1);
    store_close(s);
}

static void an_older_version_is_refused_with_the_way_out(void **state)
{
    struct folder_fixture *f = *state;
    struct text name = {0}, dump = {0};
    const char *source = getenv("srcdir");
    text_add(&name, "%s/tests/data/store/version-5.sql", source ? source : ".");
    if (!text_read_file(&dump, name.s, &f->e)) fail_msg("%s", f->e.text);
    sql(f->other, dump.s);
    text_free(&name);
    text_free(&dump);
    struct store *s = opened(f, f->path);
    struct store_merged done;
    assert_false(store_merge(s, f->other, &done, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    assert_non_null(strstr(f->e.text, "mimdsim query --upgrade"));
    assert_int_equal(number(f, s, "SELECT count(*) FROM run"), 0);
    store_close(s);
}

/* After a refusal, and after a merge, the database is written to as before: by the right build, and
 * the other one can be attached again. */
static void the_store_goes_on_after_each_merge(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, f->path), *other = opened(f, f->other);
    struct store_merged done;
    put(f, s, 0, RUN_OK, 1);
    put(f, other, 0, RUN_OK, 1);
    put(f, other, 1, RUN_OK, 2);
    store_close(other);
    sql(f->other, "UPDATE run SET digest = 'fedcba9876543210' WHERE rep = 0");
    sql(f->other, "UPDATE build SET git = 'theirs'");
    assert_false(store_merge(s, f->other, &done, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    assert_non_null(strstr(f->e.text, "fedcba9876543210"));
    err_clear(&f->e);
    put(f, s, 2, RUN_OK, 1);
    sql(f->other, "DELETE FROM run WHERE rep = 0");
    if (!store_merge(s, f->other, &done, &f->e)) fail_msg("%s", f->e.text);
    assert_int_equal(done.added, 1);
    put(f, s, 3, RUN_OK, 1);
    assert_int_equal(number(f, s,
                            "SELECT count(*) FROM run JOIN build b ON b.id = build_id WHERE "
                            "b.git = 'theirs'"),
                     1);
    assert_int_equal(
        number(f, s, "SELECT count(DISTINCT build_id) FROM run WHERE rep IN (0, 2, 3)"), 1);
    store_close(s);
}

static void check_point(struct folder_fixture *f, struct store *s, const char *subject,
                        double value)
{
    static const char *const name[] = {"suite", "subject", "quantity", "at",    "unit",
                                       "value", "class",   "verdict",  "source"};
    const struct store_value v[] = {store_text("closed"), store_text(subject), store_text("time"),
                                    store_text("P=8"),    store_text("s"),     store_real(value),
                                    store_text("exact"),  store_text("pass"),  store_text("hand")};
    if (!store_insert(s, "check_point", 9, name, v, &f->e)) fail_msg("%s", f->e.text);
}

/* Rows of studies: what is there stays, what is not is added; verdicts on all runs together are not
 * taken over. */
static void studies_are_added_and_never_replaced(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, f->path), *other = opened(f, f->other);
    struct store_merged done;
    check_point(f, s, "ring", 1);
    check_point(f, other, "ring", 2);
    check_point(f, other, "torus", 3);
    struct real_result real = {.status = RUN_OK, .nrank = 4, .nsample = 2, .nstage = 1};
    struct real_sample sample[2] = {{0.5, false}, {0.75, true}};
    real.sample = sample;
    strcpy(real.stage[0].name, "all");
    const struct real_task task = {"hash", "mine", "dynamics", 8, "n = 8"};
    if (!store_put_real(other, &task, &real, &f->e)) fail_msg("%s", f->e.text);
    store_close(other);
    sql(f->other, "INSERT INTO claim (id, variant, statement, test, unit, verdict) VALUES ('C1', "
                  "'', 'x', 'y', '', 'pass')");
    sql(f->other, "UPDATE build SET git = 'theirs'");
    if (!store_merge(s, f->other, &done, &f->e)) fail_msg("%s", f->e.text);
    /* a point, a real run, its stage, its two samples */
    assert_int_equal(done.studies, 5);
    assert_string_equal(rows(f, s, "SELECT subject, value FROM check_point ORDER BY subject"),
                        "ring 1.0 \ntorus 3.0 \n");
    assert_string_equal(rows(f, s,
                             "SELECT b.git, r.scenario, (SELECT count(*) FROM real_stage), "
                             "(SELECT total(seconds) FROM real_sample) FROM real_run r JOIN "
                             "build b ON b.id = r.build_id"),
                        "theirs mine 1 1.25 \n");
    assert_int_equal(number(f, s, "SELECT count(*) FROM claim"), 0);
    if (!store_merge(s, f->other, &done, &f->e)) fail_msg("%s", f->e.text);
    assert_int_equal(done.studies, 0);
    store_close(s);
}

/* Tables that came after the first databases of this version may be missing there; what stands in
 * their place may not be anything else. */
static void tables_that_came_later_may_be_missing(void **state)
{
    struct folder_fixture *f = *state;
    for (int view = 0; view < 2; view++) {
        unlink(f->path);
        unlink(f->other);
        struct store *s = opened(f, f->path), *other = opened(f, f->other);
        struct store_merged done;
        put(f, other, 1, RUN_OK, 2);
        check_point(f, other, "ring", 2);
        store_close(other);
        sql(f->other, "DROP TABLE load_point; DROP TABLE load_series; DROP TABLE program_line; "
                      "DROP TABLE explain_point");
        if (view) sql(f->other, "CREATE VIEW program_line AS SELECT id AS run_id FROM run");
        assert_int_equal(store_merge(s, f->other, &done, &f->e), !view);
        assert_int_equal(f->e.kind, view ? ERR_DATA : ERR_NONE);
        err_clear(&f->e);
        assert_int_equal(number(f, s, "SELECT count(*) FROM run"), !view);
        assert_int_equal(number(f, s, "SELECT count(*) FROM check_point"), !view);
        store_close(s);
    }
}

/* Rows of a user's own tables belong to the user, also where they tell of runs and both databases
 * have them. */
static void rows_of_a_users_own_tables_are_not_merged(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, f->path), *other = opened(f, f->other);
    struct store_merged done;
    put(f, other, 1, RUN_OK, 2);
    store_close(other);
    store_close(s);
    sql(f->path, "CREATE TABLE my_notes (run_id INTEGER REFERENCES run (id), note TEXT)");
    sql(f->other, "CREATE TABLE my_notes (run_id INTEGER REFERENCES run (id), words TEXT); INSERT "
                  "INTO my_notes VALUES (1, 'slow')");
    s = opened(f, f->path);
    if (!store_merge(s, f->other, &done, &f->e)) fail_msg("%s", f->e.text);
    assert_int_equal(done.added, 1);
    assert_int_equal(number(f, s, "SELECT count(*) FROM my_notes"), 0);
    store_close(s);
}

/* Tables of a user's own may stand beside those of this program, and what ANALYZE makes: neither
 * must be in the other database. */
static void a_users_own_tables_stay_where_they_are(void **state)
{
    static const char own[] = "CREATE TABLE my_notes (run_id INTEGER, note TEXT); INSERT INTO "
                              "my_notes VALUES (1, 'slow'); CREATE VIEW my_view AS SELECT 1; "
                              "ANALYZE";
    struct folder_fixture *f = *state;
    for (int side = 0; side < 2; side++) {
        unlink(f->path);
        unlink(f->other);
        struct store *s = opened(f, f->path), *other = opened(f, f->other);
        struct store_merged done;
        put(f, s, 0, RUN_OK, 1);
        put(f, other, 1, RUN_OK, 2);
        store_close(other);
        store_close(s);
        sql(side == 0 ? f->path : f->other, own);
        s = opened(f, f->path);
        if (!store_merge(s, f->other, &done, &f->e)) fail_msg("%s", f->e.text);
        assert_int_equal(done.added, 1);
        assert_int_equal(number(f, s, "SELECT count(*) FROM sqlite_schema WHERE name = 'my_notes'"),
                         side == 0);
        store_close(s);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, drop_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(any_merges_do_what_the_model_does),
        TEST(what_is_refused_changes_nothing),
        TEST(files_that_are_none_are_told_apart),
        TEST(an_older_version_is_refused_with_the_way_out),
        TEST(the_store_goes_on_after_each_merge),
        TEST(studies_are_added_and_never_replaced),
        TEST(a_users_own_tables_stay_where_they_are),
        TEST(tables_that_came_later_may_be_missing),
        TEST(rows_of_a_users_own_tables_are_not_merged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
