/* test_oscillator.c - a mass on a spring, whose steps in time textbooks give in closed form, and
 * reports of the constraint force algorithm. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/refine.h"
#include "dynamics/trajectory.h"
#include "scene.h"

static const struct dynamics_type *exact(void) { return dynamics_type_of(PRECISION_DOUBLE); }

/* ---- steps in time of one mass on a spring ---- */

/* A mass on a prismatic joint with spring and damper. */
static struct scene oscillator(double mass, double stiffness, double damping, double rest)
{
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    struct body_def b = {.name = "mass",
                         .parent = -1,
                         .joint = JOINT_PRISMATIC,
                         .axis = {0, 1, 0},
                         .mass = mass,
                         .inertia = {1, 0, 0, 1, 0, 1},
                         .stiffness = stiffness,
                         .rest = rest,
                         .damping = damping};
    s.model = model_begin(s.a, NULL);
    assert_true(model_add_body(s.model, &b, &e) >= 0);
    assert_true(model_finish(s.model, false, &e));
    s.state = state_take(s.model, s.a);
    return s;
}

/* Of the undamped mass: what the symplectic rules keep exactly, step after step. */
static void symplectic_steps_keep_their_own_energy(void **state)
{
    (void)state;
    const double m = 2.5, k = 90, h = 0.05, rest = 0.4, z = h * h * k / m;
    struct scene s = oscillator(m, k, 0, rest);
    s.state->q[0] = rest + 0.3, s.state->qd[0] = -1.1;
    double first[2] = {0};
    for (int rule = 0; rule < 2; rule++)
        for (int step = 0; step < 200; step++) {
            const double q = s.state->q[0] - rest, u = s.state->qd[0];
            /* Hairer, Lubich, Wanner: Geometric Numerical Integration, I.1 and IX.3: of symplectic
             * Euler u^2 + w^2 q^2 - h w^2 q u, of Stoermer-Verlet u^2 + w^2 q^2 (1 - h^2 w^2 / 4)
             */
            const double kept = rule == 0 ? u * u + k / m * q * q - h * k / m * q * u
                                          : u * u + k / m * q * q * (1 - z / 4);
            if (step == 0) first[rule] = kept;
            assert_true(fabs(kept - first[rule]) <= 1e-12 * first[rule]);
            assert_true(exact()->advance(
                s.model, s.state, rule == 0 ? STEP_SEMI_IMPLICIT : STEP_KDK, h, 1, s.a, NULL));
        }
    scene_end(&s);
}

/* A step of each rule as a 2 x 2 matrix on (q - rest, u), from the textbook. */
static void one_step_is_the_textbooks_matrix(void **state)
{
    (void)state;
    const double m = 1.5, k = 20, c = 0.8, rest = -0.2, h = 0.07;
    struct scene s = oscillator(m, k, c, rest);
    for (int trial = 0; trial < 6; trial++) {
        const double q = 0.5 - 0.2 * trial, u = -1 + 0.45 * trial;
        /* Runge-Kutta 4: the exponential series of h A to its fourth power */
        double x[2] = {q, u}, term[2] = {q, u};
        for (int p = 1; p <= 4; p++) {
            const double t[2] = {h / p * term[1], h / p * (-k * term[0] - c * term[1]) / m};
            memcpy(term, t, sizeof t);
            x[0] += t[0], x[1] += t[1];
        }
        s.state->q[0] = rest + q, s.state->qd[0] = u;
        assert_true(exact()->advance(s.model, s.state, STEP_RK4, h, 1, s.a, NULL));
        assert_true(fabs(s.state->q[0] - rest - x[0]) < 1e-14 &&
                    fabs(s.state->qd[0] - x[1]) < 1e-13);
        /* backward Euler, which the linearly implicit rule is for a linear spring */
        s.state->q[0] = rest + q, s.state->qd[0] = u;
        assert_true(exact()->advance(s.model, s.state, STEP_LINEARLY_IMPLICIT, h, 1, s.a, NULL));
        const double after = (m * u - h * k * q) / (m + h * c + h * h * k);
        assert_true(fabs(s.state->qd[0] - after) < 1e-14);
        assert_true(fabs(s.state->q[0] - rest - q - h * after) < 1e-15);
        /* symplectic Euler: velocity first */
        s.state->q[0] = rest + q, s.state->qd[0] = u;
        assert_true(exact()->advance(s.model, s.state, STEP_SEMI_IMPLICIT, h, 1, s.a, NULL));
        const double kicked = u + h * (-k * q - c * u) / m;
        assert_true(fabs(s.state->qd[0] - kicked) < 1e-14);
        assert_true(fabs(s.state->q[0] - rest - q - h * kicked) < 1e-15);
    }
    scene_end(&s);
}

/* A screw alone, backward Euler in (q, u) with q' = u / sqrt(1 + p^2): its mass against u is (I + m
 * p^2) / (1 + p^2), and the velocity after the step is that of the spring at its end. */
static void a_screws_implicit_step_ends_where_its_spring_is(void **state)
{
    (void)state;
    const double m = 1.5, inertia = 0.3, k = 40, c = 0.7, rest = 0.1, h = 0.06;
    for (int trial = 0; trial < 5; trial++) {
        const double p = 0.5 * trial, per = sqrt(1 + p * p),
                     mass = (inertia + m * p * p) / per / per;
        const double q = 0.4 - 0.3 * trial, u = 0.8 * trial - 1;
        struct scene s = {.a = arena_create()};
        struct err e;
        err_clear(&e);
        struct body_def b = {.name = "screw",
                             .parent = -1,
                             .joint = JOINT_HELICAL,
                             .axis = {0, 0, 1},
                             .pitch = p,
                             .mass = m,
                             .inertia = {1, 0, 0, 1, 0, inertia},
                             .stiffness = k,
                             .rest = rest,
                             .damping = c};
        s.model = model_begin(s.a, NULL);
        assert_true(model_add_body(s.model, &b, &e) >= 0);
        assert_true(model_finish(s.model, false, &e));
        s.state = state_take(s.model, s.a);
        s.state->q[0] = rest + q, s.state->qd[0] = u;
        assert_true(exact()->advance(s.model, s.state, STEP_LINEARLY_IMPLICIT, h, 1, s.a, NULL));
        const double after = (mass * u - h * k * q) / (mass + h * c + h * h * k / per);
        assert_true(fabs(s.state->qd[0] - after) < 1e-13);
        assert_true(fabs(s.state->q[0] - rest - q - h * after / per) < 1e-13);
        scene_end(&s);
    }
}

/* Without a damper: q = a cos wt + b / w sin wt. */
static void every_stepper_follows_the_cosine(void **state)
{
    (void)state;
    const double m = 2, k = 50, rest = 0.1, omega = 5, time = 0.9;
    for (const char *const *name = trajectory_steppers(); *name != NULL; name++) {
        struct scene s = oscillator(m, k, 0, rest);
        struct err e;
        err_clear(&e);
        s.state->q[0] = rest + 0.2, s.state->qd[0] = 0.5;
        /* the first orders take too many steps for more digits */
        const bool first_order = strcmp(*name, "rk1imp") == 0;
        const double tolerance = first_order ? 1e-5 : 1e-8;
        const struct trajectory_options o = {.stepper = *name, .tolerance = tolerance};
        struct trajectory_report report = {0};
        if (!trajectory_advance(s.model, s.state, time, &o, s.a, &report, &e))
            fail_msg("%s: %s", *name, e.text);
        const double q = 0.2 * cos(omega * time) + 0.5 / omega * sin(omega * time),
                     u = -0.2 * omega * sin(omega * time) + 0.5 * cos(omega * time);
        assert_true(fabs(s.state->q[0] - rest - q) < 1e4 * tolerance * 0.2);
        assert_true(fabs(s.state->qd[0] - u) < 1e4 * tolerance);
        assert_true(report.steps > 3 && report.evaluations >= report.steps);
        scene_end(&s);
    }
}

/* What fails leaves the state as it was. */
static void a_trajectory_that_fails_moves_nothing(void **state)
{
    (void)state;
    const struct trajectory_options row[] = {
        {.stepper = "none", .tolerance = 1e-6},
        {.stepper = "rk4", .tolerance = 1e-12, .most_evaluations = 20},
        /* an explicit rule with steps a thousand times too long leaves all numbers behind */
        {.stepper = "rk4", .fixed_steps = 200, .tolerance = 1e-6},
    };
    for (int i = 0; i < 3; i++) {
        struct scene s = oscillator(1, 1e14, 0, 0);
        struct err e;
        err_clear(&e);
        s.state->q[0] = 0.2, s.state->qd[0] = 0.5;
        assert_false(trajectory_advance(s.model, s.state, 100, &row[i], s.a, NULL, &e));
        assert_int_equal(e.kind, i == 0 ? ERR_USAGE : ERR_CHECK);
        assert_true(s.state->q[0] == 0.2 && s.state->qd[0] == 0.5);
        scene_end(&s);
    }
}

/* Quaternions have length one after each step of each rule, whatever the joint has besides. */
static void steps_keep_quaternions_of_length_one(void **state)
{
    (void)state;
    static const enum model_joint joint[] = {JOINT_SPHERICAL, JOINT_SLOT, JOINT_POINT_PLANE,
                                             JOINT_FLOATING};
    for (int j = 0; j < 4; j++)
        for (int rule = STEP_SEMI_IMPLICIT; rule <= STEP_RK4; rule++) {
            struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 4, joint[j], 7);
            spec.rate = 5; /* 0.5 rad a step, where the rule alone would leave the sphere */
            struct scene s = scene_of(&spec);
            for (int step = 0; step < 3; step++) {
                double before[200], moved = 0;
                memcpy(before, s.state->q, (size_t)s.model->nq * sizeof(double));
                assert_true(
                    exact()->advance(s.model, s.state, (enum step_rule)rule, 0.02, 1, s.a, NULL));
                for (int i = 0; i < s.model->nbody; i++) {
                    const int at = s.model->q_at[i] + joint_quaternion(joint[j]);
                    double square = 0;
                    for (int k = 0; k < 4; k++) {
                        square += s.state->q[at + k] * s.state->q[at + k];
                        moved += fabs(s.state->q[at + k] - before[at + k]);
                    }
                    assert_true(fabs(square - 1) < 1e-14);
                }
                assert_true(moved > 1e-3);
            }
            scene_end(&s);
        }
}

/* Which of the three questions a difference of two bodies is an answer to. */
static void bodies_are_alike_in_what_they_are_asked_for(void **state)
{
    (void)state;
    enum { AXES = 1, MASS = 2, HANGS = 4 };
    static const struct {
        size_t at;
        int differs;
    } row[] = {
        {offsetof(struct body_def, axis[2]), AXES},
        {offsetof(struct body_def, axis2[1]), AXES},
        {offsetof(struct body_def, mass), MASS},
        {offsetof(struct body_def, com[0]), MASS},
        {offsetof(struct body_def, inertia[0]), MASS},
        {offsetof(struct body_def, inertia[5]), MASS},
        {offsetof(struct body_def, placement.quat[3]), HANGS},
        {offsetof(struct body_def, placement.p[2]), HANGS},
        {offsetof(struct body_def, pitch), HANGS},
        {offsetof(struct body_def, stiffness), HANGS},
        {offsetof(struct body_def, rest), HANGS},
        {offsetof(struct body_def, damping), HANGS},
    };
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 3, JOINT_REVOLUTE, 1);
    struct scene s = scene_of(&spec);
    struct body_def *b = s.model->body;
    const struct body_def like = b[1];
    for (size_t i = 0; i <= sizeof row / sizeof *row; i++) {
        const bool none = i == sizeof row / sizeof *row;
        b[2] = like;
        /* names, lines and parents are nobody's question */
        strcpy(b[2].name, "other"), b[2].line = 77, b[2].parent = 0;
        if (!none) *(double *)((char *)&b[2] + row[i].at) += 0.125;
        const int differs = none ? 0 : row[i].differs;
        assert_int_equal(bodies_alike(s.model, 1, 2), !(differs & AXES));
        assert_int_equal(bodies_weigh_alike(s.model, 1, 2), !(differs & MASS));
        assert_int_equal(bodies_hang_alike(s.model, 2, 1), !(differs & HANGS));
    }
    b[2] = like;
    b[2].joint = JOINT_PRISMATIC;
    assert_false(bodies_alike(s.model, 1, 2));
    assert_true(bodies_alike(s.model, -1, -1));
    assert_false(bodies_alike(s.model, -1, 1));
    scene_end(&s);
}

/* ---- constraint forces ---- */

static void sizes_are_relative_to_the_answer(void **state)
{
    (void)state;
    static const struct {
        double x[3], y[3], wanted;
    } row[] = {
        {{1, -3, 2}, {4, 6, -5}, 0.5},
        {{0, 0, 0}, {0, 0, 0}, 0},
        {{0, 1e-300, 0}, {0, 0, 0}, 1},
        {{1, NAN, 1}, {1, 1, 1}, INFINITY},
        {{1, 1, -INFINITY}, {1, 1, 1}, INFINITY},
        {{0, 0, 0}, {0, -2, 0}, 0},
        {{NAN, 0, 0}, {0, 0, 0}, INFINITY},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        assert_true(relative_size(3, row[i].x, row[i].y) == row[i].wanted);
    assert_true(relative_size(2, row[0].x, row[0].y) == 0.5);
    assert_true(relative_size(1, row[0].x, row[0].y) == 0.25);
    assert_true(relative_size(0, row[0].x, row[0].y) == 0);
}

/* Heavy and light links in turn: the robust way has nearly all digits where others have few, and
 * its last correction tells so. */
static void the_robust_way_has_nearly_all_digits(void **state)
{
    (void)state;
    double plain = 0;
    for (int ratio = 0; ratio <= 18; ratio += ratio == 12 ? 4 : 2)
        for (int n = 2; n <= 12; n += 5) {
            struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 3);
            struct scene s = scene_of(&spec);
            for (int i = 0; i < n; i += 2) {
                s.model->body[i].mass *= pow(10, -ratio);
                for (int k = 0; k < 6; k++) s.model->body[i].inertia[k] *= pow(10, -ratio);
            }
            /* the constants were made of the masses before */
            s.model->constants = NULL;
            double reference[12], qdd[12], direct[12];
            struct forward_report report;
            assert_true(
                dynamics_type_of(PRECISION_QUAD)
                    ->forward(s.model, s.state, FORWARD_ABA, s.a, reference, NULL, NULL, NULL));
            assert_true(exact()->forward(s.model, s.state, FORWARD_CFA_ROBUST, s.a, qdd, NULL,
                                         &report, NULL));
            assert_true(relative_error(n, qdd, reference) < 1e-14);
            /* beyond what the precision resolves articulated bodies have to solve it */
            assert_int_equal(report.fell_back, ratio > 12);
            assert_int_equal(report.nrow, 0);
            assert_true(report.refined > 0);
            if (exact()->forward(s.model, s.state, FORWARD_CFA_PAPER, s.a, direct, NULL, NULL,
                                 NULL))
                plain = fmax(plain, relative_error(n, direct, reference));
            scene_end(&s);
        }
    assert_true(plain > 1e-9); /* without refinement it is no such thing */
}

/* Bodies without an inertia of their own: the constraint forces have no system, articulated bodies
 * have an answer, and the robust way takes it and says so. */
static void without_inertia_articulated_bodies_take_over(void **state)
{
    (void)state;
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    s.model = model_begin(s.a, NULL);
    for (int i = 0; i < 6; i++) {
        struct body_def b = {.name = "link",
                             .parent = i - 1,
                             .joint = JOINT_REVOLUTE,
                             .axis = {i % 2, 0, 1 - i % 2},
                             .com = {0.5}};
        b.placement.p[0] = i > 0;
        if (i % 3 != 1) b.mass = i == 5 ? 1e7 : 1 + i;
        for (int k = 0; k < 6 && b.mass > 0; k += k == 0 ? 3 : 2)
            b.inertia[k] = b.mass * (0.1 + 0.03 * k);
        assert_true(model_add_body(s.model, &b, &e) >= 0);
    }
    s.model->gravity[1] = -9.81;
    assert_false(s.model->has_phi);
    if (!model_finish(s.model, true, &e)) fail_msg("%s", e.text);
    assert_false(s.model->has_phi);
    s.state = state_take(s.model, s.a);
    double qdd[6], reference[6];
    for (int i = 0; i < 6; i++) s.state->q[i] = 0.3 * i - 0.5, s.state->qd[i] = 1 - 0.4 * i;
    assert_true(dynamics_type_of(PRECISION_QUAD)
                    ->forward(s.model, s.state, FORWARD_ABA, s.a, reference, NULL, NULL, NULL));
    for (int k = 0; k < FORWARD_METHODS; k++) {
        struct forward_report report;
        const bool forces = k == FORWARD_CFA_PAPER || k == FORWARD_CFA_DIRECT;
        assert_int_equal(exact()->forward(s.model, s.state, (enum forward_method)k, s.a, qdd, NULL,
                                          &report, NULL),
                         !forces);
        if (forces) continue;
        assert_int_equal(report.fell_back, k == FORWARD_CFA_ROBUST);
        assert_true(relative_error(6, qdd, reference) < (k == FORWARD_CFA_ROBUST ? 1e-15 : 1e-10));
    }
    scene_end(&s);
}

/* A last body without any inertia along its joint has no acceleration: every method says so. */
static void nothing_to_accelerate_is_told(void **state)
{
    (void)state;
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    s.model = model_begin(s.a, NULL);
    for (int i = 0; i < 2; i++) {
        struct body_def b = {
            .name = "link", .parent = i - 1, .joint = JOINT_REVOLUTE, .axis = {0, 0, 1}};
        if (i == 0) b.mass = 1, memcpy(b.inertia, (double[6]){1, 0, 0, 1, 0, 1}, 48);
        assert_true(model_add_body(s.model, &b, &e) >= 0);
    }
    assert_true(model_finish(s.model, true, &e));
    s.state = state_take(s.model, s.a);
    s.state->tau[1] = 1;
    double qdd[2];
    for (int k = 0; k < FORWARD_METHODS; k++)
        assert_false(
            exact()->forward(s.model, s.state, (enum forward_method)k, s.a, qdd, NULL, NULL, NULL));
    scene_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symplectic_steps_keep_their_own_energy),
        cmocka_unit_test(one_step_is_the_textbooks_matrix),
        cmocka_unit_test(a_screws_implicit_step_ends_where_its_spring_is),
        cmocka_unit_test(every_stepper_follows_the_cosine),
        cmocka_unit_test(a_trajectory_that_fails_moves_nothing),
        cmocka_unit_test(steps_keep_quaternions_of_length_one),
        cmocka_unit_test(bodies_are_alike_in_what_they_are_asked_for),
        cmocka_unit_test(sizes_are_relative_to_the_answer),
        cmocka_unit_test(the_robust_way_has_nearly_all_digits),
        cmocka_unit_test(without_inertia_articulated_bodies_take_over),
        cmocka_unit_test(nothing_to_accelerate_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
