/* fuzz_database.c - a small database, and everything that is read of one (fuzz_database.h). */
#include "fuzz_database.h"

#include <stdio.h>
#include <sqlite3.h>
#include <unistd.h>

#include "../support/made_run.h"
#include "app/load_curve.h"
#include "base/text.h"
#include "plan/plan.h"
#include "report/claims.h"
#include "report/report.h"
#include "report/report_document.h"
#include "report/trace.h"
#include "store/merge.h"
#include "study/audit.h"

/* SLICES: parts into which the relations, and the figures, are divided. */
enum { RUNS = 2, MOST_COLUMNS = 1024, MOST_NAMES = 256, STEPS = 200000, SLICES = 16 };

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
        /* No log: two files less for each input (bytes 18 and 19 of the header, 1: none). */
        image.s[18] = image.s[19] = 1;
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

/* One of SLICES parts of all tables and views. */
static void read_relations(struct store *s, size_t slice, struct err *e)
{
    for (size_t i = slice; i < nrelation; i += SLICES) {
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

/* Every SLICES-th rule; the table of all claims with the first. */
static void read_claims(struct store *s, size_t slice, struct err *e)
{
    static struct claim_rules c;
    if (c.n == 0) CHECK(claims_read(&c, plan_data_dir(), e));
    for (int i = (int)slice; i < c.n; i += SLICES)
        judge(claims_judge(&c.rule[i], s, "what-if", no_row, NULL, e), e);
    if (slice == 0) judge(claims_print(s, true, fuzz_sink(), e), e);
}

/* Every SLICES-th figure. */
static void read_figures(struct store *s, size_t slice, struct err *e)
{
    static char **name;
    static int n;
    if (name == NULL) n = report_figures(plan_data_dir(), &name);
    char folder[256];
    snprintf(folder, sizeof folder, "%s/figures", fuzz_folder());
    for (int i = (int)slice; i < n; i += SLICES)
        judge(report_figure(s, plan_data_dir(), name[i], folder, e), e);
}

static void read_report(struct store *s, struct err *e)
{
    char folder[256];
    snprintf(folder, sizeof folder, "%s/figures", fuzz_folder());
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

/* As `mimdsim load --traffic FILE:RUN`, up to the first message. */
static void read_traffic(const char *path, struct err *e)
{
    char word[300];
    snprintf(word, sizeof word, "%s:%d", path, RUNS);
    struct arena *a = arena_create();
    const struct run_spec spec = made_spec(a, "t3e-300", 4, 4, 0);
    struct load_question q = {.machine = &spec.machine};
    struct load_recording x;
    struct load_series s;
    judge(load_recording_read(word, &x, a, e) && load_begin(&q, &x, &s, a, e), e);
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

/* All that is read of a database, in parts of about the same work; the last two open it by
 * themselves. */
enum {
    PART_RELATIONS,
    PART_CLAIMS = PART_RELATIONS + SLICES,
    PART_FIGURES = PART_CLAIMS + SLICES,
    PART_TIMELINES = PART_FIGURES + SLICES,
    PART_AUDIT,
    PART_REPORT,
    PART_TRAFFIC,
    PART_MERGE,
    PARTS
};

static void read_part(struct store *s, const char *path, size_t part, struct err *e)
{
    if (part < PART_CLAIMS) read_relations(s, part - PART_RELATIONS, e);
    else if (part < PART_FIGURES) read_claims(s, part - PART_CLAIMS, e);
    else if (part < PART_TIMELINES) read_figures(s, part - PART_FIGURES, e);
    else if (part == PART_TIMELINES) read_timelines(s, e);
    else if (part == PART_AUDIT) audit(s, e);
    else if (part == PART_REPORT) read_report(s, e);
    else if (part == PART_TRAFFIC) read_traffic(path, e);
    else merge(path, e);
}

void database_read(const char *path, size_t chosen)
{
    struct err e;
    err_clear(&e);
    struct store *s = store_open(path, STORE_READ, &e);
    if (s == NULL) {
        judge(false, &e);
        return;
    }
    for (size_t part = 0; part < PARTS; part++)
        if (fuzz_is_whole() || part == chosen % PARTS) read_part(s, path, part, &e);
    store_close(s);
}
