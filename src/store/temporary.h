/* temporary.h - tables that live as long as the connection: what a verb computed and a figure's
 * query reads.
 *
 * They belong to a connection that was opened for reading, too: the database itself is never
 * changed. */
#ifndef STORE_TEMPORARY_H
#define STORE_TEMPORARY_H

#include "store/store.h"

/* store_temporary: make the table temp.`name` anew, with these columns ("x REAL, curve TEXT"); all
 * of it is this program's own text. Returns false with ERR_IO. */
bool store_temporary(struct store *s, const char *name, const char *columns, struct err *e);

/* store_temporary_row: one row into temp.`name`, (n) values in the order of its columns. */
bool store_temporary_row(struct store *s, const char *name, int n, const struct store_value *value,
                         struct err *e);

/* store_only: from now on this connection, opened for reading, is one to a passing copy of the
 * database that holds only the runs whose numbers are in the JSON array `run_ids`, with all that
 * belongs to them. */
bool store_only(struct store *s, const char *run_ids, struct err *e);

#endif
