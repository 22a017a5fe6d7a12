/* test_digest.c - fingerprints against the published examples of FIPS 180-4, and against swapped
 * words. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/digest.h"

static void sha256_is(const void *data, size_t size, const char *expected)
{
    char hex[65];
    digest_sha256_hex(data, size, hex);
    assert_string_equal(hex, expected);
}

static void sha256_meets_the_published_examples(void **state)
{
    (void)state;
    sha256_is("", 0, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    sha256_is("abc", 3, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    sha256_is("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 56,
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    sha256_is("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmn"
              "opqrlmnopqrsmnopqrstnopqrstu",
              112, "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
    char *million = malloc(1000000);
    memset(million, 'a', 1000000);
    sha256_is(million, 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    free(million);
}

static void sha256_pads_every_length_around_a_block(void **state)
{
    (void)state;
    /* The SHA-256 of the concatenated hex digests of 0 .. 130 letters 'x', from coreutils'
     * sha256sum. */
    char letters[131], all[131 * 64 + 1];
    memset(letters, 'x', sizeof letters);
    for (size_t n = 0; n <= 130; n++) digest_sha256_hex(letters, n, all + 64 * n);
    sha256_is(all, 131 * 64, "87aca1c44bc7ba8897768170211f0a02063de70801131ff86c7edb9ce32c6a50");
}

static void mixing_depends_on_every_word_and_on_their_order(void **state)
{
    (void)state;
    uint64_t ab = digest_mix(digest_mix(DIGEST_START, 1), 2),
             ba = digest_mix(digest_mix(DIGEST_START, 2), 1);
    assert_true(ab != ba);
    for (int bit = 0; bit < 64; bit++) {
        uint64_t other = digest_mix(digest_mix(DIGEST_START, UINT64_C(1) << bit ^ 1), 2);
        assert_true(other != ab);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sha256_meets_the_published_examples),
        cmocka_unit_test(sha256_pads_every_length_around_a_block),
        cmocka_unit_test(mixing_depends_on_every_word_and_on_their_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
