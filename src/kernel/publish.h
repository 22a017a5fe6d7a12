/* publish.h - numbers in the build's precision handed out as doubles (comm_publish). */
#ifndef KERNEL_PUBLISH_H
#define KERNEL_PUBLISH_H

#include "comm/comm.h"
#include "linalg/real.h"

/* publish_reals: elements first .. first + n - 1 of an output. */
static inline void publish_reals(struct comm *c, int output, int64_t first, int64_t n,
                                 const real *x)
{
    enum { CHUNK = 16 }; /* on a stack that is meant to stay within a page */
    double rounded[CHUNK];
    if (!comm_wanted(c, output)) return;
    for (int64_t at = 0; at < n; at += CHUNK) {
        const int64_t m = n - at < CHUNK ? n - at : CHUNK;
        for (int64_t i = 0; i < m; i++) rounded[i] = (double)x[at + i];
        comm_publish(c, output, first + at, m, rounded);
    }
}

/* publish_number: element `at` of an output. */
static inline void publish_number(struct comm *c, int output, int64_t at, double x)
{
    comm_publish(c, output, at, 1, &x);
}

#endif
