/* fuzz_scenario.c - scenario files: refused with a reason, or a plan of valid runs whose first can
 * be explained.
 *
 * A few lines may ask for 100,000 runs, the largest plan there is; 30 us for each of them are no
 * hang. */
#include "fuzz.h"

#include "plan/plan.h"
#include "run/run.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct plan p;
    const struct plan_options o = {.fits = run_fits};
    fuzz_data();
    err_clear(&e);
    const char *path = fuzz_file("input.yaml", data, size);
    if (plan_read(&p, path, &o, &e)) {
        CHECK(p.nrun > 0);
        fuzz_allow(FUZZ_SECONDS + 30e-6 * p.nrun);
        for (int i = 0; i < p.nrun; i++) {
            const struct run_spec *run = &p.run[i];
            CHECK(run->nrank >= 1 && run->model.nbody >= 1 && strlen(run->config_hash) == 64);
            CHECK(run->refused || run->nrank <= machine_spec_processors(&run->machine));
        }
        struct run_estimate estimate;
        int64_t work = RUN_EXPLAIN_WORK;
        if (!run_explain(&p.run[0], &work, &estimate, &e)) fuzz_refused(&e);
    } else fuzz_refused(&e);
    plan_free(&p);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
