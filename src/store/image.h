/* image.h - a new database as the bytes of its file, made while the program was built.
 *
 * Parsing the schema takes longer than a small run; copying its pages takes a few microseconds. */
#ifndef STORE_IMAGE_H
#define STORE_IMAGE_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stddef.h>

/* The bytes, written by make_image.c in the build; 0 of them where the build could not run it: then
 * the functions below make them from the schema's text. */
extern const unsigned char schema_image[];
extern const size_t schema_image_bytes;

/* image_write: a whole new database into the empty file `file`, in WAL mode or with a rollback
 * journal. Returns false with errno set. */
bool image_write(int file, bool wal);

/* image_put: the (size) bytes of a database into the empty file `file`, with the journal as above.
 * Returns false with errno set. */
bool image_put(int file, const unsigned char *image, size_t size, bool wal);

/* image_load: the same into the empty database `db` in memory. Returns false with db's error
 * set. */
bool image_load(sqlite3 *db);

#endif
