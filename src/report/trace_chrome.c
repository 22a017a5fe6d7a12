/* trace_chrome.c - Chrome trace events: a track per rank, stages as slices around their spans,
 * messages as flows.
 *
 * Times are microseconds with six decimals, which is exact for picoseconds. Slices of a track must
 * nest: spans follow each other, and a stage's slice reaches from its first span to its last. A
 * flow is written only when both its ends are in the trace; it leaves from and arrives at the
 * slices that begin at its times ("bp": "e"). */
#include <stdlib.h>

#include "base/json.h"
#include "report/timeline.h"

/* A microsecond number out of picoseconds, digit for digit. */
static void put_time(FILE *out, const char *key, int64_t ps)
{
    fprintf(out, ",\"%s\":%lld.%06lld", key, (long long)(ps / 1000000), (long long)(ps % 1000000));
}

/* A JSON string. */
static void put_text(FILE *out, const char *s)
{
    /* The JSON writer escapes; the events around it are written by hand, as they are many and
     * alike. */
    struct json j = json_make(out);
    json_text(&j, s);
}

/* Begin an event; the caller ends it with a brace. */
static void put_head(FILE *out, const char *phase, int rank, const char *name)
{
    fprintf(out, ",\n{\"ph\":\"%s\",\"pid\":0,\"tid\":%d,\"name\":", phase, rank);
    put_text(out, name);
}

/* A slice that has a beginning and a length ("X", a complete event). */
static void put_slice(FILE *out, int rank, const char *name, const char *category, int64_t begin,
                      int64_t end)
{
    put_head(out, "X", rank, name);
    fprintf(out, ",\"cat\":\"%s\"", category);
    put_time(out, "ts", begin);
    put_time(out, "dur", end - begin);
}

/* What it exchanged, and with whom, appears when the slice is clicked. */
static void put_span(const struct span *p, FILE *out)
{
    put_slice(out, p->rank, timeline_kind(p->kind), timeline_kind(p->kind), p->begin_ps, p->end_ps);
    if (p->peer >= 0)
        fprintf(out, ",\"args\":{\"peer\":%d,\"bytes\":%lld}", p->peer, (long long)p->bytes);
    fputs("}", out);
}

/* The flow of a message: "s" starts at the send's slice, "f" ends at the receive's. */
static void put_flow(const struct span *p, FILE *out)
{
    put_head(out, p->kind == SPAN_SEND ? "s" : "f", p->rank, "message");
    fprintf(out, ",\"cat\":\"message\",\"id\":%lld", (long long)p->message);
    put_time(out, "ts", p->begin_ps);
    fputs(p->kind == SPAN_SEND ? "}" : ",\"bp\":\"e\"}", out);
}

/* Names of process and tracks; tracks in the order of ranks, not of their first event. */
static void put_names(const struct timeline *t, FILE *out)
{
    fputs("{\"ph\":\"M\",\"pid\":0,\"name\":\"process_name\",\"args\":{\"name\":", out);
    put_text(out, *t->title ? t->title : "mimdsim");
    fputs("}}", out);
    for (int64_t i = 0; i < t->nspan; i++) {
        int rank = t->span[i]->rank;
        if (i > 0 && t->span[i - 1]->rank == rank) continue;
        put_head(out, "M", rank, "thread_name");
        fprintf(out, ",\"args\":{\"name\":\"rank %d\"}}", rank);
        put_head(out, "M", rank, "thread_sort_index");
        fprintf(out, ",\"args\":{\"sort_index\":%d}}", rank);
    }
}

void trace_chrome(const struct timeline *t, FILE *out)
{
    int64_t *partner = timeline_partners(t);
    fputs("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n", out);
    put_names(t, out);
    /* A stage's slice is written before the spans that it contains. */
    for (int64_t first = 0, next; first < t->nspan; first = next) {
        const struct span *head = t->span[first];
        next = timeline_group(t, first);
        put_slice(out, head->rank, timeline_stage(t, head->stage), "stage", head->begin_ps,
                  t->span[next - 1]->end_ps);
        fputs("}", out);
        for (int64_t i = first; i < next; i++) {
            put_span(t->span[i], out);
            if (partner[i] >= 0) put_flow(t->span[i], out);
        }
    }
    fputs("\n]}\n", out);
    free(partner);
}
