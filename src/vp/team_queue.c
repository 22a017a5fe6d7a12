/* team_queue.c - which share a thread runs next, and when nobody has anything to do
 * (team_parts.h). */
#include <sched.h>

#include "vp/team_parts.h"

/* A thread that sleeps has counted itself before it looked at the queues for the last time, and
 * this one looks for sleepers after it has queued: one of the two sees the other. */
void team_enqueue(struct team *t, struct share *s)
{
    struct worker *k = &t->worker[s->home];
    pthread_mutex_lock(&k->lock);
    int at = k->head + k->count++;
    k->queue[at >= t->nshare ? at - t->nshare : at] = s;
    pthread_mutex_unlock(&k->lock);
    atomic_fetch_add(&t->waiting, 1);
    if (atomic_load(&t->sleepers) == 0) return;
    pthread_mutex_lock(&t->lock);
    pthread_cond_signal(&t->news);
    pthread_mutex_unlock(&t->lock);
}

/* The longest queued of one's own; of another's the one that came last, which that one would reach
 * last. NULL: nothing there. */
static struct share *dequeue(struct team *t, struct worker *k, bool own)
{
    struct share *s = NULL;
    pthread_mutex_lock(&k->lock);
    if (k->count > 0) {
        int at = own ? k->head : k->head + k->count - 1;
        s = k->queue[at >= t->nshare ? at - t->nshare : at];
        if (own && ++k->head == t->nshare) k->head = 0;
        k->count--;
    }
    pthread_mutex_unlock(&k->lock);
    if (s) atomic_fetch_sub(&t->waiting, 1);
    return s;
}

/* Others' queues in a fixed order, beginning with the next thread: thieves then mostly look at
 * different ones. */
struct share *team_look_around(struct worker *k)
{
    struct team *t = k->team;
    struct share *s = dequeue(t, k, true);
    for (int i = 1; !s && i < t->nworker; i++) {
        s = dequeue(t, &t->worker[(k->number + i) % t->nworker], false);
        /* It stays where it was taken: its memory is now in that processor's caches. */
        if (s) s->home = k->number;
    }
    return s;
}

/* Where processes share the run, only the post knows that nothing is under way. */
static bool over(struct team *t)
{
    return atomic_load(&t->stop) ||
           (t->post ? atomic_load(&t->over) : atomic_load(&t->active) == 0);
}

/* The next share to run, NULL: the run is over. A short look for something new first: it comes
 * within microseconds, and going to sleep takes as long. */
struct share *team_next_share(struct worker *k)
{
    enum { LOOKS = 400 };
    struct team *t = k->team;
    for (;;) {
        for (int i = 0; i < LOOKS && !over(t); i++) {
            struct share *s = atomic_load(&t->waiting) > 0 ? team_look_around(k) : NULL;
            if (s) return s;
            if (i % 8 == 7) sched_yield();
        }
        pthread_mutex_lock(&t->lock);
        atomic_fetch_add(&t->sleepers, 1);
        while (!over(t) && atomic_load(&t->waiting) == 0) pthread_cond_wait(&t->news, &t->lock);
        atomic_fetch_sub(&t->sleepers, 1);
        pthread_mutex_unlock(&t->lock);
        if (over(t)) return NULL;
    }
}

/* Under the lock: a thread that is about to sleep has it, and looks before it does. */
void team_wake_all(struct team *t)
{
    pthread_mutex_lock(&t->lock);
    pthread_cond_broadcast(&t->news);
    pthread_mutex_unlock(&t->lock);
}

/* Something has come for s. Whoever calls this runs a share, so that `active` is not 0
 * meanwhile. */
void team_notify(struct team *t, struct share *s)
{
    int state = atomic_load(&s->state);
    for (;;) {
        if (state == QUEUED || state == AGAIN) return;
        const int next = state == IDLE ? QUEUED : AGAIN;
        if (!atomic_compare_exchange_weak(&s->state, &state, next)) continue;
        if (next == AGAIN) return;
        atomic_fetch_add(&t->active, 1);
        team_enqueue(t, s);
        return;
    }
}
