/* upgrade.c - one transaction from an older schema to this one, and the old database kept
 * beside; see upgrade.h.
 *
 * There is no list of changes between versions: every table is put aside under another name,
 * made anew, and filled from the old one, column by column with the same name. A new column
 * takes its default. So a column can be added without writing an upgrade. */
#include "store/upgrade.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/beside.h"
#include "store/guard.h"
#include "store/rows.h"
#include "store/run_entries.h"
#include "store/upgrade_runs.h"

enum { MOST_BACKUPS = 100 };

/* --- tables ----------------------------------------------------------------------------------- */

/* Call `visit` with each row of `sql` on `db`; false at the first failure of either. The statement
 * is finalized in any case; its code is the error of the last step. */
typedef bool visit_fn(struct store *s, sqlite3_stmt *row, struct err *e);

static bool for_each(struct store *s, sqlite3 *db, const char *sql, visit_fn *visit, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok = true;
    int code = sqlite3_prepare_v2(db, sql, -1, &q, NULL);
    while (ok && code == SQLITE_OK && sqlite3_step(q) == SQLITE_ROW) ok = visit(s, q, e);
    if (code == SQLITE_OK) code = sqlite3_finalize(q);
    if (ok && code != SQLITE_OK) ok = store_failed(&(struct store){.db = db, .path = s->path}, e);
    return ok;
}

/* Run the statement that printf-like `format` with a name or two makes; %w doubles quotes
 * (sqlite.org/printf.html). */
static bool exec_named(struct store *s, struct err *e, const char *format, const char *a,
                       const char *b)
{
    char *sql = sqlite3_mprintf(format, a, b);
    bool ok = sql != NULL ? store_exec(s, sql, e)
                          : err_set(e, ERR_INTERNAL, "no memory for database %s", s->path);
    sqlite3_free(sql);
    return ok;
}

static const char *name_of(sqlite3_stmt *row) { return store_cell(row, 0); }

static bool has_column(struct store *s, const char *table, const char *column)
{
    return sqlite3_table_column_metadata(s->db, "main", table, column, NULL, NULL, NULL, NULL,
                                         NULL) == SQLITE_OK;
}

/* Views and indices of the schema are made anew with it; those of the user's own stay. */
static bool drop_object(struct store *s, sqlite3_stmt *row, struct err *e)
{
    const bool view = strcmp(store_cell(row, 1), "view") == 0;
    return exec_named(s, e, view ? "DROP VIEW IF EXISTS \"%w\"" : "DROP INDEX IF EXISTS \"%w\"",
                      name_of(row), NULL);
}

/* "run" becomes "older_run"; a table that the old version did not have is made empty. */
static bool put_rows_aside(struct store *s, const char *table, struct err *e)
{
    return !has_column(s, table, NULL) ||
           exec_named(s, e, "ALTER TABLE \"%w\" RENAME TO \"older_%w\"", table, table);
}

static bool put_aside(struct store *s, sqlite3_stmt *row, struct err *e)
{
    return put_rows_aside(s, name_of(row), e);
}

/* The columns of `table`, and what each gets: the old column of the same name, its default, or
 * nothing of its type. */
static bool list_columns(struct store *s, const char *table, const char *older, struct text *to,
                         struct text *from, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(
                  s->db, "SELECT name, type, \"notnull\" AND dflt_value IS NULL"
                         " FROM pragma_table_info(?1)",
                  -1, &q, NULL) == SQLITE_OK;
    if (ok) store_bound(sqlite3_bind_text(q, 1, table, -1, SQLITE_STATIC));
    while (ok && sqlite3_step(q) == SQLITE_ROW) {
        const char *name = name_of(q), *comma = to->length > 0 ? ", " : "";
        const bool there = has_column(s, older, name),
                   text = sqlite3_stricmp(store_cell(q, 1), "TEXT") == 0;
        /* A column that may be NULL, or has a default, is left to SQLite. */
        if (!there && !sqlite3_column_int(q, 2)) continue;
        text_add(to, "%s\"%s\"", comma, name);
        if (there) text_add(from, "%s\"%s\"", comma, name);
        else text_add(from, "%s%s", comma, text ? "''" : "0");
    }
    return (sqlite3_finalize(q) == SQLITE_OK && ok) || store_failed(s, e);
}

/* Fill a table from the one that was put aside, which then goes. */
static bool fill_table(struct store *s, sqlite3_stmt *row, struct err *e)
{
    const char *table = name_of(row);
    struct text older = {0}, to = {0}, from = {0}, sql = {0};
    text_add(&older, "older_%s", table);
    bool ok = true;
    if (has_column(s, older.s, NULL)) {
        ok = list_columns(s, table, older.s, &to, &from, e);
        text_add(&sql, "DELETE FROM \"%s\"; INSERT INTO \"%s\" (%s) SELECT %s"
                       " FROM \"%s\"; DROP TABLE \"%s\"",
                 table, table, to.s, from.s, older.s, older.s);
        ok = ok && store_exec(s, sql.s, e);
    }
    text_free(&older);
    text_free(&to);
    text_free(&from);
    text_free(&sql);
    return ok;
}

/* What an entry holds behind its keys; a column that the older table lacks is 0, or absent where it
 * may be. */
static void add_entry_columns(struct store *s, const struct entry_view *v, const char *older,
                              struct text *sql)
{
    for (int i = 0; i < v->columns->n; i++) {
        const struct column *c = &v->columns->column[i];
        const char *otherwise = c->flags & COLUMN_NULL ? "NULL" : "0";
        text_add(sql, ", %s", has_column(s, older, c->name) ? c->name : otherwise);
    }
}

/* Rows of a table that is a view now become entries (run_entries.h), the same text as that of a new
 * run, made by SQLite. */
static bool fill_entries(struct store *s, const struct entry_view *v, struct err *e)
{
    struct text sql = {0}, keys = {0}, older = {0};
    text_add(&older, "older_%s", v->view);
    for (int i = 0; i < v->nkey; i++) text_add(&keys, "%s%s", i > 0 ? ", " : "", v->key[i]);
    /* Two rows of one key are damage that nobody would find in a text. */
    text_add(&sql, "CREATE UNIQUE INDEX %s_keys ON %s (run_id, %s);", older.s, older.s, keys.s);
    text_add(&sql, "INSERT INTO %s SELECT run_id, json_group_array(json_array(%s", v->table,
             keys.s);
    add_entry_columns(s, v, older.s, &sql);
    text_add(&sql, ")) FROM (SELECT * FROM %s ORDER BY run_id, %s) GROUP BY run_id; DROP TABLE %s",
             older.s, keys.s, older.s);
    const bool ok = !has_column(s, older.s, NULL) || store_exec(s, sql.s, e);
    text_free(&sql);
    text_free(&keys);
    text_free(&older);
    return ok;
}

/* Everything within the transaction. `fresh` is an empty database of this version: it tells what
 * there is to be. */
static bool remake(struct store *s, sqlite3 *fresh, const char *schema, int version, int64_t *kept,
                   struct err *e)
{
    static const char tables[] =
        "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'",
                      /* What is dropped in one database is listed in the other: `others` of the
                       * schema are views and indices. */
                      others[] =
                          "SELECT name, type FROM sqlite_schema WHERE type <> 'table'"
                          " AND sql IS NOT NULL";
    char identity[64];
    snprintf(identity, sizeof identity, "PRAGMA user_version = %d", STORE_VERSION);
    /* What are views now were tables: they must be out of the way before views are dropped. */
    bool ok = true;
    for (int i = 0; i < ENTRY_VIEWS && ok; i++) ok = put_rows_aside(s, entry_view[i].view, e);
    /* Order: views refer to tables, so they go first and are made with the schema. */
    ok = ok && for_each(s, fresh, others, drop_object, e) &&
         for_each(s, fresh, tables, put_aside, e) && store_exec(s, schema, e) &&
         for_each(s, fresh, tables, fill_table, e);
    for (int i = 0; i < ENTRY_VIEWS && ok; i++) ok = fill_entries(s, &entry_view[i], e);
    return ok && upgrade_runs(s, version, kept, e) && store_exec(s, identity, e) &&
           guard_schema(s, "main", s->path, e);
}

/* A fresh database in memory is the list of what there has to be. */
static bool remake_from(struct store *s, int version, int64_t *kept, struct err *e)
{
    struct store fresh = {.path = s->path};
    struct text schema = {0};
    rows_schema(&schema);
    bool ok = sqlite3_open(":memory:", &fresh.db) == SQLITE_OK && store_exec(&fresh, schema.s, e) &&
              remake(s, fresh.db, schema.s, version, kept, e);
    sqlite3_close(fresh.db);
    text_free(&schema);
    return ok;
}

/* Renaming a table must not touch what refers to it, and tables go while others still refer to
 * them. */
static bool begin(struct store *s, struct err *e)
{
    return store_exec(
        s, "PRAGMA foreign_keys = OFF; PRAGMA legacy_alter_table = ON; BEGIN IMMEDIATE", e);
}

/* Ends the transaction either way, and puts the connection's settings back. */
static bool end(struct store *s, bool ok, struct err *e)
{
    ok = ok && store_exec(s, "COMMIT", e);
    if (!ok && !sqlite3_get_autocommit(s->db)) sqlite3_exec(s->db, "ROLLBACK", NULL, NULL, NULL);
    sqlite3_exec(s->db, "PRAGMA legacy_alter_table = OFF; PRAGMA foreign_keys = ON", NULL, NULL,
                 NULL);
    return ok;
}

static void tell_kept(int64_t kept, struct text *told)
{
    if (kept > 0)
        text_add(told, "; %lld runs cannot be described by this program any more: table run_older "
                       "says why",
                 (long long)kept);
}

/* --- the old one beside ----------------------------------------------------------------------- */

/* A copy of the database as it was before this transaction, into the new file `to`. Another
 * connection reads it: this one holds the lock for writing and sees its own changes. */
static bool copy_into(struct store *s, const char *to, struct err *e)
{
    struct store reader = {.path = s->path};
    char *sql = sqlite3_mprintf("VACUUM INTO %Q", to);
    bool ok = sqlite3_open_v2(s->path, &reader.db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX,
                              NULL) == SQLITE_OK ||
              store_failed(&reader, e);
    ok = ok && guard_begin(&reader, e) && store_exec(&reader, sql, e);
    sqlite3_free(sql);
    sqlite3_close(reader.db);
    return ok;
}

/* Link `from` to PATH.vN, or PATH.vN.K where that is taken: an earlier backup is never replaced.
 * *name is the one it got, for the caller to free. */
static bool link_free_name(struct store *s, int version, const char *from, struct text *name)
{
    for (int k = 0; k < MOST_BACKUPS; k++) {
        name->length = 0;
        text_add(name, "%s.v%d", s->path, version);
        if (k > 0) text_add(name, ".%d", k);
        if (link(from, name->s) == 0) return true;
        if (errno != EEXIST) return false;
    }
    return false;
}

/* Keep the old database: whole under its name, on the disk, or not there at all. */
static bool back_up(struct store *s, int version, struct text *name, struct err *e)
{
    char *beside = NULL;
    int file = beside_open(s->path, &beside);
    if (file < 0)
        return err_set(e, ERR_CREATE, "cannot keep a copy of database %s: %s", s->path,
                       strerror(errno));
    bool ok = copy_into(s, beside, e);
    if (ok && (fdatasync(file) != 0 || !link_free_name(s, version, beside, name)))
        ok = err_set(e, ERR_IO, "cannot keep a copy of database %s: %s", s->path, strerror(errno));
    unlink(beside);
    close(file);
    free(beside);
    return ok;
}

/* --- both ways -------------------------------------------------------------------------------- */

/* What user_version says now: another program may have upgraded it while this one waited for the
 * lock. */
static bool still(struct store *s, int version, bool *same, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool ok = sqlite3_prepare_v2(s->db, "PRAGMA user_version", -1, &q, NULL) == SQLITE_OK &&
              sqlite3_step(q) == SQLITE_ROW;
    *same = ok && sqlite3_column_int(q, 0) == version;
    if (!ok) store_failed(s, e);
    sqlite3_finalize(q);
    return ok;
}

/* In the user's file. The backup exists before the first change; if the upgrade fails, the file
 * is as it was and the backup goes. */
bool upgrade_file(struct store *s, int version, struct text *told, struct err *e)
{
    struct text name = {0};
    int64_t kept = 0;
    bool same = false, ok = begin(s, e) && still(s, version, &same, e);
    bool backed = ok && same && back_up(s, version, &name, e);
    if (same) ok = ok && backed && remake_from(s, version, &kept, e);
    ok = end(s, ok, e);
    if (backed && !ok) unlink(name.s);
    if (backed && ok) {
        text_add(told, "database %s was of version %d and is now of version %d; the old one is "
                       "kept as %s",
                 s->path, version, STORE_VERSION, name.s);
        tell_kept(kept, told);
        /* The old tables' pages are given back; where that fails they are used again later. */
        sqlite3_exec(s->db, "VACUUM", NULL, NULL, NULL);
    }
    text_free(&name);
    return ok;
}

/* Every page of s->db into the database `to`, with the log's pages. */
static bool copy_pages(struct store *s, sqlite3 *to, struct err *e)
{
    sqlite3_backup *b = sqlite3_backup_init(to, "main", s->db, "main");
    if (b != NULL) sqlite3_backup_step(b, -1);
    int code = b != NULL ? sqlite3_backup_finish(b) : sqlite3_errcode(to);
    if (code == SQLITE_OK) return true;
    return err_set(e,
                   code == SQLITE_BUSY    ? ERR_BUSY
                   : code == SQLITE_NOMEM ? ERR_INTERNAL
                                          : ERR_IO,
                   "database %s could not be copied for reading: %s", s->path,
                   sqlite3_errstr(code));
}

/* For a reader: its file stays untouched. The copy takes the place of s->db. */
bool upgrade_copy(struct store *s, int version, struct text *told, struct err *e)
{
    sqlite3 *copy = NULL;
    int64_t kept = 0;
    /* An empty name: a private file in the folder for temporary files, removed when it is
     * closed. */
    bool ok = sqlite3_open("", &copy) == SQLITE_OK && copy_pages(s, copy, e);
    if (!ok) {
        if (e->kind == ERR_NONE)
            err_set(e, ERR_IO, "no temporary file for a copy of database %s", s->path);
        sqlite3_close(copy);
        return false;
    }
    sqlite3_close(s->db);
    s->db = copy;
    if (!guard_begin(s, e)) return false;
    ok = end(s, begin(s, e) && remake_from(s, version, &kept, e), e);
    if (!ok) return false;
    text_add(told,
             "database %s is of version %d: read through an upgraded copy; `mimdsim query "
             "--upgrade %s` upgrades it",
             s->path, version, s->path);
    tell_kept(kept, told);
    return true;
}
