/* draft_folder.c - see draft_folder.h.
 *
 * Other programs write where they like and as slowly as they like. In a folder of its own a half
 * of a file is no harm: it has no name that anybody reads, and whoever ends early leaves a folder
 * that the next one removes. A lock tells who still lives, as for single files (beside.h). */
#include "base/draft_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/beside.h"
#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"

enum { TRIALS = 100 };

static bool is_dots(const char *name) { return strcmp(name, ".") == 0 || strcmp(name, "..") == 0; }

/* The entries of an open folder, NULL: none can be had; to be closed with closedir. */
static DIR *entries(int folder)
{
    /* Another descriptor: closedir would close the one with the lock. */
    const int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *dir = copy >= 0 ? fdopendir(copy) : NULL;
    if (dir == NULL && copy >= 0) close(copy);
    return dir;
}

/* Files go, folders stay: nobody makes one here. */
static void empty(int folder)
{
    DIR *dir = entries(folder);
    for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;)
        if (!is_dots(entry->d_name)) unlinkat(folder, entry->d_name, 0);
    if (dir != NULL) closedir(dir);
}

/* Remove `name` in `parent` when it is a folder of ours in which nobody works: whoever gets the
 * lock of it is alone. */
static void remove_left(int parent, const char *name)
{
    struct stat info;
    const int folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    if (fstat(folder, &info) == 0 && info.st_uid == geteuid() &&
        flock(folder, LOCK_EX | LOCK_NB) == 0) {
        empty(folder);
        unlinkat(parent, name, AT_REMOVEDIR);
    }
    close(folder);
}

/* What processes left that have ended without their last words. */
static void clean(const char *place, const char *own)
{
    const int parent = open(place, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *dir = parent >= 0 ? entries(parent) : NULL;
    for (struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;)
        if (beside_is_draft(entry->d_name, own)) remove_left(parent, entry->d_name);
    if (dir != NULL) closedir(dir);
    if (parent >= 0) close(parent);
}

/* Six digits of base 36: the number of the process tells apart those that live at one time, the
 * trial what is there already. */
static void draw_letters(int trial, char letters[7])
{
    static const char digit[] = "0123456789abcdefghijklmnopqrstuvwxyz";
    uint64_t x = (uint64_t)getpid() * TRIALS + (uint64_t)trial;
    for (int i = 0; i < 6; i++, x /= 36) letters[i] = digit[x % 36];
    letters[6] = '\0';
}

/* Made and locked. A cleaner may have come between the two: then it has no name any more, and the
 * next trial makes another. Returns false with errno. */
static bool make(struct draft_folder *d, const char *path, int trial)
{
    struct text name = {0};
    struct stat info;
    char letters[7];
    draw_letters(trial, letters);
    text_add(&name, "%s" BESIDE_MIDDLE "%s" BESIDE_ENDING, path, letters);
    /* mkdir follows no link and takes nothing that is there. */
    d->lock = mkdir(name.s, 0777) == 0 ? open(name.s, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    d->path = name.s;
    const bool locked = d->lock >= 0 && flock(d->lock, LOCK_EX | LOCK_NB) == 0;
    /* Where the file system has no locks, nobody else gets one either. */
    const bool ours = d->lock >= 0 && (locked || errno != EWOULDBLOCK) &&
                      fstat(d->lock, &info) == 0 && info.st_nlink > 0;
    if (ours) return true;
    const int why = d->lock >= 0 ? EEXIST : errno;
    if (d->lock >= 0) close(d->lock);
    text_free(&name);
    d->path = NULL;
    errno = why;
    return false;
}

bool draft_folder_begin(struct draft_folder *d, const char *path, struct err *e)
{
    const char *slash = strrchr(path, '/');
    CHECK(slash != NULL);
    *d = (struct draft_folder){
        .place = slash == path ? memory_text("/") : memory_text_part(path, (size_t)(slash - path)),
        .lock = -1};
    /* Also what other figures' drawers left would do no harm, but it is theirs to remove. */
    clean(d->place, slash + 1);
    bool made = false;
    for (int trial = 0; trial < TRIALS && !made; trial++) {
        made = make(d, path, trial);
        if (!made && errno != EEXIST) break;
    }
    if (made) return true;
    err_set(e, errno == ENOMEM ? ERR_INTERNAL : ERR_CREATE, "cannot make files in %s: %s", d->place,
            strerror(errno));
    free(d->place);
    *d = (struct draft_folder){.lock = -1};
    return false;
}

/* One file to its place. A name that is a folder there is told, not replaced. */
static bool move(const struct draft_folder *d, const char *name, struct err *e)
{
    struct text from = {0}, to = {0};
    text_add(&from, "%s/%s", d->path, name);
    text_add(&to, "%s/%s", d->place, name);
    bool ok = rename(from.s, to.s) == 0;
    if (!ok) err_set(e, ERR_IO, "writing %s failed: %s", to.s, strerror(errno));
    text_free(&from);
    text_free(&to);
    return ok;
}

bool draft_folder_publish(const struct draft_folder *d, bool (*chosen)(const char *name),
                          struct err *e)
{
    DIR *dir = entries(d->lock);
    bool ok = true;
    if (dir == NULL)
        return err_set(e, errno == ENOMEM ? ERR_INTERNAL : ERR_IO, "cannot read %s: %s", d->path,
                       strerror(errno));
    /* What is moved meanwhile may come again or not: a second rename of it cannot happen. */
    for (struct dirent *entry; ok && (entry = readdir(dir)) != NULL;)
        if (!is_dots(entry->d_name) && chosen(entry->d_name)) ok = move(d, entry->d_name, e);
    closedir(dir);
    return ok;
}

void draft_folder_end(struct draft_folder *d)
{
    if (d->path == NULL) return;
    empty(d->lock);
    rmdir(d->path);
    close(d->lock);
    free(d->path);
    free(d->place);
    *d = (struct draft_folder){.lock = -1};
}
