/* fuzz_machine.c - machine files: refused with a reason, or a machine with processors whose every
 * value has an origin.
 */
#include "fuzz.h"

#include "plan/plan.h"
#include "run/run.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct machine_spec m;
    struct origin *origin = NULL;
    int norigin = 0;
    fuzz_data();
    err_clear(&e);
    struct arena *a = arena_create();
    const char *path = fuzz_file("input.yaml", data, size);
    if (plan_machine(&m, path, NULL, a, &origin, &norigin, &e)) {
        CHECK(machine_spec_processors(&m) >= 1 && norigin > 0);
        for (int i = 0; i < norigin; i++) CHECK(origin[i].key[0] != '\0' && origin[i].file != NULL);
        /* Its network is built, too. */
        const struct plan_options o = {.fits = run_fits};
        if (!plan_check_file(path, &o, &e)) fuzz_refused(&e);
    } else fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
