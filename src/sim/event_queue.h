/* event_queue.h - what happens next, in the total order (time, lane and key, age).
 *
 * Simulated time never goes back, and most events are posted a short while ahead: a wheel of wheels (Varghese and
 * Lauck, 1987). Level l holds the events whose time first differs from the present in bits 6 l .. 6 l + 5, one bucket
 * per value of these bits; a bucket is spread over the lower levels when its turn comes. So an event is moved two or
 * three times, whatever the number pending. The events of one instant are sorted when it comes; those posted at the
 * present instant wait in a small heap. */
#ifndef SIM_EVENT_QUEUE_H
#define SIM_EVENT_QUEUE_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/sim.h"

struct event {
    sim_ps time;
    uint64_t order; /* lane in the upper 16 bits, key in the lower 48 */
    uint64_t age;   /* order of posting, set by event_queue_push */
    sim_action *action;
    void *subject;
    uint64_t argument;
};

/* A growing array, for the events of the present instant. */
struct event_bucket {
    struct event *event; /* owned, (capacity) */
    uint32_t count, capacity;
};

enum { CHUNK_EVENTS = 31 };

/* Buckets of the future are chains of chunks from one pool, so that memory follows the number pending. */
struct event_chunk {
    struct event_chunk *next;
    uint32_t count;
    struct event event[CHUNK_EVENTS];
};

struct event_chain {
    struct event_chunk *first, *last;
};

enum { WHEEL_BITS = 6, WHEEL_SLOTS = 1 << WHEEL_BITS, WHEEL_LEVELS = (63 + WHEEL_BITS - 1) / WHEEL_BITS };

/* Where an event of the present instant stands in its order. */
struct event_key {
    uint64_t order, age;
    uint32_t index;
};

struct event_queue {
    sim_ps now; /* no event is earlier */
    uint64_t next_age;
    uint64_t count;            /* pending, all together */
    struct event_bucket run;   /* the events of this instant, */
    struct event_key *key;     /* (run.capacity) sorted; */
    struct event_key *scratch; /* (run.capacity) for sorting */
    uint32_t run_at, key_capacity;
    struct event_bucket heap;    /* posted at this instant since it began */
    uint64_t full[WHEEL_LEVELS]; /* bit per bucket that is not empty */
    struct event_chain wheel[WHEEL_LEVELS][WHEEL_SLOTS];
    struct event_chunk *pool; /* chunks not in use */
    void *slab;               /* owned: memory of the chunks, a list */
};

/* event_queue_init, event_queue_done: an empty queue at time 0; give its memory back. */
void event_queue_init(struct event_queue *q);
void event_queue_done(struct event_queue *q);

/* event_queue_push: add an event, not earlier than the last one taken (CHECK); sets its age in the queue. */
void event_queue_push(struct event_queue *q, const struct event *e);

/* event_queue_pop: the first event into *e; false when there is none. */
bool event_queue_pop(struct event_queue *q, struct event *e);

/* event_queue_next_time: time of the first event, SIM_NEVER when there is none. */
sim_ps event_queue_next_time(const struct event_queue *q);

#endif
