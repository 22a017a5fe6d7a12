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
extern const unsigned schema_front_cells, schema_front_page; /* 0: there is no front */
extern const size_t schema_front_bytes; /* what lies behind them is never looked at by the front */

/* image_write: a whole new database into the empty file `file`, in WAL mode or with a rollback
 * journal. Returns false with errno set. */
bool image_write(int file, bool wal);

/* image_put: the (size) bytes of a database into the empty file `file`, with the journal as above;
 * all of it where `front` alone is seen of the bytes. Returns false with errno set. */
bool image_put(int file, const unsigned char *image, size_t size, bool front, bool wal);

/* image_load: the same into the empty database `db` in memory; with `front` what a single run needs
 * of it alone (make_image.c), where the image knows that. Returns false with db's error set. */
bool image_load(sqlite3 *db, bool front);

/* image_has_front: whether it does. image_show: from now on all is seen of the bytes of such a
 * database, by an open connection, too, unless it is in a transaction. Nothing may have been
 * created or dropped before. */
bool image_has_front(void);
void image_show(unsigned char *bytes);

/* image_take: the empty database `db` becomes that of the (size) bytes of sqlite3_malloc, which it
 * owns. Returns false with db's error set. */
bool image_take(sqlite3 *db, unsigned char *bytes, size_t size);

#endif
