/* progress.h - one line of progress on stderr for anything that takes over a second.
 *
 * On a terminal the line is rewritten in place, elsewhere a line is printed every 10 s. Nothing on
 * stdout. */
#ifndef BASE_PROGRESS_H
#define BASE_PROGRESS_H

#include <stdbool.h>

struct progress {
    const char *what;  /* borrowed */
    double total;      /* units of work, > 0 */
    double start;      /* host seconds */
    double last;       /* host seconds of the last line */
    const char *detail; /* borrowed; put behind the line, NULL: nothing */
    bool quiet, tty, shown;
};

/* progress_make: begin; `quiet` shows nothing ever. */
struct progress progress_make(const char *what, double total, bool quiet);

/* progress_show: `done` of the total is finished; prints percent, rate, time left and p->detail
 * when it is time to. */
void progress_show(struct progress *p, double done);

/* progress_due: whether progress_show would print now. */
bool progress_due(const struct progress *p);

/* progress_end: remove the line on a terminal. */
void progress_end(struct progress *p);

/* host_seconds: monotonic wall clock of the host [s]; for progress and cost reports, never for a
 * result. */
double host_seconds(void);

/* host_processor_seconds: processor time of this process [s], which others' work on the host does
 * not lengthen. */
double host_processor_seconds(void);

/* host_peak_bytes: largest resident set of this process so far [B]. */
long host_peak_bytes(void);

#endif
