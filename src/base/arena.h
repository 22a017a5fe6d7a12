/* arena.h - all memory of one run, given back at once.
 *
 * Blocks grow from the heap as needed; nothing is freed singly. Scratch is taken after a mark and
 * given back by arena_release. Memory is zeroed. Where the system refuses more, the process ends
 * (check_memory). */
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stddef.h>

#include "base/size.h"

struct arena;
struct arena_mark {
    void *block;
    size_t used;
};

/* arena_create: a new empty arena; the caller owns it and ends it with arena_destroy. */
struct arena *arena_create(void);

/* arena_destroy: give back every byte; accepts NULL. */
void arena_destroy(struct arena *a);

/* arena_empty: give back everything taken and begin anew, the peak as well; of its blocks the
 * largest one of at most `keep` bytes stays, so that the next run of the same size finds its
 * pages. */
void arena_empty(struct arena *a, size_t keep);

/* arena_take: `size` zeroed bytes, aligned to 64; lives until arena_destroy or the release of an
 * earlier mark. */
void *arena_take(struct arena *a, size_t size);

/* arena_take_full: as arena_take; `full` says that all of it will be written: it may lie in large
 * pages then, where an array that stays sparse would take memory for nothing. */
void *arena_take_full(struct arena *a, size_t size, bool full);

/* arena_text: a copy of the string `s` in the arena. */
char *arena_text(struct arena *a, const char *s);

/* arena_mark: the present position; arena_release gives back everything taken since (marks
 * nest). */
struct arena_mark arena_mark(struct arena *a);
void arena_release(struct arena *a, struct arena_mark m);

/* arena_touch: every page of what has been taken is there from now on, as for a program that has
 * used its memory before; contents stay. So are the pages of the takes that follow, up to `more`
 * bytes of them; where the arena is empty these takes lie one after the other in one block, which
 * arena_empty keeps. */
void arena_touch(struct arena *a, size_t more);

/* arena_used: bytes in use [B]. arena_peak: largest number of bytes ever in use [B]. */
size_t arena_used(const struct arena *a);
size_t arena_peak(const struct arena *a);

/* TAKE(a, n, type): an array of n zeroed elements of `type`; TAKE_FULL: by arena_take_full. Where n
 * is a product it is a size_product: what wraps in an int is small again before this macro sees it.
 * A size that does not fit, or is negative, is refused as memory. */
#define TAKE(a, n, type) ((type *)arena_take((a), size_product((size_t)(n), sizeof(type))))
#define TAKE_FULL(a, n, type, full)                                                                \
    ((type *)arena_take_full((a), size_product((size_t)(n), sizeof(type)), (full)))

#endif
