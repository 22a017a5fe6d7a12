/* poll.c - looking for what is complete without waiting for one thing: tests, probes, waits for
 * any.
 *
 * A rank may be ahead of the events. What is true at its clock is known when the events have come
 * that far: it stops until then, by a timer at its clock. A look without success costs the time of
 * a poll, for which the rank stops, too; what comes during that time ends it. A loop of polls would
 * need an event each: polls that follow each other closely are taken together, a sixteenth of the
 * time since the first of them at a time, so that their number grows with the logarithm of the
 * waiting time. */
#include "base/check.h"
#include "base/picoseconds.h"
#include "vp/explain.h"
#include "vp/path.h"
#include "vp/matching.h"
#include "vp/offload.h"

enum { POLL_PART = 8, SERIES_PART = 16 };

/* What a look costs: an eighth of what the software spends on receiving an empty message.
 * It reads a flag or two where a receive also finds and unpacks a message. At least 1 ns,
 * so that a loop of looks ends on machines whose software takes no time. */
static sim_ps poll_cost(const struct world *w)
{
    const sim_ps cost = w->software.message[0].recv / POLL_PART;
    return cost > 1000 ? cost : 1000;
}

/* All of it counts as waiting: nobody else's traffic makes a look longer. */
static void wait_of(struct vp *v, sim_ps time)
{
    const sim_ps begin = v->clock;
    vp_wait_until(v, time, time);
    if (v->world->record->spans) vp_span(v, SPAN_WAIT, begin, v->clock, -1, 0, -1);
}

/* A look at v's clock has found nothing; what it looks for will be there at `expected`, SIM_NEVER:
 * not known. */
static void poll(struct vp *v, sim_ps expected)
{
    struct matching *k = v->matching;
    const sim_ps cost = poll_cost(v->world);
    /* The program did hardly anything since the last look: the two belong together. */
    const bool series = k->poll_step > 0 && v->clock - k->poll_end <= k->poll_step;
    if (!series) k->poll_began = v->clock;
    sim_ps step = (v->clock - k->poll_began) / SERIES_PART;
    if (step < cost) step = cost;
    /* The look takes a poll at least and a step at most; what is expected, or comes
     * unexpected (poll_notify), ends it in between. */
    k->least = ps_later(v->clock, cost);
    sim_ps until = ps_later(v->clock, step);
    if (expected < until) until = expected > k->least ? expected : k->least;
    timer_set(v, until);
    vp_block(v, WAITING_POLL, NULL);
    wait_of(v, k->until);
    k->poll_end = v->clock;
    k->poll_step = step;
}

/* Programs of this project promise to do without, which saves an event for each match; a
 * slip is a bug and told as one. */
static void need_time(struct vp *v, const char *what)
{
    offload_called(v);
    if (!v->matching) vp_misuse(v, "%s in a program that has promised to do without it "
                     "(a kernel in one file declares .wildcards = 1)", what);
}

/* ---- requests ---- */

/* When an active request is complete; SIM_NEVER: not known yet. */
sim_ps request_completion(const struct comm_request *r)
{
    switch (r->active) {
    case REQUEST_MATCHED:
        return ((const struct message *)r->detail)->net.arrival;
    case REQUEST_SENT:
    case REQUEST_DELIVERED:
        return (sim_ps)(intptr_t)r->detail;
    default:
        return SIM_NEVER;
    }
}

struct candidates {
    int active, unknown; /* requests */
    int best;            /* the one complete first, -1: none is known to be */
    sim_ps time;         /* when it is */
};

/* O(n) for each look; vp_watch is for thousands of requests. */
static struct candidates survey(int n, struct comm_request *const *r)
{
    struct candidates s = {0, 0, -1, SIM_NEVER};
    for (int i = 0; i < n; i++) {
        if (!r[i] || r[i]->active == REQUEST_DONE) continue;
        const sim_ps time = request_completion(r[i]);
        s.active++;
        s.unknown += time == SIM_NEVER;
        if (time < s.time) s.best = i, s.time = time;
    }
    return s;
}

/* Success ends a series of looks: the next one without success starts small again. */
static int finish(struct vp *v, struct comm_request *const *r, int i)
{
    v->comm.type->wait(&v->comm, r[i]);
    v->matching->poll_step = 0;
    return i;
}

int vp_complete_any(struct comm *c, int n, struct comm_request *const *r, int block)
{
    struct vp *v = (struct vp *)c;
    struct matching *k = v->matching;
    need_time(v, block ? "a wait for any of several" : "a test");
    struct candidates s = survey(n, r);
    if (s.active == 0) return -1;
    /* What is complete at the clock must be known first, then answered; a look that finds
     * nothing takes time, or loops of tests would never end. */
    if (!block) {
        if (s.unknown > 0) {
            timer_catch_up(v);
            s = survey(n, r);
        }
        if (s.time <= v->clock) return finish(v, r, s.best);
        poll(v, s.time);
        return -1;
    }
    /* the first one known is the first one when the events have come as far: until then, others may
     * come to be known */
    while (s.unknown > 0 && (s.time > k->synced || v->clock > k->synced)) {
        const sim_ps now = sim_now(v->world->sim);
        sim_ps time = s.time > v->clock ? s.time : v->clock;
        /* No older timer counts any more. Without a known time the rank waits for
         * whatever comes. */
        k->timer++;
        if (time != SIM_NEVER) timer_set(v, time > now ? time : now);
        vp_block(v, WAITING_ANY, NULL);
        s = survey(n, r);
    }
    return finish(v, r, s.best);
}

int vp_cancel(struct comm *c, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    need_time(v, "a cancelled receive");
    /* A message may have come by now that this rank does not know of yet. */
    if (r->active == REQUEST_POSTED) timer_catch_up(v);
    if (r->active == REQUEST_POSTED) {
        matching_withdraw(v, r);
    } else if (r->active == REQUEST_MATCHED) {
        /* Bound ahead of time to a message that is still on its way. The rank's own clock
         * counts: what arrives later has not come. A hand-shake cannot be taken back. */
        struct message *m = r->detail;
        if (m->kind != MESSAGE_EAGER || m->net.arrival <= v->clock) return 0;
        matching_put_back(v, m);
    } else {
        return 0;
    }
    r->active = REQUEST_DONE;
    r->detail = NULL;
    return 1;
}

/* ---- many requests ---- */

void vp_watch(struct comm *c, struct comm_request *r)
{
    struct vp *v = (struct vp *)c;
    struct matching *k = v->matching;
    need_time(v, "a watched request");
    /* The number orders requests that are complete at the same time. */
    r->watch = ++k->nwatch;
    const sim_ps time = r->active == REQUEST_DONE ? v->clock : request_completion(r);
    /* Those of unknown time are counted, and enter the heap when vp_notify says when. */
    if (time == SIM_NEVER) k->nunknown++;
    else watched_known(v, r, time);
}

struct comm_request *vp_next_complete(struct comm *c, int64_t time)
{
    struct vp *v = (struct vp *)c;
    struct matching *k = v->matching;
    need_time(v, "a watched request");
    for (;;) {
        /* the first one known is the first one when the events have come as far */
        const sim_ps first = k->nheap > 0 ? k->heap[0].time : SIM_NEVER;
        sim_ps goal = first < time ? first : time;
        /* Nothing that is unknown can still come before `goal`. */
        if (k->nunknown == 0 || goal <= k->synced) break;
        if (goal < v->clock) goal = v->clock; /* the events do not go back */
        k->timer++;
        if (goal != SIM_NEVER) timer_set(v, goal);
        vp_block(v, WAITING_ANY, NULL);
    }
    if (k->nheap > 0 && k->heap[0].time <= time) {
        struct comm_request *r = watched_pop(k);
        r->watch = 0;
        c->type->wait(c, r);
        return r;
    }
    /* Nothing is complete by `time`: the rank has waited until then. */
    if (time != INT64_MAX) wait_of(v, time);
    return NULL;
}

/* ---- probes ---- */

/* Stop until a message is there. The probe stands among the receives, so that the order
 * of posting counts for it as well. */
static struct unmatched *await(struct vp *v, struct comm_request *look)
{
    matching_post(v, look);
    vp_block(v, WAITING_RECEIVE, look);
    struct unmatched *u = look->detail;
    const sim_ps begin = v->clock;
    vp_path_join(v, u->m->net.path);
    vp_wait_until(v, u->m->net.arrival, u->m->net.uncontended);
    if (v->world->record->spans)
        vp_span(v, SPAN_WAIT, begin, v->clock, u->source->rank, u->m->bytes, -1);
    return u;
}

/* The request now owns the message; a buffer comes later (vp_receive_into). */
static void take_probed(struct vp *v, struct unmatched *u, struct comm_request *r)
{
    *r = (struct comm_request){.bytes = u->m->bytes,
                               .tag = u->m->tag,
                               .peer = u->source->rank,
                               .active = REQUEST_TAKEN,
                               .file = v->comm.file,
                               .line = v->comm.line};
    r->detail = matching_take(v, u);
}

int vp_probe(struct comm *c, int src, int64_t tag, int64_t mask, int block,
             struct comm_envelope *out, struct comm_request *take)
{
    struct vp *v = (struct vp *)c;
    need_time(v, "a probe");
    if (src < COMM_ANY_SOURCE || src >= v->world->nrank)
        vp_misuse(v, "a probe for messages from rank %d", src);
    struct comm_request look = {.peer = src,
                                .tag = tag,
                                .mask = mask,
                                .kind = RECEIVE_PROBE,
                                .file = c->file,
                                .line = c->line};
    /* Arrivals up to the clock must be known before one can be said to be the first. */
    timer_catch_up(v);
    struct unmatched *u = matching_find(v, &look, v->clock);
    if (!u && !block) {
        /* A message that is known to come later ends the look in time. */
        u = matching_find(v, &look, SIM_NEVER);
        poll(v, u ? u->m->net.arrival : SIM_NEVER);
        return 0;
    }
    if (!u) u = await(v, &look);
    *out = (struct comm_envelope){u->source->rank, u->m->tag, u->m->bytes};
    if (take) take_probed(v, u, take);
    /* A look with success takes a poll, too. */
    wait_of(v, v->clock + poll_cost(v->world));
    v->matching->poll_step = 0;
    return 1;
}

/* From here on as any receive whose message is there: copied out when it is waited for. */
void vp_receive_into(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity)
{
    struct vp *v = (struct vp *)c;
    if (r->active != REQUEST_TAKEN) vp_misuse(v, "a buffer for a message that no probe has taken");
    r->buffer = buffer;
    r->capacity = capacity;
    r->posted_ps = v->clock;
    r->file = c->file;
    r->line = c->line;
    struct message *m = r->detail;
    message_bind(v, r, m, m->net.arrival > v->clock ? m->net.arrival : v->clock);
}
