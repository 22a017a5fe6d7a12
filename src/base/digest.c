/* digest.c - SHA-256 (FIPS 180-4).
 *
 * Written out here instead of linking a library of cryptography: identities need one function, the
 * same on every host, and no secrecy. Texts are hashed whole, so that there is no state to keep
 * between calls. */
#include "base/digest.h"

#include <string.h>

/* First 32 bits of the fractional parts of the cube roots of the first 64 primes (FIPS
 * 180-4, 4.2.2). */
static const uint32_t K[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t rotate_right(uint32_t x, int k)
{
    return (x >> k) | (x << (32 - k));
}

/* The word at `p`: its highest byte comes first. */
static uint32_t word_at(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* One of the words behind the first 16 of the schedule (6.2.2, step 1); each takes the place of the
 * one 16 before it, which no later one needs. */
static inline uint32_t next_word(uint32_t w[16], int t)
{
    const uint32_t a = w[(t + 1) & 15], b = w[(t + 14) & 15];
    const uint32_t s0 = rotate_right(a, 7) ^ rotate_right(a, 18) ^ (a >> 3);
    const uint32_t s1 = rotate_right(b, 17) ^ rotate_right(b, 19) ^ (b >> 10);
    return w[t & 15] += s1 + w[(t + 9) & 15] + s0;
}

/* Round k of 8 (6.2.2, step 3); `add` is its constant and its word. The working variables a .. h
 * stand in v; where the standard moves all of them by one place, the place of `a` moves, and is
 * back after eight rounds. */
static inline void round_of(uint32_t v[8], int k, uint32_t add)
{
#define V(i) v[((i)-k) & 7]
    const uint32_t a = V(0), e = V(4);
    const uint32_t s1 = rotate_right(e, 6) ^ rotate_right(e, 11) ^ rotate_right(e, 25);
    const uint32_t t1 = V(7) + s1 + ((e & V(5)) ^ (~e & V(6))) + add;
    const uint32_t s0 = rotate_right(a, 2) ^ rotate_right(a, 13) ^ rotate_right(a, 22);
    V(3) += t1;
    V(7) = t1 + s0 + ((a & V(1)) ^ (a & V(2)) ^ (V(1) & V(2)));
#undef V
}

/* sha256_block: fold one block of 64 bytes into the hash h (6.2.2, steps 2 to 4). */
static void sha256_block(uint32_t h[8], const unsigned char *block)
{
    uint32_t w[16], v[8];
    memcpy(v, h, sizeof v);
    for (int i = 0; i < 16; i++) w[i] = word_at(block + 4 * i);
    for (int t = 0; t < 64; t += 8) {
        /* Unrolled, the places are constants and the variables registers. */
#pragma GCC unroll 8
        for (int k = 0; k < 8; k++)
            round_of(v, k, K[t + k] + (t < 16 ? w[t + k] : next_word(w, t + k)));
    }
    /* Added to the hash so far: what makes the function hard to run backwards. */
    for (int i = 0; i < 8; i++) h[i] += v[i];
}

void digest_sha256_hex(const void *data, size_t size, char hex[65])
{
    uint32_t h[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                     0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    const unsigned char *p = data;
    size_t rest = size;
    /* Whole blocks first, then the padded tail. */
    for (; rest >= 64; rest -= 64, p += 64) sha256_block(h, p);

    /* Padding (5.1.1): one bit, zeros, and the length in bits in the last eight bytes. */
    unsigned char tail[128] = {0};
    /* Where the length does not fit behind the rest, a second block holds it. */
    size_t ntail = rest < 56 ? 64 : 128;
    if (rest > 0) memcpy(tail, p, rest);
    tail[rest] = 0x80;
    for (int i = 0; i < 8; i++) tail[ntail - 1 - i] = (unsigned char)((uint64_t)size * 8 >> 8 * i);
    for (size_t i = 0; i < ntail; i += 64) sha256_block(h, tail + i);

    for (int i = 0; i < 64; i++) hex[i] = "0123456789abcdef"[h[i / 8] >> (28 - 4 * (i % 8)) & 15];
    hex[64] = '\0';
}
