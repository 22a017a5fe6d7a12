/* trace_paje.c - Paje traces: containers are ranks, with one state for the stage and one for the
 * activity; messages are links. Events must come in the order of time; the definitions are those of
 * "Paje trace file" (Kergommeaux and Stein, 2003), with the fields that ViTE and pj_dump read. */
#include <stdlib.h>

#include "base/memory.h"
#include "report/timeline.h"

/* In the order in which events of one time must be written. */
enum change { STAGE_BEGINS, SPAN_BEGINS, MESSAGE_LEAVES, MESSAGE_ARRIVES, SPAN_ENDS };

/* A line of the trace that is yet to be written. */
struct event {
    int64_t time;
    enum change change;
    int64_t index;   /* of the span */
};

static int compare_events(const void *a, const void *b)
{
    const struct event *x = a, *y = b;
    if (x->time != y->time) return x->time < y->time ? -1 : 1;
    if (x->change != y->change) return x->change < y->change ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/* The fields of each event that is used, numbered 0 to 8; a reader learns the format from here. */
static void put_definitions(FILE *out)
{
    /* number, name and fields; fields are separated by blanks */
    static const char *const definition[] = {
        "PajeDefineContainerType 0\n% Alias string\n% Type string\n% Name string",
        "PajeDefineStateType 1\n% Alias string\n% Type string\n% Name string",
        "PajeDefineLinkType 2\n% Alias string\n"
        "% Type string\n% StartContainerType string\n% EndContainerType string\n% Name string",
        "PajeDefineEntityValue 3\n% Alias string\n% Type string\n% Name string\n% Color color",
        "PajeCreateContainer 4\n"
        "% Time date\n% Alias string\n% Type string\n% Container string\n% Name string",
        "PajeDestroyContainer 5\n% Time date\n% Type string\n% Name string",
        "PajeSetState 6\n% Time date\n% Type string\n% Container string\n% Value string",
        "PajeStartLink 7\n% Time date\n"
        "% Type string\n% Container string\n% StartContainer string\n% Value string\n% Key string",
        "PajeEndLink 8\n"
        "% Time date\n% Type string\n% Container string\n% EndContainer string\n% Value string\n"
        "% Key string"};
    for (size_t i = 0; i < sizeof definition / sizeof *definition; i++)
        fprintf(out, "%%EventDef %s\n%%EndEventDef\n", definition[i]);
}

/* Types, and colours that are told apart by colour-blind readers (Okabe and Ito). */
static void put_types(const struct timeline *t, FILE *out)
{
    static const char *const colour[] = {"0.0 0.447 0.698", "0.902 0.624 0.0", "0.941 0.894 0.259",
                                         "0.784 0.831 0.863", "0.8 0.475 0.655"};
    static const char *const hue[] = {"0.337 0.706 0.914", "0.0 0.62 0.451", "0.835 0.369 0.0",
                                      "0.941 0.894 0.259"};
    fputs("0 M 0 \"machine\"\n0 R M \"rank\"\n1 S R \"stage\"\n1 A R \"activity\"\n2 L M R R "
          "\"message\"\n",
          out);
    for (int i = 0; i < t->run->nstage; i++)
        fprintf(out, "3 s%d S \"%s\" \"%s\"\n", i, t->run->stage_name[i], hue[i % 4]);
    for (int i = SPAN_COMPUTE; i <= SPAN_BARRIER; i++)
        fprintf(out, "3 a%d A \"%s\" \"%s\"\n", i, timeline_kind((enum span_kind)i), colour[i]);
    fputs("3 idle A \"idle\" \"1 1 1\"\n3 m L \"message\" \"0 0 0\"\n", out);
}

/* Seconds out of picoseconds, digit for digit. */
static void put_time(FILE *out, int kind, int64_t ps)
{
    fprintf(out, "%d %lld.%012lld", kind, (long long)(ps / 1000000000000),
            (long long)(ps % 1000000000000));
}

/* All changes of state and all message ends, in order of time; returns how many. */
static int64_t gather(const struct timeline *t, const int64_t *partner, struct event *event)
{
    int64_t n = 0;
    for (int64_t i = 0; i < t->nspan; i++) {
        const struct span *p = t->span[i];
        /* The first and the last span of a rank open and close its states. */
        bool first = i == 0 || t->span[i - 1]->rank != p->rank;
        bool last = i + 1 == t->nspan || t->span[i + 1]->rank != p->rank;
        /* Stages change only when the next span has another one. */
        if (first || t->span[i - 1]->stage != p->stage)
            event[n++] = (struct event){p->begin_ps, STAGE_BEGINS, i};
        event[n++] = (struct event){p->begin_ps, SPAN_BEGINS, i};
        if (partner[i] >= 0 && p->kind == SPAN_SEND)
            event[n++] = (struct event){p->end_ps, MESSAGE_LEAVES, i};
        /* A message cannot arrive before it left: the receive may have been posted earlier. */
        if (partner[i] >= 0 && p->kind == SPAN_RECV) {
            int64_t sent = t->span[partner[i]]->end_ps;
            event[n++] =
                (struct event){p->begin_ps > sent ? p->begin_ps : sent, MESSAGE_ARRIVES, i};
        }
        /* Where the next span follows at once, it replaces the state; else the rank is idle. */
        if (last || t->span[i + 1]->begin_ps > p->end_ps)
            event[n++] = (struct event){p->end_ps, SPAN_ENDS, i};
    }
    qsort(event, (size_t)n, sizeof *event, compare_events);
    return n;
}

/* Event 6 sets a state, 7 and 8 are the two ends of a message, matched by its number. */
static void put_event(const struct timeline *t, const struct event *v, FILE *out)
{
    const struct span *p = t->span[v->index];
    bool link = v->change == MESSAGE_LEAVES || v->change == MESSAGE_ARRIVES;
    put_time(out, v->change == MESSAGE_LEAVES ? 7 : v->change == MESSAGE_ARRIVES ? 8 : 6, v->time);
    if (link) fprintf(out, " L m r%d m %lld\n", p->rank, (long long)p->message);
    else if (v->change == STAGE_BEGINS) fprintf(out, " S r%d s%d\n", p->rank, p->stage);
    else if (v->change == SPAN_BEGINS) fprintf(out, " A r%d a%d\n", p->rank, (int)p->kind);
    else fprintf(out, " A r%d idle\n", p->rank);
}

/* Make or end the containers: the machine around the ranks. Ranks are inside the machine: made
 * after it, ended before it. */
static void put_containers(const struct timeline *t, bool make, int64_t time, FILE *out)
{
    if (make) {
        put_time(out, 4, time);
        fputs(" m M 0 \"machine\"\n", out);
    }
    for (int64_t i = 0; i < t->nspan; i++) {
        int rank = t->span[i]->rank;
        if (i > 0 && t->span[i - 1]->rank == rank) continue;
        put_time(out, make ? 4 : 5, time);
        if (make) fprintf(out, " r%d R m \"rank %d\"\n", rank, rank);
        else fprintf(out, " R r%d\n", rank);
    }
    if (!make) {
        put_time(out, 5, time);
        fputs(" M m\n", out);
    }
}

void trace_paje(const struct timeline *t, FILE *out)
{
    /* At most four events a span: stage, span, message end, idle. Gather and sort first: Paje is
     * read from start to end, in the order of time, while spans lie rank by rank. */
    int64_t *partner = timeline_partners(t), end = t->begin_ps;
    struct event *event = memory_take((size_t)t->nspan * 4, sizeof *event);
    int64_t n = gather(t, partner, event),
            start = event[0].time < t->begin_ps ? event[0].time : t->begin_ps;
    if (n > 0 && event[n - 1].time > end) end = event[n - 1].time;
    put_definitions(out);
    put_types(t, out);
    put_containers(t, true, start, out);
    for (int64_t i = 0; i < n; i++) put_event(t, &event[i], out);
    put_containers(t, false, end, out);
    free(event);
    free(partner);
}
