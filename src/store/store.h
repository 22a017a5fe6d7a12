/* store.h - the only room that knows SQLite: one row set per run, one transaction each, one writer.
 *
 * A run is identified by (config_hash, seed, rep); storing it again replaces it. Units are in the column names. The
 * schema is src/store/schema.sql; views (v_speedup, v_stage, ...) are for people and for plots/ *.sql. */
#ifndef STORE_STORE_H
#define STORE_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "measure/run_result.h"
#include "spec/run_spec.h"

struct store;
enum store_mode { STORE_READ, STORE_WRITE };

/* store_open: open or (STORE_WRITE) make the database `path`. Returns NULL with ERR_NO_INPUT (read, not there),
 * ERR_DATA (not ours, or newer), ERR_BUSY (locked), ERR_CREATE or ERR_IO (read-only, disk full). */
struct store *store_open(const char *path, enum store_mode mode, struct err *e);

/* store_close: accepts NULL. */
void store_close(struct store *s);

/* store_has: whether a run that ended RUN_OK with this identity is stored (RUN_INVALID and others are run again). */
bool store_has(struct store *s, const struct run_spec *spec);

/* store_put: the run with provenance, in one transaction; nothing is stored on failure. `left_out` is a text list. */
bool store_put(struct store *s, const struct run_spec *spec, const struct run_result *r, const char *left_out,
               struct err *e);

/* store_select: run the query `sql` and hand each row to `row` as text values (NULL for SQL NULL) with the column
 * names; return false from `row` to stop. nparam texts are bound to ?1, ?2, ...
 * Returns false with ERR_DATA when the statement is wrong. */
typedef bool store_row_fn(void *context, int ncolumn, const char *const *name, const char *const *value);
bool store_select(struct store *s, const char *sql, int nparam, const char *const *param, store_row_fn *row,
                  void *context, struct err *e);

#endif
