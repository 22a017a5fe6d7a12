/* memory.h - memory of the heap that is there or ends the process with its own status, never NULL.
 *
 * Where the system refuses memory, check_memory says so and the process ends with status 71: a
 * campaign's parent tells it as that of its worker, and a file in the making was never under its
 * own name (beside.h). What is too large because of a file's numbers is refused before it is asked
 * for (size.h). All of it is given back by free(). */
#ifndef BASE_MEMORY_H
#define BASE_MEMORY_H

#include <stddef.h>

/* memory_take: `n` elements of `size` bytes, not set; memory_zeroed: all zero. n = 0 gives memory
 * that is not used. */
void *memory_take(size_t n, size_t size) __attribute__((malloc, returns_nonnull));
void *memory_zeroed(size_t n, size_t size) __attribute__((malloc, returns_nonnull));

/* memory_resize: `p`, from here or NULL, with room for `n` elements of `size` bytes; what fits of
 * it stays. */
void *memory_resize(void *p, size_t n, size_t size)
    __attribute__((returns_nonnull, warn_unused_result));

/* memory_aligned: as memory_take, at a multiple of `alignment`, a power of two. */
void *memory_aligned(size_t alignment, size_t n, size_t size)
    __attribute__((malloc, returns_nonnull));

/* memory_text: a copy of the string `s`; memory_text_part: of at most its first `n` bytes. */
char *memory_text(const char *s) __attribute__((malloc, returns_nonnull));
char *memory_text_part(const char *s, size_t n) __attribute__((malloc, returns_nonnull));

#endif
