/* store.c - opening, checking and closing the database, and transactions.
 *
 * Durability: a run takes milliseconds, so a commit must not wait for the disk. Journal mode WAL
 * with synchronous = NORMAL writes each commit to the log without a flush: after kill -9 the system
 * still holds every committed run; a power cut may lose the last ones, but the log's checksums keep
 * the database whole. Shared memory of WAL does not work over network file systems: there a
 * rollback journal with full flushes is used. */
#include "store/store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/beside.h"
#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "store/connection.h"
#include "store/guard.h"
#include "store/image.h"
#include "store/publish.h"
#include "store/rows.h"
#include "store/schema.h"
#include "store/settings.h"
#include "store/upgrade.h"

/* Whose database it is, and of which version; *empty for one without tables. Checked before any
 * other statement: a database of another program must not be touched. */
static bool check_owner(struct store *s, bool *empty, int64_t *version, struct err *e)
{
    int64_t application = 0, tables = 0;
    if (!store_number(s, "SELECT count(*) FROM sqlite_schema", &tables, e) ||
        !store_number(s, "PRAGMA application_id", &application, e) ||
        !store_number(s, "PRAGMA user_version", version, e))
        return false;
    /* An empty file is a database to SQLite. */
    *empty = tables == 0 && application == 0;
    if (*empty) return true;
    if (application != STORE_APPLICATION)
        return err_set(e, ERR_DATA, "%s is a database of another program, not of mimdsim", s->path);
    if (*version > STORE_VERSION || *version < STORE_OLDEST)
        return err_set(e, ERR_DATA,
                       "database %s has schema version %lld, this program knows "
                       "versions %d to %d; %s",
                       s->path, (long long)*version, STORE_OLDEST, STORE_VERSION,
                       *version > STORE_VERSION ? "use a newer mimdsim"
                                                : "run its scenarios again");
    return true;
}

/* Tables and identity of a new database, in one transaction. */
static bool create_schema(struct store *s, struct err *e)
{
    struct text t = {0};
    rows_database(&t);
    int64_t version;
    bool empty = false,
         ok = store_exec(s, "BEGIN EXCLUSIVE", e) && check_owner(s, &empty, &version, e);
    /* Another program may have made it while we waited for the lock. */
    if (ok && empty) ok = store_exec(s, t.s, e);
    if (ok) ok = store_exec(s, "COMMIT", e);
    if (!ok) sqlite3_exec(s->db, "ROLLBACK", NULL, NULL, NULL);
    text_free(&t);
    return ok;
}

/* See the head of this file. */
static bool set_journal(struct store *s, struct err *e)
{
    return publish_network(s->path)
               ? store_exec(s, "PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL", e)
               : store_exec(s, "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL", e);
}

/* Upgrade by `way`, and keep what it says for store_remark. */
static bool upgrade(struct store *s, int version,
                    bool (*way)(struct store *, int, struct text *, struct err *), struct err *e)
{
    struct text told = {0};
    const bool ok = way(s, version, &told, e);
    s->remark = told.s;
    return ok;
}

/* Make the tables that the database lacks. */
static bool add_tables(struct store *s, struct err *e)
{
    struct text t = {0};
    rows_schema(&t);
    const bool ok = store_exec(s, strstr(t.s, "CREATE TABLE IF NOT EXISTS"), e);
    text_free(&t);
    return ok;
}

/* Everything between opening the file and the first statement of a writer. */
static bool prepare_writer(struct store *s, struct err *e)
{
    bool empty = false;
    int64_t version;
    if (!check_owner(s, &empty, &version, e)) return false;
    if (sqlite3_db_readonly(s->db, "main") == 1)
        return err_set(e, ERR_IO, "database %s is read-only", s->path);
    if ((empty && !create_schema(s, e)) || !set_journal(s, e)) return false;
    if (!empty && version < STORE_VERSION && !upgrade(s, (int)version, upgrade_file, e))
        return false;
    if (empty || s->fresh) guard_trust(s);
    else if (version == STORE_VERSION && !guard_schema(s, "main", s->path, e)) return false;
    /* Tables that came after the first databases of this version; a new one has them all. */
    if (!s->fresh && !add_tables(s, e)) return false;
    /* A lock or a folder that cannot be written shows now, before anything is computed. */
    return store_exec(
        s, "PRAGMA foreign_keys = ON; PRAGMA temp_store = MEMORY; BEGIN IMMEDIATE; COMMIT", e);
}

/* A reader changes nothing: an older database is upgraded in a copy, and query_only forbids the
 * rest. */
static bool prepare_reader(struct store *s, struct err *e)
{
    bool empty = false;
    int64_t version;
    if (!check_owner(s, &empty, &version, e)) return false;
    if (!empty && version < STORE_VERSION && !upgrade(s, (int)version, upgrade_copy, e))
        return false;
    if (!empty &&
        ((version == STORE_VERSION && !guard_schema(s, "main", s->path, e)) || !guard_rows(s, e)))
        return false;
    if (!store_exec(s, "PRAGMA query_only = ON", e)) return false;
    /* Without tables every query would fail with a message about the table. */
    return !empty || err_set(e, ERR_DATA, "%s is an empty database", s->path);
}

/* Whether SQLite takes a path that long: from the root, and with the ending of its log (mxPathname
 * of its os_unix.c, within what the system takes). */
static bool path_fits(const char *path, enum err_kind kind, struct err *e)
{
    const sqlite3_vfs *system = sqlite3_vfs_find(NULL);
    char *folder = publish_folder(path), *root = realpath(folder, NULL);
    const char *name = strrchr(path, '/');
    const size_t most = system != NULL ? (size_t)system->mxPathname - strlen("-journal") : SIZE_MAX,
                 length = strlen(root != NULL ? root : folder) + 1 +
                          strlen(name != NULL ? name + 1 : path);
    free(root);
    free(folder);
    return length <= most ||
           err_set(e, kind, "cannot open database %s: its path has %zu characters from the root, "
                            "SQLite takes at most %zu",
                   path, length, most);
}

/* Mistakes in the path that SQLite would report vaguely, before it is called. *exists when there
 * is a file. */
static bool check_path(const char *path, enum store_mode mode, bool *exists, struct err *e)
{
    struct stat info;
    const enum err_kind kind = mode == STORE_READ ? ERR_NO_INPUT : ERR_CREATE;
    *exists = stat(path, &info) == 0;
    /* SQLite would tell of the first thing that cannot be done with it, such as "Illegal seek". */
    if (*exists && !S_ISREG(info.st_mode))
        return err_set(e, mode == STORE_READ ? ERR_DATA : ERR_CREATE,
                       "%s is %s; a database is a regular file", path,
                       text_file_kind(info.st_mode));
    if (!*exists && errno != ENOENT && errno != ENOTDIR)
        return err_set(e, kind, "cannot open database %s: %s", path, strerror(errno));
    if (!*exists && mode == STORE_READ)
        return err_set(e, ERR_NO_INPUT, "there is no database %s; `mimdsim run` makes one", path);
    if (*exists) return path_fits(path, kind, e);
    char *folder = publish_folder(path);
    bool writable = access(folder, W_OK | X_OK) == 0;
    free(folder);
    /* access has set errno */
    if (!writable) err_set(e, ERR_CREATE, "cannot make database %s: %s", path, strerror(errno));
    return writable && path_fits(path, kind, e);
}

/* A database in WAL mode in a folder that cannot be written opens only when declared unchanging. */
static void reopen_immutable(struct store *s)
{
    struct text uri = {0};
    text_add(&uri, "file:");
    for (const unsigned char *c = (const unsigned char *)s->path; *c; c++)
        /* What has a meaning in a URI is percent-encoded. */
        if (*c == '?' || *c == '#' || *c == '%') text_add(&uri, "%%%02X", *c);
        else text_add_bytes(&uri, (const char *)c, 1);
    text_add(&uri, "?immutable=1");
    sqlite3_close(s->db);
    sqlite3_open_v2(uri.s, &s->db, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX,
                    NULL);
    text_free(&uri);
}

/* With a log the database is in use, or was not closed: only SQLite may read it then. */
static bool log_exists(const char *path)
{
    struct text log = {0};
    text_add(&log, "%s-wal", path);
    bool there = access(log.s, F_OK) == 0;
    text_free(&log);
    return there;
}

/* Where the file may be written, it is opened so, although query_only forbids every change: SQLite
 * removes the log of a WAL database only when its last connection could write. Where not, its log
 * would stay behind: none is made. */
static bool open_reader(struct store *s, struct err *e)
{
    if (sqlite3_open_v2(s->path, &s->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL))
        return store_failed(s, e);
    if (sqlite3_db_readonly(s->db, "main") == 1 && !log_exists(s->path)) reopen_immutable(s);
    int64_t ignored;
    struct err first = {0};
    if (!guard_begin(s, e)) return false;
    /* The first read tells whether the log's shared memory can be used. */
    bool readable = store_number(s, "SELECT count(*) FROM sqlite_schema", &ignored, &first);
    int code = sqlite3_errcode(s->db);
    if (!readable && (code == SQLITE_CANTOPEN || code == SQLITE_READONLY) && !log_exists(s->path))
        reopen_immutable(s);
    return guard_begin(s, e) && prepare_reader(s, e);
}

static bool open_writer(struct store *s, struct err *e)
{
    if (sqlite3_open_v2(s->path, &s->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL))
        return store_failed(s, e);
    return guard_begin(s, e) && prepare_writer(s, e);
}

/* Nothing of it survives store_close, unless it is published. With STORE_MEMORY rows of single
 * ranks and settings are not even made. */
static bool open_memory(struct store *s, enum store_mode mode, struct err *e)
{
    const int how = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
    if (sqlite3_open_v2(":memory:", &s->db, how, NULL) != SQLITE_OK) return store_failed(s, e);
    s->passing = mode == STORE_MEMORY;
    s->unpublished = mode == STORE_WHOLE;
    s->front = s->unpublished && image_has_front();
    if (!guard_begin(s, e)) return false;
    guard_trust(s);
    return (image_load(s->db, s->front) || store_failed(s, e)) &&
           store_exec(s, "PRAGMA foreign_keys = ON; PRAGMA temp_store = MEMORY", e);
}

/* What a crash left is removed by the next writer, not by a reader. */
struct store *store_open(const char *path, enum store_mode mode, struct err *e)
{
    bool exists = true;
    guard_library(); /* before anything else of SQLite's */
    if (mode == STORE_WRITE || mode == STORE_WHOLE) beside_clean(path);
    const bool memory = mode == STORE_MEMORY || mode == STORE_SCRATCH;
    if (!memory && !check_path(path, mode, &exists, e)) return NULL;
    const bool later = !exists && mode == STORE_WHOLE;
    if (!exists && !later && !publish_new(path, e)) return NULL;
    struct store *s = memory_zeroed(1, sizeof *s);
    s->path = memory_text(path);
    s->writable = mode != STORE_READ;
    s->fresh = !exists;
    const bool ok = memory || later ? open_memory(s, mode, e)
                    : s->writable   ? open_writer(s, e)
                                    : open_reader(s, e);
    if (ok) return s;
    store_close(s);
    return NULL;
}

/* Of several programs that close a database at the same moment none is the last one for SQLite,
 * and its logs stay beside it. Whoever sees them opens and closes once more; while another program
 * has the database open they stay, as they should. */
static void remove_logs(const char *path)
{
    struct text log = {0};
    text_add(&log, "%s-shm", path); /* there from the first use to the end of the last */
    for (int trial = 0; trial < 4 && access(log.s, F_OK) == 0; trial++) {
        sqlite3 *db = NULL;
        usleep((useconds_t)(500 * trial));
        if (sqlite3_open_v2(path, &db, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK)
            sqlite3_exec(db, "PRAGMA schema_version", NULL, NULL, NULL);
        sqlite3_close(db);
    }
    text_free(&log);
}

/* Statements first: SQLite refuses to close a database with open ones. A transaction that was
 * not committed is undone. */
void store_close(struct store *s)
{
    if (s == NULL) return;
    store_forget(s);
    if (s->in_transaction) sqlite3_exec(s->db, "ROLLBACK", NULL, NULL, NULL);
    CHECK(sqlite3_close(s->db) == SQLITE_OK);
    if (s->writable && !s->unpublished) remove_logs(s->path);
    settings_forget(s);
    free(s->path);
    free(s->remark);
    free(s);
}

const char *store_path(const struct store *s) { return s->path; }

const char *store_remark(const struct store *s) { return s->remark; }

/* Opening for writing upgrades: all that is left is to say what happened. */
bool store_upgrade(const char *path, struct text *told, struct err *e)
{
    bool exists;
    struct store *s =
        check_path(path, STORE_READ, &exists, e) ? store_open(path, STORE_WRITE, e) : NULL;
    if (s == NULL) return false;
    if (s->remark != NULL) text_add(told, "%s", s->remark);
    else text_add(told, "database %s is of version %d already", path, STORE_VERSION);
    store_close(s);
    return true;
}

bool store_begin(struct store *s, struct err *e)
{
    CHECK(!s->in_transaction);
    sqlite3_stmt *begin = store_statement(s, STATEMENT_BEGIN, e);
    s->in_transaction = begin != NULL && store_step(s, begin, e);
    return s->in_transaction;
}

bool store_commit(struct store *s, struct err *e)
{
    CHECK(s->in_transaction);
    /* SQLite undoes a transaction by itself when memory is refused, also to a statement whose
     * failure does not matter: what stood in it is lost all the same. */
    if (sqlite3_get_autocommit(s->db)) {
        store_rollback(s);
        return err_set(e, ERR_INTERNAL, "no memory for database %s: its last rows were not stored",
                       s->path);
    }
    sqlite3_stmt *commit = store_statement(s, STATEMENT_COMMIT, e);
    /* A commit can fail (disk full): then nothing of the transaction is kept. */
    if (commit == NULL || !store_step(s, commit, e)) {
        store_rollback(s);
        return false;
    }
    s->in_transaction = false;
    return true;
}

void store_rollback(struct store *s)
{
    if (!s->in_transaction) return; /* it did not begin, or its end has failed */
    /* Some errors (disk full) have rolled back already. */
    if (!sqlite3_get_autocommit(s->db)) sqlite3_exec(s->db, "ROLLBACK", NULL, NULL, NULL);
    s->in_transaction = false;
    /* rows that were put may have been forgotten, too */
    s->build_id = 0;
    settings_forget(s);
}
