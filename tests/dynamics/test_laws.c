/* test_laws.c - laws between the serial algorithms on seeded systems: every joint type, chains,
 * trees, every base. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "dynamics/dynamics_table.h"
#include "scene.h"

static const struct dynamics_type *exact(void) { return dynamics_type_of(PRECISION_DOUBLE); }

/* Run `law` on chains and trees of every joint type and of several sizes, on fixed, moving and
 * floating bases. */
static void on_all_systems(void (*law)(struct scene *))
{
    static const int size[] = {1, 2, 3, 7, 16, 31};
    static const enum model_generator kind[] = {MODEL_SERIAL_CHAIN, MODEL_COMB, MODEL_STAR,
                                                MODEL_RANDOM_TREE, MODEL_DENDRIMER};
    for (int joint = JOINT_FIXED; joint <= JOINT_MIXED; joint++)
        for (int k = 0; k < 30; k++) {
            struct model_spec spec =
                spec_random(kind[k % 5], size[k % 6], (enum model_joint)joint, (uint64_t)k + 1);
            spec.base = (enum model_base)(k % 3);
            if (joint == JOINT_FIXED && spec.base != BASE_FLOATING) continue;
            for (int i = 0; i < 6; i++) spec.base_acceleration[i] = 0.3 * (i - 2);
            struct scene s = scene_of(&spec);
            if (s.model->nu > 0) law(&s);
            scene_end(&s);
        }
}

static void articulated_bodies_undo_newton_euler(struct scene *s)
{
    double *tau = TAKE(s->a, s->model->nu, double), *back = TAKE(s->a, s->model->nu, double);
    exact()->forward(s->model, s->state, FORWARD_ABA, s->a, s->state->qdd, NULL, NULL, NULL);
    exact()->inverse(s->model, s->state, s->a, tau, NULL);
    assert_true(relative_error(s->model->nu, tau, s->state->tau) < 1e-9);
    memcpy(s->state->tau, tau, (size_t)s->model->nu * sizeof *tau);
    assert_true(exact()->forward(s->model, s->state, FORWARD_ABA, s->a, back, NULL, NULL, NULL));
    assert_true(relative_error(s->model->nu, back, s->state->qdd) < 1e-9);
}

static void aba_undoes_rnea(void **state)
{
    (void)state;
    on_all_systems(articulated_bodies_undo_newton_euler);
}

static void methods_agree(struct scene *s)
{
    static const double tolerance[FORWARD_METHODS] = {1e-11, 1e-8, 1e-8, 1e-8, 1e-10, 1e-12};
    int n = s->model->nu;
    double *reference = TAKE(s->a, n, double), *x = TAKE(s->a, n, double);
    assert_true(dynamics_type_of(PRECISION_QUAD)
                    ->forward(s->model, s->state, FORWARD_ABA, s->a, reference, NULL, NULL, NULL));
    for (int k = 0; k < FORWARD_METHODS; k++) {
        struct forward_report report;
        assert_true(exact()->forward(s->model, s->state, (enum forward_method)k, s->a, x, NULL,
                                     &report, NULL));
        assert_true(relative_error(n, x, reference) < tolerance[k]);
        assert_false(report.fell_back);
    }
}

static void all_forward_methods_agree_with_quad_precision(void **state)
{
    (void)state;
    on_all_systems(methods_agree);
}

/* M u' = RNEA(u') - RNEA(0), column by column; symmetric; positive definite. */
static void mass_matrix_is_inverse_dynamics(struct scene *s)
{
    int n = s->model->nu;
    double *mass = TAKE(s->a, n * n, double), *zero = TAKE(s->a, n, double),
           *column = TAKE(s->a, n, double);
    exact()->mass_matrix(s->model, s->state, s->a, mass, NULL);
    memset(s->state->qdd, 0, (size_t)n * sizeof *zero);
    exact()->inverse(s->model, s->state, s->a, zero, NULL);
    double scale = 0, worst = 0, kinetic = 0;
    for (int j = 0; j < n; j++) {
        s->state->qdd[j] = 1;
        exact()->inverse(s->model, s->state, s->a, column, NULL);
        s->state->qdd[j] = 0;
        for (int i = 0; i < n; i++) {
            worst = fmax(worst, fabs(column[i] - zero[i] - mass[i * n + j]));
            scale = fmax(scale, fmax(fabs(mass[i * n + j]), fabs(zero[i])));
            kinetic += 0.5 * s->state->qd[i] * mass[i * n + j] * s->state->qd[j];
            assert_true(mass[i * n + j] == mass[j * n + i]);
        }
        assert_true(mass[j * n + j] > 0);
    }
    assert_true(worst <= 1e-12 * scale);
    struct dynamics_totals t;
    exact()->totals(s->model, s->state, s->a, &t);
    assert_true(fabs(kinetic - t.kinetic) <= 1e-11 * t.kinetic);
}

static void crba_is_rnea_by_columns_and_half_u_m_u_is_the_energy(void **state)
{
    (void)state;
    on_all_systems(mass_matrix_is_inverse_dynamics);
}

/* The fast path of all-revolute systems and the general code. */
static void fast_paths_equal_the_general_code(void **state)
{
    (void)state;
    for (int n = 1; n < 60; n += 7) {
        struct model_spec spec =
            spec_random(n % 2 ? MODEL_RANDOM_TREE : MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 5);
        struct scene s = scene_of(&spec);
        struct dynamics *d = dynamics_take(s.model, s.a);
        double *x = TAKE(s.a, n, double), *y = TAKE(s.a, n, double);
        dynamics_load(d, s.state);
        assert_non_null(d->revolute);
        rnea(d, s.state->q, s.state->qd, s.state->qdd, x, NULL);
        rnea_full(d, s.state->q, s.state->qd, s.state->qdd, y, NULL);
        assert_true(relative_error(n, x, y) < 1e-13);
        assert_true(aba(d, s.state->q, s.state->qd, s.state->tau, x, NULL));
        assert_true(aba_full(d, s.state->q, s.state->qd, s.state->tau, y, NULL));
        assert_true(relative_error(n, x, y) < 1e-11);
        scene_end(&s);
    }
}

/* Joint accelerations of a free system do not feel a common velocity: u' of the base changes by -w
 * x dv alone. */
static void free_systems_do_not_feel_a_common_velocity(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_DENDRIMER, 15, JOINT_REVOLUTE, 3);
    spec.base = BASE_FLOATING;
    struct scene s = scene_of(&spec);
    int n = s.model->nu;
    double *before = TAKE(s.a, n, double), *after = TAKE(s.a, n, double);
    const double dv[3] = {1e4, -2e4, 5e3}, *w = s.state->qd + 3;
    exact()->forward(s.model, s.state, FORWARD_ABA, s.a, before, NULL, NULL, NULL);
    for (int k = 0; k < 3; k++) s.state->qd[k] += dv[k];
    exact()->forward(s.model, s.state, FORWARD_ABA, s.a, after, NULL, NULL, NULL);
    before[0] -= w[1] * dv[2] - w[2] * dv[1];
    before[1] -= w[2] * dv[0] - w[0] * dv[2];
    before[2] -= w[0] * dv[1] - w[1] * dv[0];
    assert_true(relative_error(n - 6, after + 6, before + 6) < 1e-14);
    assert_true(relative_error(3, after, before) < 1e-14);
    scene_end(&s);
}

/* External wrench m g on every body, at its centre of mass and turned to body axes, is the same as
 * gravity. */
static void gravity_is_an_external_force(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 20, JOINT_MIXED, 8);
    spec.external_force = 0;
    struct scene s = scene_of(&spec);
    int n = s.model->nbody, nu = s.model->nu;
    double *with = TAKE(s.a, nu, double), *without = TAKE(s.a, nu, double);
    exact()->inverse(s.model, s.state, s.a, with, NULL);
    struct dynamics *d = dynamics_take(s.model, s.a);
    struct body_motion *pose = TAKE(s.a, n, struct body_motion);
    forward_kinematics(d, s.state->q, s.state->qd, s.state->qdd, pose);
    double *fext = state_fext_need(s.state, s.model, s.a), g[3];
    memcpy(g, s.model->gravity, sizeof g);
    for (int i = 0; i < n; i++) {
        const double *c = s.model->body[i].com;
        double *f = fext + 6 * i;
        for (int k = 0; k < 3; k++)
            f[k] = s.model->body[i].mass *
                   (pose[i].r[k] * g[0] + pose[i].r[3 + k] * g[1] + pose[i].r[6 + k] * g[2]);
        f[3] = c[1] * f[2] - c[2] * f[1], f[4] = c[2] * f[0] - c[0] * f[2],
        f[5] = c[0] * f[1] - c[1] * f[0];
    }
    memset(s.model->gravity, 0, sizeof g);
    exact()->inverse(s.model, s.state, s.a, without, NULL);
    assert_true(relative_error(nu, without, with) < 1e-13);
    scene_end(&s);
}

/* d/dt (kinetic + potential) = tau . u + damping power, by a central difference of the motion. */
static void power_balances(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 6; seed++) {
        struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 12, JOINT_MIXED, seed);
        spec.external_force = 0;
        spec.base = seed % 2 ? BASE_FIXED : BASE_FLOATING;
        struct scene s = scene_of(&spec);
        const struct dynamics_type *quad = dynamics_type_of(PRECISION_QUAD);
        struct state *later = state_take(s.model, s.a);
        double power = 0, energy[2];
        const double h = 1e-5;
        for (int side = 0; side < 2; side++) {
            memcpy(later->q, s.state->q, (size_t)s.model->nq * sizeof(double));
            memcpy(later->qd, s.state->qd, (size_t)s.model->nu * sizeof(double));
            memcpy(later->tau, s.state->tau, (size_t)s.model->nu * sizeof(double));
            assert_true(exact()->advance(s.model, later, STEP_RK4, side ? h : -h, 1, s.a, NULL));
            struct dynamics_totals t;
            quad->totals(s.model, later, s.a, &t);
            energy[side] = t.kinetic + t.potential;
        }
        for (int k = 0; k < s.model->nu; k++) power += s.state->tau[k] * s.state->qd[k];
        double scale = fabs(energy[0]) + fabs(energy[1]) + fabs(power);
        assert_true(fabs((energy[1] - energy[0]) / (2 * h) - power) < 1e-8 * scale);
        scene_end(&s);
    }
}

/* Float, double and quad differ by about their precision. */
static void precisions_agree(void **state)
{
    (void)state;
    static const double tolerance[] = {
        [PRECISION_DOUBLE] = 1e-13, [PRECISION_FLOAT] = 1e-4, [PRECISION_QUAD] = 0};
    struct model_spec spec = spec_random(MODEL_COMB, 14, JOINT_MIXED, 4);
    struct scene s = scene_of(&spec);
    int n = s.model->nu;
    double *x = TAKE(s.a, n, double), *reference = TAKE(s.a, n, double);
    dynamics_type_of(PRECISION_QUAD)->inverse(s.model, s.state, s.a, reference, NULL);
    for (int p = PRECISION_DOUBLE; p <= PRECISION_QUAD; p++) {
        const struct dynamics_type *t = dynamics_type_of((enum precision)p);
        t->inverse(s.model, s.state, s.a, x, NULL);
        double error = relative_error(n, x, reference);
        assert_true(error <= tolerance[p]);
        assert_true(p != PRECISION_FLOAT || error > 1e-9);
    }
    scene_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aba_undoes_rnea),
        cmocka_unit_test(all_forward_methods_agree_with_quad_precision),
        cmocka_unit_test(crba_is_rnea_by_columns_and_half_u_m_u_is_the_energy),
        cmocka_unit_test(fast_paths_equal_the_general_code),
        cmocka_unit_test(free_systems_do_not_feel_a_common_velocity),
        cmocka_unit_test(gravity_is_an_external_force),
        cmocka_unit_test(power_balances),
        cmocka_unit_test(precisions_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
