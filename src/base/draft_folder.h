/* draft_folder.h - files that are made in a folder of their own, by whatever program, and get their
 * places together when they are whole. */
#ifndef BASE_DRAFT_FOLDER_H
#define BASE_DRAFT_FOLDER_H

#include <stdbool.h>

#include "base/err.h"

/* DIR/NAME.new-XXXXXX.part, locked (flock) as long as this process lives. */
struct draft_folder {
    char *path;  /* owned; NULL: none */
    char *place; /* owned: DIR, where its files are to be */
    int lock;
};

/* draft_folder_begin: make a folder for the files of `path` (DIR/NAME), in DIR, which is there.
 * Those that processes left which have ended since are removed first. Returns false with
 * ERR_CREATE, or ERR_INTERNAL for lack of memory. */
bool draft_folder_begin(struct draft_folder *d, const char *path, struct err *e);

/* draft_folder_publish: every file in it whose name is `chosen` goes to DIR under that name, in
 * place of an older one. Returns false with ERR_IO; what was not moved is still in the folder. */
bool draft_folder_publish(const struct draft_folder *d, bool (*chosen)(const char *name),
                          struct err *e);

/* draft_folder_end: the folder goes, with what is left in it. */
void draft_folder_end(struct draft_folder *d);

#endif
