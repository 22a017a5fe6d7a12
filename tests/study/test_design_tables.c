/* test_design_tables.c - the design's tables of condition numbers, errors and breakdowns (physics
 * 8), entry by entry: each is met within a factor of 10, or it is listed with what comes out here
 * and why. */
#include "config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "design_system.h"
#include "dynamics/dynamics.h"
#include "study/stability.h"
#include "study/stability_scene.h"

enum { MOST_LINE = 400 };

/* One line of tests/data/physics/tables.txt: table family n masses ratio column value here
 * reason. */
struct entry {
    char table[8], family[12], masses[16], column[24], reason[200];
    int n;
    double ratio, value, here; /* here: NaN when the value is met */
};

/* A scene's quantities, worked out when asked for. */
struct subject {
    char name[64];
    struct arena *a, *rows;
    struct model *m;
    struct state *s;
    struct design_system system;
    struct stability_report report;
};

static bool entry_read(FILE *f, struct entry *x)
{
    char line[MOST_LINE], here[24];
    while (fgets(line, sizeof line, f)) {
        if (line[0] == '#' || line[0] == '\n') continue;
        *x = (struct entry){0};
        int got = sscanf(line, "%7s %11s %d %15s %lf %23s %lf %23s %199[^\n]", x->table, x->family,
                         &x->n, x->masses, &x->ratio, x->column, &x->value, here, x->reason);
        if (got < 8) fail_msg("not an entry: %s", line);
        if (sscanf(here, "%lf", &x->here) != 1) x->here = NAN;
        if (isfinite(x->here) && got < 9) fail_msg("no reason: %s", line);
        return true;
    }
    return false;
}

static struct stability_scene scene_of(const struct entry *x, const char *name)
{
    static const char *const spread[] = {"even", "heavy-tip", "light-tip", "light-base",
                                         "up",   "down",      "random",    "alternating"};
    struct stability_scene c = {.name = name, .spec = {.nbody = x->n}, .ratio = x->ratio};
    if (strcmp(x->family, "twist") == 0) c.spec.axes = AXES_TWISTED;
    if (strcmp(x->family, "coil") == 0) c.spec.axes = AXES_TWISTED, c.spec.pose = POSE_COILED;
    if (strcmp(x->family, "sphere") == 0) c.spec.joint = JOINT_SPHERICAL;
    if (strcmp(x->family, "torsion") == 0)
        c.spec.generator = MODEL_POLYMER, c.spec.axes = AXES_TWISTED, c.spec.pose = POSE_COILED,
        c.spec.torque = 1e-21, c.spec.rate = 1e11;
    for (int k = 0; k < 8; k++)
        if (strcmp(x->masses, spread[k]) == 0) c.spread = (enum spread)k;
    return c;
}

static void subject_end(struct subject *t)
{
    if (t->a) arena_destroy(t->a);
    if (t->rows) arena_destroy(t->rows);
}

static void subject_make(struct subject *t, const struct entry *x)
{
    char name[64];
    snprintf(name, sizeof name, "%s %d %s %.0e", x->family, x->n, x->masses, x->ratio);
    if (strcmp(name, t->name) == 0) return;
    subject_end(t);
    *t = (struct subject){.a = arena_create(), .rows = arena_create()};
    snprintf(t->name, sizeof t->name, "%s", name);
    const struct stability_scene c = scene_of(x, t->name);
    struct err e = {0};
    if (!scene_build(&c, t->a, &t->m, &t->s, &e)) fail_msg("%s: %s", name, e.text);
    t->system = design_system_make(t->m, t->s, t->a);
}

static double error_of(struct subject *t, const char *algorithm)
{
    if (!t->report.arena) {
        t->report.arena = t->rows;
        stability_accelerations(&t->report, t->name, t->m, t->s, false, t->a);
    }
    for (int i = 0; i < t->report.nrow; i++) {
        const struct stability_row *r = &t->report.row[i];
        char name[40];
        snprintf(name, sizeof name, "%s", r->algorithm);
        for (char *p = name; *p; p++)
            if (*p == ' ') *p = '-';
        if (strcmp(name, algorithm) == 0 && strcmp(r->precision, "double") == 0) return r->error;
    }
    fail_msg("no algorithm %s", algorithm);
    return NAN;
}

static double measure(struct subject *t, const struct entry *x)
{
    subject_make(t, x);
    if (strcmp(x->column, "cond-A") == 0) return design_condition(&t->system, false);
    if (strcmp(x->column, "cond-blk") == 0) return design_condition(&t->system, true);
    if (strcmp(x->column, "cond-M") == 0) return design_mass_condition(t->m, t->s, t->a);
    if (strcmp(x->column, "thomas") == 0)
        return design_backward_error(&t->system, SOLVER_THOMAS, PART_CR, 1);
    if (strcmp(x->column, "cr") == 0)
        return design_backward_error(&t->system, SOLVER_CR, PART_CR, x->n);
    if (strcmp(x->column, "pcr") == 0)
        return design_backward_error(&t->system, SOLVER_PCR_SYMMETRIC, PART_PCR, x->n);
    return error_of(t, x->column);
}

static bool within(double x, double y) { return x <= 10 * y && y <= 10 * x; }

#ifdef SANITIZERS /* slow, and more bodies are more of the same */
enum { MOST_BODIES = 64, FEW_ENTRIES = 100 };
#else
enum { MOST_BODIES = 1 << 20, FEW_ENTRIES = 200 };
#endif

static void every_entry_is_met_or_explained(void **state)
{
    (void)state;
    FILE *f = fopen(MIMDSIM_SRCDIR "/tests/data/physics/tables.txt", "r");
    assert_non_null(f);
    struct subject t = {0};
    struct entry x;
    int entries = 0, met = 0, wrong = 0;
    while (entry_read(f, &x)) {
        if (x.n > MOST_BODIES) continue;
        const double here = measure(&t, &x);
        const bool fits = within(here, x.value);
        entries++;
        met += fits;
        if (fits || (isfinite(x.here) && within(here, x.here))) continue;
        print_message("%s %s %d %s %.0e %s: %.0e in the design, %.1e here\n", x.table, x.family,
                      x.n, x.masses, x.ratio, x.column, x.value, here);
        wrong++;
    }
    fclose(f);
    subject_end(&t);
    print_message("%d entries, %d within a factor of 10\n", entries, met);
    assert_true(entries > FEW_ENTRIES);
    assert_true(10 * met > 8 * entries);
    assert_int_equal(wrong, 0);
}

#ifndef SANITIZERS /* long chains */
/* 8.5: where pivots stop being positive. */
static void breakdown_comes_where_the_design_says(void **state)
{
    (void)state;
    struct subject t = {0};
    struct entry x = {.family = "straight", .masses = "even", .n = 32768};
    subject_make(&t, &x);
    assert_true(isfinite(design_backward_error(&t.system, SOLVER_THOMAS, PART_CR, 1)));
    assert_true(isfinite(design_backward_error(&t.system, SOLVER_PARTITION, PART_CR, 8)));
    assert_false(isfinite(design_backward_error(&t.system, SOLVER_PCR_SYMMETRIC, PART_PCR, 8)));
    x.n = 8192;
    subject_make(&t, &x);
    const double pcr = design_backward_error(&t.system, SOLVER_PCR_SYMMETRIC, PART_PCR, 8);
    /* long before breakdown there is nothing right in the answer */
    assert_true(pcr > 1e-6 && isfinite(pcr));
    assert_true(design_backward_error(&t.system, SOLVER_PARTITION, PART_CR, 8) < 1e-14);
    subject_end(&t);
}
#endif

/* ... and where CRBA has nothing right any more. */
static void uneven_masses_break_crba_alone(void **state)
{
    (void)state;
    struct subject t = {0};
    struct entry x = {.n = 64, .ratio = 1e12};
    static const char *const family[] = {"twist", "sphere"}, *const masses[] = {"heavy-tip", "up",
                                                                                "even"};
    for (int k = 0; k < 6; k++) {
        snprintf(x.family, sizeof x.family, "%s", family[k / 3]);
        snprintf(x.masses, sizeof x.masses, "%s", masses[k % 3]);
        subject_make(&t, &x);
        const double error = error_of(&t, "crba");
        print_message("%s %s 64: CRBA %.1e\n", x.family, x.masses, error);
        if (k % 3 == 2) assert_true(error < 1e-6);
        else assert_true(!isfinite(error) || error > 1e-3);
        assert_true(error_of(&t, "direct-cr") < 1e-8);
    }
    subject_end(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_entry_is_met_or_explained),
#ifndef SANITIZERS
        cmocka_unit_test(breakdown_comes_where_the_design_says),
#endif
        cmocka_unit_test(uneven_masses_break_crba_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
