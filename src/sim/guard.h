/* guard.h - pages between stacks that nobody may touch, so that an overflow ends at once. */
#ifndef SIM_GUARD_H
#define SIM_GUARD_H

#include <stddef.h>

/* guard_pages: guard the first page (`page` bytes) of each of `n` pieces of `stride` bytes from
 * `base`, in private memory of this process that nobody has touched yet. Returns how many are
 * guarded, counted from the first: all of them on Linux 6.13 and later, elsewhere a share of the
 * mappings that the system allows. */
int guard_pages(char *base, size_t stride, size_t page, int n);

#endif
