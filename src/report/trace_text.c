/* trace_text.c - the timeline as bars of letters, for a terminal: what each rank does most in each
 * slot of time. */
#include <string.h>

#include "report/timeline.h"

enum { NKIND = SPAN_BARRIER + 1, MOST_COLUMNS = 500 };

/* As many letters as a line of any terminal holds. */
static int columns_of(const struct timeline *t)
{
    return t->columns < MOST_COLUMNS ? t->columns : MOST_COLUMNS;
}

/* How much of the span lies in [begin, end) [ps]. */
static int64_t overlap(const struct span *p, int64_t begin, int64_t end)
{
    int64_t from = p->begin_ps > begin ? p->begin_ps : begin,
            to = p->end_ps < end ? p->end_ps : end;
    return to > from ? to - from : 0;
}

/* One rank's spans are span[first] to span[next - 1], by time. Two lines: its stages, a letter
 * each, and what it does most of the time in each column. */
static void put_rank(const struct timeline *t, int64_t first, int64_t next, int64_t begin,
                     int64_t end, FILE *out)
{
    /* in the order of enum span_kind */
    static const char sign[] = "#><.|";
    char stage_bar[MOST_COLUMNS], bar[MOST_COLUMNS];
    const int columns = columns_of(t);
    int64_t from = first;
    /* One column is the time from left to right. Spans that ended before it are not looked at
     * again, so the whole line takes one pass. */
    for (int c = 0; c < columns; c++) {
        /* in wide arithmetic: length times columns may exceed 64 bits */
        int64_t left = begin + (int64_t)((__int128)(end - begin) * c / columns);
        int64_t right = begin + (int64_t)((__int128)(end - begin) * (c + 1) / columns);
        int64_t share[NKIND] = {0}, stages[RUN_MAX_STAGES + 1] = {0};
        while (from < next && t->span[from]->end_ps <= left) from++;
        for (int64_t i = from; i < next && t->span[i]->begin_ps < right; i++) {
            int64_t part = overlap(t->span[i], left, right);
            share[t->span[i]->kind] += part;
            if (t->span[i]->stage >= 0 && t->span[i]->stage <= RUN_MAX_STAGES)
                stages[t->span[i]->stage] += part;
        }
        /* The largest share wins; of equal ones the first kind. Nothing recorded: a blank. */
        int kind = -1, stage = -1;
        for (int k = 0; k < NKIND; k++)
            if (share[k] > (kind < 0 ? 0 : share[kind])) kind = k;
        for (int k = 0; k <= RUN_MAX_STAGES; k++)
            if (stages[k] > (stage < 0 ? 0 : stages[stage])) stage = k;
        bar[c] = kind < 0 ? ' ' : sign[kind];
        stage_bar[c] = stage < 0 ? ' ' : (char)('A' + stage);
    }
    fprintf(out, "%8s  %.*s\n%8d  %.*s\n", "", columns, stage_bar, t->span[first]->rank, columns,
            bar);
}

void trace_text(const struct timeline *t, FILE *out)
{
    int64_t begin = INT64_MAX, end = 0;
    int shown = 0, ranks = 0;
    /* The window is what was asked for, less what is empty at its ends. */
    for (int64_t i = 0; i < t->nspan; i++) {
        if (t->span[i]->begin_ps < begin) begin = t->span[i]->begin_ps;
        if (t->span[i]->end_ps > end) end = t->span[i]->end_ps;
    }
    if (t->begin_ps > begin) begin = t->begin_ps;
    if (t->end_ps < end) end = t->end_ps;
    if (*t->title) fprintf(out, "%s\n", t->title);
    fprintf(out, "%.3f to %.3f us, one column is %.3f us\n", (double)begin * 1e-6,
            (double)end * 1e-6, (double)(end - begin) * 1e-6 / columns_of(t));
    fputs("what: # compute  > send  < receive  . wait  | barrier\nstages:", out);
    /* A letter for each stage, as in the bars. */
    for (int i = 0; i < t->run->nstage; i++)
        fprintf(out, " %c %s ", 'A' + i, t->run->stage_name[i]);
    fputs("\n\n    rank\n", out);
    /* Spans are sorted by rank: a rank's are a run of them. Beyond TRACE_TEXT_RANKS they are
     * only counted. */
    for (int64_t first = 0, next; first < t->nspan; first = next, ranks++) {
        for (next = first; next < t->nspan && t->span[next]->rank == t->span[first]->rank;) next++;
        if (ranks < TRACE_TEXT_RANKS) {
            put_rank(t, first, next, begin, end, out);
            shown++;
        }
    }
    if (ranks > shown) fprintf(out, "%8s  and %d more ranks\n", "", ranks - shown);
}
