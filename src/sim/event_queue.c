/* event_queue.c - a wheel of wheels for the future, a sorted run and a heap for the present; see
 * event_queue.h.
 *
 * Example: now = 0, events at 5, 70 and 5000 ps. Level 0 holds 5; level 1 (64 ps a bucket) holds 70
 * in bucket 1; level 2 (4096 ps a bucket) holds 5000 in bucket 1. When 5 is done, bucket 1 of level
 * 1 is spread from 64 ps on: 70 moves to level 0. An event is moved at most once a level. */
#include "sim/event_queue.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"

/* INSERTION_MOST: up to this many keys insertion sort is used, beyond it merge sort. Most instants
 * hold only a few events. */
enum { FIRST_CAPACITY = 8, INSERTION_MOST = 12 };

void event_queue_init(struct event_queue *q) { memset(q, 0, sizeof *q); }

void event_queue_done(struct event_queue *q)
{
    free(q->run.event);
    free(q->heap.event);
    free(q->key);
    free(q->scratch);
    while (q->slab) {
        /* The first word of a slab links to the slab allocated before it. */
        void *next = *(void **)q->slab;
        free(q->slab);
        q->slab = next;
    }
    memset(q, 0, sizeof *q);
}

/* Doubling: n events cost O(n) copies in total. The CHECK ends the process, so the old pointer need
 * not be kept when realloc fails. */
static void bucket_grow(struct event_bucket *b)
{
    b->capacity = b->capacity ? 2 * b->capacity : FIRST_CAPACITY;
    b->event = memory_resize(b->event, b->capacity, sizeof *b->event);
}

static inline void bucket_add(struct event_bucket *b, const struct event *e)
{
    if (b->count == b->capacity) bucket_grow(b);
    b->event[b->count++] = *e;
}

/* The total order within one instant: lane and key in one integer, then the order of posting. Ages
 * are unique, so that no two events are equal and every sort gives the same sequence. */
static inline bool event_before(const struct event *a, const struct event *b)
{
    return a->order != b->order ? a->order < b->order : a->age < b->age;
}

static inline bool key_before(const struct event_key *a, const struct event_key *b)
{
    return a->order != b->order ? a->order < b->order : a->age < b->age;
}

/* --- the heap of events posted at the present instant --- */

/* Sift up: parents that come later move down until the place of e is found. O(log n). The hole is
 * moved, not the event, so that each level costs one copy instead of three. */
static void heap_add(struct event_bucket *h, const struct event *e)
{
    bucket_add(h, e);
    uint32_t i = h->count - 1;
    for (; i > 0 && event_before(e, &h->event[(i - 1) / 2]); i = (i - 1) / 2)
        h->event[i] = h->event[(i - 1) / 2];
    h->event[i] = *e;
}

/* Sift down: the last event of the array is put where the first was, and sinks along the earlier of
 * each pair of children. O(log n). */
static void heap_take(struct event_bucket *h, struct event *first)
{
    *first = h->event[0];
    struct event last = h->event[--h->count];
    uint32_t i = 0;
    for (uint32_t child = 1; child < h->count; child = 2 * i + 1) {
        if (child + 1 < h->count && event_before(&h->event[child + 1], &h->event[child])) child++;
        if (!event_before(&h->event[child], &last)) break;
        h->event[i] = h->event[child];
        i = child;
    }
    if (h->count) h->event[i] = last;
}

/* --- the wheels --- */

enum { SLAB_CHUNKS = 16 };

/* Chunks come from malloc in slabs of SLAB_CHUNKS and return to the pool only; slabs are freed with
 * the queue. In the steady state posting an event calls no allocator. */
static void pool_refill(struct event_queue *q)
{
    char *slab = memory_take(1, sizeof(void *) + SLAB_CHUNKS * sizeof(struct event_chunk));
    *(void **)slab = q->slab;
    q->slab = slab;
    struct event_chunk *c = (struct event_chunk *)(slab + sizeof(void *));
    for (int i = 0; i < SLAB_CHUNKS; i++) {
        c[i].next = q->pool;
        q->pool = &c[i];
    }
}

/* Chunks are appended at the end, so that a bucket keeps the order of posting. keys_sort then finds
 * its input nearly sorted. */
static void chain_grow(struct event_queue *q, struct event_chain *chain)
{
    if (!q->pool) pool_refill(q);
    struct event_chunk *c = q->pool;
    q->pool = c->next;
    c->next = NULL;
    c->count = 0;
    if (chain->last) chain->last->next = c;
    else chain->first = c;
    chain->last = c;
}

static inline void chain_add(struct event_queue *q, struct event_chain *chain,
                             const struct event *e)
{
    if (!chain->last || chain->last->count == CHUNK_EVENTS) chain_grow(q, chain);
    chain->last->event[chain->last->count++] = *e;
}

static inline void chunk_give(struct event_queue *q, struct event_chunk *c)
{
    c->next = q->pool;
    q->pool = c;
}

/* The chain of a bucket, which is empty afterwards. */
static struct event_chain wheel_cut(struct event_queue *q, int level, int slot)
{
    struct event_chain chain = q->wheel[level][slot];
    q->wheel[level][slot] = (struct event_chain){0};
    q->full[level] &= ~(UINT64_C(1) << slot);
    return chain;
}

/* The level is given by the highest bit in which the event's time differs from the present, the
 * bucket by the WHEEL_BITS bits of its time at that level. All events of a bucket of level l > 0
 * therefore lie in one aligned interval of 2^(6 l) ps that does not contain the present. O(1). */
static inline void wheel_add(struct event_queue *q, const struct event *e)
{
    uint64_t differs = (uint64_t)e->time ^ (uint64_t)q->now;
    int level = differs ? (63 - __builtin_clzll(differs)) / WHEEL_BITS : 0;
    unsigned slot = (unsigned)(e->time >> (level * WHEEL_BITS)) & (WHEEL_SLOTS - 1);
    q->full[level] |= UINT64_C(1) << slot;
    chain_add(q, &q->wheel[level][slot], e);
}

/* The first bucket: lowest level that has any, lowest value there. Every event of a level comes
 * before all events of the next level: it agrees with the present in one more group of bits. */
static inline bool wheel_first(const struct event_queue *q, int *level, int *slot)
{
    for (int l = 0; l < WHEEL_LEVELS; l++) {
        if (!q->full[l]) continue;
        *level = l;
        *slot = __builtin_ctzll(q->full[l]);
        return true;
    }
    return false;
}

/* Spread a bucket over the levels below, from the first moment that it covers. The present moves
 * there without an event being dispatched; no event lies between. */
static void wheel_spread(struct event_queue *q, int level, int slot)
{
    struct event_chain chain = wheel_cut(q, level, slot);
    int shift = level * WHEEL_BITS;
    /* The bits of the present above this level stay; those below become 0. From level 10 on nothing
     * is above, and a shift by 64 or more would be undefined. */
    uint64_t above = shift + WHEEL_BITS > 62 ? 0 : ~UINT64_C(0) << (shift + WHEEL_BITS);
    q->now = (sim_ps)(((uint64_t)q->now & above) | (uint64_t)slot << shift);
    for (struct event_chunk *c = chain.first, *next; c; c = next) {
        next = c->next;
        for (uint32_t i = 0; i < c->count; i++) wheel_add(q, &c->event[i]);
        chunk_give(q, c);
    }
}

/* --- the sorted events of one instant --- */

/* Keys are sorted, not events: half the bytes to move, and the index tells where the event is. */
static void keys_insertion(struct event_key *k, uint32_t n)
{
    for (uint32_t i = 1; i < n; i++) {
        struct event_key x = k[i];
        uint32_t j = i;
        for (; j > 0 && key_before(&x, &k[j - 1]); j--) k[j] = k[j - 1];
        k[j] = x;
    }
}

/* Merge sort, O(n log n) also in the worst case; scratch has room for n / 2 keys at least. Only the
 * left half is copied out: the merge never writes over keys of the right half that it has not
 * read. */
static void keys_sort(struct event_key *k, struct event_key *scratch, uint32_t n)
{
    if (n <= INSERTION_MOST) {
        keys_insertion(k, n);
        return;
    }
    uint32_t half = n / 2, i = 0, j = half;
    keys_sort(k, scratch, half);
    keys_sort(k + half, scratch, n - half);
    if (!key_before(&k[half], &k[half - 1])) return; /* often posted in order */
    memcpy(scratch, k, half * sizeof *k);
    for (uint32_t out = 0; i < half; out++)
        k[out] = j < n && key_before(&k[j], &scratch[i]) ? k[j++] : scratch[i++];
}

/* The old keys are those of an instant that is over, so they are freed and not copied. */
static void keys_room(struct event_queue *q, uint32_t n)
{
    if (n <= q->key_capacity) return;
    q->key_capacity = n * 2;
    free(q->key);
    free(q->scratch);
    q->key = memory_take(q->key_capacity, sizeof *q->key);
    q->scratch = memory_take(q->key_capacity, sizeof *q->scratch);
}

/* Make the bucket of the next instant the run. */
static void run_begin(struct event_queue *q, int slot)
{
    struct event_chain chain = wheel_cut(q, 0, slot);
    q->run.count = q->run_at = 0;
    for (struct event_chunk *c = chain.first, *next; c; c = next) {
        next = c->next;
        for (uint32_t i = 0; i < c->count; i++) bucket_add(&q->run, &c->event[i]);
        chunk_give(q, c);
    }
    /* Level 0 has one bucket per picosecond: all events of the bucket are due at the same time. */
    q->now = q->run.event[0].time;
    keys_room(q, q->run.count);
    for (uint32_t i = 0; i < q->run.count; i++)
        q->key[i] = (struct event_key){q->run.event[i].order, q->run.event[i].age, i};
    keys_sort(q->key, q->scratch, q->run.count);
}

void event_queue_push(struct event_queue *q, const struct event *e)
{
    /* An event in the past would break the wheels' order, not only the meaning of time. */
    CHECK(e->time >= q->now);
    struct event aged = *e;
    aged.age = q->next_age++;
    q->count++;
    /* An event of the present instant would otherwise have to be inserted into the sorted run,
     * which costs O(n); the heap takes O(log n). */
    if (e->time == q->now) heap_add(&q->heap, &aged);
    else wheel_add(q, &aged);
}

bool event_queue_pop(struct event_queue *q, struct event *e)
{
    if (q->count == 0) return false;
    q->count--;
    /* Nothing left at this instant: advance. Each round empties one bucket; an event passes at most
     * WHEEL_LEVELS of them. */
    while (q->run_at == q->run.count && q->heap.count == 0) {
        int level, slot;
        CHECK(wheel_first(q, &level, &slot));
        if (level == 0) run_begin(q, slot);
        else wheel_spread(q, level, slot);
    }
    /* The run and the heap are both sorted: the earlier of their first events is next. */
    bool from_run = q->run_at < q->run.count;
    if (from_run) {
        *e = q->run.event[q->key[q->run_at].index];
        from_run = !q->heap.count || event_before(e, &q->heap.event[0]);
    }
    if (from_run) q->run_at++;
    else heap_take(&q->heap, e);
    return true;
}

sim_ps event_queue_next_time(const struct event_queue *q)
{
    if (q->count == 0) return SIM_NEVER;
    if (q->run_at < q->run.count || q->heap.count) return q->now;
    int level, slot;
    CHECK(wheel_first(q, &level, &slot));
    /* A bucket of level > 0 is unordered and must be searched. Spreading it here would be wrong: it
     * moves the present, and the caller may still post events before that bucket. */
    sim_ps first = SIM_NEVER;
    for (const struct event_chunk *c = q->wheel[level][slot].first; c; c = c->next)
        for (uint32_t i = 0; i < c->count; i++)
            if (c->event[i].time < first) first = c->event[i].time;
    return first;
}
