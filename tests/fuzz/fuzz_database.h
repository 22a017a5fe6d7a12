/* fuzz_database.h - a small database of ours, and everything that the program reads of a
 * stranger's. */
#ifndef TESTS_FUZZ_FUZZ_DATABASE_H
#define TESTS_FUZZ_FUZZ_DATABASE_H

#include "fuzz.h"
#include "store/store.h"

/* database_image: the bytes of a database with two runs and their timelines; made once, the same
 * every time. */
const uint8_t *database_image(size_t *size);

/* database_read: what verbs read of the database `path`: views, queries, claims, figures, the
 * audit, the report, timelines, the merging into another one. Each either works or is refused with
 * a reason. All of it takes 30 ms: of an input that a search made, only the part of number
 * `chosen`, modulo their number, is read, which is twenty times as fast; of a file of the corpus
 * all (fuzz_is_whole). */
void database_read(const char *path, size_t chosen);

/* database_columns: "TABLE COLUMN" of every column of every table, for changes; *n of them. */
const char *const *database_columns(size_t *n);

#endif
