/* level_choice.c - see level_choice.h. */
#include "study/level_choice.h"

#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "spec/identity.h"

void level_family(const struct run_spec *spec, char hex[65])
{
    struct run_spec x = *spec;
    struct arena *a = arena_create();
    memset(x.scenario, 0, sizeof x.scenario);
    x.nrank = x.model.nbody = 1;
    x.machine.network.level = LEVEL_LOGGP;
    x.machine.network.tolerance = 0;
    x.seed = x.model.seed = 0;
    x.record = (struct record_spec){0};
    run_identify(&x, a);
    memcpy(hex, x.config_hash, sizeof x.config_hash);
    arena_destroy(a);
}

int level_cheapest(const struct level_error *error, int n, double tolerance)
{
    enum network_level cheap[LEVELS];
    network_levels_by_cost(cheap);
    for (int k = 0; k < LEVELS; k++)
        for (int i = 0; i < n; i++)
            if (strcmp(error[i].level, network_level_name(cheap[k])) == 0 && error[i].error <= tolerance) return i;
    return -1;
}

void level_take(struct run_spec *spec, const struct level_error *taken)
{
    int k = 0;
    while (k < LEVELS && strcmp(network_level_name((enum network_level)k), taken->level) != 0) k++;
    CHECK(k < LEVELS);
    spec->machine.network.level = (enum network_level)k;
    spec->level_choice = (struct level_choice){.made = true, .error = taken->error};
    text_copy(spec->level_choice.at, sizeof spec->level_choice.at, taken->at);
}
