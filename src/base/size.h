/* size.h - products and sums of sizes that never wrap: what is too large becomes a size that no
 * system has.
 *
 * Numbers of bodies, ranks, rows or bytes that come from a file are multiplied here, never in int.
 * The result goes to arena_take or check_memory, which refuse it with a message, so a wrapped
 * product never becomes a small array. */
#ifndef BASE_SIZE_H
#define BASE_SIZE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/err.h"

/* SIZE_TOO_LARGE: what a product or sum that does not fit becomes; arena_take refuses it. */
#define SIZE_TOO_LARGE SIZE_MAX

/* size_product: a times b; SIZE_TOO_LARGE when that does not fit. A negative int, converted, does
 * not fit either, unless the other factor is 0. */
static inline size_t size_product(size_t a, size_t b)
{
    size_t c;
    return __builtin_mul_overflow(a, b, &c) ? SIZE_TOO_LARGE : c;
}

/* size_sum: a plus b; SIZE_TOO_LARGE when that does not fit. */
static inline size_t size_sum(size_t a, size_t b)
{
    size_t c;
    return __builtin_add_overflow(a, b, &c) ? SIZE_TOO_LARGE : c;
}

/* size_count: a times b for counts that are not negative; INT64_MAX when that does not fit. */
static inline int64_t size_count(int64_t a, int64_t b)
{
    int64_t c;
    return __builtin_mul_overflow(a, b, &c) ? INT64_MAX : c;
}

/* size_available: bytes of memory that this computer has, by the system's word: installed, or less
 * where a limit of the process says so. SIZE_MAX when it does not tell. */
size_t size_available(void);

/* size_in_memory: whether `bytes` may be asked for. When not, ERR_CONFIG at `file` and `line` (""
 * and 0: none) with what needs them, such as "machine.topology.dims '[4096, 4096]': the routing
 * tables", and the bytes. */
bool size_in_memory(size_t bytes, const char *file, int line, const char *what, struct err *e);

#endif
