/* fuzz_bytes.c - databases whose bytes a stranger changed: each change is three bytes of place, one
 * of length, and the bytes. What SQLite makes of them is read like any database. */
#include "fuzz_database.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t n;
    const uint8_t *image = database_image(&n);
    uint8_t *changed = malloc(n);
    CHECK(changed != NULL);
    memcpy(changed, image, n);
    struct fuzz_bytes b = {data, data + size};
    while (b.at < b.end) {
        size_t at = fuzz_take(&b, 3) % n, count = 1 + fuzz_below(&b, 16);
        for (size_t i = 0; i < count && at + i < n; i++)
            changed[at + i] = (uint8_t)fuzz_take(&b, 1);
    }
    database_read(fuzz_file("input.db", changed, n), fuzz_choice(data, size));
    free(changed);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    (void)seed;
    return LLVMFuzzerMutate(data, size, most);
}
