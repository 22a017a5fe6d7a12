/* connection.c - statements of an open database, and what its errors mean to a user.
 *
 * Everything that can go wrong on a disk goes wrong here first: each case has a sentence of its
 * own, as a user can do something about most of them. */
#include "store/connection.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/text.h"
#include "store/rows.h"

/* In the order of enum statement; NULL: made from a table of columns (rows.h). */
static const char *const statement_sql[] = {
#define X(name, sql) sql,
    STORE_STATEMENTS(X)
#undef X
};

/* Why the file cannot be opened. SQLite tells of the last thing that it tried, which was a log that
 * is not there or a folder that it looked for: what the user can mend is found out here again. */
static void cannot_open(const struct store *s, int system, const char *text, struct err *e)
{
    const int file = open(s->path, (s->writable ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK);
    int reason = file < 0 ? errno : 0;
    if (file >= 0) close(file);
    /* A writer makes a log beside the file. */
    struct text folder = {0};
    const char *slash = strrchr(s->path, '/');
    text_add(&folder, "%.*s", slash != NULL ? (int)(slash - s->path) + 1 : 2,
             slash != NULL ? s->path : "./");
    if (reason == 0 && s->writable && access(folder.s, W_OK | X_OK) != 0) reason = errno;
    text_free(&folder);
    if (reason == 0) reason = system;
    err_set(e, s->writable ? ERR_CREATE : ERR_NO_INPUT, "cannot open database %s: %s", s->path,
            reason ? strerror(reason) : text);
}

/* What SQLite found, as a sentence for a user: what happened, to which file, and what can be
 * done. The kind decides the exit status. */
bool store_failed(struct store *s, struct err *e)
{
    /* The system's own reason, where there is one: "Permission denied" says more than "disk I/O
     * error". */
    int code = sqlite3_errcode(s->db), system = sqlite3_system_errno(s->db);
    const char *path = s->path, *text = sqlite3_errmsg(s->db);
    /* Extended codes are not enabled: these are the primary ones. */
    switch (code) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL: /* locks of its log that did not come to be for ten seconds */
        return err_set(e, ERR_BUSY,
                       "database %s is locked by another program; try again when that has finished",
                       path);
    case SQLITE_FULL: return err_set(e, ERR_IO, "no space left on the disk of database %s", path);
    case SQLITE_READONLY: return err_set(e, ERR_IO, "database %s is read-only", path);
    case SQLITE_CANTOPEN:
        cannot_open(s, system, text, e);
        return false;
    case SQLITE_IOERR:
        return err_set(e, ERR_IO, "reading or writing database %s failed: %s", path,
                       system ? strerror(system) : text);
    case SQLITE_NOTADB: return err_set(e, ERR_DATA, "%s is not a database of mimdsim", path);
    case SQLITE_CORRUPT: return err_set(e, ERR_DATA, "database %s is damaged: %s", path, text);
    case SQLITE_OK: /* a call that keeps no code, such as deserialising: only memory fails there */
    case SQLITE_NOMEM: return err_set(e, ERR_INTERNAL, "no memory for database %s", path);
    default: return err_set(e, ERR_DATA, "database %s: %s", path, text);
    }
}

bool store_exec(struct store *s, const char *sql, struct err *e)
{
    return sqlite3_exec(s->db, sql, NULL, NULL, NULL) == SQLITE_OK || store_failed(s, e);
}

bool store_number(struct store *s, const char *sql, int64_t *out, struct err *e)
{
    sqlite3_stmt *q = NULL;
    const bool ok =
        sqlite3_prepare_v2(s->db, sql, -1, &q, NULL) == SQLITE_OK && sqlite3_step(q) == SQLITE_ROW;
    if (ok) *out = sqlite3_column_int64(q, 0);
    else store_failed(s, e);
    sqlite3_finalize(q);
    return ok;
}

/* Prepared once per connection: a campaign stores thousands of rows, and preparing takes longer
 * than storing one. */
sqlite3_stmt *store_statement(struct store *s, enum statement which, struct err *e)
{
    sqlite3_stmt **kept = &s->statement[which];
    if (*kept != NULL) return *kept;
    struct text sql = {0};
    if (statement_sql[which] != NULL) text_add(&sql, "%s", statement_sql[which]);
    else rows_insert(which, &sql);
    if (sqlite3_prepare_v3(s->db, sql.s, -1, SQLITE_PREPARE_PERSISTENT, kept, NULL))
        store_failed(s, e);
    text_free(&sql);
    return *kept;
}

/* Found by their whole texts: most differ within their first bytes. */
sqlite3_stmt *store_kept(struct store *s, const char *sql)
{
    for (int i = 0; i < STORE_KEPT; i++) {
        struct kept *k = &s->kept[i];
        if (k->sql == NULL || strcmp(k->sql, sql) != 0) continue;
        sqlite3_stmt *q = k->statement;
        free(k->sql);
        *k = (struct kept){0};
        return q;
    }
    return NULL;
}

/* What it read is let go, and no binding outlives the text that it borrows. */
void store_keep(struct store *s, const char *sql, sqlite3_stmt *q)
{
    int at = 0;
    while (at < STORE_KEPT && s->kept[at].sql != NULL) at++;
    /* All places are taken: one after the other is given up. */
    if (at == STORE_KEPT) {
        at = s->replaced;
        s->replaced = (at + 1) % STORE_KEPT;
    }
    struct kept *k = &s->kept[at];
    sqlite3_finalize(k->statement);
    free(k->sql);
    sqlite3_reset(q);
    sqlite3_clear_bindings(q);
    *k = (struct kept){memory_text(sql), q};
}

void store_forget(struct store *s)
{
    for (int i = 0; i < STATEMENT_COUNT; i++) sqlite3_finalize(s->statement[i]);
    memset(s->statement, 0, sizeof s->statement);
    for (int i = 0; i < STORE_KEPT; i++) {
        sqlite3_finalize(s->kept[i].statement);
        free(s->kept[i].sql);
    }
    memset(s->kept, 0, sizeof s->kept);
}

/* A loop that ends at the first step without a row would take an error for the end. */
bool store_next(struct store *s, sqlite3_stmt *q, bool *row, struct err *e)
{
    const int code = sqlite3_step(q);
    *row = code == SQLITE_ROW;
    return *row || code == SQLITE_DONE || store_failed(s, e);
}

bool store_step(struct store *s, sqlite3_stmt *statement, struct err *e)
{
    bool ok = sqlite3_step(statement) == SQLITE_DONE || store_failed(s, e);
    sqlite3_reset(statement);
    return ok;
}

bool store_find_id(struct store *s, sqlite3_stmt *statement, int64_t *id, struct err *e)
{
    const int code = sqlite3_step(statement);
    const bool ok = code == SQLITE_ROW || code == SQLITE_DONE || store_failed(s, e);
    *id = code == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
    sqlite3_reset(statement);
    return ok;
}
