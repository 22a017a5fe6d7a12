/* fuzz_netcheck.c - reference cases of networks: refused with a reason, or every case answered at
 * every level. */
#include "fuzz.h"

#include "study/netcheck.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    static struct netcheck n;
    struct arena *a = arena_create();
    err_clear(&e);
    if (netcheck_run(&n, fuzz_file("input.json", data, size), NULL, NULL, true, a, &e)) {
        CHECK(n.nrow >= 0);
        netcheck_print(&n, 0.1, false, fuzz_sink());
    } else fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
