/* scratch.h - a folder of its own for a test's files, removed at the end. */
#ifndef SUPPORT_SCRATCH_H
#define SUPPORT_SCRATCH_H

#include <stddef.h>

/* scratch_make: make a new empty folder below $TMPDIR or where the system keeps such; its name in
 * `folder`. */
void scratch_make(char *folder, size_t size);

/* scratch_path: "folder/name" into `path`; returns path. */
char *scratch_path(char *path, size_t size, const char *folder, const char *name);

/* scratch_remove: the folder with everything in it. */
void scratch_remove(const char *folder);

#endif
