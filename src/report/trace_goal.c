/* trace_goal.c - a recorded run as a schedule in the language GOAL: what each rank computed, sent
 * and received, one after the other.
 *
 * A rank's operations form a chain. What follows a send waits for its start alone: a program that
 * goes on while a large message is answered must not wait for the answer here. A message's tag is
 * its number among those of its sender, so that each receive finds the message that it found in the
 * run. Waiting is not written: it comes about again; but for that in a barrier of the machine,
 * which the language does not know: the time spent in it is written as computing. Times are in
 * picoseconds, which a remark says; other readers of the language know no unit. */
#include <stdlib.h>

#include "base/check.h"
#include "report/timeline.h"

/* What one rank has done so far. */
struct chain {
    int64_t label;        /* of the last operation, 0: none */
    bool after_send;      /* it is a send */
    int64_t last_message; /* when its last message ended */
};

/* The last operation has its number: this one waits for it. */
static void put_link(struct chain *c, bool send, FILE *out)
{
    c->label++;
    if (c->label > 1)
        fprintf(out, "l%lld %s l%lld\n", (long long)c->label,
                c->after_send ? "irequires" : "requires", (long long)c->label - 1);
    c->after_send = send;
}

static void put_operation(struct chain *c, const struct span *p, FILE *out)
{
    const int64_t label = c->label + 1, tag = p->message & UINT32_MAX;
    const bool send = p->kind == SPAN_SEND;
    if (p->kind == SPAN_COMPUTE || p->kind == SPAN_BARRIER)
        fprintf(out, "l%lld: calc %lld\n", (long long)label, (long long)(p->end_ps - p->begin_ps));
    else
        fprintf(out, "l%lld: %s %lldb %s %d tag %lld\n", (long long)label, send ? "send" : "recv",
                (long long)p->bytes, send ? "to" : "from", p->peer, (long long)tag);
    put_link(c, send, out);
}

static bool is_message(const struct span *p)
{
    return (p->kind == SPAN_SEND || p->kind == SPAN_RECV) && p->message >= 0;
}

/* A barrier made of messages has some within it, by time before or behind its own span; one of
 * hardware has none. */
static bool is_hardware_barrier(const struct timeline *t, int64_t i, const struct chain *c)
{
    const struct span *p = t->span[i];
    if (p->kind != SPAN_BARRIER || c->last_message > p->begin_ps) return false;
    for (int64_t k = i + 1;
         k < t->nspan && t->span[k]->rank == p->rank && t->span[k]->begin_ps < p->end_ps; k++)
        if (is_message(t->span[k])) return false;
    return true;
}

int64_t trace_goal(const struct timeline *t, FILE *out)
{
    int64_t i = 0, barriers = 0;
    fprintf(out, "// %s\n// mimdsim time unit: 1 ps\nnum_ranks %d\n", t->title, t->run->nrank);
    for (int rank = 0; rank < t->run->nrank; rank++) {
        struct chain c = {.last_message = -1};
        fprintf(out, "\nrank %d {\n", rank);
        for (; i < t->nspan && t->span[i]->rank == rank; i++) {
            const struct span *p = t->span[i];
            const bool barrier = is_hardware_barrier(t, i, &c);
            if (barrier) fprintf(out, "// a barrier of the machine\n");
            if (barrier || is_message(p) || p->kind == SPAN_COMPUTE) put_operation(&c, p, out);
            if (is_message(p)) c.last_message = p->end_ps;
            barriers += barrier;
        }
        fprintf(out, "}\n");
    }
    return barriers;
}
