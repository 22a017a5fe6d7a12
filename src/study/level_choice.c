/* level_choice.c - see level_choice.h. */
#include "study/level_choice.h"

#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "spec/identity.h"
#include "spec/spec_fields.h"

/* The identity of a run from which everything is taken that a family may differ in: sizes,
 * level, tolerance, seeds, recording, scenario. Equal identities are runs whose errors are
 * alike. */
void level_family_by(struct identity *by, const struct run_spec *spec, char hex[65])
{
    /* a copy: `spec` keeps its sizes */
    struct run_spec x = *spec;
    struct arena *a = arena_create();
    memset(x.scenario, 0, sizeof x.scenario);
    /* Any fixed value does, as long as it is the same for all members. */
    x.nrank = x.model.nbody = 1;
    x.machine.network.level = LEVEL_LOGGP;
    x.machine.network.tolerance = 0;
    x.seed = x.model.seed = 0;
    x.record = (struct record_spec){0};
    identity_set(by, &x, a);
    memcpy(hex, x.config_hash, sizeof x.config_hash);
    arena_destroy(a);
}

void level_family(const struct run_spec *spec, char hex[65])
{
    struct identity *by = identity_of_runs();
    level_family_by(by, spec, hex);
    identity_destroy(by);
}

int level_cheapest(const struct level_error *error, int n, double tolerance)
{
    /* Cheap by construction, not by a clock: the same choice on every host. */
    enum network_level cheap[LEVELS];
    network_levels_by_cost(cheap);
    for (int k = 0; k < LEVELS; k++)
        for (int i = 0; i < n; i++)
            if (strcmp(error[i].level, network_level_name(cheap[k])) == 0 &&
                error[i].error <= tolerance)
                return i;
    return -1;
}

/* The tolerance acts no more: its default, so that the run is the one that asked for this level at
 * once. */
static void drop_tolerance(struct run_spec *spec, struct arena *a)
{
    const struct field *f = &machine_table.field[field_find(&machine_table, "network.tolerance")];
    char why[160];
    CHECK(field_set(f, &spec->machine, f->fallback, a, why, (int)sizeof why));
}

void level_take(struct run_spec *spec, const struct level_error *taken, struct level_choice *choice,
                struct arena *a)
{
    /* The ladder writes levels by name into the database; a name of no level is a mistake of
     * ours. */
    int k = 0;
    while (k < LEVELS && strcmp(network_level_name((enum network_level)k), taken->level) != 0) k++;
    CHECK(k < LEVELS);
    /* What was asked stays in *choice alone: from here on the run is one that names its level. */
    *choice = (struct level_choice){
        .made = true, .tolerance = spec->machine.network.tolerance, .error = taken->error};
    text_copy(choice->at, sizeof choice->at, taken->at);
    spec->machine.network.level = (enum network_level)k;
    drop_tolerance(spec, a);
    run_identify(spec, a);
}
