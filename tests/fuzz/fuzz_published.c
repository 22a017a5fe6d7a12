/* fuzz_published.c - tables of published figures: refused with a reason, or rows within their
 * ranges. */
#include "fuzz.h"

#include "app/published.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct published *row = NULL;
    int n = 0;
    struct arena *a = arena_create();
    err_clear(&e);
    if (published_read(fuzz_file("input.csv", data, size), a, &row, &n, &e))
        for (int i = 0; i < n; i++)
            CHECK(row[i].id[0] != '\0' && row[i].low <= row[i].value &&
                  row[i].value <= row[i].high);
    else fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
