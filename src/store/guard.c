/* guard.c - a database file is input like any other: what is set before it is read, and what must
 * be true of it.
 *
 * sum() of whole numbers is an error in SQLite where it leaves 64 bits, which ends the query, and
 * with it a report of a whole database for the sake of one run: sums of times of many ranks come
 * that far. Here such a sum goes on as a real number, as all other arithmetic of SQLite does. */
#include "store/guard.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/text.h"
#include "store/rows.h"

/* Longest text or blob [B], longest statement [B]: beyond what this program stores, within what a
 * small computer has. */
enum { MOST_LENGTH = 64 << 20, MOST_STATEMENT = 4 << 20 };

/* --- sum ------------------------------------------------------------------------------------- */

/* 128 bits hold 2^64 numbers of 64 bits. SQLite's memory is aligned to 8 bytes only, which is what
 * the compiler is told: it might use instructions that want 16. */
struct __attribute__((packed, aligned(8))) sum {
    __int128 whole;
    double real; /* of those that are no whole numbers */
    int64_t n, nreal;
};

static void sum_change(sqlite3_context *c, sqlite3_value *v, int sign)
{
    struct sum *s = sqlite3_aggregate_context(c, sizeof *s);
    const int type = sqlite3_value_numeric_type(v);
    if (s == NULL || type == SQLITE_NULL) return;
    s->n += sign;
    if (type == SQLITE_INTEGER) s->whole += sign * (__int128)sqlite3_value_int64(v);
    else {
        s->nreal += sign;
        s->real += sign * sqlite3_value_double(v);
    }
}

/* NULL adds nothing, as in SQLite's own. */
static void sum_step(sqlite3_context *c, int n, sqlite3_value **v)
{
    (void)n;
    sum_change(c, v[0], 1);
}

/* The first row of a window leaves it. */
static void sum_inverse(sqlite3_context *c, int n, sqlite3_value **v)
{
    (void)n;
    sum_change(c, v[0], -1);
}

/* A whole number as long as it is one and fits; the sum of no rows is NULL. */
static void sum_value(sqlite3_context *c)
{
    const struct sum *s = sqlite3_aggregate_context(c, 0);
    if (s == NULL || s->n == 0) sqlite3_result_null(c);
    else if (s->nreal > 0) sqlite3_result_double(c, (double)s->whole + s->real);
    else if (s->whole >= INT64_MIN && s->whole <= INT64_MAX)
        sqlite3_result_int64(c, (sqlite3_int64)s->whole);
    else sqlite3_result_double(c, (double)s->whole);
}

/* --- locks ----------------------------------------------------------------------------------- */

/* When somebody wrote last: the log, or the file itself with a rollback journal. */
static int64_t last_change(const struct store *s)
{
    int64_t latest = 0;
    static const char *const ending[] = {"-wal", ""};
    for (int i = 0; i < 2; i++) {
        struct stat info;
        struct text path = {0};
        text_add(&path, "%s%s", s->path, ending[i]);
        if (stat(path.s, &info) == 0) {
            const int64_t t = info.st_mtim.tv_sec * INT64_C(1000000000) + info.st_mtim.tv_nsec;
            if (t > latest) latest = t;
        }
        text_free(&path);
    }
    return latest;
}

/* A clock that nobody sets. */
static int64_t now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * INT64_C(1000) + t.tv_nsec / 1000000;
}

/* Called by SQLite while another holds the lock. Many writers get it one after the other: whoever
 * waits gives up when nobody has written for STORE_BUSY_MS. */
static int wait_for_lock(void *context, int tries)
{
    struct store *s = context;
    const int64_t change = last_change(s), now = now_ms();
    if (tries == 0 || change != s->busy_change) {
        s->busy_change = change;
        s->busy_since_ms = now;
    }
    if (now - s->busy_since_ms >= STORE_BUSY_MS) return 0;
    /* The lock of a run's transaction is held for less than a millisecond, that of a merge for
     * longer. Short at first; later with some disorder, so that waiters do not come back
     * together. */
    const long ms = tries < 8 ? 1 << tries / 2 : 8 + (now + (int64_t)(uintptr_t)s / 64) % 24;
    nanosleep(&(struct timespec){0, ms * 1000000}, NULL);
    return 1;
}

/* --- what is set ----------------------------------------------------------------------------- */

void guard_library(void)
{
    /* Refused, which is no harm, once the library is in use; looking for a file system is use
     * enough. */
    sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
    /* One thread of the process has databases; the threads of a run compute. A small run would take
     * some twenty thousand locks that nobody else asks for. */
    sqlite3_config(SQLITE_CONFIG_SINGLETHREAD);
}

bool guard_begin(struct store *s, struct err *e)
{
    sqlite3_busy_handler(s->db, wait_for_lock, s);
    sqlite3_limit(s->db, SQLITE_LIMIT_LENGTH, MOST_LENGTH);
    sqlite3_limit(s->db, SQLITE_LIMIT_SQL_LENGTH, MOST_STATEMENT);
    const bool set =
        sqlite3_db_config(s->db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL) == SQLITE_OK &&
        sqlite3_db_config(s->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL) == SQLITE_OK &&
        sqlite3_db_config(s->db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL) == SQLITE_OK &&
        sqlite3_create_window_function(
            s->db, "sum", 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS, NULL, sum_step,
            sum_value, sum_value, sum_inverse, NULL) == SQLITE_OK;
    return (set || store_failed(s, e)) && store_exec(s, "PRAGMA cell_size_check = ON", e);
}

/* --- the schema ------------------------------------------------------------------------------ */

/* What a statement means: without comments, blanks as one, none beside punctuation. */
static void add_plain(const char *sql, size_t n, struct text *out)
{
    bool blank = false;
    for (size_t i = 0; i < n;) {
        if (sql[i] == '-' && i + 1 < n && sql[i + 1] == '-') {
            while (i < n && sql[i] != '\n') i++;
        } else if (isspace((unsigned char)sql[i])) {
            blank = true;
            i++;
        } else if (sql[i] == '\'') {
            /* A text is itself, up to its end. */
            const size_t from = i++;
            while (i < n && sql[i] != '\'') i++;
            if (i < n) i++;
            text_add_bytes(out, sql + from, i - from);
            blank = false;
        } else {
            const bool word = isalnum((unsigned char)sql[i]) || sql[i] == '_';
            const char last = out->length > 0 ? out->s[out->length - 1] : ' ';
            if (blank && word && (isalnum((unsigned char)last) || last == '_')) text_add(out, " ");
            text_add_bytes(out, &sql[i++], 1);
            blank = false;
        }
    }
}

/* Our schema as one plain text, its statements ended by ';'. IF NOT EXISTS is not stored. */
static void own_schema(struct text *plain)
{
    struct text all = {0};
    static const char unstored[] = "IF NOT EXISTS ";
    rows_schema(&all);
    for (char *at = all.s; (at = strstr(at, unstored)) != NULL;)
        memset(at, ' ', sizeof unstored - 1);
    text_add(plain, ";");
    add_plain(all.s, all.length, plain);
    text_free(&all);
}

/* Whether the statement `sql`, of an object called `name`, is one of ours, word by word. */
static bool is_own(const struct text *own, const char *sql)
{
    struct text one = {0};
    text_add(&one, ";");
    add_plain(sql, strlen(sql), &one);
    text_add(&one, ";");
    const bool found = strstr(own->s, one.s) != NULL;
    text_free(&one);
    return found;
}

/* Whether we make an object of this name: "CREATE TABLE run(". */
static bool is_own_name(const struct text *own, const char *name)
{
    static const char *const kind[] = {"TABLE", "VIEW", "INDEX"};
    static const char *const behind[] = {"(", " AS ", " ON "};
    bool found = false;
    for (int i = 0; i < 3; i++) {
        struct text one = {0};
        text_add(&one, ";CREATE %s %s%s", kind[i], name, behind[i]);
        found = found || strstr(own->s, one.s) != NULL;
        text_free(&one);
    }
    return found;
}

/* One row of the schema's table. */
/* The order matters: a view called `run` is a view of another, but first of all not our table. */
static bool check_object(const struct text *own, const char *path, const char *type,
                         const char *name, const char *sql, struct err *e)
{
    /* Indices that SQLite makes for keys, and its own tables, have no text or a reserved name. */
    if (sql[0] == '\0' || strncmp(name, "sqlite_", 7) == 0 || is_own(own, sql)) return true;
    if (is_own_name(own, name))
        return err_set(e, ERR_DATA,
                       "database %s: %s '%.60s' is not the one that mimdsim makes in version %d; "
                       "somebody has changed the schema",
                       path, type, name, STORE_VERSION);
    /* Views of the user's own are run by nobody but the user; a trigger would act on our
     * statements. */
    return strcmp(type, "trigger") != 0 ||
           err_set(e, ERR_DATA,
                   "database %s has a trigger '%.60s', which mimdsim has not made and does not run",
                   path, name);
}

/* SQLite before 3.41 takes even its functions of JSON, which a view of ours has, for unsafe. */
void guard_trust(struct store *s)
{
    sqlite3_db_config(s->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 1, NULL);
}

bool guard_schema(struct store *s, const char *schema, const char *path, struct err *e)
{
    sqlite3_stmt *q = NULL;
    struct text sql = {0}, own = {0};
    own_schema(&own);
    text_add(&sql, "SELECT type, name, coalesce(sql, '') FROM \"%s\".sqlite_schema", schema);
    bool row = true,
         ok = sqlite3_prepare_v2(s->db, sql.s, -1, &q, NULL) == SQLITE_OK || store_failed(s, e);
    while (ok && (ok = store_next(s, q, &row, e)) && row) {
        const char *word[3];
        for (int i = 0; i < 3; i++) word[i] = store_cell(q, i);
        ok = check_object(&own, path, word[0], word[1], word[2], e);
    }
    sqlite3_finalize(q);
    text_free(&sql);
    text_free(&own);
    if (ok) guard_trust(s);
    return ok;
}

/* --- the rows -------------------------------------------------------------------------------- */

/* What the check found. A page that could not be had for lack of memory, or for the disk, is told
 * in the same words as one that is damaged, but for its number, SQLite's result code. */
static bool refuse_rows(const struct store *s, const char *found, struct err *e)
{
    static const char code[] = "error code=";
    const char *at = strstr(found, code);
    const long number = at != NULL ? strtol(at + sizeof code - 1, NULL, 10) & 0xff : 0;
    if (number == SQLITE_NOMEM)
        return err_set(e, ERR_INTERNAL, "no memory for database %s", s->path);
    if (number == SQLITE_IOERR) return err_set(e, ERR_IO, "reading database %s failed", s->path);
    /* of the pages behind a long row it tells no number: a page beyond the end has other words */
    if (strstr(found, "failed to get page") != NULL)
        return err_set(e, ERR_INTERNAL, "no memory for database %s, or its disk fails: %s", s->path,
                       found);
    return err_set(e, ERR_DATA, "database %s is damaged: %s", s->path, found);
}

/* SQLite's own check, of which one finding is enough. It reads all pages once, as a report does;
 * the full check of indices would sort them. A row that passes has what its table promises, so that
 * nobody who reads it has to ask whether a name is there. */
bool guard_rows(struct store *s, struct err *e)
{
    sqlite3_stmt *q = NULL;
    bool row = false,
         ok = sqlite3_prepare_v2(s->db, "PRAGMA quick_check(1)", -1, &q, NULL) == SQLITE_OK
                  ? store_next(s, q, &row, e)
                  : store_failed(s, e);
    /* "ok", or what is wrong: "NULL value in run.status", "CHECK constraint failed in span". */
    const char *found = ok && row ? store_cell(q, 0) : NULL;
    if (found != NULL && strcmp(found, "ok") != 0) ok = refuse_rows(s, found, e);
    sqlite3_finalize(q);
    return ok;
}
