/* connection.h - what the files of this room share: the open database and its prepared statements.
 *
 * Statements are prepared when first used and kept: preparing costs more than stepping. */
#ifndef STORE_CONNECTION_H
#define STORE_CONNECTION_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/check.h"
#include "base/err.h"

/* X(name, sql): the statements that store_put and store_has use again and again. Those without a
 * text insert a row of a table that is made of columns (rows.h). */
#define STORE_STATEMENTS(X)                                                                        \
    X(RUN_FIND, "SELECT id, status FROM run WHERE config_hash = ?1 AND seed = ?2 AND rep = ?3")    \
    X(RUN_CALL, "UPDATE run SET label = ?4 WHERE config_hash = ?1 AND seed = ?2 AND rep = ?3")     \
    X(RUN_DELETE, "DELETE FROM run WHERE id = ?1")                                                 \
    X(RUN_CLEAR, "DELETE FROM run")                                                                \
    X(BUILD_ADD,                                                                                   \
      "INSERT OR IGNORE INTO build (version, git, compiler, flags) VALUES (?1, ?2, ?3, ?4)")       \
    X(BUILD_FIND,                                                                                  \
      "SELECT id FROM build WHERE version = ?1 AND git = ?2 AND compiler = ?3 AND flags = ?4")     \
    X(SETTING_ADD, "INSERT INTO setting (key, value, number, unit) VALUES (?1, ?2, ?3, ?4)")       \
    X(SETTING_FIND, "SELECT id FROM setting WHERE key = ?1 AND value = ?2")                        \
    X(RUN_SETTINGS, "INSERT INTO run_setting SELECT ?1, value FROM json_each(?2)")                 \
    X(FIRST_SETTINGS,                                                                              \
      "INSERT INTO run_setting SELECT ?1, id FROM setting NOT INDEXED ORDER BY id")                \
    X(BEGIN, "BEGIN IMMEDIATE")                                                                    \
    X(COMMIT, "COMMIT")                                                                            \
    X(PROGRAM_LINE, "INSERT INTO program_line VALUES (?1, ?2, ?3, ?4, ?5)")                        \
    X(RUN_INSERT, NULL)                                                                            \
    X(STAGE, NULL)                                                                                 \
    X(RANK_TIMES, "INSERT INTO rank_times VALUES (?1, ?2)")                                        \
    X(LINK_LOADS, "INSERT INTO link_loads VALUES (?1, ?2)")                                        \
    X(BASELINE, NULL)                                                                              \
    X(ERROR_CHECK, NULL)                                                                           \
    X(OMISSION, NULL)                                                                              \
    X(SPAN, NULL)

enum statement {
#define X(name, sql) STATEMENT_##name,
    STORE_STATEMENTS(X)
#undef X
        STATEMENT_COUNT
};

enum {
    STORE_APPLICATION = 0x6d696d64, /* "mimd" */
    STORE_VERSION =
        10, /* of schema.sql, in user_version; to be raised, too, when a default changes */
    STORE_OLDEST = 4,        /* the oldest version that is upgraded */
    STORE_BUSY_MS = 2000,    /* how long another program's lock is waited for while nobody writes */
    STORE_RANK_ROWS = 256,   /* more ranks: table rank_times stays empty */
    STORE_LINK_ROWS = 16384, /* link loads kept of one run */
    STORE_SPAN_ROWS = 20000, /* a longer timeline is a file */
    STORE_LINE_ROWS = 1000,  /* lines of output kept of one run */
    STORE_KEPT = 48          /* statements kept by their texts: all claims of a study and more */
};

/* A prepared statement and the text that it was prepared from, both owned; NULL, NULL: none. */
struct kept {
    char *sql;
    sqlite3_stmt *statement;
};

struct store {
    sqlite3 *db; /* owned */
    char *path;  /* owned */
    char *remark; /* owned, what is to be told about opening it, NULL: nothing */
    bool writable;
    bool fresh;                               /* its file was made by this store_open */
    bool unpublished;                         /* STORE_WHOLE: its file is still to be made */
    bool front;                               /* it shows what a single run needs alone (image.h) */
    bool passing;                             /* STORE_MEMORY: what only people read is not kept */
    bool had_settings;                        /* some were put, and may be there */
    bool in_transaction;                      /* store_begin's */
    /* when others wrote last, and since when nobody has (guard.c) */
    int64_t busy_change, busy_since_ms;
    /* row of this program in table build, 0: not looked up yet */
    int64_t build_id;
    struct settings *settings; /* owned, of the run that was put last (settings.h), NULL: none */
    sqlite3_stmt *statement[STATEMENT_COUNT]; /* owned, NULL until used */
    struct kept kept[STORE_KEPT];             /* of other texts, in no order */
    int replaced;                             /* the next of them to be given up */
};

/* store_forget: the prepared statements are prepared anew when they are used again. */
void store_forget(struct store *s);

/* store_statement: the prepared statement, reset and without bindings; NULL with the error set. */
sqlite3_stmt *store_statement(struct store *s, enum statement which, struct err *e);

/* store_kept: the statement that was kept for `sql`, without bindings, taken out so that whoever
 * uses it is alone; NULL: there is none. store_keep: takes over `q`, prepared from `sql` and no
 * longer in use, for the next one who asks. */
sqlite3_stmt *store_kept(struct store *s, const char *sql);
void store_keep(struct store *s, const char *sql, sqlite3_stmt *q);

/* store_step: run a statement that returns no row, and reset it. */
bool store_step(struct store *s, sqlite3_stmt *statement, struct err *e);

/* store_find_id: run a statement that finds the id of a row, and reset it; *id 0: there is none.
 * Returns false with the error set. */
bool store_find_id(struct store *s, sqlite3_stmt *statement, int64_t *id, struct err *e);

/* store_bound: what binding a parameter has returned. One that there was no memory for would be
 * NULL in a row; like any refused memory (memory.h), it ends the process. */
static inline void store_bound(int code)
{
    if (code == SQLITE_NOMEM) check_memory(0);
}

/* store_cell: the text in `column` of the present row, until the next one; NULL is "". */
static inline const char *store_cell(sqlite3_stmt *q, int column)
{
    const bool null = sqlite3_column_type(q, column) == SQLITE_NULL;
    const char *text = (const char *)sqlite3_column_text(q, column);
    if (text == NULL && !null) check_memory(0);
    return text != NULL ? text : "";
}

/* store_next: the next row of `q`: *row tells whether there is one. Returns false with the error
 * set when the rows end for any other reason than that there are no more. */
bool store_next(struct store *s, sqlite3_stmt *q, bool *row, struct err *e);

/* store_failed: set *e from the database's last error: what went wrong, in which file. Returns
 * false. */
bool store_failed(struct store *s, struct err *e);

/* store_number: the integer that `sql` (a pragma or a count) returns. Returns false with the error
 * set. */
bool store_number(struct store *s, const char *sql, int64_t *out, struct err *e);

/* store_exec: run SQL text that returns nothing of interest. */
bool store_exec(struct store *s, const char *sql, struct err *e);

#endif
