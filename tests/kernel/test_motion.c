/* test_motion.c - time steps taken in parallel against the GNU Scientific Library's steppers, and their orders. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "evaluation.h"
#include "mech/trajectory.h"

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
                fail_msg("rule %d joint %d: %.2e, then %.2e", rules[k].rule, joints[j], coarse, fine);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_rule_has_its_order),
        cmocka_unit_test(small_steps_follow_the_reference),
        cmocka_unit_test(springs_and_closed_chains_move_too),
        cmocka_unit_test(the_number_of_ranks_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
