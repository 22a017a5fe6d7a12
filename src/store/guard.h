/* guard.h - a database file is input like any other: what is set before it is read, and what must
 * be true of it.
 *
 * A file of SQLite is a program, too: its views and triggers are SQL of whoever made it, run by
 * every query that names what they stand for. Where the names are ours, only ours are let run. */
#ifndef STORE_GUARD_H
#define STORE_GUARD_H

#include "store/connection.h"

/* guard_library: before the first database is opened: SQLite keeps no statistics of its memory,
 * which costs two locks for each block, and takes no locks at all: one thread has databases. */
void guard_library(void);

/* guard_begin: right after opening, before anything is read: no function that a schema could misuse
 * (trusted_schema, until guard_schema has found it to be ours), no triggers, no writing to the
 * schema's own table, cells checked, limits of lengths; sum() that never fails (guard.c). A lock is
 * waited for as long as the others who hold it write. */
bool guard_begin(struct store *s, struct err *e);

/* guard_schema: whether the schema is the one that this program makes: every table, view and index
 * of ours as it is today, and no trigger. Further tables, indices and views are the user's own,
 * whose queries alone use them. Returns false with ERR_DATA and the name; else as guard_trust.
 * `schema`: "main", or the name of an attached database called `path`. */
bool guard_schema(struct store *s, const char *schema, const char *path, struct err *e);

/* guard_trust: the schema was just made by this program, or compared with it. */
void guard_trust(struct store *s);

/* guard_rows: whether every page can be read and every row keeps the rules of its table: kinds of
 * values, NOT NULL, CHECK. Returns false with ERR_DATA, the table and the column. */
bool guard_rows(struct store *s, struct err *e);

#endif
