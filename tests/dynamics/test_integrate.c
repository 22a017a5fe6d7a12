/* test_integrate.c - orders of the fixed steps, conservation, and GSL's steppers against reference
 * trajectories. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/trajectory.h"
#include "model/vector_model.h"
#include "scene.h"

#define DATA(file) MIMDSIM_SRCDIR "/tests/data/vectors/trajectories/" file

static const struct dynamics_type *exact(void) { return dynamics_type_of(PRECISION_DOUBLE); }

static struct state *copy_of(const struct scene *s)
{
    struct state *c = state_take(s->model, s->a);
    memcpy(c->q, s->state->q, (size_t)s->model->nq * sizeof(double));
    memcpy(c->qd, s->state->qd, (size_t)s->model->nu * sizeof(double));
    memcpy(c->tau, s->state->tau, (size_t)s->model->nu * sizeof(double));
    memcpy(c->base_acceleration, s->state->base_acceleration, sizeof c->base_acceleration);
    return c;
}

/* Error of q after 0.2 s by n steps. */
static double error_of(const struct scene *s, enum step_rule rule, int n,
                       const struct state *reference)
{
    struct state *c = copy_of(s);
    assert_true(exact()->advance(s->model, c, rule, 0.2 / n, n, s->a, NULL));
    return relative_error(s->model->nq, c->q, reference->q);
}

/* Halving the step divides the error by 2^order, for a system with joints of every kind. */
static void steps_have_their_orders(void **state)
{
    (void)state;
    static const int order[] = {
        [STEP_SEMI_IMPLICIT] = 1, [STEP_KDK] = 2, [STEP_RK4] = 4, [STEP_LINEARLY_IMPLICIT] = 1};
    for (uint64_t seed = 2; seed < 5; seed++) {
        struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 9, JOINT_MIXED, seed);
        spec.external_force = 0;
        spec.base = BASE_FLOATING;
        spec.mass_ratio = 1;
        spec.stiffness = 3;
        spec.damping = 0.1;
        struct scene s = scene_of(&spec);
        struct state *reference = copy_of(&s);
        assert_true(exact()->advance(s.model, reference, STEP_RK4, 0.2 / 800, 800, s.a, NULL));
        for (int rule = STEP_SEMI_IMPLICIT; rule <= STEP_LINEARLY_IMPLICIT; rule++) {
            double coarse = error_of(&s, (enum step_rule)rule, 50, reference);
            double fine = error_of(&s, (enum step_rule)rule, 100, reference);
            assert_true(fabs(log2(coarse / fine) - order[rule]) < 0.35);
        }
        scene_end(&s);
    }
}

/* A free tree without gravity keeps energy, linear and angular momentum. */
static void free_motion_conserves(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_DENDRIMER, 15, JOINT_SPHERICAL, 3);
    spec.external_force = spec.torque = 0;
    spec.base = BASE_FLOATING;
    memset(spec.gravity, 0, sizeof spec.gravity);
    struct scene s = scene_of(&spec);
    struct dynamics_totals before, after;
    exact()->totals(s.model, s.state, s.a, &before);
    assert_true(exact()->advance(s.model, s.state, STEP_RK4, 5e-4, 400, s.a, NULL));
    exact()->totals(s.model, s.state, s.a, &after);
    assert_true(fabs(after.kinetic - before.kinetic) < 1e-8 * before.kinetic);
    assert_true(relative_error(3, after.linear, before.linear) < 1e-8);
    assert_true(relative_error(3, after.angular, before.angular) < 1e-8);
    scene_end(&s);
}

/* (M + s) u' = tau - k (q - rest + h u) - c u - xi with the mass matrix and inverse dynamics,
 * joints of every kind. */
static void implicit_accelerations_solve_their_equation(void **state)
{
    (void)state;
    int springs = 0;
    for (uint64_t seed = 1; seed < 9; seed++) {
        struct model_spec spec =
            spec_random(MODEL_RANDOM_TREE, 9, seed % 2 ? JOINT_MIXED : JOINT_REVOLUTE, seed);
        const double h = 1e-2, k = pow(10, (double)seed), c = seed % 3 ? 1e-2 * k : 0;
        spec.base = seed % 4 ? BASE_FIXED : BASE_FLOATING;
        spec.stiffness = k, spec.damping = c;
        struct scene s = scene_of(&spec);
        struct dynamics *d = dynamics_take(s.model, s.a);
        const int n = s.model->nu;
        double *ud = TAKE(s.a, n, double), *mass = TAKE(s.a, n * n, double),
               *xi = TAKE(s.a, n, double);
        struct work w = {0};
        dynamics_load(d, s.state);
        assert_true(implicit_forward(d, h, s.state->q, s.state->qd, s.state->tau, ud, &w));
        crba(d, s.state->q, mass, &w);
        rnea(d, s.state->q, s.state->qd, d->zero, xi, &w);
        for (int i = 0; i < s.model->nbody; i++)
            for (int r = s.model->u_at[i]; r < s.model->u_at[i + 1]; r++) {
                const struct body_def *b = &s.model->body[i];
                const double q = s.state->q[s.model->q_at[i]], u = s.state->qd[r];
                double left = xi[r] - s.state->tau[r], scale = fabs(left);
                if (b->stiffness > 0) {
                    left += b->stiffness * (q - b->rest + h * u) + b->damping * u +
                            h * (c + h * k) * ud[r];
                    scale = fmax(scale, fabs(h * (c + h * k) * ud[r]));
                    springs++;
                }
                for (int j = 0; j < n; j++)
                    left += mass[n * r + j] * ud[j], scale += fabs(mass[n * r + j] * ud[j]);
                assert_true(fabs(left) <= 1e-11 * scale);
            }
        scene_end(&s);
    }
    assert_true(springs > 30);
}

/* Steps a thousand times above the explicit limit: springs come to rest, explicitly they break
 * everything. */
static void implicit_steps_are_stable_at_any_stiffness(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 6, JOINT_REVOLUTE, 5);
        spec.stiffness = 1e8, spec.damping = damped ? 1e6 : 0;
        struct scene s = scene_of(&spec);
        struct state *c = copy_of(&s), *explicit = copy_of(&s);
        for (int i = 0; i < 6; i++) c->q[i] += 0.1, explicit->q[i] += 0.1;
        assert_true(exact()->advance(s.model, c, STEP_LINEARLY_IMPLICIT, 0.1, 200, s.a, NULL));
        for (int i = 0; i < 6; i++)
            assert_true(fabs(c->q[i] - s.model->body[i].rest) < 1e-3 && fabs(c->qd[i]) < 1e-2);
        const bool went =
            exact()->advance(s.model, explicit, STEP_SEMI_IMPLICIT, 0.1, 200, s.a, NULL);
        assert_true(!went || !(fabs(explicit->qd[0]) < 1e6));
        scene_end(&s);
    }
}

/* Every GSL stepper brings a short reference trajectory to its tolerance. */
static void steppers_reach_the_reference(const char *path, const char *only, double tolerance,
                                         double allowed)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct vector_case c;
    if (!vector_read(path, &c, a, &e)) fail_msg("%s", e.text);
    struct model *m = vector_model(&c, a, &e);
    assert_non_null(m);
    for (const char *const *name = trajectory_steppers(); *name; name++) {
        if (only && strcmp(*name, only) != 0) continue;
        bool low = strstr(*name, "rk1imp") || strstr(*name, "rk2imp") || strcmp(*name, "rk2") == 0;
        struct trajectory_options o = {.stepper = *name, .tolerance = low ? 1e-5 : tolerance};
        struct trajectory_report report;
        struct state *s = vector_state(&c, m, a);
        assert_true(
            trajectory_advance(m, s, c.instant[1].time - c.instant[0].time, &o, a, &report, &e));
        assert_true(report.steps > 2 && report.evaluations > report.steps);
        assert_true(relative_error(m->nq, s->q, c.instant[1].q) < (low ? 1e-2 : allowed));
        assert_true(relative_error(m->nu, s->qd, c.instant[1].qd) < (low ? 5e-2 : 10 * allowed));
    }
    arena_destroy(a);
}

static void gsl_steppers_follow_reference_trajectories(void **state)
{
    (void)state;
    steppers_reach_the_reference(DATA("traj_double_pendulum.json"), NULL, 1e-9, 1e-7);
    steppers_reach_the_reference(DATA("traj_stiff_light_n03.json"), "bsimp", 1e-9, 1e-7);
}

/* Twice as many equal steps divide the error by 2^order or more, explicit or implicit. */
static void fixed_steps_of_the_library_have_their_orders(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double order;
        int coarse;
    } stepper[] = {{"rk2", 2, 40},    {"rk4", 4, 20},    {"rkf45", 4, 20},
                   {"rkck", 5, 10},   {"rk8pd", 8, 4},   {"rk1imp", 1, 40},
                   {"rk2imp", 2, 40}, {"rk4imp", 4, 10}, {"bsimp", 6, 4}};
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 3, JOINT_REVOLUTE, 5);
    spec.external_force = 0;
    spec.base = BASE_FIXED;
    struct scene s = scene_of(&spec);
    struct err e;
    err_clear(&e);
    struct state *reference = copy_of(&s);
    const struct trajectory_options tight = {.stepper = "rk8pd", .tolerance = 1e-14};
    assert_true(trajectory_advance(s.model, reference, 0.2, &tight, s.a, NULL, &e));
    for (size_t k = 0; k < sizeof stepper / sizeof *stepper; k++) {
        double error[2];
        for (int fine = 0; fine < 2; fine++) {
            const struct trajectory_options o = {
                .stepper = stepper[k].name, .tolerance = 1e-13,
                .fixed_steps = (fine + 1) * stepper[k].coarse};
            struct trajectory_report report;
            struct state *c = copy_of(&s);
            assert_true(trajectory_advance(s.model, c, 0.2, &o, s.a, &report, &e));
            assert_int_equal(report.steps, o.fixed_steps);
            error[fine] = relative_error(s.model->nq, c->q, reference->q);
        }
        const double order = log2(error[0] / error[1]);
        if (error[1] > 1e-13 && order < stepper[k].order - 0.4)
            fail_msg("%s: order %g, errors %g and %g", stepper[k].name, order, error[0], error[1]);
    }
    scene_end(&s);
}

/* rk8pd at a tight tolerance, through all instants, within the reference's own sensitivity. */
static void the_best_stepper_follows_all_instants(void **state)
{
    (void)state;
    static const char *const path[] = {DATA("traj_double_pendulum.json"),
                                       DATA("traj_spherical_n05.json"), DATA("traj_float_n08.json"),
                                       DATA("traj_stiff_n06.json")};
    for (int k = 0; k < 4; k++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        struct vector_case c;
        if (!vector_read(path[k], &c, a, &e)) fail_msg("%s", e.text);
        struct model *m = vector_model(&c, a, &e);
        struct state *s = vector_state(&c, m, a);
        const struct trajectory_options o = {.stepper = "rk8pd", .tolerance = 1e-12};
        for (int i = 1;
             i < 4 && c.instant[i].time <= (k < 3 ? 1 : 0.1) && c.instant[i].sensitivity < 1e4;
             i++) {
            assert_true(trajectory_advance(m, s, c.instant[i].time - c.instant[i - 1].time, &o, a,
                                           NULL, &e));
            double allowed = 1e-9 * fmax(1, c.instant[i].sensitivity);
            assert_true(relative_error(m->nq, s->q, c.instant[i].q) < allowed);
            struct dynamics_totals t;
            exact()->totals(m, s, a, &t);
            assert_true(fabs(t.kinetic + t.potential - c.instant[i].energy[2]) <
                        1e-8 * fmax(1, fabs(t.kinetic) + fabs(t.potential)));
        }
        arena_destroy(a);
    }
}

static void an_unknown_stepper_is_refused_with_the_nearest_name(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 2, JOINT_REVOLUTE, 1);
    struct scene s = scene_of(&spec);
    struct err e;
    err_clear(&e);
    const struct trajectory_options o = {.stepper = "rk8dp", .tolerance = 1e-6};
    assert_false(trajectory_advance(s.model, s.state, 1, &o, s.a, NULL, &e));
    assert_int_equal(e.kind, ERR_USAGE);
    assert_non_null(strstr(e.text, "rk8pd"));
    err_clear(&e);
    const struct trajectory_options few = {
        .stepper = "rkf45", .tolerance = 1e-6, .most_evaluations = 3};
    assert_false(trajectory_advance(s.model, s.state, 1, &few, s.a, NULL, &e));
    assert_int_equal(e.kind, ERR_CHECK);
    const double no_time[] = {0, -1, INFINITY, NAN};
    const struct trajectory_options good = {.stepper = "rkf45", .tolerance = 1e-6};
    for (int k = 0; k < 4; k++) {
        err_clear(&e);
        assert_false(trajectory_advance(s.model, s.state, no_time[k], &good, s.a, NULL, &e));
        assert_int_equal(e.kind, ERR_CHECK);
    }
    scene_end(&s);
}

static void what_cannot_move_stays_where_it_is(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 2, JOINT_FIXED, 1);
    struct scene s = scene_of(&spec);
    struct err e;
    err_clear(&e);
    struct trajectory_report report = {1, 1};
    const struct trajectory_options o = {.stepper = "bsimp", .tolerance = 1e-6};
    assert_true(trajectory_advance(s.model, s.state, 1, &o, s.a, &report, &e));
    assert_true(report.steps == 0 && report.evaluations == 0);
    scene_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_have_their_orders),
        cmocka_unit_test(free_motion_conserves),
        cmocka_unit_test(implicit_accelerations_solve_their_equation),
        cmocka_unit_test(implicit_steps_are_stable_at_any_stiffness),
        cmocka_unit_test(gsl_steppers_follow_reference_trajectories),
        cmocka_unit_test(fixed_steps_of_the_library_have_their_orders),
        cmocka_unit_test(the_best_stepper_follows_all_instants),
        cmocka_unit_test(an_unknown_stepper_is_refused_with_the_nearest_name),
        cmocka_unit_test(what_cannot_move_stays_where_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
