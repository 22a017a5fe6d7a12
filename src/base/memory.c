/* memory.c - memory of the heap that is there or ends the process with its own status, never NULL.
 *
 * One place decides what a refusal means, so that no caller forgets it, and none aborts as if it
 * were our own mistake. */
#include "config.h"

#include "base/memory.h"

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/check.h"
#include "base/size.h"

/* malloc(0) may be NULL without being a refusal: one byte at least. */
static size_t bytes_of(size_t n, size_t size)
{
    size_t bytes = size_product(n, size);
    return bytes ? bytes : 1;
}

void *memory_take(size_t n, size_t size)
{
    void *p = malloc(bytes_of(n, size));
    if (!p) check_memory(bytes_of(n, size));
    return p;
}

void *memory_zeroed(size_t n, size_t size)
{
    /* calloc and not memset: large blocks come from the system as zeros and cost only what is
     * touched. */
    void *p = calloc(1, bytes_of(n, size));
    if (!p) check_memory(bytes_of(n, size));
    return p;
}

void *memory_resize(void *p, size_t n, size_t size)
{
    void *q = realloc(p, bytes_of(n, size));
    if (!q) check_memory(bytes_of(n, size));
    return q;
}

void *memory_aligned(size_t alignment, size_t n, size_t size)
{
    /* aligned_alloc wants a multiple of the alignment. */
    size_t bytes = size_sum(bytes_of(n, size), alignment - 1) & ~(alignment - 1);
    void *p = aligned_alloc(alignment, bytes);
    if (!p) check_memory(bytes);
    return p;
}

#if defined __GLIBC__ && defined MADV_HUGEPAGE && !defined SANITIZERS && !defined THREAD_SANITIZER
/* LARGE_PAGE: of x86-64 and aarch64. LEAD: small pages before the first of them, which malloc
 * touches before it is advised. KEPT: address space that the heap takes at a time, and keeps.
 * MAPPED: malloc's own limit for what is mapped apart. LEAST_SHARE: how many times KEPT must be
 * there. */
enum { LARGE_PAGE = 1 << 21, LEAD = 1 << 15, KEPT = 1 << 26, MAPPED = 1 << 25, LEAST_SHARE = 64 };

void memory_large_pages(void)
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
void memory_large_pages(void) {}
#endif

char *memory_text(const char *s)
{
    size_t bytes = strlen(s) + 1;
    return memcpy(memory_take(bytes, 1), s, bytes);
}

char *memory_text_part(const char *s, size_t n)
{
    size_t length = strnlen(s, n);
    char *copy = memory_take(length + 1, 1);
    memcpy(copy, s, length);
    copy[length] = '\0';
    return copy;
}
