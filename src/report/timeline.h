/* timeline.h - the spans that one trace shows, picked and put in order; what the formats of trace.h
 * share. */
#ifndef REPORT_TIMELINE_H
#define REPORT_TIMELINE_H

#include "report/trace.h"

struct timeline {
    const struct run_result *run;
    const char *title;
    int first_rank, last_rank;
    int64_t begin_ps, end_ps;
    int columns;
    int64_t nspan;
    const struct span **span;   /* (nspan) by rank, then begin */
};

/* timeline_kind: the word of a kind of span. */
const char *timeline_kind(enum span_kind kind);

/* timeline_stage: the name of a stage of the run. */
const char *timeline_stage(const struct timeline *t, int stage);

/* timeline_group: one past the last of the spans from `first` on that follow each other in one
 * stage of one rank. */
int64_t timeline_group(const struct timeline *t, int64_t first);

/* timeline_partners: for each span of kind send or receive with a message number the index of the
 * other end, -1 without one; (nspan) from the heap, owned by the caller. */
int64_t *timeline_partners(const struct timeline *t);

/* The formats. */
void trace_chrome(const struct timeline *t, FILE *out);
void trace_paje(const struct timeline *t, FILE *out);
void trace_csv(const struct timeline *t, FILE *out);
void trace_text(const struct timeline *t, FILE *out);

/* trace_goal: returns how many barriers of the machine it wrote as computing times. */
int64_t trace_goal(const struct timeline *t, FILE *out);

#endif
