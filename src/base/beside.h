/* beside.h - files that are written beside their place, never through a link, and what a crash left
 * of them. */
#ifndef BASE_BESIDE_H
#define BASE_BESIDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/err.h"

/* Between a path and six letters of its own, and behind them: what is in the making. */
#define BESIDE_MIDDLE ".new-"
#define BESIDE_ENDING ".part"

/* A file in the making: it gets its name when it is whole. */
struct beside {
    FILE *out;  /* to be written to */
    char *path; /* owned, where it is to be; through links */
    int why;    /* errno of a write that failed, 0: none did, or stdio knows of it alone */
    /* owned, where it is now; NULL: written in place, as it is no regular file (/dev/stdout) */
    char *name;
};

/* beside_begin: begin the file `path`. Returns false with ERR_CREATE, or ERR_INTERNAL for lack of
 * memory. beside_end: it is there,
 * whole, in place of an older one, when `keep` and all writes went well; else nothing is left of it
 * and the older one stays. Returns false with ERR_IO when `keep` and it is not there. */
bool beside_begin(struct beside *b, const char *path, struct err *e);
bool beside_end(struct beside *b, bool keep, struct err *e);

/* beside_write: the file `path` with these `size` bytes, whole or as it was. False as
 * beside_begin, or with ERR_IO. */
bool beside_write(const char *path, const void *data, size_t size, struct err *e);

/* beside_open: make a new file PATH.new-XXXXXX.part in the folder of `path`, open it for writing
 * and lock it (flock).
 *
 *   *name  its path, for the caller to free; NULL on failure
 *
 * The name is drawn anew until none has it (mkostemp), so nothing that lies there, a link least of
 * all, is ever opened. Its mode is what the umask leaves of 0666. Returns the descriptor, or -1
 * with errno. */
int beside_open(const char *path, char **name);

/* beside_clean: remove the files that beside_open made for `path` in processes that have ended
 * since. Those that a living process writes are locked and stay, as do links and files of other
 * users. */
void beside_clean(const char *path);

/* beside_is_draft: whether `name` is one that something in the making for `own` has: both without
 * their folder. */
bool beside_is_draft(const char *name, const char *own);

#endif
