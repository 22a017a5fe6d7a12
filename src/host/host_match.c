/* host_match.c - wildcards, tests and probes on MPI: messages are taken from MPI as they come and
 * matched here.
 *
 * MPI's own matching knows no masks of tags. So a program that uses comm_match.h gets all its
 * messages by this file: each that has arrived goes to the first posted receive that fits it, or
 * waits in the order of arrival. The rules are those of comm_match.h: messages of one sender do not
 * overtake each other, of two receives the one posted first is served. What "arrived first" means
 * is decided by this computer, so answers that depend on it may differ from run to run. */
#include <stdlib.h>
#include <string.h>

#include "host/host_parts.h"

static struct host_comm *mine(struct comm *c) { return (struct host_comm *)c; }

/* Whether a receive from `src` with `tag` under `mask` takes message m. */
static bool fits(const struct host_pending *m, int src, int64_t tag, int64_t mask)
{
    return (src == COMM_ANY_SOURCE || src == m->from) && ((m->tag ^ tag) & mask) == 0;
}

/* Message m into the buffer of request r, cut where it is too long; r is complete. */
static void deliver(struct host_comm *h, struct host_pending *m, struct comm_request *r)
{
    /* What the request says of its message is what comm_match.h promises. */
    struct host_pending *p = r->detail;
    const size_t room = (size_t)r->capacity, n = m->bytes < room ? m->bytes : room;
    if (n > 0 && r->buffer != NULL) memcpy(r->buffer, m->copy, n);
    r->truncated = m->bytes > room;
    r->bytes = (int64_t)m->bytes;
    r->peer = m->from;
    r->tag = m->tag;
    p->done = true;
    p->order = ++h->completed;
}

/* One message from MPI, if there is any: to a receive or to the list. */
static bool take_one(struct host_comm *h)
{
    const struct lane_calls *lane = h->hosts->call->lane;
    struct hosts_message told;
    bool there = false;
    if (!lane->look(&h->lane, &there, &told)) host_stop(h, "MPI reports an error in a probe");
    if (!there) return false;
    /* Into a node first: which receive fits is not known before the tag is. */
    struct host_pending *m = host_pending_new(h, told.bytes);
    m->bytes = told.bytes;
    m->from = told.from;
    m->tag = host_tag_back(h, told.tag);
    if (!lane->receive(&h->lane, &told, m->copy)) host_stop(h, "MPI reports an error in a receive");
    for (struct host_pending **at = &h->posted.first; *at != NULL; at = &(*at)->next) {
        struct host_pending *p = *at;
        if (!fits(m, p->from, p->tag, p->mask)) continue;
        host_list_remove(&h->posted, at);
        deliver(h, m, p->request);
        host_pending_free(h, m);
        return true;
    }
    host_list_add(&h->arrived, m);
    return true;
}

/* All that MPI has for this rank now. */
static void progress(struct host_comm *h)
{
    while (h->hosts != NULL && take_one(h)) continue;
}

/* The first message that has arrived and fits; NULL: none. */
static struct host_pending **find(struct host_comm *h, int src, int64_t tag, int64_t mask)
{
    struct host_pending **at = &h->arrived.first;
    while (*at != NULL && !fits(*at, src, tag, mask)) at = &(*at)->next;
    return *at != NULL ? at : NULL;
}

/* The receive is posted here alone: MPI's own queue of arrived messages is emptied by progress. */
void host_match_receive(struct comm *c, int src, int64_t tag, int64_t mask, void *buffer,
                        int64_t capacity, struct comm_request *r)
{
    struct host_comm *h = mine(c);
    struct host_pending *p = host_pending_new(h, 0);
    p->held = true;
    p->from = src;
    p->tag = tag;
    p->mask = mask;
    p->request = r;
    *r = (struct comm_request){.buffer = buffer,
                               .bytes = capacity,
                               .capacity = capacity,
                               .tag = tag,
                               .mask = mask,
                               .peer = src,
                               .active = 1,
                               .detail = p,
                               .file = c->file,
                               .line = c->line};
    /* A message that waits already goes before any that comes now. */
    struct host_pending **at = find(h, src, tag, mask);
    if (at == NULL) {
        host_list_add(&h->posted, p);
        return;
    }
    struct host_pending *m = host_list_remove(&h->arrived, at);
    deliver(h, m, r);
    host_pending_free(h, m);
}

/* By looking again and again, as MPI itself waits. */
void host_match_wait(struct host_comm *h, struct comm_request *r)
{
    const struct host_pending *p = r->detail;
    while (!p->done) progress(h);
    /* A receive from a given rank with one tag is of exactly its size (comm_irecv). */
    host_finish(h, r);
}

/* Receives are completed by messages that come, sends by MPI. */
static bool is_done(struct host_comm *h, const struct comm_request *r)
{
    struct host_pending *p = r->detail;
    return p->send ? host_test_send(h, p) : p->done;
}

/* The one complete first, then the lowest: -1, none is. *open: requests that are not. */
static int first_done(struct host_comm *h, int n, struct comm_request *const *r, int *open)
{
    /* Completions are numbered, since several may have happened since the last look. */
    uint64_t least = UINT64_MAX;
    int best = -1;
    *open = 0;
    for (int i = 0; i < n; i++) {
        if (r[i] == NULL || !r[i]->active) continue;
        (*open)++;
        const struct host_pending *p = r[i]->detail;
        if (!is_done(h, r[i]) || p->order >= least) continue;
        least = p->order;
        best = i;
    }
    return best;
}

/* Nothing open and nothing done: there is nothing to wait for. */
int host_match_any(struct comm *c, int n, struct comm_request *const *r, int block)
{
    struct host_comm *h = mine(c);
    int open, which;
    if (!h->timed) host_stop(h, "line %d: a test in a program that does not say so", c->line);
    do {
        progress(h);
        which = first_done(h, n, r, &open);
    } while (block && which < 0 && open > 0);
    if (which >= 0) host_finish(h, r[which]);
    return which;
}

/* The message stays where it is unless a request takes it. */
int host_match_probe(struct comm *c, int src, int64_t tag, int64_t mask, int block,
                     struct comm_envelope *out, struct comm_request *take)
{
    struct host_comm *h = mine(c);
    struct host_pending **at;
    if (!h->timed) host_stop(h, "line %d: a probe in a program that does not say so", c->line);
    do {
        progress(h);
        at = find(h, src, tag, mask);
    } while (block && at == NULL);
    if (at == NULL) return 0;
    struct host_pending *m = *at;
    *out = (struct comm_envelope){m->from, m->tag, (int64_t)m->bytes};
    if (take == NULL) return 1;
    /* The message is the request's from now on; its buffer comes with host_match_into. */
    host_list_remove(&h->arrived, at);
    m->done = m->held = true;
    m->order = ++h->completed;
    *take = (struct comm_request){.bytes = (int64_t)m->bytes,
                                  .tag = m->tag,
                                  .peer = m->from,
                                  .active = 1,
                                  .detail = m,
                                  .file = c->file,
                                  .line = c->line};
    return 1;
}

/* It has been here since the probe; wait has nothing left to do. */
void host_match_into(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity)
{
    const struct host_pending *m = r->detail;
    (void)c;
    const size_t n = m->bytes < (size_t)capacity ? m->bytes : (size_t)capacity;
    if (n > 0) memcpy(buffer, m->copy, n);
    r->buffer = buffer;
    r->capacity = capacity;
    r->truncated = m->bytes > (size_t)capacity;
}

/* What has a message by now is not taken back. */
int host_match_cancel(struct comm *c, struct comm_request *r)
{
    struct host_comm *h = mine(c);
    progress(h);
    for (struct host_pending **at = &h->posted.first; *at != NULL; at = &(*at)->next) {
        if (*at != r->detail) continue;
        host_list_remove(&h->posted, at);
        host_finish(h, r);
        return 1;
    }
    return 0;
}

/* Also of programs whose messages MPI matches: nobody has posted anything any more. */
bool host_match_drain(struct host_comm *h)
{
    bool left = h->arrived.first != NULL;
    while (take_one(h)) left = true;
    /* Nodes go back to the spare ones: the next run has none of this one's messages. */
    while (h->arrived.first != NULL)
        host_pending_free(h, host_list_remove(&h->arrived, &h->arrived.first));
    while (h->posted.first != NULL)
        host_pending_free(h, host_list_remove(&h->posted, &h->posted.first));
    return left;
}
