/* mpi_memory.c - memory of the ranks of one run, taken and given back all the time.
 *
 * Small blocks come from the run's arena by powers of two and are kept for the next taker,
 * whichever rank that is. Large ones come from the heap, so that a message of many megabytes does
 * not stay for good; a list of them gives back those of ranks that never came to their end. */
#include <stdlib.h>

#include "base/memory.h"
#include "mpi/mpi_internal.h"

enum { SMALLEST = 5, HEAD = 32 /* [B], keeps the alignment of long double and vectors */ };

struct mpi_large {
    struct mpi_large *next, **before;
};

/* What stands before each block. The list comes first, so that an entry's address is that
 * of the block from the heap. */
union head {
    struct {
        struct mpi_large list; /* large ones */
        int class;             /* power of two of small ones, -1: large */
    };
    char room[HEAD];
};

/* Class k holds blocks of up to 2^(SMALLEST + k) bytes, class 16 of up to 2 MiB. */
static int class_of(size_t bytes)
{
    if (bytes <= (size_t)1 << SMALLEST) return 0;
    return 64 - __builtin_clzll((unsigned long long)bytes - 1) - SMALLEST;
}

static void *take_large(struct mpi_world *w, size_t bytes)
{
    union head *h = memory_take(HEAD + bytes, 1);
    /* Out of memory ends the process with a message: no caller has a way to go on. */
    h->class = -1;
    h->list.next = w->large;
    /* `before` is the link that leads here, so that a block is taken off without a
     * search. */
    h->list.before = &w->large;
    if (w->large) w->large->before = &h->list.next;
    w->large = &h->list;
    return (char *)h + HEAD;
}

/* Free blocks are chained through their first word; the head stays, so the class is known
 * when a block comes back. Blocks hold what they held: callers fill them or ask for
 * zeros. */
void *mpi_take(struct mpi_world *w, int64_t bytes)
{
    int class = class_of((size_t)bytes);
    if (class >= MEMORY_CLASSES) return take_large(w, (size_t)bytes);
    union head *h = w->free_memory[class];
    if (h) w->free_memory[class] = *(void **)((char *)h + HEAD);
    else h = arena_take(w->arena, HEAD + ((size_t)1 << (class + SMALLEST)));
    h->class = class;
    return (char *)h + HEAD;
}

void *mpi_take_zero(struct mpi_world *w, int64_t bytes)
{
    return memset(mpi_take(w, bytes), 0, (size_t)bytes);
}

char *mpi_take_text(struct mpi_world *w, const char *s)
{
    size_t bytes = strlen(s) + 1;
    return memcpy(mpi_take(w, (int64_t)bytes), s, bytes);
}

void mpi_give(struct mpi_world *w, void *block)
{
    if (!block) return;
    union head *h = (union head *)((char *)block - HEAD);
    if (h->class >= 0) {
        *(void **)block = w->free_memory[h->class];
        w->free_memory[h->class] = h;
        return;
    }
    *h->list.before = h->list.next;
    if (h->list.next) h->list.next->before = h->list.before;
    free(h);
}

/* Small blocks end with the run's arena. */
void mpi_memory_end(struct mpi_world *w)
{
    while (w->large) {
        struct mpi_large *block = w->large;
        w->large = block->next;
        free(block);
    }
}
