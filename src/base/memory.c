/* memory.c - memory of the heap that is there or ends the process with its own status, never NULL.
 *
 * One place decides what a refusal means, so that no caller forgets it, and none aborts as if it
 * were our own mistake. */
#include "config.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

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
