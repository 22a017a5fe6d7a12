/* outcome.c - what a command has left (outcome.h). Hundreds of thousands of folders are looked at,
 * and nearly all of their files are those of the folder before: what was found in a file is kept
 * for as long as its bytes are the same. */
#include "outcome.h"

#include <errno.h>
#include <ftw.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const unsigned long long none = 14695981039346656037ULL; /* FNV-1a, 64 bits */

static unsigned long long print_of(unsigned long long print, const void *data, size_t n)
{
    for (const unsigned char *c = data; n > 0; n--, c++) print = (print ^ *c) * 1099511628211ULL;
    return print;
}

bool ends_in(const char *s, const char *end)
{
    const size_t n = strlen(s), m = strlen(end);
    return n >= m && strcmp(s + n - m, end) == 0;
}

_Noreturn void die(const char *what)
{
    fprintf(stderr, "every: %s: %s\n", what, strerror(errno));
    exit(2);
}

/* --- databases -------------------------------------------------------------------------------- */

/* The rows of a query as a print; *bad when it cannot be asked. */
static unsigned long long rows_of(sqlite3 *db, const char *sql, bool *bad)
{
    unsigned long long print = none;
    sqlite3_stmt *q = NULL;
    int code = sqlite3_prepare_v2(db, sql, -1, &q, NULL);
    while (code == SQLITE_OK || code == SQLITE_ROW) {
        code = sqlite3_step(q);
        for (int i = 0; code == SQLITE_ROW && i < sqlite3_column_count(q); i++) {
            const char *text = (const char *)sqlite3_column_text(q, i);
            if (text) print = print_of(print, text, strlen(text) + 1);
        }
    }
    if (code != SQLITE_DONE) *bad = true;
    sqlite3_finalize(q);
    return print;
}

/* Whether it is whole; its rows, but for what the host's clock says, as a print. */
static unsigned long long look_at_database(const char *path, char *why, size_t size)
{
    sqlite3 *db = NULL;
    bool bad = sqlite3_open_v2(path, &db, SQLITE_OPEN_READWRITE, NULL) != SQLITE_OK;
    const unsigned long long whole = rows_of(
                                 db, "SELECT integrity_check FROM pragma_integrity_check", &bad),
                             ok = print_of(none, "ok", 3);
    if (bad || whole != ok) snprintf(why, size, "%s is damaged", path);
    if (rows_of(db, "SELECT \"table\" FROM pragma_foreign_key_check", &bad) != none)
        snprintf(why, size, "%s: rows refer to rows that are not there", path);
    unsigned long long print =
        rows_of(db,
                "SELECT r.config_hash, r.status, r.makespan_ps, r.digest, (SELECT count(*) FROM "
                "stage WHERE run_id = r.id), (SELECT count(*) FROM run_setting WHERE run_id = "
                "r.id), (SELECT count(*) FROM baseline WHERE run_id = r.id), (SELECT count(*) FROM "
                "error_check WHERE run_id = r.id) FROM run r ORDER BY 1",
                &bad);
    if (bad) snprintf(why, size, "%s cannot be read: %s", path, sqlite3_errmsg(db));
    sqlite3_close(db);
    return print;
}

/* --- files ------------------------------------------------------------------------------------ */

static struct outcome *filled;

/* The bytes of a file as a print; of one that is not there: none. */
static unsigned long long bytes_of(const char *path)
{
    char buffer[8192];
    unsigned long long print = none;
    FILE *in = fopen(path, "rb");
    if (!in && errno != ENOENT) die(path);
    for (size_t n; in && (n = fread(buffer, 1, sizeof buffer, in)) > 0;)
        print = print_of(print, buffer, n);
    if (in) fclose(in);
    return print;
}

/* A database and the bytes in it and in its log are looked at once: that takes milliseconds. */
static unsigned long long rows_once(const char *path, unsigned long long bytes)
{
    enum { KEPT = 4096 };
    static struct {
        unsigned long long key, rows;
        char bad[256];
    } kept[KEPT];
    char log[256];
    snprintf(log, sizeof log, "%s-wal", path);
    unsigned long long key = bytes ^ bytes_of(log) * 31 ^ print_of(none, path, strlen(path));
    const size_t at = key % KEPT;
    if (kept[at].key != key) {
        kept[at].key = key;
        kept[at].bad[0] = '\0';
        kept[at].rows = look_at_database(path, kept[at].bad, sizeof kept[at].bad);
    }
    if (kept[at].bad[0]) snprintf(filled->bad, sizeof filled->bad, "%s", kept[at].bad);
    return kept[at].rows;
}

static int add_file(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info, (void)place;
    if (type != FTW_F || ends_in(path, "-shm")) return 0;
    unsigned long long bytes = bytes_of(path);
    filled->state += print_of(bytes, path, strlen(path)); /* in whatever order they are found */
    if (ends_in(path, "-wal")) return 0;
    if (filled->nfile == OUTCOME_FILES) errno = E2BIG, die(path);
    struct outcome_file *f = &filled->file[filled->nfile++];
    snprintf(f->name, sizeof f->name, "%s", path);
    f->print = bytes;
    return 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const struct outcome_file *)a)->name, ((const struct outcome_file *)b)->name);
}

void outcome_look(struct outcome *o)
{
    o->nfile = 0;
    o->state = 0;
    o->bad[0] = '\0';
    filled = o;
    if (nftw(".", add_file, 8, FTW_PHYS) != 0) die("files");
    /* after all bytes are read: looking writes what a log still holds into its database */
    for (int i = 0; i < o->nfile; i++)
        if (ends_in(o->file[i].name, ".db"))
            o->file[i].print = rows_once(o->file[i].name, o->file[i].print);
    qsort(o->file, (size_t)o->nfile, sizeof *o->file, by_name);
}

const unsigned long long *outcome_find(const struct outcome *o, const char *name)
{
    struct outcome_file key;
    snprintf(key.name, sizeof key.name, "%s", name);
    const struct outcome_file *f =
        bsearch(&key, o->file, (size_t)o->nfile, sizeof *o->file, by_name);
    return f ? &f->print : NULL;
}

bool outcome_same(const struct outcome *a, const struct outcome *b)
{
    if (a->nfile != b->nfile) return false;
    for (int i = 0; i < a->nfile; i++) {
        const unsigned long long *other = outcome_find(b, a->file[i].name);
        if (!other || *other != a->file[i].print) return false;
    }
    return true;
}
