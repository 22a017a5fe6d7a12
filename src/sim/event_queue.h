/* event_queue.h - what happens next, in the total order (time, lane and key, age).
 *
 * A 4-ary heap of 24-byte entries; what is to be done lies in slots beside it, so that sifting moves little. */
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

struct event_entry {
    sim_ps time;
    uint64_t order;
    uint32_t age;  /* order of posting; wraps only when fewer than 2^31 events are pending */
    uint32_t slot;
};

struct event_slot {
    sim_action *action;
    void *subject;
    uint64_t argument;
};

struct event_queue {
    struct event_entry *heap; /* owned, (capacity) */
    struct event_slot *slot;  /* owned, (capacity) */
    uint32_t *free_slot;      /* owned, (capacity): slots not in use, from index `count` on */
    uint32_t count, capacity, next_age;
};

/* event_queue_init, event_queue_done: an empty queue; give its memory back. */
void event_queue_init(struct event_queue *q);
void event_queue_done(struct event_queue *q);

/* event_queue_push: add an event; O(log4 n). */
void event_queue_push(struct event_queue *q, const struct event *e);

/* event_queue_pop: the first event into *e; false when there is none. */
bool event_queue_pop(struct event_queue *q, struct event *e);

#endif
