/* event_queue.h - what happens next, in the total order (time, lane and key, order of posting).
 *
 * Simulated time never goes back, and most events are posted a short while ahead: a wheel of wheels
 * (Varghese and Lauck, 1987). Time is cut into windows of 2^WINDOW_BITS ps. Level l holds the
 * events whose window first differs from the present one in bits 6 l .. 6 l + 5 of its number, one
 * bucket per value of these bits; a bucket is spread over the lower levels when its turn comes. A
 * window is shorter than the latency of any link, so an event is moved once or twice, whatever the
 * number pending. The events of a window are sorted when it comes; those posted within the present
 * window wait in a heap. */
#ifndef SIM_EVENT_QUEUE_H
#define SIM_EVENT_QUEUE_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/sim.h"

struct event {
    sim_ps time;
    uint64_t order; /* lane in the upper 16 bits, key in the lower 48 */
    sim_action *action;
    void *subject;
    uint64_t argument;
};

/* An event of the present window that was posted within it. */
struct event_late {
    struct event event;
    uint64_t age; /* order of posting */
};

enum { CHUNK_EVENTS = 32 };

/* Buckets of the future are chains of chunks from one pool, so that memory follows the number
 * pending. */
struct event_chunk {
    struct event_chunk *next;
    uint32_t count;
    struct event event[CHUNK_EVENTS];
};

struct event_chain {
    struct event_chunk *first, *last;
};

enum {
    WINDOW_BITS = 12, /* 4 ns */
    WHEEL_BITS = 6,
    WHEEL_SLOTS = 1 << WHEEL_BITS,
    WHEEL_LEVELS = (63 - WINDOW_BITS + WHEEL_BITS - 1) / WHEEL_BITS
};

/* Where an event of a window stands in its order: from the highest bit on, 32 of its time after the
 * window's beginning [ps], 64 of its order, 32 of its place: the number of its chunk of the window,
 * times CHUNK_EVENTS, and the place there. No two are equal, and one comparison without a branch
 * orders two. */
__extension__ typedef unsigned __int128 event_key;

struct event_queue {
    sim_ps now;                   /* no event is earlier */
    uint64_t window;              /* number of the present window */
    uint64_t next_age;
    uint64_t count;               /* pending, all together */
    /* (run_count) owned: the events of this window that were posted before it, sorted */
    struct event *run;
    uint32_t run_at, run_count;
    /* owned, for sorting: (chunk_capacity) a window's chunks, (run_capacity) their keys, twice */
    struct event_chunk **chunk;
    event_key *key, *scratch;
    uint32_t chunk_capacity, run_capacity;
    struct event_late *heap;      /* (heap_count) owned: posted since */
    uint32_t heap_count, heap_capacity;
    sim_action *foreseen;         /* see sim_foresee; NULL: none */
    sim_early *early;
    int steps;                    /* how often each event is announced */
    uint64_t full[WHEEL_LEVELS]; /* bit per bucket that is not empty */
    struct event_chain wheel[WHEEL_LEVELS][WHEEL_SLOTS];
    struct event_chunk *pool; /* chunks not in use */
    void *slab;               /* owned: memory of the chunks, a list */
};

/* event_queue_init, event_queue_done: an empty queue at time 0; give its memory back. */
void event_queue_init(struct event_queue *q);
void event_queue_done(struct event_queue *q);

/* event_queue_push: add an event, not earlier than the last one taken (CHECK). */
void event_queue_push(struct event_queue *q, const struct event *e);

/* event_queue_pop: the first event into *e; false when there is none. */
bool event_queue_pop(struct event_queue *q, struct event *e);

/* event_queue_pop_by: the same if that is due by `last`, else false: the queue may then stand
 * behind `last`, and nothing may be added up to it before something is taken. */
bool event_queue_pop_by(struct event_queue *q, sim_ps last, struct event *e);

/* event_queue_next_time: time of the first event, SIM_NEVER when there is none. */
sim_ps event_queue_next_time(const struct event_queue *q);

#endif
