/* fuzz_vector.c - reference vectors: refused with a reason, or a case whose model is built; small
 * ones are computed by every serial algorithm. */
#include "fuzz.h"

#include "model/vector_model.h"
#include "study/verify.h"

enum { COMPUTED_BODIES = 4, COMPUTED_VELOCITIES = 12 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct vector_case c;
    struct verify_report r;
    const struct verify_options o = {.precision = PRECISION_DOUBLE};
    struct arena *a = arena_create();
    const char *path = fuzz_file("input.json", data, size);
    err_clear(&e);
    bool fine = vector_read(path, &c, a, &e);
    if (fine) {
        const struct model *m = vector_model(&c, a, &e);
        fine = m != NULL;
        if (fine) CHECK(vector_state(&c, m, a) != NULL);
        fine = fine && c.nbody <= COMPUTED_BODIES && c.nv <= COMPUTED_VELOCITIES && c.ninstant == 0;
        if (fine) fine = verify_file(path, &o, a, &r, &e);
    }
    if (!fine && e.kind != ERR_NONE) fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
