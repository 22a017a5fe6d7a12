/* team.c - the threads of a run, and their turns with the shares of its ranks (team.h).
 *
 * A share is an actor: a ring of ready ranks and an inbox of messages from other shares. It is
 * idle, queued at a thread, or run by one. Threads take shares from the front of their own queue
 * and, when that is empty, from the back of others'. A turn of a share is bounded and it then goes
 * to the end of the queue: so no share runs far ahead of those that read what it sends, and
 * messages in flight stay about as many as on one thread. The run is over when every share is idle:
 * nobody can go on, and nothing is on its way. */
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "measure/run_heartbeat.h"
#include "sim/stack_fault.h"
#include "vp/team_parts.h"

/* --- threads ---------------------------------------------------------------------------------- */

/* Every thread adds what its turns have ended; whoever shows it reads the sum. */
static void tell_heartbeat(struct share *s)
{
    struct run_heartbeat *p = s->world.load->heartbeat;
    if (!p || s->world.nfinished == s->told) return;
    atomic_fetch_add_explicit(&p->ended, s->world.nfinished - s->told, memory_order_relaxed);
    s->told = s->world.nfinished;
}

void team_delay(struct worker *k)
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
    team_delay(k);
    /* Messages are taken from and given back to this thread's own pool, whoever made them. */
    w->pool = &k->pool;
    /* Its ranks are made by the thread that begins with them, which brings their memory. */
    if (!s->made) world_make_ranks(w, t->seed);
    s->made = true;
    team_take_in(s);
    team_leave_barrier(t, s);
    world_resume(w, (int64_t)TURN * w->nown);
    team_send_out(t, s);
    tell_heartbeat(s);
    /* A rank has failed: nobody begins another turn. */
    if (w->stopped) {
        atomic_store(&t->stop, true);
        team_wake_all(t);
        return;
    }
    team_delay(k);
    /* More to do, or new messages since it looked: to the end of the queue. Else it is idle, and
     * the last one that is ends the run. */
    int running = RUNNING;
    if (w->ready_count > 0 || !atomic_compare_exchange_strong(&s->state, &running, IDLE)) {
        atomic_store(&s->state, QUEUED);
        team_enqueue(t, s);
    } else if (atomic_fetch_sub(&t->active, 1) == 1) {
        team_wake_all(t);
    }
}

/* ---- several processes ---- */

/* A letter from another process becomes a message, or ends a barrier. */
static void take_letter(void *context, const struct letter *l, const void *data)
{
    struct team *t = context;
    struct world *w = t->world;
    if (l->to == LETTER_ENTERS) team_enter_process(t, l->arrival);
    if (l->to == LETTER_LEAVES) team_release(t, l->arrival);
    if (l->to < 0) return;
    struct message *m = message_take(&t->worker[0].pool, l->hollow ? 0 : l->bytes);
    if (!l->hollow && l->bytes > 0) memcpy(m->data, data, (size_t)l->bytes);
    m->hollow = l->hollow != 0;
    m->bytes = l->bytes;
    m->tag = l->tag;
    m->sent = l->sent;
    m->kind = MESSAGE_EAGER;
    m->net.id = l->id;
    m->net.arrival = l->arrival;
    m->net.uncontended = l->uncontended;
    m->to = &w->vp[l->to];
    m->from = &w->vp[message_source(m)];
    const int share = l->to >> t->shift;
    struct batch *b = t->in[share];
    if (b && b->n == BATCH) {
        team_push(t, &t->share[share], b);
        b = NULL;
    }
    if (!b) b = t->in[share] = batch_new();
    b->message[b->n++] = m;
}

/* After each look at the post: a batch that waits for more letters would wait for ever. */
static void hand_letters_over(struct team *t)
{
    for (int i = t->first; i < t->end; i++) {
        if (t->in[i]) team_push(t, &t->share[i], t->in[i]);
        t->in[i] = NULL;
    }
}

/* The thread that serves the post runs shares in between. It never sleeps for long: letters come
 * without a signal. */
static void work_and_post(struct worker *k)
{
    enum { PAUSE_US = 20 };
    struct team *t = k->team;
    while (t->state == POST_GOES_ON) {
        bool busy;
        const bool failed = atomic_load(&t->stop), idle = failed || atomic_load(&t->active) == 0;
        t->state = post_serve(t->post, idle, failed, take_letter, t, &busy);
        hand_letters_over(t);
        struct share *s = failed || t->state != POST_GOES_ON ? NULL : team_look_around(k);
        if (s) run_share(k, s);
        else if (!busy) usleep(PAUSE_US);
    }
    atomic_store(&t->over, true);
    team_wake_all(t);
}

/* The first worker is the caller's own thread, which alone may show how far the run is. */
static void *work(void *argument)
{
    struct worker *k = argument;
    struct team *t = k->team;
    const struct run_heartbeat *p = t->world->load->heartbeat;
    check_note_set(t->note.describe, t->note.context);
    struct stack_fault *fault = k->number > 0 ? stack_fault_join(t->world->fault) : NULL;
    if (k->number == 0 && t->post) work_and_post(k);
    for (struct share *s; (s = team_next_share(k)) != NULL;) {
        run_share(k, s);
        if (k->number == 0 && p && p->beat) p->beat(p->context);
    }
    stack_fault_end(fault);
    return NULL;
}

/* --- one run ---------------------------------------------------------------------------------- */

/* Shares of 2^shift ranks, so that a rank's share is found by a shift. */
static int shift_of(int nrank, int parts)
{
    int shift = 0;
    while ((int64_t)parts * SHARES_PER_THREAD << shift < nrank) shift++;
    return shift;
}

/* Processes may have different numbers of threads, but must agree on the shares. */
enum { THREADS_OF_A_PROCESS = 4 };

/* Blocks of whole shares, as even as they go. */
void team_part(const struct world_load *load, int process, int *first, int *end)
{
    *first = 0;
    *end = load->nrank;
    if (!load->hosts) return;
    const int64_t size = load->hosts->size;
    const int shift = shift_of(load->nrank, (int)size * THREADS_OF_A_PROCESS);
    const int64_t nshare = ((load->nrank - 1) >> shift) + 1;
    *first = (int)(process * nshare / size) << shift;
    if (process + 1 < size) *end = (int)((process + 1) * nshare / size) << shift;
}

/* Each share is the whole world but for its own ring of ready ranks, pool, and account of what
 * ended. Tables of the network are common: what is written in them belongs to one node, and so to
 * one rank. */
static void make_shares(struct team *t)
{
    struct world *w = t->world;
    const struct hosts *h = w->load->hosts;
    t->shift = shift_of(w->nrank, h ? h->size * THREADS_OF_A_PROCESS : t->nworker);
    t->nshare = ((w->nrank - 1) >> t->shift) + 1;
    t->first = h ? (int)((int64_t)h->rank * t->nshare / h->size) : 0;
    t->end = h ? (int)((int64_t)(h->rank + 1) * t->nshare / h->size) : t->nshare;
    t->share = TAKE(w->scratch, t->nshare, struct share);
    t->in = TAKE(w->scratch, t->nshare, struct batch *);
    for (int i = t->first; i < t->end; i++) {
        struct share *s = &t->share[i];
        const int first = i << t->shift, left = w->nrank - first;
        s->world = *w;
        s->world.team = t;
        s->world.whole = &s->world;
        s->world.share_barrier = team_barrier;
        s->world.first = first;
        s->world.nown = left < 1 << t->shift ? left : 1 << t->shift;
        s->world.ready = w->ready + first;
        /* Windows leave the network to one thread. */
        if (!w->windows) s->world.net = net_share(w->net, s, w->scratch);
        s->out = TAKE(w->scratch, t->nshare, struct batch *);
        s->touched = TAKE(w->scratch, t->nshare, int);
        /* Neighbours to one thread: most messages stay near. */
        s->home = (int)((int64_t)(i - t->first) * t->nworker / (t->end - t->first));
    }
}

/* Messages are made in an arena of the thread, so that no two threads ask for memory at once. */
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

void team_go(struct team *t, void *(*run)(void *worker))
{
    int nthread = 1;
    for (; nthread < t->nworker; nthread++)
        if (pthread_create(&t->worker[nthread].thread, NULL, run, &t->worker[nthread]) != 0) break;
    run(&t->worker[0]);
    for (int i = 1; i < nthread; i++) pthread_join(t->worker[i].thread, NULL);
}

void team_gather(struct team *t)
{
    struct world *w = t->world;
    w->nfinished = 0;
    int inside = t->inside + (atomic_load(&t->whole) ? w->nown : 0);
    for (int i = t->first; i < t->end; i++) inside += t->share[i].world.barrier_count;
    w->barrier_count = inside;
    for (int i = t->first; i < t->end; i++) {
        struct world *s = &t->share[i].world;
        w->nfinished += s->nfinished;
        w->failed = w->failed || s->failed;
        w->stopped = w->stopped || s->stopped;
        if (s->late) w->late = s->late;
        s->barrier_count = inside;
    }
}

/* Batches are left only where the run was stopped. */
void team_destroy(struct team *t)
{
    for (int i = t->first; i < t->end; i++) {
        struct share *s = &t->share[i];
        free(t->in[i]);
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
    post_close(t->post);
    pthread_mutex_destroy(&t->lock);
    pthread_cond_destroy(&t->news);
}

struct team *team_create(struct world *w, uint64_t seed)
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
    return t;
}

/* From the outside in, and back: shares, threads, post. Every own share is queued once, since all
 * ranks are ready at time 0; from then on only what comes queues it. */
void team_run(struct world *w, uint64_t seed)
{
    struct team *t = team_create(w, seed);
    if (w->load->hosts) t->post = post_open(w->load->hosts, w->load->job_run);
    atomic_store(&t->active, t->end - t->first);
    for (int i = t->first; i < t->end; i++) {
        atomic_store(&t->share[i].state, QUEUED);
        team_enqueue(t, &t->share[i]);
    }
    team_go(t, work);
    team_gather(t);
    w->failed = w->failed || t->state == POST_FAILED;
    w->broken = t->state == POST_BROKEN;
    team_destroy(t);
}
