/* event_queue.c - a wheel of wheels for the future, a sorted run and a heap for the present; see
 * event_queue.h.
 *
 * Example, in windows: the present is window 0, events lie in windows 5, 70 and 5000. Level 0 holds
 * 5; level 1 (64 windows a bucket) holds 70 in bucket 1; level 2 (4096 windows a bucket) holds 5000
 * in bucket 1. When 5 is done, bucket 1 of level 1 is spread from window 64 on: 70 moves to level
 * 0. An event is moved at most once a level.
 *
 * Events of one time stay in the order of posting wherever they are, since they are always in the
 * same bucket and buckets are appended to and read in order. So no event carries its age: its
 * place tells it. */
#include "sim/event_queue.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"

enum { FIRST_CAPACITY = 8 };

/* FAR: so many events ahead the memory of an event is asked for. */
enum { FAR = 8 };

void event_queue_init(struct event_queue *q) { memset(q, 0, sizeof *q); }

void event_queue_done(struct event_queue *q)
{
    free(q->run);
    free(q->heap);
    free(q->chunk);
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

static inline uint64_t window_of(sim_ps time) { return (uint64_t)time >> WINDOW_BITS; }

/* The total order: time, lane and key in one integer, then the order of posting. Ages are unique,
 * so that no two are equal. */
static inline bool late_before(const struct event_late *a, const struct event_late *b)
{
    if (a->event.time != b->event.time) return a->event.time < b->event.time;
    return a->event.order != b->event.order ? a->event.order < b->event.order : a->age < b->age;
}

/* --- the heap of events posted within the present window --- */

/* Sift up: parents that come later move down until the place of the event is found. O(log n). The
 * hole is moved, not the event, so that each level costs one copy instead of three. */
static void heap_add(struct event_queue *q, const struct event *e)
{
    if (q->heap_count == q->heap_capacity) {
        q->heap_capacity = q->heap_capacity ? 2 * q->heap_capacity : FIRST_CAPACITY;
        q->heap = memory_resize(q->heap, q->heap_capacity, sizeof *q->heap);
    }
    const struct event_late late = {*e, q->next_age++};
    struct event_late *h = q->heap;
    uint32_t i = q->heap_count++;
    for (; i > 0 && late_before(&late, &h[(i - 1) / 2]); i = (i - 1) / 2) h[i] = h[(i - 1) / 2];
    h[i] = late;
}

/* Sift down: the last event of the array is put where the first was, and sinks along the earlier of
 * each pair of children. O(log n). */
static void heap_take(struct event_queue *q, struct event *first)
{
    struct event_late *h = q->heap;
    *first = h[0].event;
    const uint32_t n = --q->heap_count;
    const struct event_late last = h[n];
    uint32_t i = 0;
    for (uint32_t child = 1; child < n; child = 2 * i + 1) {
        if (child + 1 < n && late_before(&h[child + 1], &h[child])) child++;
        if (!late_before(&h[child], &last)) break;
        h[i] = h[child];
        i = child;
    }
    if (n) h[i] = last;
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

/* The level is given by the highest bit in which the event's window differs from the present one,
 * the bucket by the WHEEL_BITS bits of its window at that level. All events of a bucket of level
 * l > 0 therefore lie in one aligned interval of 2^(6 l) windows without the present one. O(1). */
static inline void wheel_add(struct event_queue *q, const struct event *e)
{
    const uint64_t window = window_of(e->time), differs = window ^ q->window;
    const int level = differs ? (63 - __builtin_clzll(differs)) / WHEEL_BITS : 0;
    const unsigned slot = (unsigned)(window >> (level * WHEEL_BITS)) & (WHEEL_SLOTS - 1);
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

/* The first window of a bucket: the bits above the bucket's level are the present's, those below
 * are 0. */
static inline uint64_t window_at(const struct event_queue *q, int level, int slot)
{
    const int shift = level * WHEEL_BITS;
    const uint64_t above = ~UINT64_C(0) << (shift + WHEEL_BITS);
    return (q->window & above) | (uint64_t)slot << shift;
}

/* The present moves there; no event lies between. */
static inline void move_to(struct event_queue *q, int level, int slot)
{
    q->window = window_at(q, level, slot);
}
_Static_assert(WHEEL_LEVELS * WHEEL_BITS < 64, "the shift by a level and its bits is defined");

/* Spread a bucket over the levels below, from the first window that it covers. */
static void wheel_spread(struct event_queue *q, int level, int slot)
{
    struct event_chain chain = wheel_cut(q, level, slot);
    move_to(q, level, slot);
    for (struct event_chunk *c = chain.first, *next; c; c = next) {
        next = c->next;
        for (uint32_t i = 0; i < c->count; i++) wheel_add(q, &c->event[i]);
        chunk_give(q, c);
    }
}

/* --- the sorted events of one window --- */

/* Keys are sorted, not events: less than half of the bytes to move, and the place tells where the
 * event is. Which of two keys is less nobody can foresee, so that a branch would be mispredicted
 * half of the time: there is none. */
static inline void keys_exchange(event_key *a, event_key *b)
{
    const event_key x = *a, y = *b;
    *a = x < y ? x : y;
    *b = x < y ? y : x;
}

/* Up to four, by a network. */
static inline void keys_few(event_key *k, uint32_t n)
{
    if (n < 2) return;
    if (n == 4) keys_exchange(&k[2], &k[3]);
    keys_exchange(&k[0], &k[1]);
    if (n == 4) keys_exchange(&k[1], &k[3]);
    if (n > 2) keys_exchange(&k[0], &k[2]);
    if (n > 2) keys_exchange(&k[1], &k[2]);
}

/* Merge sort, O(n log n) also in the worst case; scratch has room for n / 2 keys at least. Only the
 * left half is copied out: the merge never writes over keys of the right half that it has not
 * read. */
static void keys_sort(event_key *k, event_key *scratch, uint32_t n)
{
    if (n <= 4) {
        keys_few(k, n);
        return;
    }
    const uint32_t half = n / 2;
    keys_sort(k, scratch, half);
    keys_sort(k + half, scratch, n - half);
    if (k[half - 1] < k[half]) return; /* often posted in order */
    memcpy(scratch, k, half * sizeof *k);
    const event_key *left = scratch, *right = k + half;
    const event_key *const left_end = scratch + half, *const right_end = k + n;
    while (left < left_end && right < right_end) {
        const bool take_right = *right < *left;
        *k++ = *(take_right ? right : left);
        right += take_right;
        left += !take_right;
    }
    memcpy(k, left, (size_t)(left_end - left) * sizeof *k);
}

/* The old ones are those of a window that is over, so they are freed and not copied. */
static void run_room(struct event_queue *q, uint32_t chunks)
{
    if (chunks <= q->chunk_capacity) return;
    q->chunk_capacity = chunks * 2;
    q->run_capacity = q->chunk_capacity * CHUNK_EVENTS;
    free(q->run);
    free(q->chunk);
    free(q->key);
    free(q->scratch);
    q->run = memory_take(q->run_capacity, sizeof *q->run);
    q->chunk = memory_take(q->chunk_capacity, sizeof *q->chunk);
    q->key = memory_take(q->run_capacity, sizeof *q->key);
    q->scratch = memory_take(q->run_capacity, sizeof *q->scratch);
}

/* What the first events of the next window are about: a window may be too short to ask in. */
static inline void warm_up_next(const struct event_queue *q, int slot)
{
    const uint64_t later = q->full[0] & (~UINT64_C(1) << slot);
    if (later == 0) return;
    const struct event_chunk *c = q->wheel[0][__builtin_ctzll(later)].first;
    for (uint32_t i = 0; i < FAR && i < c->count; i++)
        __builtin_prefetch((const void *)(uintptr_t)c->event[i].argument);
}

/* The keys of a window's events, in the order of posting; how many. */
static uint32_t keys_make(struct event_queue *q, const struct event_chain *chain)
{
    uint32_t n = 0, chunks = 0;
    for (struct event_chunk *c = chain->first; c; c = c->next) {
        const uint32_t index = chunks * CHUNK_EVENTS;
        for (uint32_t i = 0; i < c->count; i++) {
            const struct event *e = &c->event[i];
            const uint32_t after = (uint32_t)e->time & ((UINT32_C(1) << WINDOW_BITS) - 1);
            q->key[n++] = (event_key)after << 96 | (event_key)e->order << 32 | (index + i);
        }
        q->chunk[chunks++] = c;
    }
    return n;
}

/* Make a bucket of level 0 the run. Its events are moved once more, into their order: so they are
 * found without a table, also those that are asked for ahead, and the chunks are used again at
 * once. */
static void run_begin(struct event_queue *q, int slot)
{
    const struct event_chain chain = wheel_cut(q, 0, slot);
    uint32_t chunks = 0;
    move_to(q, 0, slot);
    for (const struct event_chunk *c = chain.first; c; c = c->next) chunks++;
    run_room(q, chunks);
    const uint32_t n = keys_make(q, &chain);
    keys_sort(q->key, q->scratch, n);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t index = (uint32_t)q->key[i];
        q->run[i] = q->chunk[index / CHUNK_EVENTS]->event[index % CHUNK_EVENTS];
    }
    q->run_at = 0;
    q->run_count = n;
    /* The chunks go back as they are chained. */
    chain.last->next = q->pool;
    q->pool = chain.first;
    warm_up_next(q, slot);
}

void event_queue_push(struct event_queue *q, const struct event *e)
{
    /* An event in the past would break the wheels' order, not only the meaning of time. */
    CHECK(e->time >= q->now);
    q->count++;
    /* An event of the present window would otherwise have to be inserted into the sorted run, which
     * costs O(n); the heap takes O(log n). */
    if (window_of(e->time) == q->window) heap_add(q, e);
    else wheel_add(q, e);
}

/* Nothing is left of this window: the next one that has events, if it begins by `last`. Each
 * round empties one bucket; an event passes at most WHEEL_LEVELS of them. */
static bool advance(struct event_queue *q, sim_ps last)
{
    int level = 0, slot = 0;
    q->run_at = q->run_count = 0;
    for (;;) {
        CHECK(wheel_first(q, &level, &slot));
        if (window_at(q, level, slot) << WINDOW_BITS > (uint64_t)last) return false;
        if (level == 0) break;
        wheel_spread(q, level, slot);
    }
    run_begin(q, slot);
    return true;
}

/* Whether the first of the run comes before the first of the heap. Of two with one time and order
 * that of the run does: it was posted before the window began. */
static inline bool run_first(const struct event_queue *q)
{
    if (q->heap_count == 0) return true;
    const struct event *r = &q->run[q->run_at], *h = &q->heap[0].event;
    return r->time != h->time ? r->time < h->time : r->order <= h->order;
}

/* Records that events are about lie anywhere in memory, each reached through the one before: what
 * an event's argument points to is asked for FAR events ahead, the rest in further steps. */
static inline void warm_up(const struct event_queue *q)
{
    enum { STEP = 3 };
    const struct event *run = &q->run[q->run_at];
    const uint32_t left = q->run_count - q->run_at;
    if (left > FAR) __builtin_prefetch((const void *)(uintptr_t)run[FAR].argument);
    if (!q->foreseen) return;
    for (int step = 0; step < q->steps; step++) {
        const uint32_t ahead = FAR - (uint32_t)(step + 1) * STEP;
        if (left > ahead && run[ahead].action == q->foreseen)
            q->early(run[ahead].subject, run[ahead].argument, step);
    }
}

bool event_queue_pop_by(struct event_queue *q, sim_ps last, struct event *e)
{
    if (q->count == 0) return false;
    if (q->run_at == q->run_count && q->heap_count == 0 && !advance(q, last)) return false;
    const bool run = q->run_at < q->run_count && run_first(q);
    const struct event *first = run ? &q->run[q->run_at] : &q->heap[0].event;
    if (first->time > last) return false;
    q->count--;
    if (run) {
        warm_up(q);
        *e = *first;
        q->run_at++;
    } else {
        heap_take(q, e);
    }
    q->now = e->time;
    return true;
}

bool event_queue_pop(struct event_queue *q, struct event *e)
{
    return event_queue_pop_by(q, SIM_NEVER, e);
}

sim_ps event_queue_next_time(const struct event_queue *q)
{
    if (q->count == 0) return SIM_NEVER;
    if (q->run_at < q->run_count && run_first(q)) return q->run[q->run_at].time;
    if (q->heap_count) return q->heap[0].event.time;
    int level, slot;
    CHECK(wheel_first(q, &level, &slot));
    /* A bucket is unordered and must be searched. Beginning it here would be wrong: it moves the
     * present, and the caller may still post events before it. */
    sim_ps first = SIM_NEVER;
    for (const struct event_chunk *c = q->wheel[level][slot].first; c; c = c->next)
        for (uint32_t i = 0; i < c->count; i++)
            if (c->event[i].time < first) first = c->event[i].time;
    return first;
}
