/* matching.c - messages and receives find each other in simulated time (matching.h).
 *
 * Receives rank messages by arrival, messages rank receives by posting, both the same for all: the
 * outcome is the one stable matching, whichever side asks first. So an event per message that may
 * go to a receive from anybody, and one per such receive, find what a step-by-step account of
 * arrivals and postings would. Messages of one sender pass each other only where no receive fits
 * both. The rules are MPI's (section 3.5 of MPI 5.0), times are simulated [ps]. */
#include "vp/matching.h"

#include "base/check.h"

enum { FIRST_CAPACITY = 16 };

struct matching *matching_create(struct world *w)
{
    struct matching *k = TAKE(w->scratch, 1, struct matching);
    k->capacity = FIRST_CAPACITY;
    k->table = TAKE(w->scratch, FIRST_CAPACITY, struct source *);
    k->synced = -1;
    return k;
}

/* ---- senders ---- */

/* Fibonacci hashing: neighbouring ranks lie apart. */
static struct source **place_of(const struct matching *k, int rank)
{
    uint32_t at = (uint32_t)rank * UINT32_C(2654435769) >> 8;
    for (;; at++) {
        struct source **s = &k->table[at & (uint32_t)(k->capacity - 1)];
        if (!*s || (*s)->rank == rank) return s;
    }
}

static void grow(struct world *w, struct matching *k)
{
    struct source **old = k->table;
    const int n = k->capacity;
    k->capacity = 2 * n;
    k->table = TAKE(w->scratch, k->capacity, struct source *);
    for (int i = 0; i < n; i++)
        if (old[i]) *place_of(k, old[i]->rank) = old[i];
}

static struct source *source_of(struct world *w, struct matching *k, int rank)
{
    struct source **s = place_of(k, rank);
    if (*s) return *s;
    struct source *made = TAKE(w->scratch, 1, struct source);
    made->rank = rank;
    *s = made;
    if (++k->nsource > k->capacity / 2) grow(w, k);
    return made;
}

/* The sender's messages stand in the order sent; put back, one may belong before others. */
static void join_source(struct source *s, struct unmatched *u)
{
    struct unmatched *before = s->last;
    while (before && before->m->net.id > u->m->net.id) before = before->before;
    u->source = s;
    u->before = before;
    u->after = before ? before->after : s->first;
    *(u->before ? &u->before->after : &s->first) = u;
    *(u->after ? &u->after->before : &s->last) = u;
}

static void leave_source(struct unmatched *u)
{
    struct source *s = u->source;
    *(u->before ? &u->before->after : &s->first) = u->after;
    *(u->after ? &u->after->before : &s->last) = u->before;
    s->held -= u->held;
    u->held = false;
}

/* Whether no message that its sender sent before u fits r too. */
static bool first_sent(const struct unmatched *u, const struct comm_request *r)
{
    for (const struct unmatched *x = u->before; x; x = x->before)
        if (message_fits(x->m, u->source->rank, r)) return false;
    return true;
}

/* ---- order of arrival ---- */

static bool earlier(const struct unmatched *a, const struct unmatched *b)
{
    const struct net_message *x = &a->m->net, *y = &b->m->net;
    return x->arrival != y->arrival ? x->arrival < y->arrival : x->id < y->id;
}

static void append_known(struct matching *k, struct unmatched *u)
{
    u->known = true;
    u->next = NULL;
    u->prev = k->last;
    *(k->last ? &k->last->next : &k->first) = u;
    k->last = u;
    if (!k->fresh) k->fresh = u;
}

static void leave_known(struct matching *k, struct unmatched *u)
{
    if (k->fresh == u) k->fresh = u->next;
    *(u->prev ? &u->prev->next : &k->first) = u->next;
    *(u->next ? &u->next->prev : &k->last) = u->prev;
    u->known = false;
}

/* Two sorted chains become one; `prev` is set later. */
static struct unmatched *merge(struct unmatched *a, struct unmatched *b)
{
    struct unmatched *first = NULL, **end = &first;
    while (a && b) {
        struct unmatched **least = earlier(b, a) ? &b : &a;
        *end = *least;
        end = &(*least)->next;
        *least = *end;
    }
    *end = a ? a : b;
    return first;
}

/* Merge sort from the bottom: run[i] holds 2^i messages or none. */
static struct unmatched *sorted(struct unmatched *u)
{
    struct unmatched *run[32] = {NULL}, *all = NULL;
    while (u) {
        struct unmatched *next = u->next;
        u->next = NULL;
        int i = 0;
        for (; run[i]; i++) {
            u = merge(run[i], u);
            run[i] = NULL;
        }
        run[i] = u;
        u = next;
    }
    for (int i = 0; i < 32; i++) all = merge(run[i], all);
    return all;
}

/* Bring the fresh ones into the order of arrival. They mostly arrive behind all others: the part of
 * the old ones that they may reach into is found from the end. */
static void order_known(struct matching *k)
{
    if (!k->fresh) return;
    struct unmatched *old = k->fresh->prev, *fresh = sorted(k->fresh);
    while (old && earlier(fresh, old)) old = old->prev;
    /* The old part from `tail` on may have to be mixed with fresh ones; what lies before it stays
     * as it is. */
    struct unmatched *tail = old ? old->next : k->first;
    if (tail == k->fresh || !tail) tail = NULL;
    /* what stands behind `old` up to the fresh ones is a sorted chain of its own */
    if (tail) {
        struct unmatched *end = tail;
        while (end->next && end->next != k->fresh) end = end->next;
        end->next = NULL;
    }
    struct unmatched *rest = merge(tail, fresh);
    *(old ? &old->next : &k->first) = rest;
    for (struct unmatched *prev = old, *u = rest; u; prev = u, u = u->next) {
        u->prev = prev;
        k->last = u;
    }
    k->fresh = NULL;
}

struct unmatched *matching_find(struct vp *v, const struct comm_request *r, sim_ps now)
{
    struct matching *k = v->matching;
    order_known(k);
    for (struct unmatched *u = k->first; u && u->m->net.arrival <= now; u = u->next) {
        if (!message_fits(u->m, u->source->rank, r)) continue;
        /* MPI's order: a receive posted earlier has the first claim, an earlier message comes first
         */
        const struct comm_request *p = v->posted;
        while (p && p != r && !message_fits(u->m, u->source->rank, p)) p = p->detail;
        if (p && p != r) continue;
        /* Else an earlier message of its sender, not here yet or claimed by another receive, fits,
         * too, and must come first. A receive marks u, so that it is tried again when that one has
         * been taken; a probe takes nothing and marks nothing. */
        if (first_sent(u, r)) return u;
        if (r->kind == RECEIVE_PROBE) continue;
        if (!u->held) u->source->held++;
        u->held = true;
    }
    return NULL;
}

/* ---- finding each other ---- */

static bool depends_on_time(const struct comm_request *r)
{
    return r->peer < 0 || r->kind == RECEIVE_PROBE;
}

/* The record is free again unless an event still points to it; that event then gives it back. */
struct message *matching_take(struct vp *v, struct unmatched *u)
{
    struct matching *k = v->matching;
    struct message *m = u->m;
    leave_source(u);
    if (u->known) leave_known(k, u);
    u->m = NULL;
    m->unmatched = NULL;
    if (!u->due) {
        u->next = k->spare;
        k->spare = u;
    }
    return m;
}

void matching_withdraw(struct vp *v, struct comm_request *r)
{
    struct comm_request **p = &v->posted;
    while (*p != r) {
        CHECK(*p);
        p = (struct comm_request **)&(*p)->detail;
    }
    *p = r->detail;
    if (!r->detail) v->posted_end = p;
    v->matching->nwild -= depends_on_time(r);
}

/* Receives from a given source are bound ahead of time. Where an earlier message of s is still on
 * its way to an earlier receive that fits m, too, m has not come before that one: MPI's order
 * again. */
static void keep_order(struct source *s, const struct comm_request *r, struct message *m)
{
    const bool claimed = ((m->tag ^ s->latest_tag) & s->latest_mask) == 0;
    if (s->latest > m->net.arrival && s->latest_id < m->net.id && claimed)
        m->net.arrival = s->latest;
    if (m->net.arrival < s->latest) return;
    s->latest = m->net.arrival;
    s->latest_id = m->net.id;
    s->latest_tag = r->tag;
    s->latest_mask = r->mask;
}

static void bind(struct vp *v, struct comm_request *r, struct unmatched *u)
{
    const sim_ps now = sim_now(v->world->sim);
    matching_withdraw(v, r);
    if (r->kind == RECEIVE_PROBE) {
        r->active = REQUEST_MATCHED;
        r->detail = u;
        if (v->waiting == r) vp_wake(v->world, v);
        return;
    }
    struct source *s = u->source;
    struct message *m = matching_take(v, u);
    keep_order(s, r, m);
    sim_ps when = m->net.arrival > r->posted_ps ? m->net.arrival : r->posted_ps;
    message_bind(v, r, m, when > now ? when : now);
}

static void arrives(void *subject, uint64_t argument, sim_ps now);

static void announce(struct sim *sim, struct unmatched *u, sim_ps now)
{
    const sim_ps arrival = u->m->net.arrival;
    u->due = true;
    sim_at(sim, arrival > now ? arrival : now, LANE_ARRIVAL, message_key(u->m), arrives, u, 0);
}

/* Look for a receive for u. One from a given source takes it at once; one from anybody at the later
 * of arrival and posting, in an event: `arrived` says that this is it. Returns whether u was taken.
 */
static bool try(struct vp *v, struct unmatched *u, bool arrived)
{
    struct sim *sim = v->world->sim;
    const sim_ps now = sim_now(sim), arrival = u->m->net.arrival;
    /* The first posted receive that fits has the claim, even if a later one could be served now. */
    struct comm_request *r = v->posted;
    while (r && !message_fits(u->m, u->source->rank, r)) r = r->detail;
    if (!r) return false;
    if (!first_sent(u, r)) {
        if (!u->held) u->source->held++;
        u->held = true;
        return false;
    }
    if (!depends_on_time(r) || (arrived && r->open)) {
        bind(v, r, u);
        return r->kind != RECEIVE_PROBE;
    }
    /* at or before the posting, the event of the posting finds it */
    if ((r->open || arrival > r->posted_ps) && !u->due) announce(sim, u, now);
    return false;
}

/* A message that had to wait for another of its sender has not come before that one, which came at
 * `floor`. */
static void arrives_behind(struct matching *k, struct unmatched *u, sim_ps floor)
{
    if (!u->known || u->m->net.arrival >= floor) return;
    leave_known(k, u);
    u->m->net.arrival = floor;
    append_known(k, u);
}

/* When a message of s that came at `floor` has been taken, those behind it that had to wait for it
 * have another try. */
static void release_held(struct vp *v, struct source *s, sim_ps floor)
{
    struct unmatched *u = s->first;
    while (u && s->held) {
        bool taken = false;
        if (u->held) {
            u->held = false;
            s->held--;
            arrives_behind(v->matching, u, floor);
            const sim_ps arrival = u->m->net.arrival;
            taken = try(v, u, false);
            if (taken) floor = arrival;
        }
        u = taken ? s->first : u->after;
    }
}

static void offer(struct vp *v, struct unmatched *u, bool arrived)
{
    struct source *s = u->source;
    const sim_ps arrival = u->m->net.arrival;
    if (try(v, u, arrived) && s->held) release_held(v, s, arrival);
}

static void arrives(void *subject, uint64_t argument, sim_ps now)
{
    (void)argument, (void)now;
    struct unmatched *u = subject;
    u->due = false;
    if (u->m) {
        offer(u->m->to, u, true);
        return;
    }
    struct matching *k = u->owner;
    u->next = k->spare;
    k->spare = u;
}

/* ---- messages ---- */

static struct unmatched *unmatched_make(struct message *m)
{
    struct matching *k = m->to->matching;
    struct unmatched *u = k->spare;
    if (u) k->spare = u->next;
    else u = TAKE(m->to->world->scratch, 1, struct unmatched);
    *u = (struct unmatched){.m = m, .owner = k};
    m->unmatched = u;
    join_source(source_of(m->to->world, k, m->from->comm.rank), u);
    return u;
}

void matching_announce(struct message *m) { unmatched_make(m); }

static void request_arrives(void *subject, uint64_t argument, sim_ps now)
{
    (void)argument, (void)now;
    struct message *m = subject;
    matching_deliver(m->to, m);
}

void matching_deliver(struct vp *v, struct message *m)
{
    /* The answer to a request to send cannot be taken back: what receives it is decided when it
     * arrives. */
    if (m->kind == MESSAGE_REQUEST_TO_SEND && m->net.arrival > sim_now(v->world->sim)) {
        sim_at(v->world->sim, m->net.arrival, LANE_ARRIVAL, message_key(m), request_arrives, m, 0);
        return;
    }
    append_known(v->matching, m->unmatched);
    if (v->waiting_for == WAITING_POLL) poll_notify(v, m->net.arrival);
    offer(v, m->unmatched, false);
}

void matching_put_back(struct vp *v, struct message *m)
{
    struct unmatched *u = unmatched_make(m);
    append_known(v->matching, u);
    offer(v, u, false);
}

/* ---- receives ---- */

/* Whether a receive posted before r, which depends on time, could take a message that fits r. */
static bool behind_wild(const struct vp *v, const struct comm_request *r)
{
    /* Two masks overlap where both look at a bit: different there, no message fits both. */
    if (v->matching->nwild == 0) return false;
    for (const struct comm_request *p = v->posted; p != r; p = p->detail)
        if (depends_on_time(p) && (p->peer < 0 || p->peer == r->peer) &&
            ((p->tag ^ r->tag) & p->mask & r->mask) == 0)
            return true;
    return false;
}

/* r waits for u, which others of its sender have passed: these have another try when u is taken. */
static void hold_behind(const struct unmatched *u, const struct comm_request *r)
{
    for (struct unmatched *x = u->after; x; x = x->after)
        if (x->known && !x->held && message_fits(x->m, r->peer, r)) {
            x->held = true;
            x->source->held++;
        }
}

/* The first message sent by r's source that fits r, when its arrival is known and no receive before
 * r claims it. */
static struct unmatched *first_of_source(struct vp *v, const struct comm_request *r)
{
    /* A receive from one source needs no event: its message follows from the order of sending
     * alone. */
    struct source *s = *place_of(v->matching, r->peer);
    struct unmatched *u = s ? s->first : NULL;
    while (u && !message_fits(u->m, r->peer, r)) u = u->after;
    if (!u) return NULL;
    if (!u->known) {
        hold_behind(u, r);
        return NULL;
    }
    if (v->matching->nwild == 0 && !u->held) return u;
    for (const struct comm_request *p = v->posted; p != r; p = p->detail)
        if (message_fits(u->m, r->peer, p)) return NULL;
    return u;
}

/* Messages that are known to arrive later, and whose coming nobody has asked for so far. */
static void expect(struct vp *v, const struct comm_request *r, sim_ps now)
{
    for (struct unmatched *u = v->matching->last; u && u->m->net.arrival > now; u = u->prev)
        if (!u->due && message_fits(u->m, u->source->rank, r)) announce(v->world->sim, u, now);
}

static void look(struct vp *v, struct comm_request *r, sim_ps now)
{
    struct unmatched *u = depends_on_time(r) ? matching_find(v, r, now) : first_of_source(v, r);
    if (!u) {
        if (depends_on_time(r)) expect(v, r, now);
        return;
    }
    struct source *s = u->source;
    const sim_ps arrival = u->m->net.arrival;
    bind(v, r, u);
    if (s->held) release_held(v, s, arrival);
}

/* The receives posted by now look for messages, in their order. */
static void open_receives(void *subject, uint64_t argument, sim_ps now)
{
    (void)argument;
    struct vp *v = subject;
    struct comm_request *r = v->posted;
    while (r && r->posted_ps <= now) {
        const bool fresh = !r->open;
        r->open = 1;
        if (fresh) look(v, r, now);
        r = r->active == REQUEST_POSTED ? r->detail
                                        : v->posted; /* others may have left the list with it */
    }
}

void matching_post(struct vp *v, struct comm_request *r)
{
    r->active = REQUEST_POSTED;
    r->posted_ps = v->clock;
    r->detail = NULL;
    *v->posted_end = r;
    v->posted_end = (struct comm_request **)&r->detail;
    /* Behind a receive from anybody even one from a given source depends on time: the other may
     * take its message. */
    if (depends_on_time(r) || behind_wild(v, r)) {
        v->matching->nwild += depends_on_time(r);
        r->open = 0;
        sim_at(v->world->sim, v->clock, LANE_POST, (uint64_t)v->comm.rank, open_receives, v, 0);
        return;
    }
    r->open = 1;
    look(v, r, v->clock);
}

const struct message *matching_leftover(const struct vp *v)
{
    const struct matching *k = v->matching;
    for (int i = 0; i < k->capacity; i++)
        if (k->table[i] && k->table[i]->first) return k->table[i]->first->m;
    return NULL;
}
