/* fuzz_goal_binary.c - schedules in GOAL's binary form: refused with a reason, or executed. */
#include "fuzz_goal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct arena *a = arena_create();
    err_clear(&e);
    const char *bytes = (const char *)data;
    if (goal_is_binary(bytes, size))
        goal_try(goal_read_binary(bytes, size, "input.goal", a, &e), a, &e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    /* numbers of whole bytes: libFuzzer's own changes fit */
    (void)seed;
    return LLVMFuzzerMutate(data, size, most);
}
