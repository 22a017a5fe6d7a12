/* random.h - seeded random streams that can be split by name, equal on every host.
 *
 * Generator: xoshiro256** (Blackman and Vigna, 2018), seeded by splitmix64 over (seed, a, b). */
#ifndef BASE_RANDOM_H
#define BASE_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t s[4];
};

/* random_make: the stream of (seed, a, b); a and b name its purpose and owner (rank, body,
 * repetition). */
struct random random_make(uint64_t seed, uint64_t a, uint64_t b);

/* random_u64: the next 64 bits. */
uint64_t random_u64(struct random *r);

/* random_uniform: uniform in [lo, hi). */
double random_uniform(struct random *r, double lo, double hi);

/* random_normal: standard normal (polar method; two uniforms or more per call). */
double random_normal(struct random *r);

/* random_below: uniform integer in [0, n), without modulo bias; n >= 1. */
uint64_t random_below(struct random *r, uint64_t n);

#endif
