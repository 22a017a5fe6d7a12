/* arena.c - a bump allocator over mapped blocks.
 *
 * The first blocks are small and of the heap, which keeps its pages from one arena to the next:
 * most arenas need no more, and to map and fault in pages for each takes longer than what is done
 * in them. Later blocks come from mmap, as does one for a single large array, which so costs only
 * the pages that are touched, and fresh pages are zero already: `dirty` remembers how far a block
 * was ever used, and only below it must a new take be cleared by hand. Blocks double in size, so
 * the number of system calls is logarithmic in what a run needs. After a release the next block is
 * kept for the next take: a loop around a mark near a block's end does not map and unmap each time
 * round.
 *
 * Under the address sanitizer what was released is poisoned and takes are kept apart, so that
 * overruns and uses after release are seen, and the blocks are roots of the leak detector. */
#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/check.h"
#include "base/memory.h"

#if defined __has_feature
#if __has_feature(address_sanitizer)
#define ARENA_ASAN 1
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define ARENA_ASAN 1
#endif
#ifdef ARENA_ASAN
#include <sanitizer/asan_interface.h>
#include <sanitizer/lsan_interface.h>
#define POISON(p, n) ASAN_POISON_MEMORY_REGION(p, n)
#define UNPOISON(p, n) ASAN_UNPOISON_MEMORY_REGION(p, n)
#define ROOT_ADD(p, n) __lsan_register_root_region(p, n)
#define ROOT_REMOVE(p, n) __lsan_unregister_root_region(p, n)
enum { GAP = 64 };
#else
#define POISON(p, n) ((void)(p), (void)(n))
#define UNPOISON(p, n) ((void)(p), (void)(n))
#define ROOT_ADD(p, n) ((void)(p), (void)(n))
#define ROOT_REMOVE(p, n) ((void)(p), (void)(n))
enum { GAP = 0 };
#endif

/* ALIGN: a cache line, enough for any type and for vector loads. Blocks up to FIRST_BLOCK are of
 * the heap, and so are those below HUGE_BLOCK that are made for many takes; those from there on may
 * use large pages; beyond LARGEST_BLOCK they do not double any more. */
enum {
    ALIGN = 64,
    SMALL_BLOCK = 1 << 16,
    FIRST_BLOCK = 1 << 18,
    HUGE_BLOCK = 1 << 22,
    LARGEST_BLOCK = 1 << 28,
    PAGE = 4096
};

/* The head of a block lies in its own first bytes; takes start at ALIGN. */
struct block {
    struct block *below; /* the block filled before this one */
    bool heap;           /* of the heap, not mapped */
    size_t capacity;     /* bytes of the whole block */
    size_t used;         /* next free offset from the block's start, a multiple of ALIGN */
    size_t dirty;        /* bytes beyond this offset were never handed out: still zero */
    size_t before;       /* bytes in use in the blocks below */
};
_Static_assert(sizeof(struct block) <= ALIGN,
               "the head of a block fits in front of its first take");

struct arena {
    struct block *top;   /* the block in use, NULL at first */
    struct block *spare; /* one empty block kept after a release, or NULL */
    size_t next;         /* size of the next block */
    size_t peak;
};

/* Nothing is mapped before the first take. */
struct arena *arena_create(void)
{
    struct arena *a = memory_zeroed(1, sizeof *a);
    a->next = SMALL_BLOCK;
    return a;
}

/* Poisoned memory must be clean again before it goes back to the system, since the next mapping at
 * the address would inherit it. */
static void block_unmap(struct block *b)
{
    if (!b) return;
    UNPOISON(b, b->dirty);
    if (b->heap) {
        free(b);
        return;
    }
    ROOT_REMOVE(b, b->capacity);
    munmap(b, b->capacity);
}

void arena_destroy(struct arena *a)
{
    if (!a) return;
    block_unmap(a->spare);
    while (a->top) {
        struct block *below = a->top->below;
        block_unmap(a->top);
        a->top = below;
    }
    free(a);
}

/* block_of_heap: all of it may have been used before: it is cleared as it is taken. */
static struct block *block_of_heap(size_t capacity)
{
    struct block *b = memory_aligned(ALIGN, capacity, 1);
    *b = (struct block){.heap = true, .capacity = capacity, .used = ALIGN, .dirty = capacity};
    return b;
}

/* block_map: an empty block with room for `size` bytes after its head. `full`: they will all be
 * written. */
static struct block *block_map(struct arena *a, size_t size, bool full)
{
    if (a->next == SMALL_BLOCK) {
        a->next = FIRST_BLOCK;
        if (size <= SMALL_BLOCK - ALIGN) return block_of_heap(SMALL_BLOCK);
    }
    size_t capacity = (ALIGN + size + PAGE - 1) / PAGE * PAGE;
    if (capacity < a->next) capacity = a->next;
    if (a->next < LARGEST_BLOCK) a->next *= 2;
    /* A block of many takes fills from below; a single large array may stay sparse. */
    const bool fills = full || size <= capacity / 8;
    if ((fills && capacity < HUGE_BLOCK) || capacity <= FIRST_BLOCK) return block_of_heap(capacity);
    struct block *b = mmap(NULL, capacity, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (b == MAP_FAILED) check_memory(capacity);
    if (fills) madvise(b, capacity, MADV_HUGEPAGE);
    ROOT_ADD(b, capacity);
    *b = (struct block){.capacity = capacity, .used = ALIGN, .dirty = ALIGN};
    return b;
}

/* arena_grow: make a block with `size` free bytes the top. */
static struct block *arena_grow(struct arena *a, size_t size, bool full)
{
    /* The block kept by an earlier release, if it is large enough. */
    struct block *b = a->spare;
    a->spare = NULL;
    /* Too small for this take: given back rather than kept for a later one. */
    if (b && b->capacity - ALIGN < size) {
        block_unmap(b);
        b = NULL;
    }
    if (!b) b = block_map(a, size, full);
    b->below = a->top;
    b->before = a->top ? a->top->before + a->top->used - ALIGN : 0;
    a->top = b;
    return b;
}

void *arena_take_full(struct arena *a, size_t size, bool full)
{
    /* What a negative number becomes as size_t; rounding up below cannot wrap. */
    if (size >= SIZE_MAX / 2) check_memory(size);
    size_t room = (size + ALIGN - 1) / ALIGN * ALIGN + GAP;
    struct block *b = a->top;
    if (!b || b->capacity - b->used < room) b = arena_grow(a, room, full);
    char *p = (char *)b + b->used;
    /* Only what was handed out before needs clearing; fresh pages of the mapping are zero. */
    if (b->used < b->dirty) {
        size_t old = b->dirty - b->used;
        UNPOISON(p, old < size ? old : size);
        memset(p, 0, old < size ? old : size);
    }
    POISON(p + size, room - size);
    b->used += room;
    if (b->dirty < b->used) b->dirty = b->used;
    /* Peak of what is in use, not of what is mapped: it is compared with estimates. */
    const size_t in_use = arena_used(a);
    if (in_use > a->peak) a->peak = in_use;
    return p;
}

void *arena_take(struct arena *a, size_t size) { return arena_take_full(a, size, false); }

char *arena_text(struct arena *a, const char *s)
{
    size_t n = strlen(s) + 1;
    return memcpy(arena_take(a, n), s, n);
}

/* A mark is a place: O(1), and it needs no entry anywhere. */
struct arena_mark arena_mark(struct arena *a)
{
    return (struct arena_mark){a->top, a->top ? a->top->used : 0};
}

/* arena_drop_top: take the top block off, and keep the larger of it and the spare one. */
static void arena_drop_top(struct arena *a)
{
    struct block *b = a->top, *kept = a->spare;
    a->top = b->below;
    if (kept && kept->capacity >= b->capacity) {
        block_unmap(b);
        return;
    }
    block_unmap(kept);
    if (b->capacity > LARGEST_BLOCK) { /* too large to sit on: its pages go back to the host */
        a->spare = NULL;
        block_unmap(b);
        return;
    }
    b->used = ALIGN;
    POISON((char *)b + ALIGN, b->dirty - ALIGN);
    a->spare = b;
}

void arena_release(struct arena *a, struct arena_mark m)
{
    while (a->top != m.block) {
        CHECK(a->top != NULL && "the mark is of this arena and was not released before");
        arena_drop_top(a);
    }
    if (!a->top) return;
    CHECK(m.used <= a->top->used);
    /* Uses after release are seen by the sanitizer, also without a new take. */
    POISON((char *)a->top + m.used, a->top->used - m.used);
    a->top->used = m.used;
}

/* Written with what it holds: a page that was only read would be the one page of zeros. Between two
 * takes the address sanitizer forbids it to others. */
__attribute__((no_sanitize_address)) static void block_touch(struct block *b, size_t bytes)
{
    for (size_t i = 0; i < bytes; i += PAGE) {
        volatile char *p = (char *)b + i;
        const char held = *p;
        *p = held;
    }
}

/* The next `more` bytes of a block: there, and zero, so that nothing is left to do for a take. The
 * sanitizer lets them be used before that. */
static void block_foresee(struct block *b, size_t more)
{
    const size_t room = b->capacity - b->used, old = b->dirty - b->used;
    UNPOISON((char *)b + b->used, old);
    memset((char *)b + b->used, 0, old);
    b->dirty = b->used;
    block_touch(b, b->used + (more < room ? more : room));
}

/* Takes fill the top block first; the rest of them, or all, find room in one more. */
void arena_touch(struct arena *a, size_t more)
{
    for (struct block *b = a->top; b; b = b->below) block_touch(b, b->used);
    if (more == 0) return;
    if (a->top) block_foresee(a->top, more);
    if (a->spare && a->spare->capacity - ALIGN < more) block_unmap(a->spare), a->spare = NULL;
    if (!a->spare) a->spare = block_map(a, more, false);
    block_foresee(a->spare, more);
}

size_t arena_used(const struct arena *a)
{
    return a->top ? a->top->before + a->top->used - ALIGN : 0;
}

size_t arena_peak(const struct arena *a)
{
    return a->peak;
}

/* Small blocks are dropped for larger ones from run to run, until one holds all of a run. */
void arena_empty(struct arena *a, size_t keep)
{
    while (a->top) {
        struct block *below = a->top->below;
        /* It would take the place of one that may stay. */
        if (a->top->capacity > keep) block_unmap(a->top), a->top = below;
        else arena_drop_top(a);
    }
    if (a->spare && a->spare->capacity > keep) block_unmap(a->spare), a->spare = NULL;
    /* Blocks must not double for ever. */
    if (a->next > FIRST_BLOCK) a->next = a->spare ? 2 * a->spare->capacity : FIRST_BLOCK;
    if (a->next > LARGEST_BLOCK) a->next = LARGEST_BLOCK;
    a->peak = 0;
}
