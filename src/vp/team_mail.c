/* team_mail.c - messages to other shares, in batches, and to other processes, as letters
 * (team_parts.h). */
#include <stdlib.h>

#include "base/check.h"
#include "vp/team_parts.h"

/* Batches of one sender's share are pushed by one thread at a time, in their order. */
void team_push(struct team *t, struct share *to, struct batch *b)
{
    b->next = atomic_load(&to->inbox);
    while (!atomic_compare_exchange_weak(&to->inbox, &b->next, b)) {}
    team_notify(t, to);
}

/* From the heap: it is freed by another thread than made it. */
struct batch *batch_new(void)
{
    struct batch *b = malloc(sizeof *b);
    CHECK(b);
    b->n = 0;
    return b;
}

/* The process that has share `share` of nshare: process p begins at p nshare / H. */
static int process_of(const struct team *t, int share)
{
    const int64_t size = t->world->load->hosts->size;
    return (int)((size * (share + 1) - 1) / t->nshare);
}

/* A message for another process ends here as a message: its letter becomes one there. */
static void send_letter(struct world *w, struct message *m, int process)
{
    const struct letter l = {.id = m->net.id,
                             .tag = m->tag,
                             .bytes = m->bytes,
                             .arrival = m->net.arrival,
                             .uncontended = m->net.uncontended,
                             .sent = m->sent,
                             .to = (int32_t)(m->to - w->vp),
                             .hollow = m->hollow};
    post_put(w->team->post, process, &l, m->data);
    message_give(w->pool, m);
}

/* One batch at a time is filled for each share; most go when the turn ends. */
void team_post(struct world *w, struct message *m)
{
    struct share *s = (struct share *)w;
    struct team *t = w->team;
    const int to = (int)(m->to - w->vp) >> t->shift;
    if (to < t->first || to >= t->end) {
        send_letter(w, m, process_of(t, to));
        return;
    }
    struct batch *b = s->out[to];
    if (!b) {
        b = s->out[to] = batch_new();
        s->touched[s->ntouched++] = to;
    }
    b->message[b->n++] = m;
    if (b->n < BATCH) return;
    team_push(t, &t->share[to], b);
    /* The share stays in the list of touched ones, with nothing to send: it is asked for once. */
    s->out[to] = batch_new();
}

/* At the end of a turn, so that a share is told once of all that comes from this one. */
void team_send_out(struct team *t, struct share *s)
{
    for (int i = 0; i < s->ntouched; i++) {
        const int to = s->touched[i];
        struct batch *b = s->out[to];
        s->out[to] = NULL;
        if (b->n > 0) team_push(t, &t->share[to], b);
        else free(b);
    }
    s->ntouched = 0;
}

/* Messages, their receivers and the receives lie cold in memory: each is asked for early enough. */
static void deliver_batch(const struct world *w, const struct batch *b)
{
    for (int i = 0; i < b->n; i++) {
        if (i + 8 < b->n) __builtin_prefetch(b->message[i + 8]);
        if (i + 5 < b->n) __builtin_prefetch(&b->message[i + 5]->to->posted);
        if (i + 2 < b->n) __builtin_prefetch(b->message[i + 2]->to->posted);
        w->arrived(b->message[i]);
    }
}

/* The oldest first: matching goes by the order of sending. */
void team_take_in(struct share *s)
{
    struct batch *new = atomic_exchange(&s->inbox, NULL), *old = NULL;
    while (new) {
        struct batch *next = new->next;
        new->next = old;
        old = new;
        new = next;
    }
    while (old) {
        struct batch *next = old->next;
        deliver_batch(&s->world, old);
        free(old);
        old = next;
    }
}
