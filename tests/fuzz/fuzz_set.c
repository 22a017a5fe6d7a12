/* fuzz_set.c - `--set`: each line of the input is one option, applied to a small scenario. */
#include "fuzz.h"

#include "plan/plan.h"
#include "run/run.h"

enum { MOST = 8 };

static const char scenario[] =
    "schema_version: 1\nmachine: ideal\nkernel: dynamics\nranks: 4\nn: 8\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *path;
    const char *set[MOST];
    struct plan_options o = {.set = set, .fits = run_fits};
    struct err e;
    struct plan p;
    fuzz_data();
    if (path == NULL) path = strdup(fuzz_file("small.yaml", scenario, strlen(scenario)));
    char *text = fuzz_text(data, size), *rest = text;
    for (char *line; o.nset < MOST && (line = strsep(&rest, "\n")) != NULL;) set[o.nset++] = line;
    err_clear(&e);
    if (plan_read(&p, path, &o, &e)) CHECK(p.nrun > 0);
    else fuzz_refused(&e);
    plan_free(&p);
    free(text);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}
