/* team.c - shares of ranks, the threads that run them, and the messages between them (team.h).
 *
 * A share is an actor: a ring of ready ranks and an inbox of messages from other shares. It is idle,
 * queued at a thread, or run by one. Threads take shares from the front of their own queue and, when
 * that is empty, from the back of others'. A turn of a share is bounded and it then goes to the end
 * of the queue: so no share runs far ahead of those that read what it sends, and messages in flight
 * stay about as many as on one thread. The run is over when every share is idle: nobody can go on,
 * and nothing is on its way. */
#include "vp/team.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "measure/run_heartbeat.h"
#include "spec/topology_list.h"

/* Shares for each thread: enough to divide the work evenly, and few enough that most neighbours are
 * in one's own. TURN: how often each rank of a share may go on in one turn, on average. */
enum { SHARES_PER_THREAD = 8, TURN = 4, BATCH = 62, MOST_THREADS = 1024 };

/* Messages for one share, in the order sent. */
struct batch {
    struct batch *next;
    int n;
    struct message *message[BATCH];
};

/* AGAIN: something came for it while a thread ran it. */
enum { IDLE, QUEUED, RUNNING, AGAIN };

struct share {
    struct world world; /* first: a rank's world is its share */
    _Atomic(struct batch *) inbox; /* the newest first */
    _Atomic int state;
    struct batch **out; /* (nshare) being filled for other shares, NULL: none */
    int *touched;       /* (ntouched) shares for which there is one */
    int ntouched, home; /* home: the thread at which it queues */
    int barriers;       /* of the machine's, whose end it has seen */
    int told;           /* ranks that the heartbeat knows to have ended */
    bool made;
};

/* A host thread. */
struct worker {
    struct team *team;
    pthread_t thread;
    struct message_pool pool;
    pthread_mutex_t lock; /* of the queue */
    struct share **queue; /* (nshare) ring */
    int head, count, number;
    struct random random; /* of delays in tests */
};

struct team {
    struct world *world; /* of the whole run */
    struct share *share; /* (nshare) */
    struct worker *worker; /* (nworker) */
    struct message_depot *depot;
    int nshare, nworker, shift; /* rank r is in share r >> shift */
    uint64_t seed;
    struct check_note note;
    _Atomic int active;  /* shares that are not idle; 0: the run is over */
    _Atomic int waiting; /* shares in queues */
    _Atomic bool stop;   /* a rank has failed */
    _Atomic int sleepers;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t news;
    int inside; /* ranks in the machine's barrier whose shares are in it as a whole */
    sim_ps latest;
    _Atomic sim_ps release;
    _Atomic int barriers;
};

/* --- queues ------------------------------------------------------------------------------------ */

/* A thread that sleeps has counted itself before it looked at the queues for the last time, and this
 * one looks for sleepers after it has queued: one of the two sees the other. */
static void enqueue(struct team *t, struct share *s)
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

static struct share *look_around(struct worker *k)
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

static bool over(struct team *t) { return atomic_load(&t->active) == 0 || atomic_load(&t->stop); }

/* The next share to run, NULL: the run is over. A short look for something new first: it comes within
 * microseconds, and going to sleep takes as long. */
static struct share *next_share(struct worker *k)
{
    enum { LOOKS = 400 };
    struct team *t = k->team;
    for (;;) {
        for (int i = 0; i < LOOKS && !over(t); i++) {
            struct share *s = atomic_load(&t->waiting) > 0 ? look_around(k) : NULL;
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

static void wake_all(struct team *t)
{
    pthread_mutex_lock(&t->lock);
    pthread_cond_broadcast(&t->news);
    pthread_mutex_unlock(&t->lock);
}

/* Something has come for s. Whoever calls this runs a share, so that `active` is not 0 meanwhile. */
static void notify(struct team *t, struct share *s)
{
    int state = atomic_load(&s->state);
    for (;;) {
        if (state == QUEUED || state == AGAIN) return;
        const int next = state == IDLE ? QUEUED : AGAIN;
        if (!atomic_compare_exchange_weak(&s->state, &state, next)) continue;
        if (next == AGAIN) return;
        atomic_fetch_add(&t->active, 1);
        enqueue(t, s);
        return;
    }
}

/* --- messages ---------------------------------------------------------------------------------- */

/* Batches of one sender's share are pushed by one thread at a time, in their order. */
static void push(struct team *t, struct share *to, struct batch *b)
{
    b->next = atomic_load(&to->inbox);
    while (!atomic_compare_exchange_weak(&to->inbox, &b->next, b)) {}
    notify(t, to);
}

/* One batch at a time is filled for each share; most go when the turn ends. */
void team_post(struct world *w, struct message *m)
{
    struct share *s = (struct share *)w;
    struct team *t = w->team;
    const int to = (int)(m->to - w->vp) >> t->shift;
    struct batch *b = s->out[to];
    if (!b) {
        b = s->out[to] = malloc(sizeof *b);
        CHECK(b);
        b->n = 0;
        s->touched[s->ntouched++] = to;
    }
    b->message[b->n++] = m;
    if (b->n < BATCH) return;
    push(t, &t->share[to], b);
    /* The share stays in the list of touched ones, with nothing to send: it is asked for once. */
    s->out[to] = malloc(sizeof *b);
    CHECK(s->out[to]);
    s->out[to]->n = 0;
}

static void send_out(struct team *t, struct share *s)
{
    for (int i = 0; i < s->ntouched; i++) {
        const int to = s->touched[i];
        struct batch *b = s->out[to];
        s->out[to] = NULL;
        if (b->n > 0) push(t, &t->share[to], b);
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
static void take_in(struct share *s)
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

/* --- the machine's barrier --------------------------------------------------------------------- */

/* It is left at the latest time at which a rank entered: a maximum, first within each share. The
 * release stays valid until the next barrier is complete, for which every rank must have left this
 * one. */
static void barrier(struct vp *v)
{
    struct world *w = v->world;
    struct team *t = w->team;
    if (v->clock > w->barrier_latest) w->barrier_latest = v->clock;
    if (++w->barrier_count == w->nown) {
        pthread_mutex_lock(&t->lock);
        if (w->barrier_latest > t->latest) t->latest = w->barrier_latest;
        t->inside += w->nown;
        const bool complete = t->inside == w->nrank;
        if (complete) {
            atomic_store(&t->release, t->latest + w->software.barrier);
            t->latest = 0;
            t->inside = 0;
            atomic_fetch_add(&t->barriers, 1);
        }
        pthread_mutex_unlock(&t->lock);
        w->barrier_count = 0;
        w->barrier_latest = 0;
        for (int i = 0; complete && i < t->nshare; i++) notify(t, &t->share[i]);
    }
    vp_block(v, WAITING_BARRIER, NULL);
}

static void leave_barrier(struct team *t, struct share *s)
{
    struct world *w = &s->world;
    const int barriers = atomic_load(&t->barriers);
    if (barriers == s->barriers) return;
    s->barriers = barriers;
    w->barrier_release = atomic_load(&t->release);
    for (int i = 0; i < w->nown; i++) vp_wake(w, &w->vp[w->first + i]);
}

/* --- threads ----------------------------------------------------------------------------------- */

static void tell_heartbeat(struct share *s)
{
    struct run_heartbeat *p = s->world.load->heartbeat;
    if (!p || s->world.nfinished == s->told) return;
    atomic_fetch_add_explicit(&p->ended, s->world.nfinished - s->told, memory_order_relaxed);
    s->told = s->world.nfinished;
}

/* For tests: a thread loses its processor for a while, where it would matter most. */
static void delay(struct worker *k)
{
    if (!k->team->world->load->delays || random_below(&k->random, 4) != 0) return;
    const struct timespec pause = {0, random_below(&k->random, 60) * 1000};
    nanosleep(&pause, NULL);
}

/* One turn of a share. */
static void run_share(struct worker *k, struct share *s)
{
    struct team *t = k->team;
    struct world *w = &s->world;
    atomic_store(&s->state, RUNNING);
    delay(k);
    w->pool = &k->pool;
    /* Its ranks are made by the thread that begins with them, which brings their memory. */
    if (!s->made) world_make_ranks(w, t->seed);
    s->made = true;
    take_in(s);
    leave_barrier(t, s);
    world_resume(w, (int64_t)TURN * w->nown);
    send_out(t, s);
    tell_heartbeat(s);
    if (w->stopped) {
        atomic_store(&t->stop, true);
        wake_all(t);
        return;
    }
    delay(k);
    /* More to do, or new messages since it looked: to the end of the queue. Else it is idle, and the
     * last one that is ends the run. */
    int running = RUNNING;
    if (w->ready_count > 0 || !atomic_compare_exchange_strong(&s->state, &running, IDLE)) {
        atomic_store(&s->state, QUEUED);
        enqueue(t, s);
    } else if (atomic_fetch_sub(&t->active, 1) == 1) {
        wake_all(t);
    }
}

/* The first worker is the caller's own thread, which alone may show how far the run is. */
static void *work(void *argument)
{
    struct worker *k = argument;
    struct team *t = k->team;
    const struct run_heartbeat *p = t->world->load->heartbeat;
    check_note_set(t->note.describe, t->note.context);
    for (struct share *s; (s = next_share(k)) != NULL;) {
        run_share(k, s);
        if (k->number == 0 && p && p->beat) p->beat(p->context);
    }
    return NULL;
}

/* --- one run ----------------------------------------------------------------------------------- */

/* Shares of 2^shift ranks, so that a rank's share is found by a shift. */
static void make_shares(struct team *t)
{
    struct world *w = t->world;
    while ((int64_t)t->nworker * SHARES_PER_THREAD << t->shift < w->nrank) t->shift++;
    t->nshare = ((w->nrank - 1) >> t->shift) + 1;
    t->share = TAKE(w->scratch, t->nshare, struct share);
    for (int i = 0; i < t->nshare; i++) {
        struct share *s = &t->share[i];
        const int first = i << t->shift, left = w->nrank - first;
        s->world = *w;
        s->world.team = t;
        s->world.share_barrier = barrier;
        s->world.first = first;
        s->world.nown = left < 1 << t->shift ? left : 1 << t->shift;
        s->world.ready = w->ready + first;
        s->world.net = net_share(w->net, s, w->scratch);
        s->out = TAKE(w->scratch, t->nshare, struct batch *);
        s->touched = TAKE(w->scratch, t->nshare, int);
        /* Neighbours to one thread: most messages stay near. */
        s->home = (int)((int64_t)i * t->nworker / t->nshare);
    }
}

static void make_workers(struct team *t)
{
    t->worker = TAKE(t->world->scratch, t->nworker, struct worker);
    for (int i = 0; i < t->nworker; i++) {
        struct worker *k = &t->worker[i];
        k->team = t;
        k->number = i;
        k->queue = TAKE(t->world->scratch, t->nshare, struct share *);
        k->pool.arena = arena_create();
        k->pool.depot = t->depot;
        k->random = random_make(t->world->load->delays, (uint64_t)i, 0);
        CHECK(pthread_mutex_init(&k->lock, NULL) == 0);
    }
}

/* A system that refuses a thread leaves its work to the others. */
static void go(struct team *t)
{
    int nthread = 1;
    for (; nthread < t->nworker; nthread++)
        if (pthread_create(&t->worker[nthread].thread, NULL, work, &t->worker[nthread]) != 0) break;
    work(&t->worker[0]);
    for (int i = 1; i < nthread; i++) pthread_join(t->worker[i].thread, NULL);
}

/* What the shares know becomes the world's. A deadlock is explained from the ranks' own states, which
 * are those of a run on one thread: whoever can go on does, in any order. */
static void gather(struct team *t)
{
    struct world *w = t->world;
    int inside = t->inside;
    for (int i = 0; i < t->nshare; i++) inside += t->share[i].world.barrier_count;
    for (int i = 0; i < t->nshare; i++) {
        struct world *s = &t->share[i].world;
        w->nfinished += s->nfinished;
        w->failed = w->failed || s->failed;
        w->stopped = w->stopped || s->stopped;
        if (s->late) w->late = s->late;
        s->barrier_count = inside;
    }
}

/* Batches are left only where the run was stopped. */
static void destroy(struct team *t)
{
    for (int i = 0; i < t->nshare; i++) {
        struct share *s = &t->share[i];
        for (int k = 0; k < s->ntouched; k++) free(s->out[s->touched[k]]);
        for (struct batch *b = atomic_load(&s->inbox), *next; b; b = next) {
            next = b->next;
            free(b);
        }
    }
    for (int i = 0; i < t->nworker; i++) {
        pthread_mutex_destroy(&t->worker[i].lock);
        arena_destroy(t->worker[i].pool.arena);
    }
    message_depot_destroy(t->depot);
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->news);
}

const char *world_alone(const struct machine_spec *m, const struct world_load *load, const struct record_spec *record)
{
    if (load->foreign) return "the program is not a built-in one";
    if (load->timed) return "receives from anybody and tests depend on time";
    if (m->network.level != LEVEL_LOGGP || topology_has(m->topology.family, TOPOLOGY_SHARED))
        return "messages wait for each other at links (network.level loggp has none)";
    if (m->topology.processors_per_node > 1) return "processors of a node share a port";
    if (m->software.kernel_server) return "one kernel server serves the whole machine";
    if (!software_all_eager(&m->software, load->largest_message)) return "large messages shake hands";
    if (m->noise.background_load > 0) return "other jobs' traffic follows time";
    if (record->spans) return "a timeline is recorded";
    return record->path ? "a critical path is recorded" : NULL;
}

void team_run(struct world *w, uint64_t seed)
{
    const int most = w->nrank < MOST_THREADS ? w->nrank : MOST_THREADS;
    struct team *t = TAKE(w->scratch, 1, struct team);
    t->world = w;
    t->nworker = w->load->threads < most ? w->load->threads : most;
    t->seed = seed;
    t->note = check_note_get();
    t->depot = message_depot_create();
    CHECK(pthread_mutex_init(&t->lock, NULL) == 0 && pthread_cond_init(&t->news, NULL) == 0);
    make_shares(t);
    make_workers(t);
    atomic_store(&t->active, t->nshare);
    for (int i = 0; i < t->nshare; i++) {
        atomic_store(&t->share[i].state, QUEUED);
        enqueue(t, &t->share[i]);
    }
    go(t);
    gather(t);
    destroy(t);
}
