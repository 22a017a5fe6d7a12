/* store.h - the only room that knows SQLite: one row set per run, one transaction each, one writer.
 *
 * A run is identified by (config_hash, seed, rep); storing it again replaces it. Units are in the
 * column names. The schema is src/store/schema.sql with the columns of rows.h; views (v_speedup,
 * v_stage, ...) are for people and for plots/ *.sql. docs/database.md describes all of it. */
#ifndef STORE_STORE_H
#define STORE_STORE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/err.h"
#include "base/text.h"
#include "measure/column.h"
#include "measure/run_result.h"
#include "spec/run_spec.h"

struct store;
enum store_mode {
    STORE_READ,
    STORE_WRITE,
    STORE_MEMORY, /* a passing database without a file: `path` is a name for messages; settings and
                     rows of single ranks are not kept */
    STORE_SCRATCH, /* the same with all rows */
    STORE_WHOLE    /* as STORE_WRITE, but a new database gets its file from store_publish alone */
};

/* store_open: open or (all but STORE_READ) make the database `path`. One of an older version is
 * upgraded: in its file with STORE_WRITE, the old one kept beside it; in a temporary copy with
 * STORE_READ; store_remark tells it. Returns NULL with ERR_NO_INPUT (read, not there), ERR_DATA
 * (not ours, newer, or too old), ERR_BUSY (locked), ERR_CREATE or ERR_IO (read-only, disk full). */
struct store *store_open(const char *path, enum store_mode mode, struct err *e);

/* store_publish: a database of STORE_WHOLE that has no file yet gets one, with all rows that were
 * committed, whole or not at all; where another program made the file meanwhile, the rows are added
 * to its. Without it such a database ends with store_close. Others: nothing to do. Returns false
 * with ERR_CREATE, ERR_IO, or as store_open and store_merge (merge.h). */
bool store_publish(struct store *s, struct err *e);

/* store_show: from here on a new database of STORE_WHOLE has all its tables and views, not those of
 * runs alone; others: nothing to do. Not within a transaction. */
void store_show(struct store *s);

/* store_remark: a sentence for the user about how the database was opened, NULL: nothing to say. */
const char *store_remark(const struct store *s);

/* store_upgrade: make the database `path`, which has to be there, one of this version. *told (owned
 * by the caller) says what was done. Returns false as store_open. */
bool store_upgrade(const char *path, struct text *told, struct err *e);

/* store_close: accepts NULL. */
void store_close(struct store *s);

/* store_has: whether a run that ended RUN_OK with this identity is stored (RUN_INVALID and others
 * are run again). */
bool store_has(struct store *s, const struct run_spec *spec);

/* store_call: the stored run of this identity, if there is one, is called as `spec` is
 * (run_label.h) from now on. */
bool store_call(struct store *s, const struct run_spec *spec, struct err *e);

/* store_put: the run with provenance and how its level was chosen (`order`, NULL: by the spec), in
 * one transaction; nothing is stored on failure. */
bool store_put(struct store *s, const struct run_spec *spec, const struct run_order *order,
               const struct run_result *r, struct err *e);

/* store_clear: a passing database is to hold other runs: all that it holds go, which takes less
 * time than another database. */
bool store_clear(struct store *s, struct err *e);

/* store_note_build: this program in table build, for rows that belong to no run; store_put does it
 * by itself. */
bool store_note_build(struct store *s, struct err *e);

/* One value of a row, as stored: non-finite reals become NULL. */
struct store_value {
    enum store_kind { STORE_NULL, STORE_INT, STORE_REAL, STORE_TEXT } kind;
    int64_t integer;
    double real;
    const char *text;           /* borrowed; of a row read: valid until the row function returns */
};

/* store_null, store_int, store_real, store_text: a value of that kind; text may be NULL, which is
 * SQL NULL. */
struct store_value store_null(void);
struct store_value store_int(int64_t v);
struct store_value store_real(double v);
struct store_value store_text(const char *v);

/* store_insert: one row into `table` (schema.sql), replacing the row with the same key; a
 * transaction of its own unless store_begin opened one.
 *
 *   name, value  in  (ncolumn <= 64) columns of the table; those left out get their default
 *
 *   Returns false with ERR_DATA (no such table or column, a value that the table forbids), ERR_BUSY
 * or ERR_IO. */
bool store_insert(struct store *s, const char *table, int ncolumn, const char *const *name,
                  const struct store_value *value, struct err *e);

/* store_insert_row: as store_insert, the columns of `t` with their values in `row`, behind (n) keys
 * of other origin. */
bool store_insert_row(struct store *s, const char *table, int n, const char *const *name,
                      const struct store_value *value, const struct column_table *t,
                      const void *row, struct err *e);

/* store_delete: remove the rows of `table` where `column` equals `value` (a suite that is filled
 * anew). */
bool store_delete(struct store *s, const char *table, const char *column, struct store_value value,
                  struct err *e);

/* store_begin: open one transaction around several store_put, store_insert and store_delete;
 * store_commit makes them last, store_rollback forgets them, and does nothing where none is open.
 * They do not nest. */
bool store_begin(struct store *s, struct err *e);
bool store_commit(struct store *s, struct err *e);
void store_rollback(struct store *s);

/* store_run_id: the row of this identity in table run, 0 when it is not stored. */
int64_t store_run_id(struct store *s, const struct run_spec *spec);

/* store_select: run the query `sql` and hand each row to `row` as text values (NULL for SQL NULL)
 * with the column names; return false from `row` to stop. nparam texts are bound to ?1, ?2, ...
 * Returns false with ERR_DATA when the statement is wrong. */
typedef bool store_row_fn(void *context, int ncolumn, const char *const *name,
                          const char *const *value);
bool store_select(struct store *s, const char *sql, int nparam, const char *const *param,
                  store_row_fn *row, void *context, struct err *e);

/* store_query: as store_select, with each value in its own kind. `header`, when not NULL, is called
 * once before the rows, also when there are none; then `value` is NULL. */
typedef bool store_value_fn(void *context, int ncolumn, const char *const *name,
                            const struct store_value *value);
bool store_query(struct store *s, const char *sql, int nparam, const char *const *param,
                 store_value_fn *header, store_value_fn *row, void *context, struct err *e);

/* store_document: the manual of the database in Markdown: every table, view and column with its
 * type in a line. Returns false as store_open. */
bool store_document(FILE *out, struct err *e);

/* store_path: the file name it was opened with. */
const char *store_path(const struct store *s);

#endif
