/* make_image.c - writes src/store/schema_image.c while the program is built: a new database as a
 * constant of bytes.
 *
 * A string is compiled a hundred times faster than a list of numbers. Most bytes are zero, which
 * octal escapes write in two characters. */
#include <stdio.h>
#include <stdlib.h>

#include "store/image.h"
#include "store/rows.h"

enum { LINE_BYTES = 64 };

static void fail(const char *what)
{
    fprintf(stderr, "make_image: %s\n", what);
    exit(1);
}

/* A line is a string of its own: its last escape ends with it. */
static void write_line(const unsigned char *byte, size_t n)
{
    printf("    \"");
    /* An escape of fewer than three digits ends at the first character that is no octal digit: the
     * backslash of the next one. */
    for (size_t i = 0; i < n; i++) printf("\\%o", byte[i]);
    printf("\"\n");
}

int main(void)
{
    struct text t = {0};
    sqlite3 *db = NULL;
    sqlite3_int64 size = 0;
    rows_database(&t);
    if (sqlite3_open(":memory:", &db) != SQLITE_OK) fail("no memory");
    if (sqlite3_exec(db, t.s, NULL, NULL, NULL) != SQLITE_OK) fail(sqlite3_errmsg(db));
    unsigned char *image = sqlite3_serialize(db, "main", &size, 0);
    if (image == NULL) fail("this SQLite has no sqlite3_serialize");
    printf("/* Made by make_image.c. */\n#include \"store/image.h\"\n\nconst size_t "
           "schema_image_bytes = %lld;\nconst unsigned char schema_image[%lld + 1] =\n",
           (long long)size, (long long)size);
    for (sqlite3_int64 at = 0; at < size; at += LINE_BYTES)
        write_line(image + at, (size_t)(size - at < LINE_BYTES ? size - at : LINE_BYTES));
    printf("    ;\n");
    sqlite3_free(image);
    sqlite3_close(db);
    text_free(&t);
    return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
