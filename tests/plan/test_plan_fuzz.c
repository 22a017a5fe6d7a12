/* test_plan_fuzz.c - seeded: damaged files never do worse than be refused; no setting is silently
 * without effect. */
#include "scratch.h"

#include <math.h>

#include "base/random.h"
#include "spec/field.h"
#include "spec/spec_fields.h"

/* ---- damaged files */

static const char *const tokens[] = {
    "[",
    "]",
    "{",
    "}",
    ": ",
    "- ",
    "\n",
    "  ",
    "\t",
    "'",
    "\"",
    "#",
    "&a ",
    "*a",
    "!!str ",
    "? ",
    "|\n",
    ">\n",
    "---\n",
    "...\n",
    "%YAML 1.1\n",
    "\xff",
    "\xe2\x82\xac",
    ", ",
    "~",
    "-1",
    "1e999",
    ".nan",
    "0x10",
    "99999999999999999999",
    "480 MB/s",
    "n",
    "ranks",
    "value",
    "base: t3e-300\n",
    "sweep",
    "variant",
    "n_over_p: 3\n",
    "kernel",
    "machine.",
};
enum { NTOKEN = sizeof tokens / sizeof *tokens };

/* One random change of *t at a random place. */
static void damage(struct text *t, struct random *r)
{
    struct text out = {0};
    size_t at = random_below(r, t->length + 1), n = random_below(r, 12), rest = t->length - at;
    if (n > rest) n = rest;
    const char *token = tokens[random_below(r, NTOKEN)];
    uint64_t how = random_below(r, 6);
    text_add_bytes(&out, t->s, at);
    if (how == 0) text_add_bytes(&out, token, strlen(token));          /* insert */
    if (how == 1) text_add_bytes(&out, token, strlen(token)), at += n; /* replace */
    if (how == 2) at += n;                                             /* delete */
    if (how == 3) text_add_bytes(&out, t->s + at, n);                  /* repeat */
    if (how == 4 && rest > 0)
        text_add(&out, "%c", (char)(t->s[at] ^ (1 << random_below(r, 7)))), at++;
    if (how == 5) at = random_below(r, 20) == 0 ? t->length : at; /* cut off, seldom */
    text_add_bytes(&out, t->s + at, t->length - at);
    text_free(t);
    *t = out;
}

static void write_bytes(const char *path, const struct text *t)
{
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(t->s, 1, t->length, out), t->length);
    fclose(out);
}

/* What was accepted is a plan of valid runs. */
static void check_plan(const struct plan *p)
{
    assert_true(p->nrun > 0);
    for (int i = 0; i < p->nrun; i++) {
        const struct run_spec *run = &p->run[i];
        assert_true(run->nrank >= 1 && run->model.nbody >= 1);
        assert_true(run->refused || run->nrank <= machine_spec_processors(&run->machine));
        assert_int_equal(strlen(run->config_hash), 64);
    }
}

static void check_refusal(const struct err *e)
{
    bool expected = e->kind == ERR_DATA || e->kind == ERR_CONFIG || e->kind == ERR_NO_INPUT;
    if (!expected || e->text[0] == '\0')
        fail_msg("refused with kind %d, text '%s'", (int)e->kind, e->text);
}

static void survive(const char *source, bool machine, uint64_t stream, int rounds)
{
    struct text original = {0}, t = {0};
    struct random r = random_make(20020923, stream, 0);
    struct err e;
    int accepted = 0;
    char path[128];
    snprintf(path, sizeof path, "%s/damaged.yaml", scratch.dir);
    err_clear(&e);
    assert_true(text_read_file(&original, source, &e));
    for (int round = 0; round < rounds; round++) {
        text_free(&t);
        text_add_bytes(&t, original.s, original.length);
        for (uint64_t i = random_below(&r, 4) + 1; i > 0; i--) damage(&t, &r);
        write_bytes(path, &t);
        struct arena *a = arena_create();
        struct plan p = {0};
        struct machine_spec m;
        err_clear(&e);
        bool fine = machine ? plan_machine(&m, path, NULL, a, NULL, NULL, &e)
                            : plan_read(&p, path, NULL, &e);
        if (!fine) check_refusal(&e);
        else if (!machine) check_plan(&p);
        else assert_true(machine_spec_processors(&m) >= 1);
        accepted += fine;
        plan_free(&p);
        arena_destroy(a);
    }
    assert_true(accepted > 0 && accepted < rounds);
    text_free(&t);
    text_free(&original);
}

static void damaged_scenarios_are_refused_or_valid(void **state)
{
    (void)state;
    survive(MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", false, 1, 1200);
}

static void damaged_machines_are_refused_or_valid(void **state)
{
    (void)state;
    survive(MIMDSIM_SRCDIR "/machines/t3e-300.yaml", true, 2, 800);
    survive(MIMDSIM_SRCDIR "/machines/fugaku.yaml", true, 3, 400);
}

static void damaged_options_are_refused_or_valid(void **state)
{
    (void)state;
    struct random r = random_make(20020923, 4, 0);
    for (int round = 0; round < 1000; round++) {
        struct text t = {0};
        struct plan p;
        struct err e;
        text_add(&t, "%s", round % 2 ? "machine.topology.dims=[16, 8, 8]" : "n=[2, 4]");
        for (uint64_t i = random_below(&r, 4) + 1; i > 0; i--) damage(&t, &r);
        const char *set = t.s;
        struct plan_options o = {.nset = 1, .set = &set};
        err_clear(&e);
        if (plan_read(&p, "speedup-t3e", &o, &e)) check_plan(&p);
        else if (e.kind != ERR_USAGE) check_refusal(&e);
        plan_free(&p);
        text_free(&t);
    }
}

/* ---- every key acts or is reported */

static bool is_reported(const struct plan *p, const char *key)
{
    size_t n = strlen(key);
    for (int i = 0; i < p->nunused; i++)
        if (strncmp(p->unused[i], key, n) == 0 && p->unused[i][n] == ':') return true;
    return false;
}

/* A valid value of f other than the one it has in `run`; false when the machine would no longer fit
 * together. */
static bool other_value(const struct field *f, const char *full, const void *base, struct text *out)
{
    double v;
    char quantity[64];
    switch (f->kind) {
    case FIELD_REAL:
        v = *(const double *)(const void *)((const char *)base + f->offset);
        v = v * 1.25 + (v == 0 ? fmin(1, f->max / 2) : 0);
        units_print(v > f->max ? f->max / 3 : v, f->unit, quantity, (int)sizeof quantity);
        return text_add(out, "%s", quantity), true;
    case FIELD_INT:
        return text_add(out, "%d",
                        *(const int *)(const void *)((const char *)base + f->offset) + 1),
               true;
    case FIELD_INT64:
        return text_add(out, "%d B", 24), true;
    case FIELD_SEED:
        return text_add(out, "77"), true;
    case FIELD_BOOL:
        return text_add(out, *((const char *)base + f->offset) ? "false" : "true"), true;
    case FIELD_CHOICE: {
        int now = *(const int *)(const void *)((const char *)base + f->offset);
        text_add(out, "%s", f->choice[now + 1] != NULL ? f->choice[now + 1] : f->choice[0]);
        return strcmp(full, "machine.placement.kind") != 0 || strcmp(out->s, "list") != 0;
    }
    case FIELD_TEXT:
        return text_add(out, "%s",
                        strcmp(full, "kernel.name") == 0                    ? "forward"
                        : strcmp(full, "kernel.algorithm") == 0             ? "ring"
                        : strcmp(full, "machine.software.collectives") == 0 ? "allreduce ring"
                        : strcmp(full, "machine.network.collective.kinds") == 0 ? "reduce"
                                                                            : "other"),
               true;
    case FIELD_SEGMENTS:
        return text_add(out, "[{from: 0 B}, {from: 1 KiB, send.overhead: 9 us}]"), true;
    case FIELD_INTS:
        return text_add(out, "[16, 16, 4]"), true;
    case FIELD_INT_LIST:
        return text_add(out, "[4, 3, 2, 1]"), true;
    case FIELD_PAIR_LIST:
        return text_add(out, "[[0, 1]]"), true;
    case FIELD_REALS:
        units_print(fmin(3, f->max / 2), f->unit, quantity, (int)sizeof quantity);
        for (int i = 0; i < f->capacity; i++) text_add(out, "%s%s", i > 0 ? ", " : "", quantity);
        return true;
    }
    return false;
}

/* Sets one key of the scene: the identity has to change, and if the key cannot act it has to be in
 * the report. */
static void try_key(const char *scene, const struct field_table *t, const struct field *f,
                    const struct plan *before)
{
    char full[128];
    struct text set = {0}, value = {0};
    struct plan p;
    struct err e;
    snprintf(full, sizeof full, "%s%s%s", t->prefix, t->prefix[0] != '\0' ? "." : "", f->key);
    /* what `jobs:` of a scenario makes, and nobody sets one by one */
    if (strcmp(t->prefix, "job") == 0) return;
    if (f->label || strcmp(full, "scenario") == 0 || strcmp(full, "machine.name") == 0) return;
    bool usable = other_value(f, full, (const char *)&before->run[0] + t->offset, &value);
    text_add(&set, "%s=%s", full, value.s);
    struct plan_options o = {.nset = 1, .set = (const char *const *)&set.s};
    err_clear(&e);
    if (usable && plan_read(&p, scene, &o, &e)) {
        /* What another setting puts to sleep is told as idle, and is no part of the identity. */
        const bool same = strcmp(p.run[0].config_hash, before->run[0].config_hash) == 0;
        const bool asleep = f->dormant && f->dormant((const char *)&p.run[0] + t->offset);
        if (same != asleep) fail_msg("%s %s", set.s, same ? "is lost" : "cannot act, but counts");
        bool idle = f->idle != NULL;
        for (int i = 0; i < p.nrun && idle; i++) idle = f->idle(&p.run[i]) != NULL;
        if (idle != is_reported(&p, full)) fail_msg("%s: idle %d, reported %d", set.s, idle, !idle);
        plan_free(&p);
    } else if (usable && e.kind != ERR_CONFIG && e.kind != ERR_NO_INPUT &&
               strcmp(full, "model.generator") != 0) {
        fail_msg("%s: %s", set.s, e.text);
    }
    text_free(&set);
    text_free(&value);
}

static void every_key_changes_the_identity_and_idle_keys_are_reported(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        "schema_version: 1\nmachine: t3e-300\nkernel: dynamics\nranks: 4\nn: 8\n",
        "schema_version: 1\nmachine: {name: origin2000, network.level: loggp}\nkernel: "
        "inverse\nranks: 4\nn: 8\n"
        "model: {inertia: random, base: moving, generator: comb}\n",
        "schema_version: 1\nmachine: {name: origin2000, node.model: roofline}\nkernel: "
        "dynamics\nranks: 4\nn: 8\nlevel: loggp\n",
        "schema_version: 1\nkernel: {name: shift, message: 64 B}\nranks: 4\n"
        "machine: {name: aries, topology.routing: valiant}\n",
        "schema_version: 1\nmachine: {name: t3e-300, placement: {kind: random}, noise: "
        "{background: {load: 5 %}}}\n"
        "kernel: {name: dynamics, solver: cr-pcr, steps: 3}\nranks: 4\n",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        char path[128];
        int ntable;
        snprintf(path, sizeof path, "%s", scratch_write(&scratch, "scene.yaml", scenes[i]));
        struct plan before = scratch_plan(path, NULL, 0);
        const struct field_table *const *table = field_tables(&ntable);
        for (int k = 0; k < ntable; k++)
            for (int j = 0; j < table[k]->nfield; j++)
                try_key(path, table[k], &table[k]->field[j], &before);
        plan_free(&before);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_scenarios_are_refused_or_valid),
        cmocka_unit_test(damaged_machines_are_refused_or_valid),
        cmocka_unit_test(damaged_options_are_refused_or_valid),
        cmocka_unit_test(every_key_changes_the_identity_and_idle_keys_are_reported),
    };
    return cmocka_run_group_tests(tests, open_scratch, close_scratch);
}
