/* timeline.c - what the formats of a trace share: words, groups of spans, the two ends of a message
 * (timeline.h). */
#include "report/timeline.h"

#include <stdlib.h>

#include "base/memory.h"

/* In the order of enum span_kind. */
const char *timeline_kind(enum span_kind kind)
{
    static const char *const word[] = {"compute", "send", "recv", "wait", "barrier"};
    return word[kind];
}

/* A stage without a name, -1, is what a program does before its first one. */
const char *timeline_stage(const struct timeline *t, int stage)
{
    return stage >= 0 && stage < t->run->nstage ? t->run->stage_name[stage] : "";
}

/* Spans are sorted by rank and begin: a group is what one rank does in one stage without a
 * break. */
int64_t timeline_group(const struct timeline *t, int64_t first)
{
    int64_t i = first + 1;
    while (i < t->nspan && t->span[i]->rank == t->span[first]->rank &&
           t->span[i]->stage == t->span[first]->stage)
        i++;
    return i;
}

/* A message's two ends, while they are matched: number of the message and place of the span. */
struct message_end {
    int64_t message, index;
};

/* Ends of one message next to each other; of equal ones the earlier span first. */
static int compare_message(const void *a, const void *b)
{
    const struct message_end *x = a, *y = b;
    if (x->message != y->message) return x->message < y->message ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/* partner[i]: the span at the other end of span i's message, -1: none. Sorting all ends by
 * message takes n log n, and needs no table of messages. A partner is missing when the window or
 * the limit cut it off, or the rank is not shown. */
int64_t *timeline_partners(const struct timeline *t)
{
    int64_t *partner = memory_take((size_t)t->nspan, sizeof *partner), n = 0;
    struct message_end *end = memory_take((size_t)t->nspan, sizeof *end);
    for (int64_t i = 0; i < t->nspan; i++) {
        partner[i] = -1;
        bool is_end = t->span[i]->kind == SPAN_SEND || t->span[i]->kind == SPAN_RECV;
        if (is_end && t->span[i]->message >= 0)
            end[n++] = (struct message_end){t->span[i]->message, i};
    }
    qsort(end, (size_t)n, sizeof *end, compare_message);
    for (int64_t i = 0; i + 1 < n; i++) {
        int64_t a = end[i].index, b = end[i + 1].index;
        /* Two sends of one number cannot be: neighbours of the same kind are no pair. */
        if (end[i].message != end[i + 1].message || t->span[a]->kind == t->span[b]->kind) continue;
        partner[a] = b;
        partner[b] = a;
    }
    free(end);
    return partner;
}
