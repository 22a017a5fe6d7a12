/* check.h - assertions about our own mistakes: always on, print where and in which run, then abort.
 *
 * Bad input is never a CHECK; it is a `struct err` (err.h). A finding of a run is a status
 * (run_result.h). */
#ifndef BASE_CHECK_H
#define BASE_CHECK_H

#include <stddef.h>

/* CHECK: abort with file, line, the condition and the note of check_note_set when `cond` is
 * false. */
#define CHECK(cond) ((cond) ? (void)0 : check_failed(__FILE__, __LINE__, #cond))

/* check_failed: print the failed condition and the current note to stderr and abort(); never
 * returns. */
_Noreturn void check_failed(const char *file, int line, const char *cond);

/* check_memory: say that the system refuses `bytes` more of memory (0: how many is not known),
 * which is nobody's mistake, and end the process with the status of ERR_INTERNAL; never returns. */
_Noreturn void check_memory(size_t bytes);

/* What check_failed says of the run in progress. */
struct check_note {
    void (*describe)(void *context, char *buffer, int size);
    void *context;
};

/* check_note_get: this thread's note, for another thread that works for the same run. */
struct check_note check_note_get(void);

/* check_note_set: register a function that describes the run in progress (time, rank, seed) for
 * check_failed.
 *
 *   describe  called with `context` and a buffer of `size` bytes to fill; NULL removes the note
 *   context   borrowed until the note is replaced
 *
 * The note is per host thread and is the only writable datum outside a run. */
void check_note_set(void (*describe)(void *context, char *buffer, int size), void *context);

#endif
