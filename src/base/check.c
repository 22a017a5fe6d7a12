/* check.c - the last words before abort: place, condition, and what the run in progress says of
 * itself. */
#include "base/check.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/err.h"

/* The only writable datum outside a run: without it, base would have to know the clock in order to
 * print it. */
static _Thread_local struct check_note check_note;

void check_note_set(void (*describe)(void *context, char *buffer, int size), void *context)
{
    check_note = (struct check_note){describe, context};
}

struct check_note check_note_get(void) { return check_note; }

void check_memory(size_t bytes)
{
    char how_much[48] = "more";
    /* What a wrapped product or a small table needed says nothing to anybody. */
    if (bytes >= 1 << 20 && bytes < SIZE_MAX)
        snprintf(how_much, sizeof how_much, "%.3g MiB more", (double)bytes / (1 << 20));
    fprintf(stderr,
            "mimdsim: out of memory: the system refuses %s; `mimdsim explain` shows how much a run "
            "needs\n",
            how_much);
    _exit(ERR_INTERNAL_STATUS); /* a worker's copy of the parent's output is not its own to flush */
}

/* abort() and not exit(): a core dump shows the state, and nothing is written on the way out. */
void check_failed(const char *file, int line, const char *cond)
{
    char note[512] = "";
    struct check_note told = check_note;
    check_note = (struct check_note){0}; /* a failing describe must not come back here for ever */
    if (told.describe) told.describe(told.context, note, (int)sizeof note);
    /* What was printed before belongs in front of the message. */
    fflush(stdout);
    fprintf(stderr, "mimdsim: internal error at %s:%d: CHECK(%s) failed%s%s\n", file, line, cond,
            note[0] ? "; " : "", note);
    abort();
}
