/* err.h - errors that a user can mend, as values: kind, place in the user's file, text.
 *
 * Functions that can fail return bool and take a `struct err *`. The first cause wins: a second ERR
 * on an error already set is ignored, so callers add context with err_in and leave. No globals; no
 * allocation but for texts that are too long, which lose a part of their middle: a path says most
 * with its ends.
 *
 * Exit statuses follow sysexits.h where it has a fitting one. */
#ifndef BASE_ERR_H
#define BASE_ERR_H

#include <stdbool.h>
#include <stddef.h>

/* X(name, exit status, word for --json) */
#define ERR_KINDS(X)                                                                               \
    X(ERR_NONE, 0, "ok")                                                                           \
    X(ERR_CHECK, 1,                                                                                \
      "check-failed")         /* a requested check or claim failed, or a run ended invalid */      \
    X(ERR_USAGE, 64, "usage") /* options or arguments */                                           \
    X(ERR_DATA, 65,                                                                                \
      "bad-data") /* a file's content: syntax, unknown key, unit, range, impossible body */        \
    X(ERR_NO_INPUT, 66,                                                                            \
      "no-input") /* a file, machine, scenario, figure or database that is not there */            \
    X(ERR_UNAVAILABLE, 69, "missing") /* an optional program is missing (gnuplot) */               \
    X(ERR_DEADLOCK, 70, "deadlock")   /* the simulated program or network cannot go on */          \
    X(ERR_INTERNAL, 71, "system") /* the operating system refused memory, a process, a mapping */  \
    X(ERR_CREATE, 73, "cannot-create") /* an output file cannot be made */                         \
    X(ERR_IO, 74, "io")                /* reading or writing failed: disk full, read-only */       \
    X(ERR_BUSY, 75, "busy")            /* try again: database locked */                            \
    X(ERR_CONFIG, 78,                                                                              \
      "config") /* values each fine but impossible together: P larger than the machine */

enum err_kind {
#define X(name, status, word) name,
    ERR_KINDS(X)
#undef X
};

/* Exit statuses by name (ERR_IO_STATUS = 74), for check.c, which stands below err.c. */
enum err_status {
#define X(name, status, word) name##_STATUS = status,
    ERR_KINDS(X)
#undef X
};

struct err {
    enum err_kind kind;
    int line;          /* 1-based line in `file`, 0 when there is none */
    char file[256];    /* the user's file, "" when there is none */
    char text[768];    /* one sentence: the value, what was expected, the nearest valid name */
};

/* err_clear: *e becomes "no error". */
void err_clear(struct err *e);

/* err_set: record an error; ignored when *e already holds one. printf-like. Always returns false,
 * so that `return err_set(e, ERR_DATA, ...)` ends a function. */
bool err_set(struct err *e, enum err_kind kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* err_set_at: as err_set, with the place in the user's file (line 0: unknown). Returns false. */
bool err_set_at(struct err *e, enum err_kind kind, const char *file, int line, const char *format,
                ...) __attribute__((format(printf, 5, 6)));

/* err_in: put `context` ("scenario fig6.yaml") in front of the text of an error already set.
 * Returns false. */
bool err_in(struct err *e, const char *context);

/* err_exit_status: the process exit status of a kind. */
int err_exit_status(enum err_kind kind);

/* err_word: the short lower-case name of a kind, for --json and for the store. */
const char *err_word(enum err_kind kind);

/* err_print: write "file:line: text" (or the text alone) to stderr, prefixed by "mimdsim: ". */
void err_print(const struct err *e);

#endif
