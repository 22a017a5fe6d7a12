/* digest.h - fingerprints: a fast 64-bit one for event streams, SHA-256 for identities. */
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

/* digest_mix: fold the 64-bit word x into the running fingerprint h (order matters). Start from
 * DIGEST_START. */
#define DIGEST_START UINT64_C(0x9e3779b97f4a7c15)
static inline uint64_t digest_mix(uint64_t h, uint64_t x)
{
    h ^= x;
    h *= UINT64_C(0xff51afd7ed558ccd);
    return h ^ (h >> 32);
}

/* digest_sha256_hex: SHA-256 (FIPS 180-4) of `size` bytes as 64 lower-case hex digits and a NUL. */
void digest_sha256_hex(const void *data, size_t size, char hex[65]);

#endif
