/* whole.h - whole arrays to and from descriptors, which take and give what they can. */
#ifndef BASE_WHOLE_H
#define BASE_WHOLE_H

#include <stdbool.h>
#include <stddef.h>

/* write_whole: all n bytes of `data`; read_whole: n bytes into `data`. Both go on after a signal.
 * False with errno: the system's reason; ENOSPC where it wrote nothing without one, 0 where there
 * was nothing more to read. */
bool write_whole(int fd, const void *data, size_t n);
bool read_whole(int fd, void *data, size_t n);

#endif
