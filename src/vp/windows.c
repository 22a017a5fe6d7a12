/* windows.c - windows of simulated time: the network's events in one thread, ranks in all of them
 * (windows.h).
 *
 * The thread of the caller has the network, and takes shares of ranks when the window's events are
 * done. Other threads take shares alone. Nobody waits for a thread that has not begun: where the
 * host has no processor for it, or a window is small, the caller does all of the work. */
#include "vp/windows.h"

#include <sched.h>
#include <stdlib.h>

#include "base/memory.h"
#include "sim/stack_fault.h"
#include "vp/windows_parts.h"
#include "vp/world_parts.h"

/* Windows end early with so many messages, so that what the network leaves to the ranks is still in
 * the caches. A window of less than FEW is not worth the other threads' attention. */
enum { MOST_TURNS = 4096, FEW = 32 };

/* ---- the network ---- */

/* Its messages come in the order of events. */
void windows_deliver(struct world *w, struct message *m)
{
    struct windows *s = w->windows;
    struct window *c = s->coming;
    const int share = (int)(windows_receiver(m) - w->vp) >> s->team->shift;
    /* Nothing that comes of this window can be earlier than what comes of its first message. */
    if (c->nturn == 0) c->first = sim_now(w->sim);
    windows_add(&c->in[share], m, windows_turn(c, share));
}

/* Empty, for new turns. */
static void clear(struct windows *s, struct window *w)
{
    for (int i = 0; i < s->team->nshare; i++)
        w->in[i].n = w->in[i].at = w->out[i].n = w->out[i].at = 0;
    w->nturn = 0;
    w->first = SIM_NEVER;
}

/* What ranks have sent in the last window but one, in the order of turns. That it comes too late is
 * never so: the lookahead says it. */
static void take_in(struct windows *s)
{
    struct window *w = s->past;
    for (int turn = 0; turn < w->nturn; turn++) {
        struct mail *out = &w->out[w->share[turn]];
        for (; out->at < out->n && out->entry[out->at].turn == turn; out->at++) {
            /* Written by the sender's thread, and not touched since. */
            if (out->at + 4 < out->n) {
                const char *next = (const char *)out->entry[out->at + 4].m;
                __builtin_prefetch(next);
                __builtin_prefetch(next + 64);
            }
            struct message *m = out->entry[out->at].m;
            CHECK(m->net.ready + s->wire >= s->done);
            net_send(s->world->net, &m->net);
        }
    }
    clear(s, w);
}

/* Events until half of the lookahead has passed, and none that ranks of the window before, which go
 * on meanwhile, may have something before. */
static void network(struct windows *s)
{
    struct sim *sim = s->world->sim;
    take_in(s);
    const sim_ps next = sim_next_time(sim);
    if (next == SIM_NEVER) return;
    /* Half, so that the next window has the other half before it must wait for these ranks. */
    sim_ps end = ps_later(next, s->lookahead / 2);
    if (s->present->nturn > 0 && ps_later(s->present->first, s->lookahead) < end)
        end = ps_later(s->present->first, s->lookahead);
    /* Beyond the end of time nothing is comparable: the loop sees it and ends the run. */
    if (next > PS_LAST && s->present->nturn == 0) end = SIM_NEVER;
    while (s->coming->nturn < MOST_TURNS && sim_step_before(sim, end)) {
    }
    s->done = end;
}

/* ---- ranks ---- */

/* Shares that nobody has taken in window `number`, from a place of one's own on: so threads mostly
 * find the shares of the window before, and help each other at the end. */
static void take_shares(struct windows *s, struct worker *k, int64_t number)
{
    struct team *t = s->team;
    const int begin = (int)((int64_t)k->number * t->nshare / t->nworker);
    for (int j = 0; j < t->nshare; j++) {
        const int i = begin + j < t->nshare ? begin + j : begin + j - t->nshare;
        /* One thread gets it; none does who still looks for the shares of a window that is over. */
        int64_t before = number - 1;
        if (!atomic_compare_exchange_strong(&s->side[i].taken, &before, number)) continue;
        if (number == 1) windows_begin(s, k, i);
        else windows_share(s, k, i);
        atomic_fetch_sub(&s->left, 1);
    }
}

/* For the other threads: there is a window. */
static void announce(struct windows *s)
{
    struct team *t = s->team;
    /* The count before the number: who sees the number may take a share at once. */
    atomic_store(&s->left, t->nshare);
    atomic_fetch_add(&s->number, 1);
    if (atomic_load(&t->sleepers) == 0) return;
    pthread_mutex_lock(&t->lock);
    pthread_cond_broadcast(&t->news);
    pthread_mutex_unlock(&t->lock);
}

/* The next window after `seen`, -1: the run is over. A short look first, as in team_next_share. */
static int64_t await(struct windows *s, int64_t seen)
{
    enum { LOOKS = 4000 };
    struct team *t = s->team;
    for (int i = 0; i < LOOKS; i++) {
        if (atomic_load(&s->over)) return -1;
        if (atomic_load(&s->number) != seen) return atomic_load(&s->number);
        if (i % 64 == 63) sched_yield();
    }
    pthread_mutex_lock(&t->lock);
    atomic_fetch_add(&t->sleepers, 1);
    while (!atomic_load(&s->over) && atomic_load(&s->number) == seen)
        pthread_cond_wait(&t->news, &t->lock);
    atomic_fetch_sub(&t->sleepers, 1);
    pthread_mutex_unlock(&t->lock);
    return atomic_load(&s->over) ? -1 : atomic_load(&s->number);
}

static void end_all(struct windows *s)
{
    atomic_store(&s->over, true);
    team_wake_all(s->team);
}

/* ---- windows ---- */

/* Where every rank may be in the machine's barrier at the end of this window, the order in which
 * they come decides who is last. Each message wakes one rank, which enters once. */
static bool may_open(const struct windows *s)
{
    return s->world->machine->software.barrier == BARRIER_HARDWARE &&
           s->inside + s->present->nturn >= s->world->nrank;
}

/* After each window: who has come how far. */
static void look(struct windows *s)
{
    struct team *t = s->team;
    s->inside = 0;
    s->world->nfinished = 0;
    for (int i = 0; i < t->nshare; i++) {
        const struct world *w = &t->share[i].world;
        s->inside += w->barrier_count;
        s->world->nfinished += w->nfinished;
        s->ended = s->ended || w->stopped;
    }
    world_tell_heartbeat(s->world);
}

/* The others begin with the ranks while this thread has the network. */
static void shared_window(struct windows *s)
{
    const int64_t number = atomic_load(&s->number) + 1;
    announce(s);
    network(s);
    take_shares(s, &s->team->worker[0], number);
    /* Only shares that others have begun: a short while, unless the host took their processor. */
    for (int i = 0; atomic_load(&s->left) > 0; i++)
        if (i % 64 == 63) sched_yield();
}

/* One window of the network, and of the ranks the window before. */
static void go_through(struct windows *s)
{
    if (may_open(s)) {
        network(s);
        windows_in_order(s);
    } else if (s->present->nturn >= FEW) {
        shared_window(s);
    } else {
        network(s);
        for (int i = 0; i < s->team->nshare; i++)
            if (s->present->in[i].n > 0) windows_share(s, &s->team->worker[0], i);
    }
    look(s);
    /* Three windows in turn: one is filled, one is lived through, one is read by the network. */
    struct window *spare = s->past;
    s->past = s->present;
    s->present = s->coming;
    s->coming = spare;
}

/* All ranks begin at time 0, by number: the turn of each share. */
static void begin(struct windows *s)
{
    const int nshare = s->team->nshare;
    for (int i = 0; i < nshare; i++) windows_turn(s->present, i);
    s->present->first = 0;
    shared_window(s);
    look(s);
    if (s->inside == s->world->nrank && !s->ended) windows_first_barrier(s);
    look(s);
    struct window *spare = s->past;
    s->past = s->present;
    s->present = spare;
}

static void *work(void *argument)
{
    struct worker *k = argument;
    struct team *t = k->team;
    struct windows *s = t->world->windows;
    check_note_set(t->note.describe, t->note.context);
    if (k->number > 0) {
        struct stack_fault *fault = stack_fault_join(t->world->fault);
        for (int64_t n = 0; (n = await(s, n)) > 0;) take_shares(s, k, n);
        stack_fault_end(fault);
        return NULL;
    }
    begin(s);
    /* Until nothing is on its way: no turn, nothing sent, no event. */
    while (!s->ended && (s->present->nturn > 0 || s->past->nturn > 0 ||
                         (sim_pending(t->world->sim) > 0 && !sim_beyond(t->world->sim))))
        go_through(s);
    end_all(s);
    return NULL;
}

/* ---- one run ---- */

static void make(struct windows *s)
{
    struct world *w = s->world;
    const int n = s->team->nshare;
    s->side = TAKE(w->scratch, n, struct side);
    for (int i = 0; i < n; i++) s->team->share[i].world.share_barrier = windows_barrier;
    for (int i = 0; i < 3; i++) {
        s->window[i].in = TAKE(w->scratch, n, struct mail);
        s->window[i].out = TAKE(w->scratch, n, struct mail);
        clear(s, &s->window[i]);
    }
    s->coming = &s->window[0];
    s->present = &s->window[1];
    s->past = &s->window[2];
    s->lookahead = windows_lookahead(w->machine, w->load);
    s->wire = windows_wire(w->machine, w->load);
}

static void destroy(struct windows *s)
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < s->team->nshare; k++) {
            free(s->window[i].in[k].entry);
            free(s->window[i].out[k].entry);
        }
        free(s->window[i].share);
    }
    team_destroy(s->team);
}

void windows_run(struct world *w, uint64_t seed)
{
    struct windows *s = TAKE(w->scratch, 1, struct windows);
    s->world = w;
    w->windows = s;
    s->team = team_create(w, seed);
    make(s);
    team_go(s->team, work);
    team_gather(s->team);
    destroy(s);
}
