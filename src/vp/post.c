/* post.c - see post.h. */
#include "vp/post.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/progress.h"

/* Tags repeat after many runs: by then no letter of an earlier one is left. */
enum { FIRST_TAG = 1000, TAGS = 4, RUNS = 7000, MOST_TRIES = 1000 };
enum kind { KIND_LETTERS, KIND_ASK, KIND_ANSWER, KIND_END };

static const double PATIENCE_S = 60; /* how long a process may be silent */

/* Letters for one process, one behind the other. */
struct bag {
    pthread_mutex_t lock;
    char *data;
    size_t used, room;
};

/* A bag on its way. */
struct sending {
    struct sending *next;
    struct hosts_request request;
    char *data;
};

struct count {
    int64_t wave, sent, received, idle, failed;
};

struct post {
    const struct hosts *h;
    int tag;
    struct bag *bag; /* (size) */
    struct sending *sending;
    _Atomic int64_t sent; /* letters put into bags */
    int64_t received;
    /* of process 0: */
    struct count wave, before; /* sums of the present wave and the one before */
    int answers;               /* of the present wave; -1: none is under way */
    double asked;
    enum post_state state;
};

/* Nothing is sent before the first call of post_serve. */
struct post *post_open(const struct hosts *h, int run)
{
    struct post *p = calloc(1, sizeof *p);
    CHECK(p);
    p->bag = calloc((size_t)h->size, sizeof *p->bag);
    CHECK(p->bag);
    for (int i = 0; i < h->size; i++) CHECK(pthread_mutex_init(&p->bag[i].lock, NULL) == 0);
    p->h = h;
    p->tag = FIRST_TAG + run % RUNS * TAGS;
    p->answers = -1;
    p->before.received = -1;
    return p;
}

/* What was sent last may be on its way still, and MPI reads it until it is through. When the run
 * has failed its receiver may never take it: then its memory is left to MPI. */
void post_close(struct post *p)
{
    if (!p) return;
    for (struct sending *s = p->sending, *next; s; s = next) {
        bool done = false;
        next = s->next;
        for (int tries = 0; !done && (p->state == POST_OVER || tries < MOST_TRIES); tries++)
            if (!p->h->call->send_done(&s->request, &done)) break;
        if (done) free(s->data);
        free(s);
    }
    for (int i = 0; i < p->h->size; i++) {
        pthread_mutex_destroy(&p->bag[i].lock);
        free(p->bag[i].data);
    }
    free(p->bag);
    free(p);
}

/* Letters begin at multiples of eight bytes. */
static size_t whole(size_t bytes) { return (bytes + 7) / 8 * 8; }

/* Counted when it is put in, so that a letter that has not left yet is under way for those who
 * count. */
void post_put(struct post *p, int process, const struct letter *l, const void *data)
{
    struct bag *b = &p->bag[process];
    const size_t bytes = l->hollow ? 0 : (size_t)l->bytes, size = sizeof *l + whole(bytes);
    /* Room doubles, so that a letter is copied a few times at most while its bag grows. */
    pthread_mutex_lock(&b->lock);
    if (b->used + size > b->room) {
        b->room = 2 * (b->used + size) + 4096;
        b->data = realloc(b->data, b->room);
        CHECK(b->data);
    }
    memcpy(b->data + b->used, l, sizeof *l);
    if (bytes > 0) memcpy(b->data + b->used + sizeof *l, data, bytes);
    b->used += size;
    p->sent++;
    pthread_mutex_unlock(&b->lock);
}

/* Bags that are through are free again. */
static bool finish_sending(struct post *p)
{
    for (struct sending **at = &p->sending; *at;) {
        struct sending *s = *at;
        bool done;
        if (!p->h->call->send_done(&s->request, &done)) return false;
        if (!done) {
            at = &s->next;
            continue;
        }
        *at = s->next;
        free(s->data);
        free(s);
    }
    return true;
}

/* All at once: the latency of a letter matters more than the number of messages, as nobody goes on
 * without it. */
static bool send_bags(struct post *p, bool *busy)
{
    for (int i = 0; i < p->h->size; i++) {
        struct bag *b = &p->bag[i];
        pthread_mutex_lock(&b->lock);
        char *data = b->data;
        const size_t used = b->used;
        if (used > 0) b->data = NULL, b->used = b->room = 0;
        pthread_mutex_unlock(&b->lock);
        if (used == 0) continue;
        /* The bag goes as it is, and a new one takes its place. */
        struct sending *s = calloc(1, sizeof *s);
        CHECK(s);
        s->data = data;
        s->next = p->sending;
        p->sending = s;
        *busy = true;
        if (!p->h->call->send_begin(i, p->tag + KIND_LETTERS, data, used, &s->request))
            return false;
    }
    return finish_sending(p);
}

/* One behind the other, as post_put has put them. */
static void open_letters(struct post *p, const char *data, size_t bytes, post_take_fn *take,
                         void *context)
{
    for (size_t at = 0; at < bytes; p->received++) {
        struct letter l;
        memcpy(&l, data + at, sizeof l);
        take(context, &l, data + at + sizeof l);
        at += sizeof l + whole(l.hollow ? 0 : (size_t)l.bytes);
    }
}

/* Read by the one thread that receives, while no share runs if `idle`: both numbers are of one
 * moment. */
static struct count own_count(const struct post *p, bool idle, bool failed)
{
    return (struct count){p->wave.wave, p->sent, p->received, idle, failed};
}

static void add_answer(struct post *p, const struct count *c)
{
    p->wave.sent += c->sent;
    p->wave.received += c->received;
    p->wave.idle += c->idle;
    p->wave.failed += c->failed;
    p->answers++;
}

/* What one message is about. */
static bool take_message(struct post *p, const struct hosts_message *m, bool idle, bool failed,
                         post_take_fn *take, void *context)
{
    char *data = malloc(m->bytes + 1);
    struct count c = {0};
    CHECK(data);
    bool ok = p->h->call->receive(m, data);
    const enum kind kind = (enum kind)(m->tag - p->tag);
    if (kind != KIND_LETTERS && m->bytes == sizeof c) memcpy(&c, data, sizeof c);
    switch (kind) {
    case KIND_LETTERS:
        if (ok) open_letters(p, data, m->bytes, take, context);
        break;
    case KIND_ASK:
        p->wave.wave = c.wave;
        c = own_count(p, idle, failed);
        ok = ok && p->h->call->send(0, p->tag + KIND_ANSWER, &c, sizeof c);
        break;
    case KIND_ANSWER:
        if (c.wave == p->wave.wave) add_answer(p, &c);
        break;
    case KIND_END:
        p->state = c.failed ? POST_FAILED : POST_OVER;
        break;
    }
    free(data);
    return ok;
}

/* By kind, since the tags of this run alone are its own. Counts only when every letter that has
 * come is taken, and made work for somebody: then `idle` is no longer true. */
static bool receive(struct post *p, bool idle, bool failed, post_take_fn *take, void *context,
                    bool *busy)
{
    bool letters = false;
    for (int kind = KIND_LETTERS; kind <= KIND_END; kind++)
        for (bool there = true; there;) {
            struct hosts_message m;
            if (!p->h->call->look(HOSTS_ANY, p->tag + kind, false, &there, &m)) return false;
            if (!there) break;
            *busy = true;
            letters = letters || kind == KIND_LETTERS;
            if (!take_message(p, &m, idle && !letters, failed, take, context)) return false;
        }
    return true;
}

/* To all others; a process that does not take it has gone. */
static bool send_all(struct post *p, enum kind kind, const struct count *c)
{
    bool ok = true;
    for (int i = 1; i < p->h->size; i++)
        ok = p->h->call->send(i, p->tag + (int)kind, c, sizeof *c) && ok;
    return ok;
}

/* The wave is complete: is the run over? */
static bool judge_wave(struct post *p)
{
    const struct count *w = &p->wave;
    const bool still = w->idle == p->h->size && w->sent == w->received;
    const bool over = still && p->before.received == w->sent;
    p->before = *w;
    p->answers = -1;
    if (!over && w->failed == 0) return true;
    p->state = w->failed ? POST_FAILED : POST_OVER;
    return send_all(p, KIND_END, w);
}

/* Process 0 asks when it has nothing to do itself, or has failed. */
static bool count(struct post *p, bool idle, bool failed)
{
    if (p->answers >= 0 && p->answers == p->h->size) return judge_wave(p);
    /* A process answers between two turns. One that is silent for very long has gone, and with it
     * its ranks. */
    if (p->answers >= 0) return host_seconds() - p->asked < PATIENCE_S;
    if (!idle && !failed) return true;
    p->wave = (struct count){.wave = p->wave.wave + 1};
    p->answers = 0;
    p->asked = host_seconds();
    const struct count own = own_count(p, idle, failed), ask = {.wave = p->wave.wave};
    add_answer(p, &own);
    return send_all(p, KIND_ASK, &ask);
}

enum post_state post_serve(struct post *p, bool idle, bool failed, post_take_fn *take,
                           void *context, bool *busy)
{
    *busy = false;
    bool ok = send_bags(p, busy) && receive(p, idle, failed, take, context, busy);
    /* What has come may have made work: only a look without news is idle. */
    if (ok && p->state == POST_GOES_ON && p->h->rank == 0) ok = count(p, idle && !*busy, failed);
    return ok ? p->state : POST_BROKEN;
}
