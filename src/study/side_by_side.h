/* side_by_side.h - independent pieces of a study on worker processes, their results in order. */
#ifndef STUDY_SIDE_BY_SIDE_H
#define STUDY_SIDE_BY_SIDE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/err.h"

/* What is done piece by piece. */
struct pieces {
    int n;
    const int *turn; /* (n) the pieces as they are begun, so that long ones do not end last; NULL:
                        in order */
    void *context;
    /* make: piece i, in a worker process: its result as *bytes at *data, which stay until the next
     * call. Nothing else that it changes is seen by anybody. */
    bool (*make)(void *context, int i, const void **data, size_t *bytes, struct err *e);
    /* take: the result of piece i, in this process, in order. */
    bool (*take)(void *context, int i, const void *data, size_t bytes, struct err *e);
};

/* side_by_side: all pieces, on `workers` processes (0: as many as processors online; 1: in this
 * process). The results do not depend on `workers`. Returns false with the error of the first piece
 * in order that has one; ERR_INTERNAL when a worker dies. */
bool side_by_side(const struct pieces *p, int workers, struct err *e);

#endif
