/* test_planar.c - planar scenes are found and only they; serial dynamics in three components equal
 * those in six. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "../support/planar_models.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/planar.h"
#include "dynamics/planar_dynamics.h"
#include "dynamics/system.h"

static double relative_error(int n, const double *x, const double *reference)
{
    double error = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        if (!(fabs(x[i] - reference[i]) <= error)) error = fabs(x[i] - reference[i]);
        scale = fmax(scale, fabs(reference[i]));
    }
    return scale > 0 ? error / scale : error;
}

static void serial_codes_agree_with_the_spatial_ones(void **state)
{
    (void)state;
    static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_PLANAR,
                                              JOINT_MIXED};
    double tau_error = 0, qdd_error = 0;
    for (int n = 1; n <= 40; n += n < 8 ? 1 : 8)
        for (int k = 0; k < 16; k++) {
            struct arena *a = arena_create();
            const struct planar_options o = {.n = n,
                                             .tree = k & 4,
                                             .joint = joints[k % 4],
                                             .springs = k & 8,
                                             .loads = n > 2 && k % 4 != 1,
                                             .seed = (uint64_t)(k + 50 * n)};
            const struct model *m = planar_model(&o, a);
            const struct state *s = planar_state(&o, m, a);
            double *x = TAKE(a, m->nu + 1, double), *y = TAKE(a, m->nu + 1, double);
            struct work w = {0}, spatial = {0};
            planar_inverse(m, s, a, x, &w);
            dynamics_type_of(PRECISION_DOUBLE)->inverse(m, s, a, y, &spatial);
            tau_error = fmax(tau_error, relative_error(m->nu, x, y));
            assert_true(planar_forward(m, s, a, x, &w));
            assert_true(dynamics_type_of(PRECISION_DOUBLE)
                            ->forward(m, s, FORWARD_ABA, a, y, NULL, NULL, &spatial));
            qdd_error = fmax(qdd_error, relative_error(m->nu, x, y));
            assert_true(w.flop < spatial.flop / 3 || n < 4);
            arena_destroy(a);
        }
    print_message("largest errors: tau %.1e, qdd %.1e\n", tau_error, qdd_error);
    assert_true(tau_error < 1e-12 && qdd_error < 1e-10);
}

/* Where the loops' constraints are independent of each other. */
static void closed_chains_agree_too(void **state)
{
    (void)state;
    double error = 0;
    int compared = 0;
    for (int k = 0; k < 48; k++) {
        struct arena *a = arena_create();
        const struct planar_options o = {.n = 9,
                                         .tree = k & 1,
                                         .joint = JOINT_MIXED,
                                         .springs = k & 2,
                                         .loads = k & 4,
                                         .twins = k & 8,
                                         .loops = 1 + k % 3,
                                         .seed = (uint64_t)(k + 1)};
        const struct model *m = planar_model(&o, a);
        const struct state *s = planar_state(&o, m, a);
        double *x = TAKE(a, m->nu, double), *y = TAKE(a, m->nu, double);
        struct work w = {0};
        struct forward_report report = {0};
        assert_true(planar_forward(m, s, a, x, &w));
        assert_true(dynamics_type_of(PRECISION_DOUBLE)
                        ->forward(m, s, FORWARD_ABA, a, y, NULL, &report, &w));
        if (report.rank == 2 * (o.twins ? (o.loops + 1) / 2 : o.loops)) {
            error = fmax(error, relative_error(m->nu, x, y));
            compared++;
        }
        arena_destroy(a);
    }
    print_message("%d scenes, largest error %.1e\n", compared, error);
    assert_true(compared > 20 && error < 1e-9);
}

/* The loop joins the base and a body without mass, whose child has some: there is nothing to scale
 * its equation by. */
static void a_loop_on_a_massless_body_has_an_answer(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e = {0};
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < 3; i++) {
        struct body_def def = {.parent = i - 1, .joint = JOINT_REVOLUTE, .mass = i == 1 ? 0 : 1};
        snprintf(def.name, sizeof def.name, "b%d", i);
        def.axis[2] = 1;
        def.placement.p[0] = i > 0;
        def.placement.quat[3] = 1;
        def.com[0] = i == 1 ? 0 : 0.5;
        for (int k = 0; k < 6; k++)
            def.inertia[k] = i != 1 && (k == 0 || k == 3 || k == 5) ? 0.1 : 0;
        assert_true(model_add_body(m, &def, &e) >= 0);
    }
    struct loop_def def = {.name = "closure", .body_a = -1, .body_b = 1, .joint = JOINT_REVOLUTE};
    def.frame_a.quat[3] = def.frame_b.quat[3] = 1;
    def.frame_a.p[0] = 1.5;
    def.frame_b.p[0] = 0.5;
    m->gravity[1] = -9.81;
    if (model_add_loop(m, &def, &e) < 0 || !model_finish(m, true, &e)) fail_msg("%s", e.text);
    const struct planar_options o = {.n = 3, .joint = JOINT_REVOLUTE, .seed = 1};
    struct state *s = planar_state(&o, m, a);
    memset(s->q, 0, (size_t)m->nq * sizeof *s->q);
    double *x = TAKE(a, m->nu, double), *y = TAKE(a, m->nu, double);
    struct work w = {0};
    struct forward_report report = {0};
    assert_true(planar_forward(m, s, a, x, &w));
    assert_true(
        dynamics_type_of(PRECISION_DOUBLE)->forward(m, s, FORWARD_ABA, a, y, NULL, &report, &w));
    for (int i = 0; i < m->nu; i++) assert_true(isfinite(x[i]));
    assert_true(relative_error(m->nu, x, y) < 1e-9);
    arena_destroy(a);
}

/* Operations of one body more in a chain of revolute joints, as counted by hand in
 * planar_dynamics.c. */
static void each_body_costs_what_was_counted(void **state)
{
    (void)state;
    struct work w[2][2] = {{{0}}};
    for (int k = 0; k < 2; k++) {
        struct arena *a = arena_create();
        const struct planar_options o = {.n = 10 + k, .joint = JOINT_REVOLUTE, .seed = 1};
        const struct model *m = planar_model(&o, a);
        const struct state *s = planar_state(&o, m, a);
        double *x = TAKE(a, m->nu, double);
        planar_inverse(m, s, a, x, &w[0][k]);
        assert_true(planar_forward(m, s, a, x, &w[1][k]));
        arena_destroy(a);
    }
    assert_int_equal(w[0][1].flop - w[0][0].flop, 6 + 10 + 10 + 2 + 1 + 14 + 3 + 13);
    assert_int_equal(w[1][1].flop - w[1][0].flop, 6 + 10 + 3 + 21 + 25 + 13 + 12 + 8);
    assert_int_equal(w[1][1].div - w[1][0].div, 1);
    assert_int_equal(w[0][1].trig - w[0][0].trig, 2);
}

static bool planar(const struct planar_options *o, enum precision precision, char *why)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct model *m = planar_model(o, a);
    const bool found = planar_scene(m, planar_state(o, m, a), precision, &e);
    strcpy(why, found ? "" : e.text);
    arena_destroy(a);
    return found;
}

static void planar_scenes_are_found(void **state)
{
    (void)state;
    char why[sizeof(struct err)];
    for (int k = 0; k < 64; k++) {
        struct planar_options o = {
            .n = 3 + k, .tree = k & 1, .joint = JOINT_MIXED, .loads = true, .loops = k & 3,
            .seed = (uint64_t)k};
        if (!planar(&o, PRECISION_DOUBLE, why)) fail_msg("seed %d: %s", k, why);
        /* doubles describe a plane anyhow in space to their own rounding only */
        assert_false(planar(&o, PRECISION_QUAD, why));
    }
}

static void a_tilted_axis_leaves_the_plane(void **state)
{
    (void)state;
    char why[sizeof(struct err)];
    for (int k = 0; k < 3; k++) {
        static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_PLANAR};
        struct planar_options o = {.n = 6, .joint = joints[k], .tilt = 1e-6, .seed = 3};
        assert_false(planar(&o, PRECISION_FLOAT, why));
        assert_non_null(strstr(why, "'b5'"));
        assert_non_null(strstr(why, joint_name(joints[k])));
    }
}

/* A chain as the generators make it. */
static struct model_spec generated(enum model_generator generator, enum model_axes axes,
                                   enum model_base base)
{
    return (struct model_spec){.generator = generator,
                               .nbody = 9,
                               .joint = JOINT_REVOLUTE,
                               .axes = axes,
                               .base = base,
                               .inertia = INERTIA_RANDOM,
                               .pose = POSE_RANDOM,
                               .length = 1,
                               .radius = 0.05,
                               .mass = 1,
                               .mass_ratio = 4,
                               .branch = 2,
                               .base_acceleration = {0, 0, 1, 1, 1, 1},
                               .seed = 5};
}

static bool generated_is_planar(const struct model_spec *spec, enum precision precision)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct model *m = model_build(spec, a, &e);
    const bool found = planar_scene(m, state_make(m, spec, a), precision, &e);
    arena_destroy(a);
    return found;
}

static void of_generated_scenes_the_parallel_ones(void **state)
{
    (void)state;
    struct model_spec spec = generated(MODEL_SERIAL_CHAIN, AXES_PARALLEL, BASE_FIXED);
    assert_true(generated_is_planar(&spec, PRECISION_QUAD));
    spec.base = BASE_MOVING;
    assert_true(generated_is_planar(&spec, PRECISION_QUAD));
    spec.base_acceleration[0] = 1e-6; /* bodies off the base's plane would feel it */
    assert_false(generated_is_planar(&spec, PRECISION_DOUBLE));
    spec = generated(MODEL_SERIAL_CHAIN, AXES_PARALLEL, BASE_FLOATING);
    assert_false(generated_is_planar(&spec, PRECISION_DOUBLE));
    spec = generated(MODEL_SERIAL_CHAIN, AXES_TWISTED, BASE_FIXED);
    assert_false(generated_is_planar(&spec, PRECISION_DOUBLE));
    spec = generated(MODEL_DENDRIMER, AXES_PARALLEL, BASE_FIXED);
    assert_true(generated_is_planar(&spec, PRECISION_DOUBLE));
    spec = generated(MODEL_FOUR_BAR, AXES_PARALLEL, BASE_FIXED);
    spec.nbody = 3;
    assert_true(generated_is_planar(&spec, PRECISION_DOUBLE));
    spec = generated(MODEL_SERIAL_CHAIN, AXES_PARALLEL, BASE_FIXED);
    spec.joint = JOINT_SPHERICAL;
    assert_false(generated_is_planar(&spec, PRECISION_DOUBLE));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(serial_codes_agree_with_the_spatial_ones),
        cmocka_unit_test(closed_chains_agree_too),
        cmocka_unit_test(a_loop_on_a_massless_body_has_an_answer),
        cmocka_unit_test(each_body_costs_what_was_counted),
        cmocka_unit_test(planar_scenes_are_found),
        cmocka_unit_test(a_tilted_axis_leaves_the_plane),
        cmocka_unit_test(of_generated_scenes_the_parallel_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
