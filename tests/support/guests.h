/* guests.h - small programs compiled when a test runs, loaded for a few ranks, and run on fibers
 * without a machine. */
#ifndef SUPPORT_GUESTS_H
#define SUPPORT_GUESTS_H

#include <stdbool.h>

#include "base/err.h"
#include "loader/loader.h"

enum { GUEST_OUTPUT = 1 << 16, GUEST_RANKS = 64 };

/* What the ranks of one program did. */
struct guests {
    char output[GUEST_OUTPUT]; /* of all ranks, in the order written, each line as "rank: text" */
    int used, status[GUEST_RANKS];
    int64_t clock_ps[GUEST_RANKS];
    int failed_rank; /* -1: none */
    char failure[1024];
    struct err error;
};

/* guests_build: compile tests/loader/programs/SOURCE (.c, .cc, .f90) and link it with the archive
 * of guest/ to a program in `folder`, its name in `path`; `options` are handed to the compiler.
 * Skips the test when there is no such compiler. */
void guests_build(const char *folder, const char *source, const char *options, char path[512]);

/* guests_run: load the program `path` for `nrank` ranks and run main(n, argument) of each on a
 * fiber; sleeping lets the others go on. False, with g->error, when it cannot be loaded. */
bool guests_run(const char *path, int nrank, int n, char **argument, struct guests *g);

/* guests_expect: build a program, run it on two ranks, and compare its output and that nothing
 * failed. */
void guests_expect(const char *folder, const char *source, const char *options, const char *output);

#endif
