/* image.c - see image.h.
 *
 * The bytes are those of a database that SQLite itself made (make_image.c): its file format is
 * fixed and the same on every host (sqlite.org/fileformat2.html). */
#include "store/image.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"
#include "base/whole.h"
#include "store/rows.h"

/* Bytes 18 and 19 of the header: 2 is WAL, 1 a rollback journal (1.3.3 of the file format). The
 * root of the schema's table follows the header (1.6). */
enum {
    HEADER_BYTES = 100,
    JOURNAL_AT = 18,
    CELLS_AT = HEADER_BYTES + 3,
    LAST_PAGE_AT = HEADER_BYTES + 8,
    BEGIN_BYTES = HEADER_BYTES + 12
};

/* Without bytes of the build: from the text, into a database in memory. */
static bool from_text(sqlite3 *db)
{
    struct text t = {0};
    rows_database(&t);
    const bool ok = sqlite3_exec(db, t.s, NULL, NULL, NULL) == SQLITE_OK;
    text_free(&t);
    return ok;
}

/* How many cells and which last page the root has that shows all. */
static void show_root(unsigned char *bytes)
{
    memcpy(bytes + CELLS_AT, schema_image + CELLS_AT, 2);
    memcpy(bytes + LAST_PAGE_AT, schema_image + LAST_PAGE_AT, 4);
}

/* Only the beginning differs, so the rest is written from where it lies. What the front does not
 * see is that of the build. */
bool image_put(int file, const unsigned char *image, size_t size, bool front, bool wal)
{
    unsigned char begin[BEGIN_BYTES];
    const size_t seen = front ? schema_front_bytes : size;
    memcpy(begin, image, sizeof begin);
    begin[JOURNAL_AT] = begin[JOURNAL_AT + 1] = wal ? 2 : 1;
    if (front) show_root(begin);
    return write_whole(file, begin, sizeof begin) &&
           write_whole(file, image + sizeof begin, seen - sizeof begin) &&
           (!front ||
            (write_whole(file, schema_image + seen, schema_image_bytes - seen) &&
             write_whole(file, image + schema_image_bytes, size - schema_image_bytes)));
}

bool image_write(int file, bool wal)
{
    if (schema_image_bytes > 0)
        return image_put(file, schema_image, schema_image_bytes, false, wal);
    sqlite3 *db = NULL;
    sqlite3_int64 size = 0;
    unsigned char *image = NULL;
    if (sqlite3_open(":memory:", &db) == SQLITE_OK && from_text(db))
        image = sqlite3_serialize(db, "main", &size, 0);
    sqlite3_close(db);
    /* Nothing but memory can be short here. */
    errno = ENOMEM;
    const bool ok = image != NULL && image_put(file, image, (size_t)size, false, wal);
    sqlite3_free(image);
    return ok;
}

/* SQLite works on the bytes as on a file: pages that nobody asks for are never looked at. */
bool image_take(sqlite3 *db, unsigned char *bytes, size_t size)
{
    sqlite3_int64 most = INT64_MAX, n = (sqlite3_int64)size; /* most: instead of 1 GiB */
    const unsigned how = SQLITE_DESERIALIZE_RESIZEABLE | SQLITE_DESERIALIZE_FREEONCLOSE;
    return sqlite3_deserialize(db, "main", bytes, n, n, how) == SQLITE_OK &&
           sqlite3_file_control(db, "main", SQLITE_FCNTL_SIZE_LIMIT, &most) == SQLITE_OK;
}

/* ---- the front ----
 *
 * SQLite parses the text of every table and view before its first statement, which takes longer
 * than a small run. The rows of the schema's table lie in pages below its root, in the order in
 * which they were made, and the root is the first page of the file: with fewer cells it has fewer
 * rows. Tables of the front were made first, so the pages of the others follow theirs: nobody looks
 * at them, and they are not even copied before all is shown. */

bool image_has_front(void) { return schema_front_page > 0; }

/* Numbers of the file format have their highest byte first. */
static void put_number(unsigned char *at, unsigned v, int n)
{
    for (int i = n - 1; i >= 0; i--, v >>= 8) at[i] = (unsigned char)v;
}

bool image_load(sqlite3 *db, bool front)
{
    if (schema_image_bytes == 0) return from_text(db);
    unsigned char *copy = sqlite3_malloc64(schema_image_bytes);
    if (copy == NULL) check_memory(schema_image_bytes);
    memcpy(copy, schema_image, front ? schema_front_bytes : schema_image_bytes);
    if (front) {
        put_number(copy + CELLS_AT, schema_front_cells, 2);
        put_number(copy + LAST_PAGE_AT, schema_front_page, 4);
    }
    return image_take(db, copy, schema_image_bytes);
}

/* A number of the header goes up by one. */
static void count_up(unsigned char *at)
{
    unsigned v = 0;
    for (int i = 0; i < 4; i++) v = v << 8 | at[i];
    put_number(at, v + 1, 4);
}

/* By its counters SQLite knows that pages, and the schema, are others than it has read (1.3 of the
 * file format: change counter, schema cookie, and for which change the size of the file holds). */
void image_show(unsigned char *bytes)
{
    static const int counter[] = {24, 40, 92};
    show_root(bytes);
    memcpy(bytes + schema_front_bytes, schema_image + schema_front_bytes,
           schema_image_bytes - schema_front_bytes);
    for (int i = 0; i < 3; i++) count_up(bytes + counter[i]);
}
