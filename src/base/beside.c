/* beside.c - files that are written beside their place, never through a link, and what a crash
 * left of them.
 *
 * A file is made under a name of its own, PATH.new-XXXXXX.part, and gets its real name when it
 * is whole. A lock tells a cleaner whether the maker still lives; the lock ends with the
 * process, however that ends. */
#include "base/beside.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/whole.h"

static const char middle[] = BESIDE_MIDDLE, ending[] = BESIDE_ENDING, journal[] = "-journal";
enum { DRAWN = 6 };

/* Locked, where the file system has locks, and still there: a cleaner may have come between the
 * making and the lock. */
static bool is_ours(int file)
{
    struct stat info;
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    return fstat(file, &info) == 0 && info.st_nlink > 0;
}

int beside_open(const char *path, char **name)
{
    /* A cleaner may take a new file between its making and its lock: then try another one. */
    for (int trial = 0; trial < 100; trial++) {
        struct text t = {0};
        text_add(&t, "%s%sXXXXXX%s", path, middle, ending);
        int file = mkostemps(t.s, (int)strlen(ending), O_CLOEXEC);
        if (file >= 0 && is_ours(file)) {
            /* mkostemps makes it for its owner alone; others may read a database as they may any
             * new file. */
            mode_t mask = umask(0);
            umask(mask);
            fchmod(file, 0666 & ~mask);
            *name = t.s;
            return file;
        }
        int code = errno;
        text_free(&t);
        if (file < 0) {
            *name = NULL;
            errno = code;
            return -1;
        }
        close(file);
    }
    /* A hundred in a row: the folder is not usable. */
    *name = NULL;
    errno = EAGAIN;
    return -1;
}

bool beside_is_draft(const char *name, const char *own)
{
    size_t n = strlen(own), m = sizeof middle - 1;
    if (strlen(name) != n + m + DRAWN + sizeof ending - 1) return false;
    if (strncmp(name, own, n) != 0 || strncmp(name + n, middle, m) != 0) return false;
    for (int i = 0; i < DRAWN; i++)
        if (!isalnum((unsigned char)name[n + m + (size_t)i])) return false;
    return strcmp(name + n + m + DRAWN, ending) == 0;
}

/* Remove `name` in folder `dir` when it is a plain file of ours that nobody writes. */
static void remove_left(int dir, const char *name)
{
    struct stat info, found;
    int file = openat(dir, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return;
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(file, LOCK_EX | LOCK_NB) == 0 &&
        fstatat(dir, name, &found, AT_SYMLINK_NOFOLLOW) == 0 && found.st_dev == info.st_dev &&
        found.st_ino == info.st_ino) {
        struct text log = {0};
        unlinkat(dir, name, 0);
        /* What a database that was being made had beside itself goes with it. */
        text_add(&log, "%s%s", name, journal);
        unlinkat(dir, log.s, 0);
        text_free(&log);
    }
    close(file);
}

void beside_clean(const char *path)
{
    /* The folder with its slash, "./" or "DIR/.". */
    const char *slash = strrchr(path, '/'), *own = slash == NULL ? path : slash + 1;
    struct text folder = {0};
    text_add(&folder, "%.*s.", slash == NULL ? 0 : (int)(slash - path) + 1, path);
    DIR *dir = opendir(folder.s);
    for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;)
        if (beside_is_draft(entry->d_name, own)) remove_left(dirfd(dir), entry->d_name);
    if (dir != NULL) closedir(dir);
    text_free(&folder);
}

/* --- whole files ------------------------------------------------------------------------------ */

/* What a name leads to through links; itself where nothing is there yet. */
static char *target_of(const char *path)
{
    char *real = realpath(path, NULL);
    if (real != NULL) return real;
    /* Else a link would be replaced by a file for lack of memory. */
    if (errno == ENOMEM) check_memory(0);
    return memory_text(path);
}

bool beside_begin(struct beside *b, const char *path, struct err *e)
{
    struct stat info;
    *b = (struct beside){.path = target_of(path)};
    const bool there = stat(b->path, &info) == 0;
    /* What is no file cannot be replaced by one: a terminal, a pipe, /dev/null. */
    if (there && !S_ISREG(info.st_mode)) b->out = fopen(b->path, "we");
    else {
        beside_clean(b->path);
        int file = beside_open(b->path, &b->name);
        /* A file that is replaced leaves its permissions. */
        if (file >= 0 && there) (void)!fchmod(file, info.st_mode & 0777);
        b->out = file >= 0 ? fdopen(file, "w") : NULL;
        const int why = errno;
        if (file >= 0 && b->out == NULL) close(file), unlink(b->name);
        errno = why;
    }
    if (b->out != NULL) return true;
    err_set(e, errno == ENOMEM ? ERR_INTERNAL : ERR_CREATE, "cannot make %s: %s", path,
            strerror(errno));
    free(b->name);
    free(b->path);
    *b = (struct beside){0};
    return false;
}

bool beside_end(struct beside *b, bool keep, struct err *e)
{
    /* stdio remembers that a write failed, but not why: the flush tells of the last part. */
    errno = b->why;
    bool bad = ferror(b->out) != 0 || b->why != 0;
    if (fclose(b->out) != 0) bad = true;
    if (!bad && keep && b->name != NULL) bad = rename(b->name, b->path) != 0;
    if (keep && bad)
        err_set(e, ERR_IO, "writing %s failed: %s", b->path,
                errno != 0 ? strerror(errno) : "a part of it could not be written");
    if (b->name != NULL && (bad || !keep)) unlink(b->name);
    free(b->name);
    free(b->path);
    *b = (struct beside){0};
    return !bad;
}

bool beside_write(const char *path, const void *data, size_t size, struct err *e)
{
    struct beside b;
    if (!beside_begin(&b, path, e)) return false;
    if (!write_whole(fileno(b.out), data, size)) b.why = errno;
    return beside_end(&b, true, e);
}
