/* random.c - xoshiro256** streams seeded by splitmix64. */
#include "base/random.h"

#include <math.h>

#include "base/check.h"

/* 0 < k < 64; compilers make one instruction of it. */
static uint64_t rotate_left(uint64_t x, int k)
{
    return (x << k) | (x >> (64 - k));
}

/* splitmix64 (Steele, Lea and Flood, 2014): advance *x and return one well mixed word. */
static uint64_t splitmix64(uint64_t *x)
{
    uint64_t z = (*x += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

struct random random_make(uint64_t seed, uint64_t a, uint64_t b)
{
    /* Each name is mixed before the next is added, so (1, 2) and (2, 1) are unrelated streams. */
    uint64_t x = seed;
    x = splitmix64(&x) + a;
    x = splitmix64(&x) + b;
    struct random r;
    /* Four mixed words: never all zero in practice, which would be the one bad state. */
    for (int i = 0; i < 4; i++) r.s[i] = splitmix64(&x);
    return r;
}

/* xoshiro256** (Blackman and Vigna 2021): period 2^256 - 1, four words of state, no divisions. */
uint64_t random_u64(struct random *r)
{
    uint64_t *s = r->s, result = rotate_left(s[1] * 5, 7) * 9, t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate_left(s[3], 45);
    return result;
}

double random_uniform(struct random *r, double lo, double hi)
{
    double u = (double)(random_u64(r) >> 11) * 0x1p-53; /* 53 bits: [0, 1) */
    double x = lo + u * (hi - lo);
    return x < hi ? x : lo; /* rounding may reach hi */
}

/* Marsaglia's polar method (1964). The second number of each pair is thrown away: keeping it would
 * be hidden state, and streams must be equal whatever was drawn before. */
double random_normal(struct random *r)
{
    for (;;) {
        double u = random_uniform(r, -1, 1), v = random_uniform(r, -1, 1), q = u * u + v * v;
        if (q > 0 && q < 1) return u * sqrt(-2 * log(q) / q);
    }
}

uint64_t random_below(struct random *r, uint64_t n)
{
    CHECK(n >= 1);
    uint64_t unfair = -n % n; /* 2^64 mod n lowest words would favour small results */
    for (;;) {
        uint64_t x = random_u64(r);
        if (x >= unfair) return x % n;
    }
}
