/* run_spec.c - the settings of a run itself, and all tables together.
 *
 * ranks and seed, and what is to be recorded. How the run is executed (what is computed although
 * nothing asks for it, who hears how far it is) is no setting and no part of its identity (struct
 * run_order). */
#include "spec/run_spec.h"

#include <string.h>

#include "base/digest.h"
#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct run_spec, member)

/* Whether two runs with different seeds may differ: if not, the seed is idle, and one repetition
 * says all. */
bool run_spec_is_random(const struct run_spec *r)
{
    const struct machine_spec *m = &r->machine;
    const enum topology_family f = m->topology.family;
    /* Every place that draws from the run's seed. */
    bool valiant = topology_has(f, TOPOLOGY_CHOOSES) && m->topology.routing == ROUTE_VALIANT;
    bool tie = topology_has(f, TOPOLOGY_RINGS) && m->topology.tie == TIE_RANDOM;
    bool routed = routing_rule_chance(m->network.routing);
    bool order = kernel_spec_has(&r->kernel, PROGRAM_RANDOM);
    /* Level 'loggp' has no links that other jobs take. */
    bool others = m->noise.background_load > 0 && m->network.level != LEVEL_LOGGP;
    return m->noise.compute_cv > 0 || others || valiant || tie || routed || order;
}

/* Repetitions of one run draw different numbers; the same repetition always the same ones. */
uint64_t run_spec_seed(const struct run_spec *r)
{
    return digest_mix(digest_mix(DIGEST_START, r->seed), (uint64_t)r->rep);
}

/* A seed that nothing draws from. */
static const char *idle_unless_random(const struct run_spec *r)
{
    return run_spec_is_random(r)
               ? NULL
               : "there is no noise, no background traffic, no random route and no random ring";
}

/* In the order of the enum. */
static const char *const baseline_rules[] = {"all", "needed", NULL};

/* Baselines are serial codes of the same task: forward dynamics has several. */
static const char *idle_without_choice(const struct run_spec *r)
{
    if (r->kernel.own) return NULL;
    if (!kernel_spec_needs_model(&r->kernel))
        return "this kernel only sends messages and has no serial code";
    return kernel_spec_has(&r->kernel, PROGRAM_FORWARD) ? NULL
                                                        : "inverse dynamics has one serial code";
}

/* Settings of the run itself; those of machine, model and program have tables of their own. */
static const struct field fields[] = {
    {.key = "scenario",
     .kind = FIELD_TEXT,
     AT(scenario),
     .capacity = 64,
     .fallback = "",
     .doc = "name of the scenario file without folder and suffix"},
    {.key = "label",
     .kind = FIELD_TEXT,
     AT(label),
     .capacity = 96,
     .fallback = "",
     .label = true,
     .doc = "what a run is called in legends and tables (also `name`); default: the machine with "
            "what was changed"},
    {.key = "ranks",
     .kind = FIELD_INT,
     AT(nrank),
     .min = 1,
     .max = 1 << 24,
     .fallback = "1",
     .doc = "P, number of ranks, each on a virtual processor; in a scenario also 'n': one per "
            "body"},
    {.key = "seed",
     .kind = FIELD_SEED,
     AT(seed),
     .fallback = "1",
     .idle = idle_unless_random,
     .doc = "seed of noise and random routes"},
    {.key = "record.baselines",
     .kind = FIELD_CHOICE,
     AT(record.baselines),
     .choice = baseline_rules,
     .fallback = "all",
     .idle = idle_without_choice,
     .doc = "serial codes to compare the run with: all, or only those that can be the fastest by "
            "operation count"},
    /* Records cost memory and rows of the database: off unless asked for. */
    {.key = "record.links",
     .kind = FIELD_BOOL,
     AT(record.links),
     .fallback = "false",
     .doc = "store busy time and queueing of every link"},
    {.key = "record.spans",
     .kind = FIELD_BOOL,
     AT(record.spans),
     .fallback = "false",
     .doc = "store the timeline: what each rank did when"},
};

const struct field_table run_table = {
    .prefix = "",
    .doc = "the run itself",
    .offset = 0,
    .size = sizeof(struct run_spec),
    .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};
