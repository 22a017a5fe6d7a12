/* store_query.c - queries out of the database, and rows of any table into it.
 *
 * Queries come from plots/, from the audit and from users (`mimdsim query`): each is checked as
 * if a user had written it. */
#include "store/store.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "store/connection.h"

/* Of one query, and of one inserted row. */
enum { MAX_COLUMNS = 128, MAX_INSERT = 64 };

struct store_value store_null(void) { return (struct store_value){.kind = STORE_NULL}; }

struct store_value store_int(int64_t v)
{
    return (struct store_value){.kind = STORE_INT, .integer = v};
}

/* What is not finite becomes NULL: a database of NaN cannot be compared or averaged. */
struct store_value store_real(double v)
{
    return isfinite(v) ? (struct store_value){.kind = STORE_REAL, .real = v} : store_null();
}

struct store_value store_text(const char *v)
{
    return v ? (struct store_value){.kind = STORE_TEXT, .text = v} : store_null();
}

/* The value keeps its type, so that one column may hold numbers and NULL. SQLITE_STATIC: the
 * caller's text lives until the step. */
static void bind_value(sqlite3_stmt *q, int place, const struct store_value *v)
{
    switch (v->kind) {
    case STORE_NULL: store_bound(sqlite3_bind_null(q, place)); break;
    case STORE_INT: store_bound(sqlite3_bind_int64(q, place, v->integer)); break;
    case STORE_REAL: store_bound(sqlite3_bind_double(q, place, v->real)); break;
    case STORE_TEXT: store_bound(sqlite3_bind_text(q, place, v->text, -1, SQLITE_STATIC)); break;
    }
}

/* The text belongs to SQLite, until the next step. One that there was no memory for is no NULL of
 * the row: *ok becomes false. */
static const char *column_text(sqlite3_stmt *q, int column, bool *ok)
{
    const bool null = sqlite3_column_type(q, column) == SQLITE_NULL;
    const char *text = (const char *)sqlite3_column_text(q, column);
    if (!null && text == NULL) *ok = false;
    return text;
}

static struct store_value column_value(sqlite3_stmt *q, int column, bool *ok)
{
    switch (sqlite3_column_type(q, column)) {
    case SQLITE_INTEGER: return store_int(sqlite3_column_int64(q, column));
    case SQLITE_FLOAT:
        return (struct store_value){.kind = STORE_REAL, .real = sqlite3_column_double(q, column)};
    case SQLITE_NULL: return store_null();
    default: return store_text(column_text(q, column, ok));
    }
}

/* Whether `sql` is more than blanks and comments. */
static bool has_statement(struct store *s, const char *sql)
{
    sqlite3_stmt *q = NULL;
    /* Looked at without SQLite first, as it would refuse even nothing where there is no memory. */
    if (sql[strspn(sql, " \t\r\n;")] == '\0') return false;
    bool more = sqlite3_prepare_v2(s->db, sql, -1, &q, NULL) != SQLITE_OK || q != NULL;
    sqlite3_finalize(q);
    return more;
}

/* Prepare the first statement of `sql`; *rest (may be NULL) is what stands behind it. Where it asks
 * for what the database does not show so far (image.h), it is shown. */
static bool prepare_shown(struct store *s, const char *sql, sqlite3_stmt **q, const char **rest,
                          struct err *e)
{
    if (sqlite3_prepare_v2(s->db, sql, -1, q, rest) == SQLITE_OK) return true;
    if (!s->front || s->in_transaction) return store_failed(s, e);
    store_show(s);
    return sqlite3_prepare_v2(s->db, sql, -1, q, rest) == SQLITE_OK || store_failed(s, e);
}

/* One statement, or NULL with *e set. What a user can write wrongly is told here: more than one
 * statement, none, a change in a database that is only read. */
static sqlite3_stmt *prepare_new(struct store *s, const char *sql, struct err *e)
{
    sqlite3_stmt *q = NULL;
    const char *rest = "";
    if (!prepare_shown(s, sql, &q, &rest, e)) return NULL;
    /* SQLite runs the first statement and ignores the rest: what would be ignored must not look
     * done. */
    if (has_statement(s, rest)) {
        if (sqlite3_errcode(s->db) == SQLITE_NOMEM) store_failed(s, e);
        err_set(e, ERR_DATA, "more than one statement: '%.60s' would not be run",
                rest + strspn(rest, " \t\r\n"));
        sqlite3_finalize(q);
        return NULL;
    }
    if (q == NULL) {
        err_set(e, ERR_DATA, "empty query");
        return NULL;
    }
    /* query_only would refuse it, too, but with a message of SQLite's. */
    if (!s->writable && !sqlite3_stmt_readonly(q)) {
        err_set(e, ERR_IO,
                "database %s is opened for reading only: a statement that changes it is not run",
                s->path);
        /* The statement is finalized on every way out: an open one would keep the database
         * locked. */
        sqlite3_finalize(q);
        return NULL;
    }
    return q;
}

/* The same with its parameters bound, which may be too few. A passing database is asked the same
 * for one set of runs after the other, and its tables stay what they are, so that a kept statement
 * is what a new one would be; elsewhere the names of its columns could be of tables that have
 * changed since. */
static sqlite3_stmt *prepare(struct store *s, const char *sql, int nparam, const char *const *param,
                             struct err *e)
{
    sqlite3_stmt *q = s->passing ? store_kept(s, sql) : NULL;
    if (q == NULL) q = prepare_new(s, sql, e);
    if (q == NULL) return NULL;
    if (sqlite3_bind_parameter_count(q) != nparam) {
        err_set(e, ERR_DATA, "the query has %d parameters, %d were given",
                sqlite3_bind_parameter_count(q), nparam);
        sqlite3_finalize(q);
        return NULL;
    }
    for (int i = 0; i < nparam; i++)
        store_bound(sqlite3_bind_text(q, i + 1, param[i], -1, SQLITE_STATIC));
    return q;
}

/* The statement of prepare, which nobody reads any more. */
static void let_go(struct store *s, const char *sql, sqlite3_stmt *q)
{
    if (s->passing) store_keep(s, sql, q);
    else sqlite3_finalize(q);
}

/* Row by row: a result of any size takes the memory of one row. */
bool store_query(struct store *s, const char *sql, int nparam, const char *const *param,
                 store_value_fn *header, store_value_fn *row, void *context, struct err *e)
{
    sqlite3_stmt *q = prepare(s, sql, nparam, param, e);
    if (q == NULL) return false;
    int ncolumn = sqlite3_column_count(q), code = SQLITE_DONE;
    const char *name[MAX_COLUMNS];
    struct store_value value[MAX_COLUMNS];
    bool ok = ncolumn <= MAX_COLUMNS ||
              err_set(e, ERR_DATA, "more than %d columns in a query", MAX_COLUMNS);
    for (int i = 0; ok && i < ncolumn; i++) name[i] = sqlite3_column_name(q, i);
    /* Names before the first row, so that a table without rows has a head. */
    bool more = ok && (header == NULL || header(context, ncolumn, name, NULL));
    while (more && (code = sqlite3_step(q)) == SQLITE_ROW) {
        for (int i = 0; i < ncolumn; i++) value[i] = column_value(q, i, &ok);
        more = ok ? row(context, ncolumn, name, value) : store_failed(s, e);
    }
    /* SQLITE_ROW: the row function stopped the query, which is no error of the database. */
    if (code != SQLITE_DONE && code != SQLITE_ROW) ok = store_failed(s, e);
    let_go(s, sql, q);
    return ok;
}

/* The same with all values as texts, NULL as NULL: for sentences and names. */
bool store_select(struct store *s, const char *sql, int nparam, const char *const *param,
                  store_row_fn *row, void *context, struct err *e)
{
    sqlite3_stmt *q = prepare(s, sql, nparam, param, e);
    if (q == NULL) return false;
    int ncolumn = sqlite3_column_count(q), code = SQLITE_DONE;
    const char *name[MAX_COLUMNS], *value[MAX_COLUMNS];
    /* The same limit and order as in store_query. */
    bool ok = ncolumn <= MAX_COLUMNS ||
              err_set(e, ERR_DATA, "more than %d columns in a query", MAX_COLUMNS);
    for (int i = 0; ok && i < ncolumn; i++) name[i] = sqlite3_column_name(q, i);
    bool more = ok;
    while (more && (code = sqlite3_step(q)) == SQLITE_ROW) {
        for (int i = 0; i < ncolumn; i++) value[i] = column_text(q, i, &ok);
        more = ok ? row(context, ncolumn, name, value) : store_failed(s, e);
    }
    /* As in store_query: a row function that stops the query makes no error. */
    if (code != SQLITE_DONE && code != SQLITE_ROW) ok = store_failed(s, e);
    let_go(s, sql, q);
    return ok;
}

/* Bind and step a statement that returns nothing. Rows come one after the other from the same text,
 * whose preparing takes longer than a row: it is kept. */
static bool run_once(struct store *s, const char *sql, int nvalue, const struct store_value *value,
                     struct err *e)
{
    /* Rows are inserted only through a connection that was opened for writing: else it is our
     * mistake, not the user's. */
    CHECK(s->writable);
    sqlite3_stmt *q = store_kept(s, sql);
    if (q == NULL && !prepare_shown(s, sql, &q, NULL, e)) return false;
    for (int i = 0; i < nvalue; i++) bind_value(q, i + 1, &value[i]);
    bool ok = sqlite3_step(q) == SQLITE_DONE || store_failed(s, e);
    store_keep(s, sql, q);
    return ok;
}

/* Names come from this program, but are quoted all the same: one may be a word of SQL. */
bool store_insert(struct store *s, const char *table, int ncolumn, const char *const *name,
                  const struct store_value *value, struct err *e)
{
    CHECK(ncolumn >= 1 && ncolumn <= MAX_INSERT);
    struct text sql = {0};
    /* A row with the same key is the same thing, measured again. */
    text_add(&sql, "INSERT OR REPLACE INTO \"%s\" (", table);
    for (int i = 0; i < ncolumn; i++) text_add(&sql, "%s\"%s\"", i ? ", " : "", name[i]);
    text_add(&sql, ") VALUES (");
    for (int i = 0; i < ncolumn; i++) text_add(&sql, i ? ", ?" : "?");
    text_add(&sql, ")");
    bool ok = run_once(s, sql.s, ncolumn, value, e);
    text_free(&sql);
    return ok;
}

/* Columns that are not in the database are left out; the rest follows the keys in the table's
 * order. */
bool store_insert_row(struct store *s, const char *table, int n, const char *const *name,
                      const struct store_value *value, const struct column_table *t,
                      const void *row, struct err *e)
{
    const char *all[MAX_INSERT];
    struct store_value cell[MAX_INSERT];
    struct column_value read[MAX_INSERT]; /* which the texts may lie in */
    /* The keys and the columns of a table are both known when the program is written: too many
     * is a mistake of ours. */
    CHECK(n + t->n <= MAX_INSERT);
    for (int i = 0; i < n; i++) {
        all[i] = name[i];
        cell[i] = value[i];
    }
    /* cell[i].text may point into read[i].buffer, so both live until the insert. */
    for (int i = 0; i < t->n; i++) {
        struct column_value *v = &read[i];
        if (t->column[i].flags & COLUMN_NO_SQL) continue;
        column_read(&t->column[i], row, v);
        all[n] = t->column[i].name;
        cell[n++] = v->kind == VALUE_ABSENT ? store_null()
                    : v->kind == VALUE_REAL ? store_real(v->real)
                    : v->kind == VALUE_TEXT ? store_text(v->text)
                                            : store_int(v->integer);
    }
    return store_insert(s, table, n, all, cell, e);
}

/* IS, not =: NULL equals NULL here. The column with its table: a name in quotes that is no column
 * would be a text to SQLite. */
bool store_delete(struct store *s, const char *table, const char *column, struct store_value value,
                  struct err *e)
{
    struct text sql = {0};
    text_add(&sql, "DELETE FROM \"%s\" WHERE \"%s\".\"%s\" IS ?", table, table, column);
    bool ok = run_once(s, sql.s, 1, &value, e);
    text_free(&sql);
    return ok;
}
