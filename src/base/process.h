/* process.h - other programs run, with texts to and from them. */
#ifndef BASE_PROCESS_H
#define BASE_PROCESS_H

#include <stdbool.h>
#include <sys/types.h>

#include "base/err.h"
#include "base/text.h"

/* process_run: start word[0] (looked for in PATH) with its arguments and wait for its end.
 *
 *   in      its standard input, NULL: this process's
 *   out     appended: its standard output, NULL: this process's
 *   status  becomes its exit status, 128 + n after signal n
 *
 * Returns false with ERR_UNAVAILABLE when there is no such program, ERR_INTERNAL when none can be
 * started. A status that is not 0 is no error here: the program has said why. */
bool process_run(const char *const *word, const struct text *in, struct text *out, int *status,
                 struct err *e);

/* process_said: the same with this process's standard input; its standard output goes nowhere, and
 * its standard error is appended to *said. */
bool process_said(const char *const *word, struct text *said, int *status, struct err *e);

/* process_replace: become another program; returns only with an error, as above. */
bool process_replace(const char *const *word, struct err *e);

/* process_end_with: of a child that process `parent` has just forked: it is killed when the thread
 * that forked it ends, whatever ends that one. False: it has ended already. */
bool process_end_with(pid_t parent);

#endif
