/* make_image.c - writes src/store/schema_image.c while the program is built: a new database as a
 * constant of bytes.
 *
 * A string is compiled a hundred times faster than a list of numbers. Most bytes are zero, which
 * octal escapes write in two characters. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/image.h"
#include "store/rows.h"

enum { LINE_BYTES = 64 };

/* What a plan of one run writes and its table reads. These are made first, so that they are the
 * first rows of the table of the schema (image_hide). */
static const char *const front[] = {
    "meta",        "build",        "run",        "setting",      "run_setting",
    "stage",       "rank_times",   "baseline",   "error_check",  "link_loads",
    "span",        "run_omission", "run_family", "program_line", "ladder",
    "uncertainty", "v_speedup",    "v_setting",  "v_unlimited",  "v_known_error"};
enum { FRONT = sizeof front / sizeof *front };

static void fail(const char *what)
{
    fprintf(stderr, "make_image: %s\n", what);
    exit(1);
}

/* Whether the statement makes one of these, or an index of one. */
static bool is_front(const char *sql)
{
    static const char *const form[] = {"CREATE TABLE %s (", "CREATE TABLE IF NOT EXISTS %s (",
                                       "CREATE VIEW %s AS", "CREATE VIEW IF NOT EXISTS %s AS",
                                       " ON %s ("};
    for (int i = 0; i < FRONT; i++)
        for (size_t k = 0; k < sizeof form / sizeof *form; k++) {
            char words[80];
            snprintf(words, sizeof words, form[k], front[i]);
            const char *at = strstr(sql, words), *index = strstr(sql, "CREATE INDEX ");
            if (at != NULL && (words[0] == 'C' || (index != NULL && index < at))) return true;
        }
    return false;
}

/* The statements of `sql`, those of the front or the others, one after the other. */
static void run_some(sqlite3 *db, const char *sql, bool of_front)
{
    struct text one = {0};
    for (; *sql != '\0'; sql++) {
        text_add_bytes(&one, sql, 1);
        if (*sql != ';' || !sqlite3_complete(one.s)) continue;
        if (is_front(one.s) == of_front &&
            sqlite3_exec(db, one.s, NULL, NULL, NULL) != SQLITE_OK)
            fail(sqlite3_errmsg(db));
        one.length = 0;
    }
    text_free(&one);
}

/* The row of the schema's table behind which nothing of the front is. */
static sqlite3_int64 last_of_front(sqlite3 *db)
{
    sqlite3_int64 last = 0;
    sqlite3_stmt *q = NULL;
    if (sqlite3_prepare_v2(db, "SELECT max(rowid) FROM sqlite_schema WHERE tbl_name = ?1", -1, &q,
                           NULL) != SQLITE_OK)
        fail(sqlite3_errmsg(db));
    for (int i = 0; i < FRONT; i++) {
        sqlite3_bind_text(q, 1, front[i], -1, SQLITE_STATIC);
        if (sqlite3_step(q) != SQLITE_ROW || sqlite3_column_type(q, 0) == SQLITE_NULL)
            fail(front[i]);
        if (sqlite3_column_int64(q, 0) > last) last = sqlite3_column_int64(q, 0);
        sqlite3_reset(q);
    }
    sqlite3_finalize(q);
    return last;
}

/* All pages so far. */
static sqlite3_int64 size_of(sqlite3 *db)
{
    sqlite3_int64 size = 0;
    unsigned char *image = sqlite3_serialize(db, "main", &size, 0);
    if (image == NULL) fail("this SQLite has no sqlite3_serialize");
    sqlite3_free(image);
    return size;
}

static unsigned number(const unsigned char *byte, int n)
{
    unsigned v = 0;
    for (int i = 0; i < n; i++) v = v << 8 | byte[i];
    return v;
}

/* How many cells of the root of the schema's table are in front, and the page that follows them
 * (1.6 of the file format): a cell is the page of a child and the last row in it. Page 0: the root
 * has no children, and all is in front. */
static unsigned cut(const unsigned char *image, sqlite3_int64 last, unsigned *page)
{
    const unsigned char *root = image + 100;
    *page = 0;
    if (root[0] != 5) return 0;
    const unsigned cells = number(root + 3, 2);
    for (unsigned i = 0; i < cells; i++) {
        const unsigned char *cell = image + number(root + 12 + 2 * i, 2), *digit = cell + 4;
        sqlite3_int64 row = 0;
        do row = row << 7 | (*digit & 127);
        while (*digit++ & 128);
        *page = number(cell, 4);
        if (row >= last) return i;
    }
    *page = number(root + 8, 4);
    return cells;
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
    run_some(db, t.s, true);
    const sqlite3_int64 front_bytes = size_of(db);
    run_some(db, t.s, false);
    unsigned char *image = sqlite3_serialize(db, "main", &size, 0);
    if (image == NULL) fail("this SQLite has no sqlite3_serialize");
    unsigned page;
    const unsigned cells = cut(image, last_of_front(db), &page);
    printf("/* Made by make_image.c. */\n#include \"store/image.h\"\n\nconst size_t "
           "schema_image_bytes = %lld, schema_front_bytes = %lld;\nconst unsigned "
           "schema_front_cells = %u, schema_front_page = %u;\nconst unsigned char "
           "schema_image[%lld + 1] =\n",
           (long long)size, (long long)front_bytes, cells, page, (long long)size);
    for (sqlite3_int64 at = 0; at < size; at += LINE_BYTES)
        write_line(image + at, (size_t)(size - at < LINE_BYTES ? size - at : LINE_BYTES));
    printf("    ;\n");
    sqlite3_free(image);
    sqlite3_close(db);
    text_free(&t);
    return fflush(stdout) == 0 && !ferror(stdout) ? 0 : 1;
}
