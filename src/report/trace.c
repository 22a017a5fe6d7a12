/* trace.c - picking the spans of a trace, and the formats by name.
 *
 * A run may have millions of spans, and viewers stop responding at far fewer: a window in time,
 * a range of ranks and a limit choose what is written. All formats get the same choice. */
#include "report/trace.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "report/csv.h"
#include "report/timeline.h"

/* In the order of enum trace_format. */
bool trace_format_find(const char *name, enum trace_format *format)
{
    static const char *const names[] = {"chrome", "paje", "csv", "text", "goal"};
    for (int i = 0; i < 5; i++)
        if (strcmp(name, names[i]) == 0) {
            *format = (enum trace_format)i;
            return true;
        }
    return false;
}

/* By time; of equal times the order in which they were recorded, so that output is reproducible. */
static int compare_begin(const void *a, const void *b)
{
    const struct span *x = *(const struct span *const *)a, *y = *(const struct span *const *)b;
    if (x->begin_ps != y->begin_ps) return x->begin_ps < y->begin_ps ? -1 : 1;
    return x < y ? -1 : x > y;
}

static int compare_rank(const void *a, const void *b)
{
    const struct span *x = *(const struct span *const *)a, *y = *(const struct span *const *)b;
    return x->rank != y->rank ? (x->rank < y->rank ? -1 : 1) : compare_begin(a, b);
}

/* The spans of *t within its window and ranks, at most `max` of them, sorted by rank and time.
 * Returns how many were left out. */
static int64_t pick(struct timeline *t, int64_t max)
{
    const struct run_result *r = t->run;
    t->span = memory_take((size_t)r->nspan, sizeof *t->span);
    for (int64_t i = 0; i < r->nspan; i++) {
        const struct span *p = &r->span[i];
        /* A span that reaches into the window is shown whole: cutting it would falsify its
         * length. */
        bool inside = p->begin_ps < t->end_ps && p->end_ps > t->begin_ps;
        if (inside && p->rank >= t->first_rank && p->rank <= t->last_rank) t->span[t->nspan++] = p;
    }
    int64_t left_out = t->nspan > max ? t->nspan - max : 0;
    /* What is too much is cut at the end of time, on all ranks alike. */
    if (left_out > 0) {
        qsort(t->span, (size_t)t->nspan, sizeof *t->span, compare_begin);
        t->nspan = max;
    }
    qsort(t->span, (size_t)t->nspan, sizeof *t->span, compare_rank);
    return left_out;
}

/* One line per span, RFC 4180. Times are whole picoseconds. */
void trace_csv(const struct timeline *t, FILE *out)
{
    fputs("rank,stage,kind,begin_ps,end_ps,peer,bytes,message\r\n", out);
    for (int64_t i = 0; i < t->nspan; i++) {
        const struct span *p = t->span[i];
        fprintf(out, "%d,", p->rank);
        csv_cell(out, timeline_stage(t, p->stage), false);
        fprintf(out, "%s,%lld,%lld,", timeline_kind(p->kind), (long long)p->begin_ps,
                (long long)p->end_ps);
        /* peer and message are empty where there is none */
        if (p->peer >= 0) fprintf(out, "%d", p->peer);
        fprintf(out, ",%lld,", (long long)p->bytes);
        if (p->message >= 0) fprintf(out, "%lld", (long long)p->message);
        fputs("\r\n", out);
    }
}

bool trace_write(const struct run_result *r, enum trace_format format,
                 const struct trace_options *o, FILE *out, int64_t *left_out, struct err *e)
{
    /* In the order of enum trace_format. */
    static void (*const write[])(const struct timeline *, FILE *) = {trace_chrome, trace_paje,
                                                                     trace_csv, trace_text};
    /* Ranks 0 to 0 are the default of the options, which means all. */
    bool all = !o->some_ranks && o->first_rank == 0 && o->last_rank == 0;
    struct timeline t = {.run = r,
                         .title = o->title ? o->title : "",
                         .begin_ps = o->begin_ps,
                         .first_rank = o->first_rank,
                         .last_rank = all ? r->nrank - 1 : o->last_rank,
                         /* end_ps 0: to the end; + 1, since a span of no length at the very end
                          * is inside, too. */
                         .end_ps = o->end_ps > 0 ? o->end_ps : r->makespan_ps + 1,
                         .columns = o->columns > 0 ? o->columns : TRACE_COLUMNS};
    if (r->span == NULL || r->nspan == 0)
        return err_set(e, ERR_NO_INPUT,
                       "this run has no timeline; record it with `record: {spans: true}`");
    /* Viewers fail on long traces; a schedule without its end would be another one. */
    const bool whole = format == TRACE_GOAL;
    if (whole) t.begin_ps = 0, t.first_rank = 0, t.last_rank = r->nrank - 1, t.end_ps = INT64_MAX;
    *left_out = pick(&t, whole ? r->nspan : o->max_spans > 0 ? o->max_spans : TRACE_MAX_SPANS);
    bool ok = t.nspan > 0 || err_set(e, ERR_CONFIG,
                                     "nothing was recorded on ranks %d to %d "
                                     "between %.6f and %.6f us",
                                     t.first_rank, t.last_rank, (double)t.begin_ps * 1e-6,
                                     (double)t.end_ps * 1e-6);
    if (ok && format == TRACE_GOAL) *left_out = trace_goal(&t, out);
    else if (ok) write[format](&t, out);
    free(t.span);
    /* A full disk shows up when the buffer is flushed. */
    if (ok && (fflush(out) != 0 || ferror(out))) ok = err_set(e, ERR_IO,
                                                              "the timeline cannot be written");
    return ok;
}
