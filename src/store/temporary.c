/* temporary.c - temporary tables and passing copies of a database that is only read; see
 * temporary.h.
 *
 * A reader's connection forbids changes (query_only), which holds for temporary tables as well. It
 * is lifted for one statement of this program's own; no text of a user comes near it. */
#include "store/temporary.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "store/connection.h"

enum { MOST_VALUES = 32 };

/* Changes are allowed, or forbidden again. */
static bool allow(struct store *s, bool allowed, struct err *e)
{
    if (s->writable) return true;
    return store_exec(s, allowed ? "PRAGMA query_only = OFF" : "PRAGMA query_only = ON", e);
}

bool store_temporary(struct store *s, const char *name, const char *columns, struct err *e)
{
    struct text sql = {0};
    text_add(&sql, "DROP TABLE IF EXISTS temp.\"%s\"; CREATE TEMP TABLE \"%s\" (%s)", name, name,
             columns);
    /* Forbidden again whatever happened in between. */
    bool ok = allow(s, true, e) && store_exec(s, sql.s, e);
    ok = allow(s, false, e) && ok;
    text_free(&sql);
    return ok;
}

/* "INSERT INTO temp.x VALUES (?, ?)" */
static void insert_statement(const char *name, int n, struct text *sql)
{
    text_add(sql, "INSERT INTO temp.\"%s\" VALUES (", name);
    for (int i = 0; i < n; i++) text_add(sql, i > 0 ? ", ?" : "?");
    text_add(sql, ")");
}

/* By its kind; texts live until the step. */
static void bind(sqlite3_stmt *q, int at, const struct store_value *v)
{
    switch (v->kind) {
    case STORE_NULL: store_bound(sqlite3_bind_null(q, at)); break;
    case STORE_INT: store_bound(sqlite3_bind_int64(q, at, v->integer)); break;
    case STORE_REAL: store_bound(sqlite3_bind_double(q, at, v->real)); break;
    case STORE_TEXT: store_bound(sqlite3_bind_text(q, at, v->text, -1, SQLITE_STATIC)); break;
    }
}

bool store_temporary_row(struct store *s, const char *name, int n, const struct store_value *value,
                         struct err *e)
{
    CHECK(n <= MOST_VALUES);
    struct text sql = {0};
    sqlite3_stmt *q = NULL;
    insert_statement(name, n, &sql);
    bool ok = allow(s, true, e) &&
              (sqlite3_prepare_v2(s->db, sql.s, -1, &q, NULL) == SQLITE_OK || store_failed(s, e));
    for (int i = 0; ok && i < n; i++) bind(q, i + 1, &value[i]);
    ok = ok && (sqlite3_step(q) == SQLITE_DONE || store_failed(s, e));
    sqlite3_finalize(q);
    text_free(&sql);
    return allow(s, false, e) && ok;
}

/* All pages of the database into a private file that SQLite removes when it is closed. */
static sqlite3 *copy_of(struct store *s, struct err *e)
{
    sqlite3 *copy = NULL;
    bool ok = sqlite3_open("", &copy) == SQLITE_OK;
    sqlite3_backup *b = ok ? sqlite3_backup_init(copy, "main", s->db, "main") : NULL;
    /* With the pages of its log, in one go: a database that others write is seen at one moment. */
    if (b != NULL) sqlite3_backup_step(b, -1);
    ok = b != NULL && sqlite3_backup_finish(b) == SQLITE_OK;
    if (ok) return copy;
    err_set(e, ERR_IO, "database %s could not be copied for reading", s->path);
    sqlite3_close(copy);
    return NULL;
}

/* The rows of all other runs go, and with them, by their foreign keys, what belongs to them. */
bool store_only(struct store *s, const char *run_ids, struct err *e)
{
    CHECK(!s->writable);
    sqlite3 *copy = copy_of(s, e);
    if (copy == NULL) return false;
    /* From here on the store is the copy; its file is untouched and no longer open. Statements that
     * were prepared for the file would go on asking it. */
    store_forget(s);
    sqlite3_close(s->db);
    s->db = copy;
    sqlite3_stmt *q = NULL;
    bool ok = store_exec(s, "PRAGMA foreign_keys = ON", e) &&
              (sqlite3_prepare_v2(s->db, "DELETE FROM run WHERE id NOT IN"
                                         " (SELECT value FROM json_each(?1))",
                                  -1, &q, NULL) == SQLITE_OK ||
               store_failed(s, e));
    if (ok) {
        store_bound(sqlite3_bind_text(q, 1, run_ids, -1, SQLITE_STATIC));
        ok = sqlite3_step(q) == SQLITE_DONE || store_failed(s, e);
    }
    sqlite3_finalize(q);
    return allow(s, false, e) && ok;
}
