/* fuzz_goal_text.c - schedules in GOAL's text form: refused with a reason, or executed. */
#include "fuzz_goal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct arena *a = arena_create();
    err_clear(&e);
    goal_try(goal_read_text((const char *)data, size, "input.goal", a, &e), a, &e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
