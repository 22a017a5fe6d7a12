/* arrivals.c - receivers that go on together, because the network tells ahead when messages come.
 *
 * At level link a message's arrival is known when its head is at the last port; the tail and the
 * interface come after that. Its receiver can do nothing before the arrival. So events up to the
 * earliest arrival of those that are known can be taken first, and receivers go on one after the
 * other then, in the same order as before. Among thousands of ranks each lies cold in the host's
 * memory, and only who stands in a row can be asked for early enough: a run of 4,096 or 16,384
 * ranks takes three quarters of the time that it takes when each goes on at once.
 *
 * Why nothing changes: the programs neither ask for the time nor receive from anybody, so that what
 * a rank does follows from its messages and their times (a Kahn network); what it sends is ready at
 * its arrival or later; and the network's events come in an order of their own (sim.h). */
#include "vp/arrivals.h"

#include "vp/team.h"

/* MOST: so many that their messages stay in a cache of the second level. */
enum { MOST = 256 };

struct arrivals {
    int n;
    sim_ps until; /* the earliest arrival of all, at most PS_LAST */
    struct message *message[MOST];
};

/* Timelines and critical paths are kept in the order of the host; users' programs are told which of
 * their mistakes came first. With a rendezvous the answer is sent when a message is matched. */
bool arrivals_make(struct world *w)
{
    const struct world_load *load = w->load;
    if (!net_defers(w->net) || !w->eager_only || load->timed || load->foreign) return false;
    if (w->record->spans || w->record->path) return false;
    w->arrivals = TAKE(w->scratch, 1, struct arrivals);
    return true;
}

void arrivals_add(struct world *w, struct message *m)
{
    struct arrivals *a = w->arrivals;
    const sim_ps last = a->n > 0 ? a->until : PS_LAST;
    a->until = m->net.arrival < last ? m->net.arrival : last;
    CHECK(a->n < MOST);
    a->message[a->n++] = m;
}

/* Each receiver goes on before the next message is matched, as if it had come alone: what ranks
 * send then enters the network in the same order, which decides between heads that are alike in
 * time, port and number. */
void arrivals_give(struct world *w)
{
    struct arrivals *a = w->arrivals;
    for (int i = 0; i < a->n && !w->stopped; i++) {
        const int left = a->n - i;
        struct message *const *next = &a->message[i];
        if (left > ARRIVALS_MESSAGE) arrivals_warm_message(next[ARRIVALS_MESSAGE]);
        if (left > ARRIVALS_RECEIVER) arrivals_warm_receiver(next[ARRIVALS_RECEIVER]->to);
        if (left > ARRIVALS_FIBER) arrivals_warm_fiber(next[ARRIVALS_FIBER]->to);
        if (left > ARRIVALS_STACK) arrivals_warm_stack(next[ARRIVALS_STACK]->to);
        w->arrived(a->message[i]);
        world_resume(w, INT64_MAX);
    }
    a->n = 0;
}

bool arrivals_step(struct world *w)
{
    const struct arrivals *a = w->arrivals;
    /* Ranks that an event has woken go on at once. */
    return a->n > 0 && a->n < MOST && w->ready_count == 0 && sim_step_before(w->sim, a->until);
}

/* A message is about to arrive: where its receiver keeps what it waits for. */
static void foresee(const struct net_message *m)
{
    __builtin_prefetch(&((const struct message *)m)->to->stages);
}

void arrivals_foresee(struct world *w) { net_foresee(w->net, foresee); }
