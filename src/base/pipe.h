/* pipe.h - whole arrays through pipes, which take and give what they can. */
#ifndef BASE_PIPE_H
#define BASE_PIPE_H

#include <stdbool.h>
#include <stddef.h>

/* pipe_write: all n bytes of `data`; pipe_read: n bytes into `data`. Both go on after a signal.
 * False: the other end is gone. */
bool pipe_write(int fd, const void *data, size_t n);
bool pipe_read(int fd, void *data, size_t n);

#endif
