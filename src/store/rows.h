/* rows.h - the tables that a run fills: their definitions and INSERT statements, made from tables
 * of columns. */
#ifndef STORE_ROWS_H
#define STORE_ROWS_H

#include "measure/column.h"
#include "store/binding.h"

/* rows_insert: the INSERT statement of `which` (STATEMENT_RUN_INSERT, STATEMENT_STAGE, ...): first
 * its keys (schema.sql), then its columns; appended. */
void rows_insert(enum statement which, struct text *sql);

/* rows_schema: the statements of schema.sql, in which the columns of each such table have replaced
 * its "@table@", with all comments; appended. */
void rows_schema(struct text *sql);

/* rows_database: all statements that make a new database: rows_schema, its identity, what table
 * meta holds; appended. */
void rows_database(struct text *sql);

/* rows_bind: bind the columns of `row` behind the keys that *b holds already; texts are borrowed.
 *
 *   row  struct run_row of STATEMENT_RUN_INSERT, else the struct whose columns the table has
 * (run_row.h) */
void rows_bind(enum statement which, struct binding *b, const void *row);

/* The columns of table run that come from the spec (struct run_row): labels, how its level was
 * chosen, all settings. */
extern const struct column_table run_identity_columns, run_level_columns, run_config_columns;

#endif
