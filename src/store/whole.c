/* whole.c - a new database that gets its file at the end (STORE_WHOLE).
 *
 * A file of SQLite that several programs may use at once costs a small run two more files, some
 * sixty locks and five flushes, which is most of what it takes. A plan of one run has one moment at
 * which there is something to keep: until then its rows lie in memory, then they are written as one
 * file. A kill before that leaves no database, as a kill before the commit would have left an empty
 * one. */
#include "base/check.h"
#include "store/connection.h"
#include "store/image.h"
#include "store/merge.h"
#include "store/publish.h"

/* Rows of ours go into a database that another program made while we were at work. */
static bool add_to(const char *path, const char *beside, struct err *e)
{
    struct store_merged done;
    struct store *theirs = store_open(path, STORE_WRITE, e);
    const bool ok = theirs != NULL && store_merge(theirs, beside, &done, e);
    store_close(theirs);
    return ok;
}

/* In place: a connection whose database is exchanged, as by sqlite3_deserialize, goes on using the
 * schema of the old one for json_each (SQLite 3.40). */
void store_show(struct store *s)
{
    if (!s->front) return;
    CHECK(!s->in_transaction);
    sqlite3_int64 size = 0;
    unsigned char *bytes = sqlite3_serialize(s->db, "main", &size, SQLITE_SERIALIZE_NOCOPY);
    CHECK(bytes != NULL); /* a front is one of bytes that lie in memory */
    image_show(bytes);
    s->front = false;
}

bool store_publish(struct store *s, struct err *e)
{
    if (!s->unpublished) return true;
    CHECK(!s->in_transaction);
    struct published b = {.file = -1};
    sqlite3_int64 size = 0;
    /* The bytes where they lie, when the database was made of bytes; else a copy. */
    unsigned char *own = sqlite3_serialize(s->db, "main", &size, SQLITE_SERIALIZE_NOCOPY),
                  *copy = own == NULL ? sqlite3_serialize(s->db, "main", &size, 0) : NULL;
    if (own == NULL && copy == NULL) check_memory(0);
    /* The file has all tables and views; what lies here goes on as before. */
    const bool ok =
        publish_place(s->path, own != NULL ? own : copy, (size_t)size, s->front, &b, e) &&
        (!b.late || add_to(s->path, b.name, e));
    publish_drop(&b);
    sqlite3_free(copy);
    s->unpublished = !ok;
    return ok;
}
