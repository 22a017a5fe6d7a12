/* sim.c - the clock and the loop.
 *
 * One thread, one queue, one clock: an event may post others, never wait. What waits are fibers,
 * which events wake up (vp). */
#include "sim/sim.h"

#include <math.h>
#include <stdlib.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/memory.h"
#include "base/picoseconds.h"
#include "sim/event_queue.h"

/* The lane stands above the key in one integer, so that one comparison orders both. */
enum { KEY_BITS = 48 };

struct sim {
    struct event_queue queue;
    sim_ps now;
    uint64_t last_order; /* of the event dispatched last */
    uint64_t digest;
    int64_t events, ties;
    bool beyond; /* the next event is later than time goes */
};

struct sim *sim_create(void)
{
    struct sim *s = memory_zeroed(1, sizeof *s);
    event_queue_init(&s->queue);
    s->digest = DIGEST_START;
    return s;
}

/* Events that are still pending own nothing: they are dropped. */
void sim_destroy(struct sim *s)
{
    if (!s) return;
    event_queue_done(&s->queue);
    free(s);
}

void sim_at(struct sim *s, sim_ps time, unsigned lane, uint64_t key, sim_action *action,
            void *subject, uint64_t argument)
{
    CHECK(time >= s->now);
    CHECK(lane < 65536 && key >> KEY_BITS == 0);
    struct event e = {time, (uint64_t)lane << KEY_BITS | key, action, subject, argument};
    event_queue_push(&s->queue, &e);
}

void sim_foresee(struct sim *s, sim_action *action, sim_early *early, int steps)
{
    s->queue.foreseen = action;
    s->queue.early = early;
    s->queue.steps = steps;
}

static inline bool dispatch(struct sim *s, sim_ps last)
{
    struct event e;
    if (!event_queue_pop_by(&s->queue, last, &e)) return false;
    /* Durations are cut off at PS_TOO_LONG, so that a time past PS_LAST has not wrapped yet; its
     * next sum might. The run ends before this event, and sim_beyond says why. */
    if (__builtin_expect(e.time > PS_LAST, 0)) {
        s->beyond = true;
        return false;
    }
    /* ties counts neighbours whose order the key or the age alone decides. Many ties show that
     * results depend on the rule for simultaneous events. */
    s->ties += s->events > 0 && e.time == s->now && (e.order ^ s->last_order) >> KEY_BITS == 0;
    s->events++;
    s->now = e.time;
    s->last_order = e.order;
    /* The digest covers what is dispatched and when, not the host's addresses. Equal digests mean
     * equal sequences of events, on any host and with any number of workers. */
    s->digest = digest_mix(digest_mix(s->digest, (uint64_t)e.time), e.order);
    e.action(e.subject, e.argument, e.time);
    return true;
}

bool sim_step(struct sim *s) { return dispatch(s, SIM_NEVER); }
bool sim_step_before(struct sim *s, sim_ps time) { return dispatch(s, time - 1); }
sim_ps sim_next_time(const struct sim *s) { return event_queue_next_time(&s->queue); }
int64_t sim_pending(const struct sim *s) { return (int64_t)s->queue.count; }
bool sim_beyond(const struct sim *s) { return s->beyond; }
sim_ps sim_now(const struct sim *s) { return s->now; }
int64_t sim_events(const struct sim *s) { return s->events; }
int64_t sim_ties(const struct sim *s) { return s->ties; }
uint64_t sim_digest(const struct sim *s) { return s->digest; }

sim_ps sim_from_seconds(double seconds)
{
    CHECK(seconds >= 0);
    return ps_rounded(seconds * SIM_PS_PER_S);
}
