/* test_motion.c - time steps taken in parallel against the GNU Scientific Library's steppers, and
 * their orders. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/system.h"
#include "dynamics/trajectory.h"
#include "evaluation.h"
#include "kernel/motion.h"

/* distance: largest difference of the end state from a tight reference. */
static double distance(const struct run_spec *spec)
{
    struct arena *a = arena_create();
    struct err e = {0};
    struct model *m = model_build(&spec->model, a, &e);
    assert_non_null(m);
    struct state *s = state_make(m, &spec->model, a);
    const struct evaluation v = evaluate_model(spec, m, s, a);
    const struct trajectory_options options = {.stepper = "rk8pd", .tolerance = 1e-12};
    struct trajectory_report report;
    const double duration = spec->kernel.steps * spec->kernel.step_size / m->second;
    if (!trajectory_advance(m, s, duration, &options, a, &report, &e)) fail_msg("%s", e.text);
    double worst = 0;
    for (int i = 0; i < m->nq; i++) worst = fmax(worst, fabs(v.q_end[i] - s->q[i]));
    for (int i = 0; i < m->nu; i++) worst = fmax(worst, fabs(v.qd_end[i] - s->qd[i]));
    arena_destroy(a);
    return worst;
}

static struct run_spec moving(enum model_generator generator, enum model_joint joint, int n, int P)
{
    struct run_spec s = evaluation_spec("forward", n, P);
    s.kernel.solver = SOLVER_PARTITION;
    s.model.generator = generator;
    s.model.joint = joint;
    s.model.rate = 0.3;
    s.model.torque = 0.3;
    return s;
}

static void every_rule_has_its_order(void **state)
{
    (void)state;
    static const struct {
        enum step_rule rule;
        double ratio;
    } rules[] = {{STEP_SEMI_IMPLICIT, 2}, {STEP_KDK, 4}, {STEP_RK4, 16}};
    static const int joints[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_UNIVERSAL, JOINT_MIXED};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 4; j++) {
            struct run_spec s = moving(MODEL_SERIAL_CHAIN, joints[j], 5, 3);
            if (joints[j] == JOINT_MIXED) s.model.base = BASE_FLOATING;
            s.kernel.step = rules[k].rule;
            s.kernel.steps = 20;
            s.kernel.step_size = 0.1 / s.kernel.steps;
            const double coarse = distance(&s);
            s.kernel.steps *= 2;
            s.kernel.step_size /= 2;
            const double fine = distance(&s);
            if (!(coarse / fine > 0.7 * rules[k].ratio || fine < 1e-11))
                fail_msg("rule %d joint %d: %.2e, then %.2e", rules[k].rule, joints[j], coarse,
                         fine);
        }
}

static void small_steps_follow_the_reference(void **state)
{
    (void)state;
    static const int generators[] = {MODEL_SERIAL_CHAIN, MODEL_COMB, MODEL_RANDOM_TREE};
    for (int g = 0; g < 3; g++)
        for (int P = 1; P <= 7; P += 3) {
            struct run_spec s = moving(generators[g], JOINT_REVOLUTE, 7, P);
            s.kernel.step = STEP_RK4;
            s.kernel.steps = 50;
            s.kernel.step_size = 1e-3;
            assert_true(distance(&s) < 1e-7);
        }
}

static void springs_and_closed_chains_move_too(void **state)
{
    (void)state;
    struct run_spec s = moving(MODEL_SERIAL_CHAIN, JOINT_REVOLUTE, 6, 4);
    s.model.stiffness = 2;
    s.model.damping = 0.1;
    s.kernel.step = STEP_RK4;
    s.kernel.steps = 40;
    s.kernel.step_size = 1e-3;
    assert_true(distance(&s) < 1e-8);
    s = moving(MODEL_FOUR_BAR, JOINT_REVOLUTE, 3, 3);
    s.kernel.step = STEP_RK4;
    s.kernel.steps = 40;
    s.kernel.step_size = 1e-3;
    assert_true(distance(&s) < 1e-8);
}

static void the_number_of_ranks_does_not_matter(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec s = moving(MODEL_SERIAL_CHAIN, JOINT_MIXED, 12, 1);
    s.kernel.steps = 10;
    s.kernel.step_size = 1e-3;
    const struct evaluation one = evaluate(&s, a);
    for (int P = 2; P <= 12; P++) {
        s.nrank = P;
        const struct evaluation v = evaluate(&s, a);
        for (int i = 0; i < 12; i++) assert_true(fabs(v.qd_end[i] - one.qd_end[i]) < 1e-9);
    }
    arena_destroy(a);
}

/* stiff: springs whose explicit limit is far below the step; chains of every sort and trees. */
static struct run_spec stiff(enum model_generator generator, enum model_joint joint, int n, int P,
                             double stiffness)
{
    struct run_spec s = moving(generator, joint, n, P);
    s.model.stiffness = stiffness;
    s.model.damping = 1e-2 * stiffness;
    s.kernel.step = STEP_LINEARLY_IMPLICIT;
    s.kernel.steps = 5;
    s.kernel.step_size = 1e-2;
    return s;
}

/* off_serial: largest difference of the end from the serial integrator's, relative to the largest
 * rate. */
static double off_serial(const struct run_spec *spec)
{
    struct arena *a = arena_create();
    struct err e = {0};
    struct model *m = model_build(&spec->model, a, &e);
    assert_non_null(m);
    struct state *s = state_make(m, &spec->model, a);
    for (int i = 0; i < m->nbody; i++)
        if (m->body[i].stiffness > 0) s->q[m->q_at[i]] += 0.1 * (i % 3 - 1);
    const struct evaluation v = evaluate_model(spec, m, s, a);
    const struct dynamics_type *t = dynamics_type_of(PRECISION_DOUBLE);
    assert_true(t->advance(m, s, spec->kernel.step, spec->kernel.step_size / m->second,
                           spec->kernel.steps, a, NULL));
    double worst = 0, scale = 1;
    for (int i = 0; i < m->nu; i++) scale = fmax(scale, fabs(s->qd[i]));
    for (int i = 0; i < m->nq; i++) worst = fmax(worst, fabs(v.q_end[i] - s->q[i]));
    for (int i = 0; i < m->nu; i++) worst = fmax(worst, fabs(v.qd_end[i] - s->qd[i]) / scale);
    assert_true(v.residual < 1e-6);
    arena_destroy(a);
    return worst;
}

static void implicit_springs_are_those_of_the_serial_integrator(void **state)
{
    (void)state;
    static const int joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_MIXED};
    for (int j = 0; j < 3; j++)
        for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
            for (int P = 1; P <= 9; P += 4)
                for (int k = 2; k <= 8; k += 3) {
                    /* nothing refines it: all digits may go */
                    if (solver == SOLVER_PCR && k == 8) continue;
                    struct run_spec s = stiff(MODEL_SERIAL_CHAIN, joints[j], 9, P, pow(10, k));
                    s.kernel.solver = solver;
                    s.kernel.inner_refinements = solver != SOLVER_PCR;
                    s.kernel.outer_refinements = solver == SOLVER_CR;
                    s.kernel.operators = P == 5 ? OPERATORS_DENSE : OPERATORS_STRUCTURED;
                    if (P == 9) s.model.base = BASE_FLOATING;
                    const double off = off_serial(&s);
                    if (!(off < (solver == SOLVER_PCR ? 1e-6 : 1e-9)))
                        fail_msg("joint %d solver %d P %d k 1e%d: %.2e", j, solver, P, k, off);
                }
}

static void implicit_springs_in_a_plane(void **state)
{
    (void)state;
    static const int generators[] = {MODEL_SERIAL_CHAIN, MODEL_COMB};
    for (int g = 0; g < 2; g++)
        for (int P = 1; P <= 9; P += 4) {
            struct run_spec s = stiff(generators[g], JOINT_REVOLUTE, 9, P, 1e7);
            s.model.axes = AXES_PARALLEL;
            s.model.inertia = INERTIA_UNIFORM;
            s.model.pose = POSE_STRAIGHT;
            memcpy(s.model.gravity, (double[3]){0, -9.81, 0}, sizeof s.model.gravity);
            s.kernel.algebra = ALGEBRA_PLANAR;
            s.kernel.outer_refinements = 1;
            assert_true(off_serial(&s) < 1e-9);
        }
}

static void implicit_springs_of_trees_too(void **state)
{
    (void)state;
    static const int generators[] = {MODEL_COMB, MODEL_STAR, MODEL_DENDRIMER, MODEL_RANDOM_TREE};
    for (int g = 0; g < 4; g++)
        for (int P = 1; P <= 13; P += 4) {
            struct run_spec s =
                stiff(generators[g], P < 9 ? JOINT_REVOLUTE : JOINT_MIXED, 13, P, 1e6);
            s.kernel.outer_refinements = P == 5;
            const double off = off_serial(&s);
            if (!(off < 1e-9)) fail_msg("tree %d P %d: %.2e", g, P, off);
        }
}

static void implicit_steps_are_refused_where_they_do_not_exist(void **state)
{
    (void)state;
    const struct kernel_type *kernel = kernel_find("forward");
    struct arena *a = arena_create();
    for (int k = 0; k < 3; k++) {
        struct run_spec s = stiff(k == 0   ? MODEL_SERIAL_CHAIN
                                  : k == 1 ? MODEL_RING
                                           : MODEL_COMB, JOINT_REVOLUTE, 9, 3, 1);
        struct err e = {0};
        if (k == 0) s.kernel.formulation = FORMULATION_PAPER;
        s.kernel.inner_refinements = k == 2;
        const struct model *m = model_build(&s.model, a, &e);
        assert_non_null(m);
        assert_false(kernel->accepts(&(struct kernel_job){.spec = &s, .model = m}, &e));
        assert_int_equal(e.kind, ERR_CONFIG);
        assert_non_null(strstr(e.text, "linearly implicit"));
    }
    arena_destroy(a);
}

/* The worst of all evaluations is what a run hears of, also when it is no number, and small terms
 * have no say. */
static void the_worst_evaluation_is_kept(void **state)
{
    (void)state;
    struct motion_seen seen = {0};
    motion_watch(&seen, 1e-9, 4, 10);
    assert_true(seen.residual == 1e-9 && seen.scale == 4 && seen.condition == 10);
    motion_watch(&seen, 1e-6, 2, 5);
    assert_true(fabs(seen.residual / 5e-7 - 1) < 1e-12 && seen.scale == 4 && seen.condition == 10);
    motion_watch(&seen, 1, 1e-12, 20); /* nothing but rounding beside the others */
    assert_true(fabs(seen.residual / 5e-7 - 1) < 1e-12 && seen.condition == 20);
    motion_watch(&seen, NAN, 4, 1);
    motion_watch(&seen, 1e-12, 4, 1);
    assert_true(isnan(seen.residual));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_rule_has_its_order),
        cmocka_unit_test(small_steps_follow_the_reference),
        cmocka_unit_test(springs_and_closed_chains_move_too),
        cmocka_unit_test(the_number_of_ranks_does_not_matter),
        cmocka_unit_test(implicit_springs_are_those_of_the_serial_integrator),
        cmocka_unit_test(implicit_springs_of_trees_too),
        cmocka_unit_test(implicit_springs_in_a_plane),
        cmocka_unit_test(implicit_steps_are_refused_where_they_do_not_exist),
        cmocka_unit_test(the_worst_evaluation_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
