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
#include "store/rows.h"

/* Bytes 18 and 19 of the header: 2 is WAL, 1 a rollback journal (1.3.3 of the file format). */
enum { HEADER_BYTES = 100, JOURNAL_AT = 18 };

/* Without bytes of the build: from the text, into a database in memory. */
static bool from_text(sqlite3 *db)
{
    struct text t = {0};
    rows_database(&t);
    const bool ok = sqlite3_exec(db, t.s, NULL, NULL, NULL) == SQLITE_OK;
    text_free(&t);
    return ok;
}

static bool write_all(int file, const unsigned char *bytes, size_t size)
{
    /* write may take less than it is given. */
    for (size_t done = 0; done < size;) {
        const ssize_t n = write(file, bytes + done, size - done);
        if (n < 0 && errno != EINTR) return false;
        if (n > 0) done += (size_t)n;
    }
    return true;
}

/* The header is the only part that differs, so the rest is written from where it lies. */
bool image_put(int file, const unsigned char *image, size_t size, bool wal)
{
    unsigned char header[HEADER_BYTES];
    memcpy(header, image, sizeof header);
    header[JOURNAL_AT] = header[JOURNAL_AT + 1] = wal ? 2 : 1;
    return write_all(file, header, sizeof header) &&
           write_all(file, image + sizeof header, size - sizeof header);
}

bool image_write(int file, bool wal)
{
    if (schema_image_bytes > 0) return image_put(file, schema_image, schema_image_bytes, wal);
    sqlite3 *db = NULL;
    sqlite3_int64 size = 0;
    unsigned char *image = NULL;
    if (sqlite3_open(":memory:", &db) == SQLITE_OK && from_text(db))
        image = sqlite3_serialize(db, "main", &size, 0);
    sqlite3_close(db);
    /* Nothing but memory can be short here. */
    errno = ENOMEM;
    const bool ok = image != NULL && image_put(file, image, (size_t)size, wal);
    sqlite3_free(image);
    return ok;
}

/* SQLite works on a copy of the bytes as on a file: pages that nobody asks for are never looked
 * at. */
bool image_load(sqlite3 *db)
{
    if (schema_image_bytes == 0) return from_text(db);
    const sqlite3_int64 size = (sqlite3_int64)schema_image_bytes;
    unsigned char *copy = sqlite3_malloc64(schema_image_bytes);
    if (copy == NULL) check_memory(schema_image_bytes);
    memcpy(copy, schema_image, schema_image_bytes);
    sqlite3_int64 most = INT64_MAX; /* instead of 1 GiB */
    const unsigned how = SQLITE_DESERIALIZE_RESIZEABLE | SQLITE_DESERIALIZE_FREEONCLOSE;
    return sqlite3_deserialize(db, "main", copy, size, size, how) == SQLITE_OK &&
           sqlite3_file_control(db, "main", SQLITE_FCNTL_SIZE_LIMIT, &most) == SQLITE_OK;
}
