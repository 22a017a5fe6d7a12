/* whole.c - see whole.h.
 *
 * A pipe holds some 64 KiB: larger arrays go through it in pieces, as fast as the other end takes
 * them. A file takes less than it is given where a disk is nearly full or a signal comes. */
#include "base/whole.h"

#include <errno.h>
#include <unistd.h>

bool write_whole(int fd, const void *data, size_t n)
{
    for (const char *p = data; n > 0;) {
        const ssize_t k = write(fd, p, n);
        if (k < 0 && errno == EINTR) continue;
        if (k == 0) errno = ENOSPC;
        if (k <= 0) return false;
        p += k;
        n -= (size_t)k;
    }
    return true;
}

bool read_whole(int fd, void *data, size_t n)
{
    for (char *p = data; n > 0;) {
        const ssize_t k = read(fd, p, n);
        if (k < 0 && errno == EINTR) continue;
        if (k == 0) errno = 0;
        if (k <= 0) return false;
        p += k;
        n -= (size_t)k;
    }
    return true;
}
