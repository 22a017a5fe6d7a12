/* fuzz_database.c - a small database, and everything that is read of one (fuzz_database.h). */
#include "fuzz_database.h"

#include <stdio.h>
#include <sqlite3.h>
#include <unistd.h>

#include "../support/made_run.h"
#include "base/text.h"
#include "plan/plan.h"
#include "report/claims.h"
#include "report/report.h"
#include "report/report_document.h"
#include "report/trace.h"
#include "store/merge.h"
#include "study/audit.h"

enum { RUNS = 2, MOST_COLUMNS = 1024, MOST_NAMES = 256, STEPS = 200000 };

static char *columns[MOST_COLUMNS], *relations[MOST_NAMES];
static size_t ncolumn, nrelation;

/* A query of a stranger may be endless by itself: that is no fault, so each is given a number of
 * steps. */
static int stop(void *context)
{
    (void)context;
    return 1;
}
static int limit_steps(sqlite3 *db, const char **message, const struct sqlite3_api_routines *api)
{
    (void)message, (void)api;
    sqlite3_progress_handler(db, STEPS, stop, NULL);
    return SQLITE_OK;
}

static bool take_name(void *context, int n, const char *const *name, const char *const *value)
{
    (void)n, (void)name;
    if (context == &ncolumn && ncolumn < MOST_COLUMNS) columns[ncolumn++] = strdup(value[0]);
    if (context == &nrelation && nrelation < MOST_NAMES) relations[nrelation++] = strdup(value[0]);
    return true;
}

/* Two runs that differ, one with what only some runs have. */
static void fill(const char *path)
{
    struct err e;
    struct arena *a = arena_create();
    err_clear(&e);
    struct store *s = store_open(path, STORE_WRITE, &e);
    CHECK(s != NULL);
    for (int i = 0; i < RUNS; i++) {
        struct run_spec spec = made_spec(a, "t3e-300", 4, 4, i);
        struct run_result r = made_result(a, &spec);
        made_spans(&r, a);
        CHECK(store_put(s, &spec, NULL, &r, &e));
    }
    CHECK(store_select(
        s,
        "SELECT m.name || ' ' || c.name FROM sqlite_schema m, pragma_table_info(m.name) c"
        " WHERE m.type = 'table' AND m.name NOT LIKE 'sqlite_%' ORDER BY 1",
        0, NULL, take_name, &ncolumn, &e));
    CHECK(store_select(s,
                       "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view') ORDER BY 1",
                       0, NULL, take_name, &nrelation, &e));
    store_close(s);
    arena_destroy(a);
}

const uint8_t *database_image(size_t *size)
{
    static struct text image;
    struct err e;
    if (image.s == NULL) {
        fuzz_data();
        setenv("MIMDSIM_GNUPLOT", "/nonexistent/gnuplot", 1);
        sqlite3_auto_extension((void (*)(void))limit_steps);
        char path[256];
        snprintf(path, sizeof path, "%s/base.db", fuzz_folder());
        fill(path);
        err_clear(&e);
        CHECK(text_read_file(&image, path, &e));
        unlink(path);
    }
    *size = image.length;
    return (const uint8_t *)image.s;
}

const char *const *database_columns(size_t *n)
{
    size_t ignored;
    database_image(&ignored);
    *n = ncolumn;
    return (const char *const *)columns;
}

/* What a part of the program says of a bad database; its answer does not matter. */
static void judge(bool fine, struct err *e)
{
    if (!fine && e->kind != ERR_IO && e->kind != ERR_BUSY && e->kind != ERR_CREATE) fuzz_refused(e);
    err_clear(e);
}

static void read_relations(struct store *s, struct err *e)
{
    for (size_t i = 0; i < nrelation; i++) {
        char sql[256];
        snprintf(sql, sizeof sql, "SELECT * FROM %s LIMIT 50", relations[i]);
        judge(report_query(s, sql, 0, NULL, i % 2 == 0, fuzz_sink(), e), e);
    }
}

static void read_timelines(struct store *s, struct err *e)
{
    static const enum trace_format format[] = {TRACE_CHROME, TRACE_PAJE, TRACE_CSV, TRACE_TEXT,
                                               TRACE_GOAL};
    for (int run = 1; run <= RUNS; run++) {
        struct arena *a = arena_create();
        struct run_result r = {0};
        bool fine = trace_read(s, run, a, &r, e);
        judge(fine, e);
        for (size_t i = 0; fine && i < sizeof format / sizeof *format; i++) {
            const struct trace_options o = {.title = "t"};
            int64_t left_out;
            judge(trace_write(&r, format[i], &o, fuzz_sink(), &left_out, e), e);
        }
        arena_destroy(a);
    }
}

static bool no_row(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    (void)context, (void)rule, (void)j;
    return true;
}

static void read_claims(struct store *s, struct err *e)
{
    struct claim_rules c;
    CHECK(claims_read(&c, plan_data_dir(), e));
    for (int i = 0; i < c.n; i++) judge(claims_judge(&c.rule[i], s, "what-if", no_row, NULL, e), e);
    judge(claims_print(s, true, fuzz_sink(), e), e);
    claims_free(&c);
}

static void read_figures(struct store *s, const char *folder, struct err *e)
{
    char **name;
    int n = report_figures(plan_data_dir(), &name);
    for (int i = 0; i < n; i++) {
        judge(report_figure(s, plan_data_dir(), name[i], folder, e), e);
        free(name[i]);
    }
    free(name);
    const struct document d = {
        .store = s, .name = "report", .title = "t", .data_dir = plan_data_dir(), .figures = folder};
    judge(document_write(&d, e), e);
}

static void audit(struct store *s, struct err *e)
{
    static struct audit_report report;
    const struct audit_options o = {.quiet = true};
    struct arena *a = arena_create();
    judge(audit_database(s, &o, a, &report, e), e);
    arena_destroy(a);
}

static void merge(const char *path, struct err *e)
{
    struct store_merged done;
    struct store *s = store_open("other", STORE_SCRATCH, e);
    CHECK(s != NULL);
    judge(store_merge(s, path, &done, e), e);
    store_close(s);
}

void database_read(const char *path)
{
    struct err e;
    char folder[256];
    snprintf(folder, sizeof folder, "%s/figures", fuzz_folder());
    err_clear(&e);
    struct store *s = store_open(path, STORE_READ, &e);
    if (s != NULL) {
        read_relations(s, &e);
        read_timelines(s, &e);
        read_claims(s, &e);
        audit(s, &e);
        read_figures(s, folder, &e);
        store_close(s);
        merge(path, &e);
    } else judge(false, &e);
}
