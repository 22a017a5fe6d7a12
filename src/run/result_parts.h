/* result_parts.h - the arrays of a run's result, for those who send it to another process as bytes.
 *
 * Sizes follow from the counts in the result, so that both ends know them. Pointers that travel
 * mean nothing to the reader, who replaces them. Both ends are the same build of this program. */
#ifndef RUN_RESULT_PARTS_H
#define RUN_RESULT_PARTS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "measure/run_result.h"

enum { RESULT_PARTS = 9 };

struct result_parts {
    void **array[RESULT_PARTS]; /* members of the result, in the order in which they travel */
    size_t bytes[RESULT_PARTS]; /* 0: the array is not there */
};

/* result_parts: those of r. */
struct result_parts result_parts(struct run_result *r);

/* result_pack: `number` and r with its arrays as one block of *bytes, to be freed by the caller. */
void *result_pack(int number, const struct run_result *r, size_t *bytes);

/* result_unpack: what result_pack made; arrays in `a`. False: the block does not have the size that
 * it tells. */
bool result_unpack(const void *block, size_t bytes, int *number, struct run_result *r,
                   struct arena *a);

#endif
