/* run_columns.c - the columns of table run that come from the spec: labels by which rows are
 * chosen, and settings.
 *
 * A column here is a copy: table run_setting has every setting of a run. A new setting needs no
 * column. */
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "measure/run_row.h"
#include "spec/field.h"
#include "spec/run_label.h"
#include "store/rows.h"

#define SPEC(member) .part = PART(struct run_row, spec), .offset = offsetof(struct run_spec, member)

/* All readers get a struct run_row. */
static const struct run_spec *spec_of(const void *row)
{
    return ((const struct run_row *)row)->spec;
}

/* The word of the setting `more`, a choice. */
static void read_setting(const struct column *c, const void *row, struct column_value *v)
{
    /* A name that is no choice of the settings would be a mistake in the table below. */
    const struct field_table *t;
    const struct field *f = field_find_full(c->more, &t);
    CHECK(f != NULL && f->kind == FIELD_CHOICE);
    const char *base = (const char *)spec_of(row) + t->offset;
    /* Choices are stored as unsigned integers, whatever their enum is called. */
    v->kind = VALUE_TEXT;
    v->text = f->choice[*(const unsigned *)(const void *)(base + f->offset)];
}

#define SETTING(name, setting, text)                                                               \
    {                                                                                              \
        name, COLUMN_STRING, .value = read_setting, .more = setting, .doc = text                   \
    }

/* The scene says how many bodies were built; a run that failed before has what was asked for. */
static void read_bodies(const struct column *c, const void *row, struct column_value *v)
{
    const struct run_result *r = ((const struct run_row *)row)->result;
    (void)c;
    v->kind = VALUE_INT;
    v->integer = r->nbody > 0 ? r->nbody : spec_of(row)->model.nbody;
}

/* Into the value's own buffer: a label is no longer than it, or is cut. */
static void read_label(const struct column *c, const void *row, struct column_value *v)
{
    struct text t = {0};
    (void)c;
    run_label(spec_of(row), &t);
    text_copy(v->buffer, sizeof v->buffer, t.s);
    text_free(&t);
    v->kind = VALUE_TEXT;
    v->text = v->buffer;
}

/* Of the text that is stored, so that an upgrade of an older database finds the same. */
static void read_machine_key(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    machine_fingerprint(spec_of(row)->config_text, v->buffer);
    v->kind = VALUE_TEXT;
    v->text = v->buffer;
}

/* Labels by which rows are chosen and grouped in queries. They repeat settings of run_setting,
 * since a column is found faster and is easier to write than a join. */
static const struct column run_identity[] = {
    {"config_hash", COLUMN_CHARS, SPEC(config_hash), .doc = "SHA-256 that identifies its settings"},
    {"seed", COLUMN_COUNT, SPEC(seed), .doc = "of noise, background traffic and random routes"},
    {"rep", COLUMN_INT, SPEC(rep), .doc = "repetition, from 0"},
    {"scenario", COLUMN_CHARS, SPEC(scenario),
     .doc = "the scenario's file without its folder and ending"},
    {"machine", COLUMN_CHARS, SPEC(machine.name), .doc = "name of the machine's file"},
    {"label", COLUMN_STRING, .value = read_label,
     .doc = "what it is called in tables and figures: a given name, or the machine with what was "
            "changed"},
    {"machine_key", COLUMN_STRING, .value = read_machine_key,
     .doc = "fingerprint of the machine's settings: runs on one machine have the same, whatever "
            "they are called"},
    SETTING("topology", "machine.topology.family", "family of its network"),
    SETTING("level", "machine.network.level", "how closely the network is simulated"),
    SETTING("placement", "machine.placement.kind", "of ranks on nodes"),
    {"kernel", COLUMN_CHARS, SPEC(kernel.name), .doc = "the parallel program"},
    SETTING("formulation", "kernel.formulation", "of forward dynamics"),
    SETTING("solver", "kernel.solver", "of the system of all ranks"),
    SETTING("part_solver", "kernel.part_solver", "of a rank's own part of it"),
    SETTING("operators", "kernel.operators", "how the matrices of a body are built and counted"),
    SETTING("precision", "kernel.precision", "of all numbers"),
    SETTING("model", "model.generator", "where the multibody system comes from"),
    SETTING("base", "model.base", "how its first body is held"),
    SETTING("joint", "model.joint", "type of its joints"),
    {"n", COLUMN_INT, .value = read_bodies, .doc = "bodies"},
    {"nu", COLUMN_INT, .part = PART(struct run_row, result),
     .offset = offsetof(struct run_result, nu),
     .doc = "degrees of freedom, 0 when there is no model"},
    {"P", COLUMN_INT, SPEC(nrank), .doc = "virtual processors"},
    {"compute_noise_cv", COLUMN_REAL, SPEC(machine.noise.compute_cv), .flags = COLUMN_NULL,
     .doc = "relative deviation of computing times; 0: no noise"},
    {"background_load", COLUMN_REAL, SPEC(machine.noise.background_load), .flags = COLUMN_NULL,
     .doc = "share of the links that other jobs use; 0: none"},
};
const struct column_table run_identity_columns = COLUMNS(run_identity);

#define ORDER(member)                                                                              \
    .part = PART(struct run_row, order), .offset = offsetof(struct run_order, member)

/* NULL where a run was stored without its order. */
static const struct run_order *order_of(const void *row)
{
    return ((const struct run_row *)row)->order;
}

/* Whether the level was chosen for its error, and not named. */
static bool level_chosen(const void *row)
{
    return order_of(row) && order_of(row)->level_choice.made;
}

/* The question as a user would write it; audit_again.c reads the tolerance back from it. */
static void read_asked(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    snprintf(v->buffer, sizeof v->buffer, "auto-tolerance %.9g %%",
             100 * order_of(row)->level_choice.tolerance);
    v->kind = VALUE_TEXT;
    v->text = v->buffer;
}

/* NULL in all runs that named their level. */
static const struct column run_level[] = {
    {"level_asked", COLUMN_STRING, .value = read_asked, .known = level_chosen, .flags = COLUMN_NULL,
     .doc = "'auto-tolerance 2 %': `level` was taken for its measured error"},
    {"level_error", COLUMN_REAL, ORDER(level_choice.error), .known = level_chosen,
     .flags = COLUMN_NULL, .doc = "of the makespan, relative, at level_error_at"},
    {"level_error_at", COLUMN_CHARS, ORDER(level_choice.at), .known = level_chosen,
     .flags = COLUMN_NULL, .doc = "where that was measured: \"n=P=128\""},
};
const struct column_table run_level_columns = COLUMNS(run_level);

/* Always a text: an audit reads the run back from it. */
static void read_config(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    v->kind = VALUE_TEXT;
    v->text = spec_of(row)->config_text ? spec_of(row)->config_text : "";
}

/* No machine of that name is shipped: nothing can be said to have changed. */
static bool machine_shipped(const void *row) { return spec_of(row)->machine_changes != NULL; }

/* The whole configuration, and how its machine differs from the shipped one. */
static const struct column run_config[] = {
    {"config_text", COLUMN_STRING, .value = read_config,
     .doc = "all settings as text; config_hash is the SHA-256 of its lines that differ from the "
            "defaults, sorted"},
    {"machine_changes", COLUMN_STRING, SPEC(machine_changes), .flags = COLUMN_NULL,
     .doc = "JSON: settings that are not those of the shipped machine of this name; '{}': none; "
            "NULL: none is shipped"},
    {"machine_hash", COLUMN_STRING, SPEC(machine_hash), .known = machine_shipped,
     .flags = COLUMN_NULL,
     .doc = "SHA-256 of that shipped machine when the run was made; 'not stored' in runs from "
            "before version 5"},
};
const struct column_table run_config_columns = COLUMNS(run_config);
