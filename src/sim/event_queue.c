/* event_queue.c - 4-ary heap of small entries; see event_queue.h. */
#include "sim/event_queue.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"

enum { FIRST_CAPACITY = 256 };

void event_queue_init(struct event_queue *q) { memset(q, 0, sizeof *q); }

void event_queue_done(struct event_queue *q)
{
    free(q->heap);
    free(q->slot);
    free(q->free_slot);
    memset(q, 0, sizeof *q);
}

static void grow(struct event_queue *q)
{
    uint32_t capacity = q->capacity ? 2 * q->capacity : FIRST_CAPACITY;
    q->heap = realloc(q->heap, capacity * sizeof *q->heap);
    q->slot = realloc(q->slot, capacity * sizeof *q->slot);
    q->free_slot = realloc(q->free_slot, capacity * sizeof *q->free_slot);
    CHECK(q->heap && q->slot && q->free_slot);
    for (uint32_t i = q->capacity; i < capacity; i++) q->free_slot[i] = i;
    q->capacity = capacity;
}

static inline bool before(const struct event_entry *a, const struct event_entry *b)
{
    if (a->time != b->time) return a->time < b->time;
    if (a->order != b->order) return a->order < b->order;
    return (int32_t)(a->age - b->age) < 0;
}

void event_queue_push(struct event_queue *q, const struct event *e)
{
    if (q->count == q->capacity) grow(q);
    uint32_t i = q->count, slot = q->free_slot[i];
    q->slot[slot] = (struct event_slot){e->action, e->subject, e->argument};
    struct event_entry entry = {e->time, e->order, q->next_age++, slot};
    q->count++;
    while (i > 0) {
        uint32_t parent = (i - 1) / 4;
        if (!before(&entry, &q->heap[parent])) break;
        q->heap[i] = q->heap[parent];
        i = parent;
    }
    q->heap[i] = entry;
}

static inline uint32_t first_child(const struct event_entry *h, uint32_t from, uint32_t count)
{
    uint32_t end = from + 4 < count ? from + 4 : count, best = from;
    for (uint32_t k = from + 1; k < end; k++)
        if (before(&h[k], &h[best])) best = k;
    return best;
}

bool event_queue_pop(struct event_queue *q, struct event *e)
{
    if (q->count == 0) return false;
    struct event_entry first = q->heap[0], last = q->heap[--q->count];
    const struct event_slot *s = &q->slot[first.slot];
    *e = (struct event){first.time, first.order, s->action, s->subject, s->argument};
    q->free_slot[q->count] = first.slot;
    uint32_t i = 0;
    for (uint32_t child = 1; child < q->count; child = 4 * i + 1) {
        child = first_child(q->heap, child, q->count);
        if (!before(&q->heap[child], &last)) break;
        q->heap[i] = q->heap[child];
        i = child;
    }
    if (q->count) q->heap[i] = last;
    return true;
}
