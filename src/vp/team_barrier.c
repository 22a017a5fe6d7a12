/* team_barrier.c - the machine's barrier: a maximum over ranks, shares, processes
 * (team_parts.h). */
#include "vp/team_parts.h"

/* It is left at the latest time at which a rank entered: a maximum, first within each share. The
 * release stays valid until the next barrier is complete, for which every rank must have left this
 * one. */
/* The time first, then the count by which a share sees that there is one. */
void team_release(struct team *t, sim_ps time)
{
    atomic_store(&t->whole, false);
    atomic_store(&t->release, time);
    atomic_fetch_add(&t->barriers, 1);
    for (int i = t->first; i < t->end; i++) team_notify(t, &t->share[i]);
}

/* On process 0: one more process is in it as a whole. The last one's news releases all. */
void team_enter_process(struct team *t, sim_ps latest)
{
    const struct hosts *h = t->world->load->hosts;
    pthread_mutex_lock(&t->lock);
    if (latest > t->latest_process) t->latest_process = latest;
    /* those with ranks */
    const bool complete = ++t->processes == (h->size < t->nshare ? h->size : t->nshare);
    const sim_ps time = t->latest_process + t->world->software.barrier;
    if (complete) t->processes = 0, t->latest_process = 0;
    pthread_mutex_unlock(&t->lock);
    if (!complete) return;
    const struct letter leaves = {.to = LETTER_LEAVES, .arrival = time, .hollow = 1};
    for (int i = 1; i < h->size; i++) post_put(t->post, i, &leaves, NULL);
    team_release(t, time);
}

/* This process is in it as a whole. */
static void enter_whole(struct team *t, sim_ps latest)
{
    atomic_store(&t->whole, true);
    const struct letter enters = {.to = LETTER_ENTERS, .arrival = latest, .hollow = 1};
    if (!t->post) team_release(t, latest + t->world->software.barrier);
    else if (t->world->load->hosts->rank == 0) team_enter_process(t, latest);
    else post_put(t->post, 0, &enters, NULL);
}

void team_barrier(struct vp *v)
{
    struct world *w = v->world;
    struct team *t = w->team;
    if (v->clock > w->barrier_latest) w->barrier_latest = v->clock;
    if (++w->barrier_count == w->nown) {
        pthread_mutex_lock(&t->lock);
        if (w->barrier_latest > t->latest) t->latest = w->barrier_latest;
        t->inside += w->nown;
        const bool complete = t->inside == t->world->nown;
        const sim_ps latest = t->latest;
        if (complete) t->latest = 0, t->inside = 0;
        pthread_mutex_unlock(&t->lock);
        w->barrier_count = 0;
        w->barrier_latest = 0;
        if (complete) enter_whole(t, latest);
    }
    vp_block(v, WAITING_BARRIER, NULL);
}

void team_leave_barrier(struct team *t, struct share *s)
{
    struct world *w = &s->world;
    const int barriers = atomic_load(&t->barriers);
    if (barriers == s->barriers) return;
    s->barriers = barriers;
    w->barrier_release = atomic_load(&t->release);
    for (int i = 0; i < w->nown; i++) vp_wake(w, &w->vp[w->first + i]);
}
