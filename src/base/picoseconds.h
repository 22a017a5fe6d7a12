/* picoseconds.h - where simulated time ends, and durations that never wrap on their way there.
 *
 * Simulated time is a 64-bit number of picoseconds. A clock that would pass PS_LAST ends its run as
 * failed (vp, sim). So that this is always seen, a duration that is longer becomes PS_TOO_LONG, and
 * what is summed without a look at a clock is summed by ps_later: three of these and a clock still
 * fit in 63 bits. */
#ifndef BASE_PICOSECONDS_H
#define BASE_PICOSECONDS_H

#include <stdint.h>

/* PS_LAST: the last simulated time, 2^60 ps or 13.3 days. PS_TOO_LONG: what any longer duration or
 * later time is. */
#define PS_LAST (INT64_C(1) << 60)
#define PS_TOO_LONG (INT64_C(1) << 61)

/* ps_rounded: the nearest picosecond of `ps` >= 0; PS_TOO_LONG where that is later than PS_LAST, or
 * no number. */
static inline int64_t ps_rounded(double ps)
{
    return ps < 0x1p60 ? (int64_t)(ps + 0.5) : PS_TOO_LONG;
}

/* ps_later: `time` plus `duration`, both at most PS_TOO_LONG and not negative; at most
 * PS_TOO_LONG. */
static inline int64_t ps_later(int64_t time, int64_t duration)
{
    int64_t sum = time + duration;
    return sum < PS_TOO_LONG ? sum : PS_TOO_LONG;
}

/* ps_times: `n` durations of `each`, none negative; PS_TOO_LONG where that is later than
 * PS_LAST. */
static inline int64_t ps_times(int64_t n, int64_t each)
{
    int64_t product;
    return __builtin_mul_overflow(n, each, &product) || product > PS_LAST ? PS_TOO_LONG : product;
}

#endif
