/* publish.c - how the file of a new database comes to its place: whole, under its name at once.
 *
 * It is written beside its place, flushed, and linked there. A kill before the link leaves no
 * database; a kill behind it, all of it. */
#include "store/publish.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "base/beside.h"
#include "base/memory.h"
#include "base/text.h"
#include "store/image.h"

/* Whether `path` is on a file system that several hosts share. Magic numbers of statfs(2): NFS,
 * SMB, CIFS, SMB2, Lustre, GPFS, BeeGFS, 9P, Ceph, AFS and FUSE. */
bool publish_network(const char *path)
{
    static const unsigned magic[] = {0x6969,     0x517B,     0xFF534D42, 0xFE534D42,
                                     0x0BD00BD0, 0x47504653, 0x19830326, 0x01021997,
                                     0x00C36400, 0x5346414F, 0x65735546};
    struct statfs info;
    if (statfs(path, &info) != 0) return false;
    for (size_t i = 0; i < sizeof magic / sizeof magic[0]; i++)
        if ((unsigned)info.f_type == magic[i]) return true;
    return false;
}

/* Up to the last slash; the present folder where there is none. */
char *publish_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder =
        slash == NULL ? memory_text("./") : memory_text_part(path, (size_t)(slash - path) + 1);
    return folder;
}

/* Logs of a database that was removed after a crash would be taken for the new one's. */
static void remove_stale_logs(const char *path)
{
    static const char *const suffix[] = {"-wal", "-shm", "-journal"};
    for (int i = 0; i < 3; i++) {
        struct text log = {0};
        text_add(&log, "%s%s", path, suffix[i]);
        if (access(log.s, F_OK) == 0 && access(path, F_OK) != 0) unlink(log.s);
        text_free(&log);
    }
}

/* What has its name by now stays. */
void publish_drop(struct published *b)
{
    if (b->file >= 0) {
        unlink(b->name);
        close(b->file);
    }
    free(b->name);
}

/* Write the (size) bytes of `image`, NULL: an empty database, and link the file to `path`. Flushed
 * before it has its name: a power cut leaves all of it or nothing. */
bool publish_place(const char *path, const unsigned char *image, size_t size, bool front,
                   struct published *b, struct err *e)
{
    char *folder = publish_folder(path);
    const bool wal = !publish_network(folder);
    free(folder);
    remove_stale_logs(path);
    b->file = beside_open(path, &b->name);
    bool ok = b->file >= 0 &&
              (image != NULL ? image_put(b->file, image, size, front, wal)
                             : image_write(b->file, wal)) &&
              fdatasync(b->file) == 0;
    if (ok && link(b->name, path) != 0) {
        b->late = errno == EEXIST;
        /* A file system without links: rename, which could replace a file that appeared
         * meanwhile. */
        ok = b->late || rename(b->name, path) == 0;
    }
    return ok || err_set(e, b->file < 0 ? ERR_CREATE : ERR_IO, "cannot make database %s: %s", path,
                         strerror(errno));
}

bool publish_new(const char *path, struct err *e)
{
    struct published b = {.file = -1};
    const bool ok = publish_place(path, NULL, 0, false, &b, e);
    publish_drop(&b);
    return ok;
}
