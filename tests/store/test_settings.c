/* test_settings.c - the settings of each run are the lines of its configuration, however much of
 * them the run before had, whoever wrote in between, and whatever was undone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/made_run.h"
#include "../support/folder_fixture.h"
#include "base/text.h"
#include "store/store.h"

enum { KEYS = 9, RUNS = 60 };

struct fixture {
    struct folder_fixture in;
    char *config[RUNS]; /* of each run that was kept, by its repetition; NULL: none */
    uint32_t state;
};

static int begin(void **state)
{
    struct fixture *f = folder_of(sizeof *f, "t.db");
    f->state = 1;
    *state = f;
    return 0;
}

/* Small numbers in no order (the generator of Lehmer). */
static int any(struct fixture *f, int n)
{
    f->state = (uint32_t)((uint64_t)f->state * 48271 % 2147483647);
    return (int)(f->state % (uint32_t)n);
}

/* Keys in one order with few values, so that runs share lines; some are left out, so that the lines
 * behind them stand elsewhere than in the run before. */
static char *any_config(struct fixture *f)
{
    struct text t = {0};
    text_add(&t, "%s", any(f, 4) == 0 ? "no setting at all\n" : "");
    for (int k = 0; k < KEYS; k++)
        if (any(f, 6) > 0) text_add(&t, "key.%d = %d us\n", k, any(f, 3));
    text_add(&t, "last = a = b%s", any(f, 2) ? "\n" : "");
    char *kept = arena_text(f->in.a, t.s);
    text_free(&t);
    return kept;
}

static bool take_text(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s", value[0] != NULL ? value[0] : "");
    return false;
}

static void is(struct fixture *f, struct store *s, const char *sql, const char *expected)
{
    struct text t = {0};
    if (!store_select(s, sql, 0, NULL, take_text, &t, &f->in.e)) fail_msg("%s", f->in.e.text);
    if (strcmp(t.s != NULL ? t.s : "", expected) != 0)
        fail_msg("%s: '%s', expected '%s'", sql, t.s, expected);
    text_free(&t);
}

/* The settings of run `rep` are its lines, and each pair of key and value stands once. */
static void check_run(struct fixture *f, struct store *s, int rep)
{
    struct text sql = {0}, expected = {0};
    text_add(&sql,
             "SELECT group_concat(line, '|') FROM (SELECT key || ' = ' || value AS line FROM "
             "run_setting rs JOIN setting ON id = setting_id WHERE run_id = (SELECT id FROM "
             "run WHERE rep = %d) ORDER BY key)",
             rep);
    for (const char *line = f->config[rep]; *line != '\0'; line += strcspn(line, "\n")) {
        line += *line == '\n';
        const int n = (int)strcspn(line, "\n");
        if (n > 0 && line[0] != 'n')
            text_add(&expected, "%s%.*s", expected.length > 0 ? "|" : "", n, line);
    }
    is(f, s, sql.s, expected.s);
    text_free(&sql);
    text_free(&expected);
    is(f, s, "SELECT count(*) - count(DISTINCT key || '=' || value) FROM setting", "0");
}

/* A run with a configuration of its own; not kept when `undone`. */
static void put(struct fixture *f, struct store *s, int rep, bool undone)
{
    struct run_spec spec = made_spec(f->in.a, "t3e-300", 16, 4, rep);
    char *config = any_config(f);
    spec.config_text = config;
    const struct run_result r = made_result(f->in.a, &spec);
    if (undone) assert_true(store_begin(s, &f->in.e));
    if (!store_put(s, &spec, NULL, &r, &f->in.e)) fail_msg("run %d: %s", rep, f->in.e.text);
    if (undone) store_rollback(s);
    f->config[rep] = undone ? NULL : config;
}

static struct store *opened(struct fixture *f, enum store_mode mode)
{
    struct store *s = store_open(f->in.path, mode, &f->in.e);
    if (s == NULL) fail_msg("%s", f->in.e.text);
    return s;
}

static void check_all(struct fixture *f, struct store *s)
{
    for (int i = 0; i < RUNS; i++)
        if (f->config[i] != NULL) check_run(f, s, i);
}

/* A new database that is made in memory has no settings before its first run, and some then. */
static void each_run_has_its_own_lines(void **state)
{
    static const enum store_mode mode[] = {STORE_SCRATCH, STORE_WHOLE, STORE_WRITE};
    struct fixture *f = *state;
    for (int k = 0; k < 3; k++) {
        struct store *s = opened(f, mode[k]);
        memset(f->config, 0, sizeof f->config);
        for (int i = 0; i < RUNS; i++) put(f, s, i, any(f, 4) == 0);
        check_all(f, s);
        is(f, s, "SELECT count(*) > 20 FROM setting", "1");
        store_close(s);
    }
}

/* A run whose rows are gone again has left no row that the next one could share. */
static void what_was_undone_is_not_shared(void **state)
{
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0, true);
    is(f, s, "SELECT count(*) FROM setting", "0");
    for (int i = 1; i < RUNS; i++) put(f, s, i, i % 2 == 0);
    check_all(f, s);
    assert_true(store_publish(s, &f->in.e));
    store_close(s);
    s = opened(f, STORE_READ);
    check_all(f, s);
    store_close(s);
}

/* Two programs that write by turns find each other's rows. */
static void others_may_write_in_between(void **state)
{
    struct fixture *f = *state;
    struct store *s[] = {opened(f, STORE_WRITE), opened(f, STORE_WRITE)};
    for (int i = 0; i < RUNS; i++) put(f, s[any(f, 2)], i, false);
    check_all(f, s[0]);
    store_close(s[1]);
    store_close(s[0]);
}

/* The same run again replaces its rows, with others than before. */
static void a_run_again_has_its_new_lines(void **state)
{
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WRITE);
    for (int i = 0; i < RUNS; i++) put(f, s, i % 3, false);
    check_all(f, s);
    is(f, s, "SELECT count(*) FROM run", "3");
    is(f, s, "SELECT count(*) FROM run_setting WHERE run_id NOT IN (SELECT id FROM run)", "0");
    store_close(s);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, drop_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(each_run_has_its_own_lines),
        TEST(what_was_undone_is_not_shared),
        TEST(others_may_write_in_between),
        TEST(a_run_again_has_its_new_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
