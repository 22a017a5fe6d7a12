/* trace.h - the recorded timeline of one run as a file that opens elsewhere.
 *
 * Each rank is one track whose slices are the recorded spans inside the slice of their stage; a
 * message is an arrow from its send to its receive. Viewers fail near a million events, so there is
 * a limit on the spans written, and what was left out is told. */
#ifndef REPORT_TRACE_H
#define REPORT_TRACE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "store/store.h"

enum trace_format {
    TRACE_CHROME, /* Chrome trace events (JSON): Perfetto, chrome://tracing */
    TRACE_PAJE,   /* Paje: ViTE, pj_dump */
    TRACE_CSV,    /* one row per span, RFC 4180 */
    TRACE_TEXT,   /* bars of letters for a terminal */
    TRACE_GOAL    /* a schedule that repeats the run: all of it, whatever the options; left_out:
                     barriers */
};

enum { TRACE_MAX_SPANS = 200000, TRACE_COLUMNS = 100, TRACE_TEXT_RANKS = 64 };

struct trace_options {
    const char *title;          /* one line for people: scenario, machine, n, P */
    int64_t max_spans;          /* 0: TRACE_MAX_SPANS, about 60 MB of JSON */
    int first_rank, last_rank;  /* both 0: all, unless some_ranks */
    bool some_ranks;            /* the two are meant as they are */
    int64_t begin_ps, end_ps;   /* window; end 0: to the end */
    int columns;                /* of TRACE_TEXT; 0: TRACE_COLUMNS */
};

/* trace_format_find: by name ("chrome", "paje", "csv", "text"); false when there is none. */
bool trace_format_find(const char *name, enum trace_format *format);

/* trace_write: the spans of `r` to `out`.
 *
 *   left_out  out  spans inside window and ranks that the limit left out, the latest ones; for
 * people, the caller says so and names the option that raises the limit. Of TRACE_GOAL: barriers of
 * the machine, which are written as computing times. TRACE_TEXT shows at most TRACE_TEXT_RANKS
 * ranks.
 *
 *   Returns false with ERR_NO_INPUT when the run has no recorded spans, ERR_CONFIG when none lies
 * in the window, ERR_IO when writing fails. */
bool trace_write(const struct run_result *r, enum trace_format format,
                 const struct trace_options *o, FILE *out, int64_t *left_out, struct err *e);

/* trace_read: the timeline of a stored run back into *r (only ranks, stages, spans and makespan),
 * in memory of `a`. Returns false with ERR_NO_INPUT when there is no such run or it has no stored
 * spans. */
bool trace_read(struct store *s, int64_t run_id, struct arena *a, struct run_result *r,
                struct err *e);

#endif
