/* store_put.c - one finished run becomes rows: run, settings, stages, ranks, baselines, checks,
 * omissions, links, spans.
 *
 * All of them in one transaction. Which columns a row has, and what they hold, say the tables of
 * columns (rows.h).
 *
 * Tables that grow with the machine (ranks, links, spans) have limits: a database of 10,000 runs
 * must stay one that can be queried and copied. Sums over all of them are in table run. */
#include "base/memory.h"
#include "store/store.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "measure/run_row.h"
#include "spec/run_label.h"
#include "store/build.h"
#include "store/rows.h"
#include "store/run_entries.h"
#include "store/settings.h"

/* A run is known by the hash of its settings, its seed and its repetition. */
static bool bind_identity(struct store *s, const struct run_spec *spec, struct binding *b,
                          struct err *e)
{
    if (!bind_start(s, STATEMENT_RUN_FIND, b, e)) return false;
    bind_text(b, spec->config_hash);
    bind_int(b, (int64_t)spec->seed);
    bind_int(b, spec->rep);
    return true;
}

/* Only a run that ended well counts: others are made again. An error reads as no. */
bool store_has(struct store *s, const struct run_spec *spec)
{
    struct err ignored = {0};
    struct binding b;
    if (!bind_identity(s, spec, &b, &ignored)) return false;
    bool has = sqlite3_step(b.statement) == SQLITE_ROW &&
               strcmp(store_cell(b.statement, 1), "ok") == 0;
    sqlite3_reset(b.statement);
    return has;
}

/* A name is no part of what a run is: it changes without running anything again. */
bool store_call(struct store *s, const struct run_spec *spec, struct err *e)
{
    struct binding b;
    struct text label = {0};
    run_label(spec, &label);
    /* By its identity, as everywhere: there may be no such row, which is no error. */
    bool ok = bind_start(s, STATEMENT_RUN_CALL, &b, e);
    if (ok) {
        bind_text(&b, spec->config_hash);
        bind_int(&b, (int64_t)spec->seed);
        bind_int(&b, spec->rep);
        bind_text(&b, label.s);
        ok = store_step(s, b.statement, e);
    }
    text_free(&label);
    return ok;
}

int64_t store_run_id(struct store *s, const struct run_spec *spec)
{
    struct err ignored = {0};
    struct binding b;
    int64_t id = 0;
    if (bind_identity(s, spec, &b, &ignored)) store_find_id(s, b.statement, &id, &ignored);
    return id;
}

/* The row of this program in table build, made when it is new; remembered for the connection. */
static bool find_build(struct store *s, struct err *e)
{
    if (s->build_id != 0) return true;
    struct build build = store_build();
    /* Add first, which does nothing where it is there, then find: two programs that begin at
     * once both find one row. */
    for (int add = 1; add >= 0; add--) {
        struct binding b;
        if (!bind_start(s, add ? STATEMENT_BUILD_ADD : STATEMENT_BUILD_FIND, &b, e)) return false;
        bind_text(&b, build.version);
        bind_text(&b, build.git);
        bind_text(&b, build.compiler);
        bind_text(&b, build.flags);
        if (add ? !store_step(s, b.statement, e)
                : !store_find_id(s, b.statement, &s->build_id, e))
            return false;
    }
    return true;
}

/* The row of a table of columns, behind keys that are bound. */
static bool put_row(struct store *s, enum statement which, struct binding *b, const void *row,
                    struct err *e)
{
    rows_bind(which, b, row);
    return store_step(s, b->statement, e);
}

/* The row of table run; *id is its key for all others. */
static bool put_run(struct store *s, const struct run_spec *spec, const struct run_order *order,
                    const struct run_result *r, int64_t *id,
                    struct err *e)
{
    struct binding b;
    if (!bind_start(s, STATEMENT_RUN_INSERT, &b, e)) return false;
    struct run_row row = run_row_make(spec, order, r);
    bind_int(&b, s->build_id);
    const bool ok = put_row(s, STATEMENT_RUN_INSERT, &b, &row, e);
    run_row_free(&row);
    if (ok) *id = sqlite3_last_insert_rowid(s->db);
    return ok;
}

/* Rows whose key is (run, number). */
static bool put_numbered(struct store *s, enum statement which, int64_t run, int64_t number,
                         const void *row, struct err *e)
{
    struct binding b;
    if (!bind_start(s, which, &b, e)) return false;
    bind_int(&b, run);
    bind_int(&b, number);
    return put_row(s, which, &b, row, e);
}

/* All ranks, or all links, in one row. */
static bool put_entries(struct store *s, enum statement which, int64_t run,
                        void (*entries)(const struct run_result *, struct text *),
                        const struct run_result *r, struct err *e)
{
    struct binding b;
    struct text t = {0};
    if (!bind_start(s, which, &b, e)) return false;
    entries(r, &t);
    bind_int(&b, run);
    store_bound(
        sqlite3_bind_text64(b.statement, b.next, t.s, t.length, SQLITE_STATIC, SQLITE_UTF8));
    const bool ok = store_step(s, b.statement, e);
    text_free(&t);
    return ok;
}

/* Stages always; single ranks of runs up to STORE_RANK_ROWS ranks, whose rows can be looked at
 * one by one. */
static bool put_stages(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    /* A run that failed before it began has no stages. */
    if ((r->stage == NULL && r->sums == NULL) || r->nrank == 0) return true;
    for (int i = 0; i < r->nstage; i++) {
        const struct stage_row row = stage_row_make(r, i);
        if (!put_numbered(s, STATEMENT_STAGE, run, i, &row, e)) return false;
    }
    return s->passing || !run_entries_ranks(r->nrank) || r->stage == NULL ||
           put_entries(s, STATEMENT_RANK_TIMES, run, rank_entries, r, e);
}

/* The serial codes of the run, in the order in which they were timed. */
static bool put_baselines(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nbaseline; i++)
        if (!put_numbered(s, STATEMENT_BASELINE, run, i, &r->baseline[i], e)) return false;
    return true;
}

/* What was compared with a reference. */
static bool put_errors(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nerror; i++)
        if (!put_numbered(s, STATEMENT_ERROR_CHECK, run, i, &r->error[i], e)) return false;
    return true;
}

/* What the run left out, and why no result needs it. A table without numbers: names are its
 * keys. */
static bool put_omissions(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nomission; i++) {
        struct binding b;
        if (!bind_start(s, STATEMENT_OMISSION, &b, e)) return false;
        bind_int(&b, run);
        if (!put_row(s, STATEMENT_OMISSION, &b, &r->omission[i], e)) return false;
    }
    return true;
}

/* Where they were recorded. */
static bool put_links(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    return r->nlink == 0 || r->link == NULL ||
           put_entries(s, STATEMENT_LINK_LOADS, run, link_entries, r, e);
}

/* Half a timeline would be misread: all spans or none. */
static bool put_spans(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    if (r->span == NULL || r->nspan > STORE_SPAN_ROWS) return true;
    for (int64_t i = 0; i < r->nspan; i++)
        if (!put_numbered(s, STATEMENT_SPAN, run, i, &r->span[i], e)) return false;
    return true;
}

/* "RANK STREAM TEXT" (run_result.said) as a row: whoever looks for what one rank said selects by
 * columns. */
static bool put_line(struct store *s, int64_t run, int number, const char *line, int length,
                     struct err *e)
{
    struct binding b;
    char *rest;
    const long rank = strtol(line, &rest, 10), stream = strtol(rest, &rest, 10);
    if (!bind_start(s, STATEMENT_PROGRAM_LINE, &b, e)) return false;
    bind_int(&b, run);
    bind_int(&b, number);
    bind_int(&b, rank);
    bind_int(&b, stream);
    /* One space ends the numbers; those that follow are the program's. */
    store_bound(sqlite3_bind_text(b.statement, b.next, rest + 1, length - (int)(rest + 1 - line),
                                  SQLITE_STATIC));
    return store_step(s, b.statement, e);
}

/* What the ranks wrote: the beginning, as it is for people. A program that prints in its innermost
 * loop must not fill a disk. */
static bool put_lines(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    if (s->passing || r->said == NULL) return true;
    const char *line = r->said;
    for (int i = 0; *line != '\0' && i < STORE_LINE_ROWS; i++) {
        const char *end = strchrnul(line, '\n');
        if (!put_line(s, run, i, line, (int)(end - line), e)) return false;
        line = *end != '\0' ? end + 1 : end;
    }
    return true;
}

/* An older row of the same identity goes, with everything that belongs to it (ON DELETE
 * CASCADE). */
static bool remove_old(struct store *s, const struct run_spec *spec, struct err *e)
{
    struct binding b;
    int64_t old;
    if (!bind_identity(s, spec, &b, e) || !store_find_id(s, b.statement, &old, e)) return false;
    if (old == 0) return true;
    if (!bind_start(s, STATEMENT_RUN_DELETE, &b, e)) return false;
    bind_int(&b, old);
    return store_step(s, b.statement, e);
}

/* What belongs to runs goes with them (ON DELETE CASCADE). */
bool store_clear(struct store *s, struct err *e)
{
    struct binding b;
    return bind_start(s, STATEMENT_RUN_CLEAR, &b, e) && store_step(s, b.statement, e);
}

bool store_note_build(struct store *s, struct err *e) { return find_build(s, e); }

bool store_put(struct store *s, const struct run_spec *spec, const struct run_order *order,
               const struct run_result *r, struct err *e)
{
    /* Within a transaction of the caller, many runs are one commit. */
    bool alone = !s->in_transaction;
    int64_t run = 0;
    CHECK(s->writable);
    if (alone && !store_begin(s, e)) return false;
    bool ok = find_build(s, e) && remove_old(s, spec, e) && put_run(s, spec, order, r, &run, e) &&
              settings_put(s, run, spec->config_text, e) && put_stages(s, run, r, e) &&
              put_baselines(s, run, r, e) && put_errors(s, run, r, e) &&
              put_omissions(s, run, r, e) && put_links(s, run, r, e) && put_spans(s, run, r, e) &&
              put_lines(s, run, r, e);
    if (!alone) return ok;
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}
