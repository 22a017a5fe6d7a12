/* windows_ranks.c - shares of ranks in one window: each by itself, or all in the order of one
 * thread (windows_parts.h). */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vp/arrivals.h"
#include "vp/windows_parts.h"

/* A list of messages tells early who is next. */
static inline void warm_up(const struct mail *in, int i)
{
    const int left = in->n - i;
    const struct entry *next = &in->entry[i];
    if (left > ARRIVALS_MESSAGE) arrivals_warm_message(next[ARRIVALS_MESSAGE].m);
    if (left > ARRIVALS_RECEIVER)
        arrivals_warm_receiver(windows_receiver(next[ARRIVALS_RECEIVER].m));
    if (left > ARRIVALS_FIBER) arrivals_warm_fiber(windows_receiver(next[ARRIVALS_FIBER].m));
    if (left > ARRIVALS_STACK) arrivals_warm_stack(windows_receiver(next[ARRIVALS_STACK].m));
}

/* Messages are taken from and given back to the thread's own pool, whoever made them. */
static struct world *begin(struct windows *s, struct worker *k, int i)
{
    struct world *w = &s->team->share[i].world;
    team_delay(k);
    w->pool = &k->pool;
    /* Read by the network in the window after this one. */
    s->side[i].out = &s->present->out[i];
    return w;
}

void windows_begin(struct windows *s, struct worker *k, int i)
{
    struct world *w = begin(s, k, i);
    /* Blocks of ranks in rising order: their first turns are one behind the other as on one
     * thread, where all go on by number. */
    s->side[i].turn = i;
    world_make_ranks(w, s->team->seed);
    world_resume(w, INT64_MAX);
}

/* A message wakes one rank at most, which goes on until it waits again, as on one thread. */
void windows_share(struct windows *s, struct worker *k, int i)
{
    struct world *w = begin(s, k, i);
    const struct mail *in = &s->present->in[i];
    for (int j = 0; j < in->n && !w->stopped; j++) {
        warm_up(in, j);
        s->side[i].turn = in->entry[j].turn;
        w->arrived(in->entry[j].m);
        world_resume(w, INT64_MAX);
    }
}

/* ---- in the order of one thread ---- */

/* A turn of share i: of the rank that takes m, where there is one, and of `n` ranks that have been
 * woken. */
static void go_on(struct windows *s, int i, struct message *m, int n)
{
    struct world *w = &s->team->share[i].world;
    s->side[i].turn = windows_turn(s->present, i);
    if (m) w->arrived(m);
    world_resume(w, n);
    s->ended = s->ended || w->stopped;
}

/* Everybody but v may leave the barrier, at one time. */
static void open_barrier(struct windows *s)
{
    struct team *t = s->team;
    sim_ps latest = 0;
    /* A maximum over shares of what each has kept of its ranks. */
    for (int i = 0; i < t->nshare; i++) {
        struct world *w = &t->share[i].world;
        if (w->barrier_latest > latest) latest = w->barrier_latest;
        w->barrier_latest = 0;
        w->barrier_count = 0;
    }
    for (int i = 0; i < t->nshare; i++)
        t->share[i].world.barrier_release = latest + s->world->software.barrier;
    s->inside = 0;
    s->opened = true;
}

static void wake_all_but(struct windows *s, const struct vp *v)
{
    struct vp *vp = s->world->vp;
    for (int i = 0; i < s->world->nrank; i++)
        if (&vp[i] != v) vp_wake(vp[i].world, &vp[i]);
}

/* The last one goes on at once, the others when it waits again, by number. Whether one is the last
 * is only known in the order of one thread. */
void windows_barrier(struct vp *v)
{
    struct world *w = v->world;
    struct windows *s = w->windows;
    if (v->clock > w->barrier_latest) w->barrier_latest = v->clock;
    w->barrier_count++;
    if (s->in_order && ++s->inside == s->world->nrank) {
        open_barrier(s);
        wake_all_but(s, v);
        return;
    }
    vp_block(v, WAITING_BARRIER, NULL);
}

/* Whom a barrier has let go. The last of them may open the next one: it is let go after all of
 * these, so that they are counted first. */
static void leave_barriers(struct windows *s)
{
    struct team *t = s->team;
    while (s->opened && !s->ended) {
        s->opened = false;
        /* Counted before the first of them goes on: it may wake others. */
        int *n = memory_take((size_t)t->nshare, sizeof *n);
        for (int i = 0; i < t->nshare; i++) n[i] = t->share[i].world.ready_count;
        for (int i = 0; i < t->nshare; i++) go_on(s, i, NULL, n[i]);
        free(n);
    }
}

/* Where a barrier opens, turns of all shares come before that of the next message: so they are
 * counted anew. */
void windows_in_order(struct windows *s)
{
    struct team *t = s->team;
    struct window *w = s->present;
    const int n = w->nturn;
    /* The numbers that the network gave are read from a copy while new ones are written. */
    int *share = memory_take((size_t)n, sizeof *share);
    memcpy(share, w->share, (size_t)n * sizeof *share);
    w->nturn = 0;
    s->in_order = true;
    for (int i = 0; i < t->nshare; i++) begin(s, &t->worker[0], i);
    for (int k = 0; k < n && !s->ended; k++) {
        struct mail *in = &w->in[share[k]];
        go_on(s, share[k], in->entry[in->at++].m, 1);
        leave_barriers(s);
    }
    s->in_order = false;
    free(share);
}

/* The last one of all has entered last; like the others it waits. */
void windows_first_barrier(struct windows *s)
{
    struct vp *last = &s->world->vp[s->world->nrank - 1];
    /* No message has come yet, so no turn lies between its entry and what follows from it. */
    s->in_order = true;
    open_barrier(s);
    vp_wake(last->world, last);
    go_on(s, windows_share_of(last->world), NULL, 1);
    wake_all_but(s, last);
    leave_barriers(s);
    s->in_order = false;
}
