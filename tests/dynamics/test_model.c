/* test_model.c - models: impossible bodies refused by name and line, index tables, generated
 * scenes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "scene.h"

static struct body_def good_body(void)
{
    return (struct body_def){.name = "arm",
                             .parent = -1,
                             .joint = JOINT_REVOLUTE,
                             .axis = {0, 0, 1},
                             .mass = 2,
                             .inertia = {0.2, 0.01, 0, 0.3, 0, 0.35},
                             .line = 17};
}

/* The message with which a model of this one body is refused; "" when it is accepted. */
static void refusal(struct body_def b, bool allow, char *text, size_t size)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, "robot.urdf");
    bool good = model_add_body(m, &b, &e) >= 0 && model_finish(m, allow, &e);
    snprintf(text, size, "%s", good ? "" : e.text);
    assert_true(good || (e.kind == ERR_DATA && e.line == 17 && strcmp(e.file, "robot.urdf") == 0));
    arena_destroy(a);
}

#define assert_refused(change, words)                                                              \
    do {                                                                                           \
        struct body_def b = good_body();                                                           \
        char said[800];                                                                            \
        change;                                                                                    \
        refusal(b, false, said, sizeof said);                                                      \
        assert_non_null(strstr(said, words));                                                      \
        assert_non_null(strstr(said, "'arm'"));                                                    \
    } while (0)

static void impossible_bodies_are_refused_by_name_and_line(void **state)
{
    (void)state;
    char text[800];
    refusal(good_body(), false, text, sizeof text);
    assert_string_equal(text, "");
    assert_refused(b.mass = 0, "mass");
    assert_refused(b.mass = -1, "must be positive");
    assert_refused(b.mass = NAN, "not finite");
    assert_refused(b.com[1] = INFINITY, "not finite");
    assert_refused(b.inertia[3] = 0, "positive definite");
    assert_refused(b.inertia[1] = 0.4, "positive definite");
    assert_refused(b.inertia[5] = 0.6, "triangle");
    assert_refused(b.axis[2] = 0, "axis");
    assert_refused(b.axis[0] = NAN, "not finite");
    assert_refused(b.placement.p[2] = NAN, "placement");
    assert_refused(b.parent = 0, "parent");
    assert_refused((b.joint = JOINT_UNIVERSAL, b.axis2[2] = 1), "orthogonal");
    assert_refused((b.joint = JOINT_SPHERICAL, b.stiffness = 1), "springs");
}

static void nonphysical_bodies_pass_when_allowed_but_numbers_must_be_finite(void **state)
{
    (void)state;
    char text[800];
    struct body_def b = good_body();
    b.mass = 0, memset(b.inertia, 0, sizeof b.inertia);
    refusal(b, true, text, sizeof text);
    assert_string_equal(text, "");
    b.mass = NAN;
    refusal(b, true, text, sizeof text);
    assert_non_null(strstr(text, "not finite"));
}

static void a_thin_rod_as_written_to_six_digits_is_accepted(void **state)
{
    (void)state;
    char text[800];
    struct body_def b = good_body();
    memcpy(b.inertia, (double[6]){1e-12, 0, 0, 0.083333333, 0, 0.083333333}, sizeof b.inertia);
    refusal(b, false, text, sizeof text);
    assert_string_equal(text, "");
}

static void impossible_loops_are_refused(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct model *m = model_begin(a, NULL);
    struct body_def b = good_body();
    err_clear(&e);
    assert_int_equal(model_add_body(m, &b, &e), 0);
    const struct loop_def bad[] = {
        {.name = "far", .body_a = -1, .body_b = 1, .joint = JOINT_REVOLUTE},
        {.name = "same", .body_a = 0, .body_b = 0, .joint = JOINT_REVOLUTE},
        {.name = "free", .body_a = -1, .body_b = 0, .joint = JOINT_FLOATING},
        {.name = "rows", .body_a = -1, .body_b = 0, .nrow = 7},
        {.name = "zero", .body_a = -1, .body_b = 0, .nrow = 1},
        {.name = "damped", .body_a = -1, .body_b = 0, .joint = JOINT_REVOLUTE, .alpha = -1},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        err_clear(&e);
        assert_int_equal(model_add_loop(m, &bad[k], &e), -1);
        assert_non_null(strstr(e.text, bad[k].name));
    }
    arena_destroy(a);
}

static void an_empty_model_is_refused(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    assert_false(model_finish(model_begin(a, NULL), false, &e));
    arena_destroy(a);
}

static void children_and_coordinates_are_indexed(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 40, JOINT_MIXED, 9);
    struct scene s = scene_of(&spec);
    const struct model *m = s.model;
    int seen = 0;
    for (int i = 0; i < m->nbody; i++) {
        assert_int_equal(m->q_at[i + 1] - m->q_at[i], joint_nq(m->body[i].joint));
        assert_int_equal(m->u_at[i + 1] - m->u_at[i], joint_nu(m->body[i].joint));
        for (int k = m->child_at[i]; k < m->child_at[i + 1]; k++, seen++) {
            assert_int_equal(m->body[m->child[k]].parent, i);
            assert_true(k == m->child_at[i] || m->child[k] > m->child[k - 1]);
        }
    }
    assert_int_equal(seen, m->nbody - 1);
    assert_int_equal(m->q_at[m->nbody], m->nq);
    scene_end(&s);
}

/* Each generator's tree. */
static void generators_make_their_trees(void **state)
{
    (void)state;
    for (int k = MODEL_SERIAL_CHAIN; k <= MODEL_DENDRIMER; k++) {
        struct model_spec spec = spec_random((enum model_generator)k, 13, JOINT_REVOLUTE, 2);
        spec.branch = 3;
        struct scene s = scene_of(&spec);
        for (int i = 1; i < 13; i++) {
            int p = s.model->body[i].parent;
            if (k == MODEL_SERIAL_CHAIN) assert_int_equal(p, i - 1);
            if (k == MODEL_STAR) assert_int_equal(p, 0);
            if (k == MODEL_DENDRIMER) assert_int_equal(p, (i - 1) / 3);
            if (k == MODEL_COMB) assert_int_equal(p, i % 3 ? i - i % 3 : i - 3);
        }
        assert_int_equal(s.model->is_chain, k == MODEL_SERIAL_CHAIN);
        assert_true(s.model->has_phi);
        scene_end(&s);
    }
}

static void the_same_seed_gives_the_same_scene_and_another_a_different_one(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 10, JOINT_MIXED, 5);
    struct scene a = scene_of(&spec), b = scene_of(&spec);
    spec.seed = 6;
    spec.joint = JOINT_REVOLUTE;
    struct scene c = scene_of(&spec);
    assert_memory_equal(a.model->body, b.model->body, 10 * sizeof *a.model->body);
    assert_memory_equal(a.state->q, b.state->q, (size_t)a.model->nq * sizeof(double));
    assert_memory_equal(a.state->fext, b.state->fext, 60 * sizeof(double));
    assert_memory_not_equal(a.state->fext, c.state->fext, 60 * sizeof(double));
    scene_end(&a), scene_end(&b), scene_end(&c);
}

/* A polymer in molecular units and the same in SI have accelerations that differ by the unit of
 * time alone. */
static void molecular_units_are_a_change_of_units(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_POLYMER, 20, JOINT_REVOLUTE, 3);
    spec.pose = POSE_COILED;
    spec.rate = 1e12, spec.torque = 1e-20, spec.external_force = 1e-11;
    struct scene s = scene_of(&spec);
    const struct model *m = s.model;
    double *x = TAKE(s.a, m->nu, double), *y = TAKE(s.a, m->nu, double);
    struct err e;
    err_clear(&e);
    struct model *si = model_begin(s.a, NULL);
    double torque = m->kilogram * m->metre * m->metre / (m->second * m->second);
    for (int i = 0; i < m->nbody; i++) {
        struct body_def b = m->body[i];
        for (int k = 0; k < 3; k++) b.com[k] *= m->metre, b.placement.p[k] *= m->metre;
        for (int k = 0; k < 6; k++) b.inertia[k] *= m->kilogram * m->metre * m->metre;
        b.mass *= m->kilogram;
        assert_true(model_add_body(si, &b, &e) >= 0);
    }
    memcpy(si->gravity, spec.gravity, sizeof si->gravity);
    assert_true(model_finish(si, false, &e));
    struct state *big = state_take(si, s.a);
    double *fext = state_fext_need(big, si, s.a);
    memcpy(big->q, s.state->q, (size_t)m->nq * sizeof(double));
    for (int k = 0; k < m->nu; k++)
        big->qd[k] = s.state->qd[k] / m->second, big->tau[k] = s.state->tau[k] * torque;
    for (int k = 0; k < 6 * m->nbody; k++)
        fext[k] = s.state->fext[k] * (k % 6 < 3 ? torque / m->metre : torque);
    for (int method = FORWARD_ABA; method < FORWARD_METHODS; method++) {
        const struct dynamics_type *t = dynamics_type_of(PRECISION_DOUBLE);
        assert_true(t->forward(m, s.state, (enum forward_method)method, s.a, x, NULL, NULL, NULL));
        assert_true(t->forward(si, big, (enum forward_method)method, s.a, y, NULL, NULL, NULL));
        for (int k = 0; k < m->nu; k++) y[k] *= m->second * m->second;
        assert_true(relative_error(m->nu, y, x) < 1e-9);
    }
    scene_end(&s);
}

/* Springs pull back to the first pose and dampers take energy away. */
static void springs_and_dampers_act(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 4, JOINT_REVOLUTE, 3);
    spec.external_force = spec.torque = spec.rate = 0;
    memset(spec.gravity, 0, sizeof spec.gravity);
    spec.stiffness = 50;
    struct scene s = scene_of(&spec);
    const struct dynamics_type *t = dynamics_type_of(PRECISION_DOUBLE);
    struct dynamics_totals before, after;
    double x[4];
    assert_true(t->forward(s.model, s.state, FORWARD_ABA, s.a, x, NULL, NULL, NULL));
    for (int k = 0; k < 4; k++) assert_true(fabs(x[k]) == 0);
    s.state->q[2] += 0.1;
    assert_true(t->forward(s.model, s.state, FORWARD_ABA, s.a, x, NULL, NULL, NULL));
    assert_true(x[2] < 0);
    t->totals(s.model, s.state, s.a, &before);
    assert_true(fabs(before.potential - 0.5 * 50 * 0.01) < 1e-12);
    assert_true(t->advance(s.model, s.state, STEP_RK4, 1e-3, 300, s.a, NULL));
    t->totals(s.model, s.state, s.a, &after);
    assert_true(fabs(after.kinetic + after.potential - before.potential) < 1e-6);
    for (int i = 0; i < 4; i++) s.model->body[i].damping = 1;
    struct err e;
    err_clear(&e);
    assert_true(model_finish(s.model, false, &e));
    assert_true(t->advance(s.model, s.state, STEP_RK4, 1e-3, 300, s.a, NULL));
    t->totals(s.model, s.state, s.a, &after);
    assert_true(after.kinetic + after.potential < 0.8 * before.potential);
    scene_end(&s);
}

/* The same scene 2^-35 as long, 2^-90 as heavy and 2^-20 as fast is the same numbers in units of
 * its own. */
static void units_of_small_links_round_nothing(void **state)
{
    (void)state;
    struct model_spec usual = spec_random(MODEL_RANDOM_TREE, 12, JOINT_MIXED, 3), small = usual;
    usual.stiffness = small.stiffness = 0;
    const int metre = -35, kilogram = -90, second = -20;
    small.length = ldexp(usual.length, metre), small.radius = ldexp(usual.radius, metre);
    small.mass = ldexp(usual.mass, kilogram);
    small.rate = ldexp(usual.rate, -second);
    small.torque = ldexp(usual.torque, kilogram + 2 * metre - 2 * second);
    small.external_force = ldexp(usual.external_force, kilogram + metre - 2 * second);
    for (int k = 0; k < 3; k++) small.gravity[k] = ldexp(usual.gravity[k], metre - 2 * second);
    struct scene a = scene_of(&usual), b = scene_of(&small);
    assert_true(b.model->metre == ldexp(1, metre) && b.model->kilogram == ldexp(1, kilogram) &&
                b.model->second == ldexp(1, second));
    for (int i = 0; i < a.model->nbody; i++) {
        const struct body_def *x = &a.model->body[i], *y = &b.model->body[i];
        assert_true(x->mass == y->mass);
        assert_memory_equal(x->inertia, y->inertia, sizeof x->inertia);
        assert_memory_equal(x->com, y->com, sizeof x->com);
        assert_memory_equal(&x->placement, &y->placement, sizeof x->placement);
    }
    assert_memory_equal(a.model->gravity, b.model->gravity, sizeof a.model->gravity);
    assert_memory_equal(a.state->q, b.state->q, (size_t)a.model->nq * sizeof(double));
    assert_memory_equal(a.state->qd, b.state->qd, (size_t)a.model->nu * sizeof(double));
    assert_memory_equal(a.state->tau, b.state->tau, (size_t)a.model->nu * sizeof(double));
    assert_memory_equal(a.state->fext, b.state->fext,
                        (size_t)(6 * a.model->nbody) * sizeof(double));
    scene_end(&a);
    scene_end(&b);
}

/* Molecules in SI units are beyond single precision (inertias of 1e-47); in their own they are
 * not. */
static void single_precision_reaches_molecules_and_denormals(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 16, JOINT_REVOLUTE, 3);
    spec.length = 1.5e-10, spec.radius = 1e-11, spec.mass = 2.3e-26, spec.torque = 1e-21,
    spec.external_force = 0;
    for (int k = 0; k < 2; k++) {
        struct scene s = scene_of(&spec);
        double single[16], right[16];
        assert_true(
            dynamics_type_of(PRECISION_FLOAT)
                ->forward(s.model, s.state, FORWARD_CFA_DIRECT, s.a, single, NULL, NULL, NULL));
        assert_true(dynamics_type_of(PRECISION_QUAD)
                        ->forward(s.model, s.state, FORWARD_ABA, s.a, right, NULL, NULL, NULL));
        assert_true(relative_error(16, single, right) < 1e-3);
        scene_end(&s);
        spec.length = 1, spec.radius = 0.05, spec.mass = spec.torque = 1e-308;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impossible_bodies_are_refused_by_name_and_line),
        cmocka_unit_test(nonphysical_bodies_pass_when_allowed_but_numbers_must_be_finite),
        cmocka_unit_test(a_thin_rod_as_written_to_six_digits_is_accepted),
        cmocka_unit_test(impossible_loops_are_refused),
        cmocka_unit_test(an_empty_model_is_refused),
        cmocka_unit_test(children_and_coordinates_are_indexed),
        cmocka_unit_test(generators_make_their_trees),
        cmocka_unit_test(the_same_seed_gives_the_same_scene_and_another_a_different_one),
        cmocka_unit_test(molecular_units_are_a_change_of_units),
        cmocka_unit_test(units_of_small_links_round_nothing),
        cmocka_unit_test(single_precision_reaches_molecules_and_denormals),
        cmocka_unit_test(springs_and_dampers_act),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
