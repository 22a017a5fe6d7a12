/* large_pages.c - the heap of this process in pages of 2 MiB. */
#include "config.h"

#include "base/large_pages.h"

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/size.h"

#if defined __GLIBC__ && defined MADV_HUGEPAGE && !defined SANITIZERS && !defined THREAD_SANITIZER
/* LEAD: small pages before the first large one, which malloc
 * touches before it is advised. KEPT: address space that the heap takes at a time, and keeps.
 * MAPPED: malloc's own limit for what is mapped apart. LEAST_SHARE: how many times KEPT must be
 * there. */
enum { LEAD = 1 << 15, KEPT = 1 << 26, MAPPED = 1 << 25, LEAST_SHARE = 64 };

void large_pages_for_heap(void)
{
    /* Where address space is limited, what the heap keeps would be missed elsewhere. */
    if (size_available() / LEAST_SHARE < KEPT) return;
    /* What the start of the process has left of its first heap is given back, so that the next take
     * needs a new one: behind it, at the place that we choose. */
    malloc_trim(0);
    char *end = sbrk(0);
    const size_t gap = (size_t)((0 - (uintptr_t)end - LEAD) % LARGE_PAGE);
    if (end == (char *)-1 || sbrk((intptr_t)gap) == (void *)-1) return;
    mallopt(M_TOP_PAD, KEPT);
    mallopt(M_TRIM_THRESHOLD, KEPT);
    mallopt(M_MMAP_THRESHOLD, MAPPED);
    void *volatile first = malloc(LEAD / 2); /* volatile: else the compiler leaves both calls out */
    free(first);
    char *advised = end + gap + LEAD, *top = sbrk(0);
    if (top > advised) madvise(advised, (size_t)(top - advised), MADV_HUGEPAGE);
}
#else
void large_pages_for_heap(void) {}
#endif
