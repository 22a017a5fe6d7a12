/* new_file.h - files that a verb makes for its user, and never writes over another. */
#ifndef BASE_NEW_FILE_H
#define BASE_NEW_FILE_H

#include <stdbool.h>

#include "base/err.h"
#include "base/text.h"

/* new_file_write: the file `path`, which must not exist, with `content`, whole or not at all.
 * Returns false with ERR_CREATE (it is there, or cannot be made) or ERR_IO. */
bool new_file_write(const char *path, const struct text *content, struct err *e);

#endif
