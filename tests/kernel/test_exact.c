/* test_exact.c - refinement with forces in twice the working precision, where working precision has
 * none left. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/system.h"
#include "evaluation.h"

/* Of the accelerations, against articulated bodies in quad precision. */
static double error_of(const struct run_spec *spec)
{
    struct arena *a = arena_create();
    struct err e = {0};
    const struct model *m = model_build(&spec->model, a, &e);
    assert_non_null(m);
    const struct state *s = state_make(m, &spec->model, a);
    const struct evaluation v = evaluate_model(spec, m, s, a);
    double *qdd = TAKE(a, m->nu, double), error = 0, scale = 0;
    struct work w = {0};
    assert_true(
        dynamics_type_of(PRECISION_QUAD)->forward(m, s, FORWARD_ABA, a, qdd, NULL, NULL, &w));
    for (int i = 0; i < m->nu; i++) {
        if (!(fabs(v.qdd[i] - qdd[i]) <= error)) error = fabs(v.qdd[i] - qdd[i]);
        scale = fmax(scale, fabs(qdd[i]));
    }
    arena_destroy(a);
    return error / scale;
}

/* light: masses of 1e-6 to 1e6 in random order on every kind of joint. */
static struct run_spec light(int n, int P, enum model_joint joint, enum solver solver)
{
    struct run_spec s = evaluation_spec("forward", n, P);
    s.model.mass_ratio = 1e12;
    s.model.joint = joint;
    s.model.pose = POSE_COILED;
    s.kernel.solver = solver;
    s.kernel.part_solver = PART_CR;
    s.kernel.residual = RESIDUAL_TWICE;
    s.kernel.inner_refinements = 8;
    return s;
}

static void every_solver_gets_all_digits(void **state)
{
    (void)state;
    static const int joints[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_UNIVERSAL, JOINT_MIXED};
    double worst = 0, working = 0;
    for (int j = 0; j < 4; j++)
        for (int solver = 0; solver <= SOLVER_THOMAS; solver++)
            for (int P = 3; P <= 33; P += 15) {
                if (solver == SOLVER_PCR) continue; /* keeps no factors */
                struct run_spec s = light(33, P, joints[j], solver);
                if (P == 18) s.model.base = BASE_FLOATING, s.kernel.operators = OPERATORS_DENSE;
                s.model.external_force = P == 3 ? 1 : 0;
                const double error = error_of(&s);
                if (!(error < 1e-12))
                    fail_msg("joint %d solver %d P %d: %.2e", joints[j], solver, P, error);
                worst = fmax(worst, error);
                s.kernel.residual = RESIDUAL_WORKING;
                s.kernel.inner_refinements = 1;
                working = fmax(working, error_of(&s));
            }
    print_message("largest error %.1e, in working precision %.1e\n", worst, working);
    assert_true(working > 1e-8); /* or nothing was shown */
}

static void float_and_planes_too(void **state)
{
    (void)state;
    for (int P = 4; P <= 16; P += 4) {
        struct run_spec s = light(16, P, JOINT_REVOLUTE, SOLVER_CR);
        s.model.mass_ratio = 1e3;
        s.kernel.precision = PRECISION_FLOAT;
        s.kernel.inner_refinements = 12;
        assert_true(error_of(&s) < 1e-4);
        s = light(16, P, JOINT_REVOLUTE, SOLVER_CR);
        s.model.axes = AXES_PARALLEL;
        s.model.inertia = INERTIA_UNIFORM;
        memcpy(s.model.gravity, (double[3]){0, -9.81, 0}, sizeof s.model.gravity);
        s.kernel.algebra = ALGEBRA_PLANAR;
        s.kernel.outer_refinements = 1;
        assert_true(error_of(&s) < 1e-11);
    }
}

static void it_is_refused_where_it_does_not_exist(void **state)
{
    (void)state;
    const struct kernel_type *kernel = kernel_find("forward");
    struct arena *a = arena_create();
    for (int k = 0; k < 3; k++) {
        struct run_spec s = light(9, 3, JOINT_REVOLUTE, SOLVER_CR);
        struct err e = {0};
        if (k == 0) s.kernel.formulation = FORMULATION_PAPER;
        if (k == 1) s.model.generator = MODEL_COMB;
        const struct model *m = model_build(&s.model, a, &e);
        assert_non_null(m);
        assert_true(kernel->accepts(&(struct kernel_job){.spec = &s, .model = m}, &e) == (k == 2));
        if (k < 2) assert_non_null(strstr(e.text, "residual: twice"));
    }
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_solver_gets_all_digits),
        cmocka_unit_test(float_and_planes_too),
        cmocka_unit_test(it_is_refused_where_it_does_not_exist),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
