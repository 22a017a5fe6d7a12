/* trace.h - the recorded timeline of one run as a file that opens elsewhere.
 *
 * Each rank is one track whose slices are the recorded spans inside the slice of their stage; a message is an arrow
 * from the end of its send to the end of its receive. Viewers fail near a million events, so there is a limit on the
 * spans written, and what was left out is told. */
#ifndef REPORT_TRACE_H
#define REPORT_TRACE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/err.h"
#include "measure/run_result.h"

enum trace_format {
    TRACE_CHROME, /* Chrome trace events (JSON): Perfetto, chrome://tracing */
    TRACE_PAJE,   /* Paje: ViTE, pj_dump */
    TRACE_CSV,    /* one row per span, RFC 4180 */
    TRACE_TEXT    /* bars of letters for a terminal */
};

struct trace_options {
    const char *title;          /* one line for people: scenario, machine, n, P */
    int64_t max_spans;          /* 0: 200,000 */
    int first_rank, last_rank;  /* both 0: all */
    int64_t begin_ps, end_ps;   /* window; end 0: to the end */
    int columns;                /* of TRACE_TEXT; 0: 100 */
};

/* trace_format_find: by name ("chrome", "paje", "csv", "text"); false when there is none. */
bool trace_format_find(const char *name, enum trace_format *format);

/* trace_write: the spans of `r` to `out`, in the order of time.
 *
 *   left_out  out  spans inside the window that the limit left out: the latest ones
 *
 *   Returns false with ERR_NO_INPUT when the run has no recorded spans, ERR_IO when writing fails. */
bool trace_write(const struct run_result *r, enum trace_format format, const struct trace_options *o, FILE *out,
                 int64_t *left_out, struct err *e);

#endif
