/* fuzz_database.h - a small database of ours, and everything that the program reads of a
 * stranger's. */
#ifndef TESTS_FUZZ_FUZZ_DATABASE_H
#define TESTS_FUZZ_FUZZ_DATABASE_H

#include "fuzz.h"
#include "store/store.h"

/* database_image: the bytes of a database with two runs and their timelines; made once, the same
 * every time. */
const uint8_t *database_image(size_t *size);

/* database_read: all that verbs read of the database `path`: every view, query, claim and figure,
 * the audit, the report, the timelines, the merging into another one. Each either works or is
 * refused with a reason. */
void database_read(const char *path);

/* database_columns: "TABLE COLUMN" of every column of every table, for changes; *n of them. */
const char *const *database_columns(size_t *n);

#endif
