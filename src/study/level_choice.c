/* level_choice.c - see level_choice.h. */
#include "study/level_choice.h"

#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "spec/field.h"

/* From cheap to dear. auto gives the times of packet and costs no more. */
static const struct {
    const char *name;
    enum network_level level;
} by_cost[] = {{"loggp", LEVEL_LOGGP}, {"link", LEVEL_LINK}, {"auto", LEVEL_AUTO}, {"packet", LEVEL_PACKET},
               {"flit", LEVEL_FLIT}};
enum { LEVELS = sizeof by_cost / sizeof *by_cost };

void level_family(const struct run_spec *spec, char hex[65])
{
    struct run_spec x = *spec;
    struct text t = {0};
    memset(x.scenario, 0, sizeof x.scenario);
    x.nrank = x.model.nbody = 1;
    x.machine.network.level = LEVEL_LOGGP;
    x.machine.network.tolerance = 0;
    x.seed = x.model.seed = 0;
    x.record = (struct record_spec){0};
    fields_config(&x, &t);
    digest_sha256_hex(t.s, t.length, hex);
    text_free(&t);
}

int level_cheapest(const struct level_error *error, int n, double tolerance)
{
    for (int k = 0; k < LEVELS; k++)
        for (int i = 0; i < n; i++)
            if (strcmp(error[i].level, by_cost[k].name) == 0 && error[i].error <= tolerance) return i;
    return -1;
}

void level_take(struct run_spec *spec, const struct level_error *taken)
{
    int k = 0;
    while (k < LEVELS && strcmp(by_cost[k].name, taken->level) != 0) k++;
    CHECK(k < LEVELS);
    spec->machine.network.level = by_cost[k].level;
    spec->level_choice = (struct level_choice){.made = true, .error = taken->error};
    text_copy(spec->level_choice.at, sizeof spec->level_choice.at, taken->at);
}
