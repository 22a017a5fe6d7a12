/* new_file.c - making a file that is not there. */
#include "base/new_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

/* A new file: O_EXCL, so that nothing that is there, a link least of all, is written to. What could
 * not be written as a whole is removed again: a disk that is full leaves nothing. */
bool new_file_write(const char *path, const struct text *content, struct err *e)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd < 0 && errno == EEXIST)
        return err_set(e, ERR_CREATE, "%s is there already; choose another name, or move it away",
                       path);
    if (fd < 0) return err_set(e, ERR_CREATE, "%s: %s", path, strerror(errno));
    const bool written = write(fd, content->s, content->length) == (ssize_t)content->length;
    if (close(fd) == 0 && written) return true;
    unlink(path);
    return err_set(e, ERR_IO, "%s cannot be written: %s", path, strerror(errno));
}
