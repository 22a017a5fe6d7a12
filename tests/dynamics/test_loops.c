/* test_loops.c - closed chains: two independent ways agree, loops do no work, redundancy,
 * stabilisation, drift. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/system.h"
#include "scene.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static const struct dynamics_type *exact(void) { return dynamics_type_of(PRECISION_DOUBLE); }

static struct scene four_bar(void)
{
    struct model_spec spec = spec_random(MODEL_FOUR_BAR, 3, JOINT_REVOLUTE, 1);
    spec.gravity[0] = spec.gravity[2] = 0, spec.gravity[1] = -9.81;
    spec.external_force = 0;
    spec.rate = 2;
    return scene_of(&spec);
}

static struct forward_report forward_by(const struct scene *s, enum forward_method method,
                                        double *qdd, double *lambda)
{
    struct forward_report report;
    assert_true(exact()->forward(s->model, s->state, method, s->a, qdd, lambda, &report, NULL));
    return report;
}

/* A moving ring or tree with extra random loops of every joint type, at a random pose (not closed:
 * the accelerations are defined all the same). */
static struct scene tangle(enum model_joint loop_joint, uint64_t seed)
{
    struct model_spec spec =
        spec_random(seed % 2 ? MODEL_RANDOM_TREE : MODEL_SERIAL_CHAIN, 14, JOINT_SPHERICAL, seed);
    spec.base = seed % 3 ? BASE_FIXED : BASE_FLOATING;
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    struct model *tree = model_build(&spec, s.a, &e), *m = model_begin(s.a, NULL);
    for (int i = 0; i < tree->nbody; i++) assert_true(model_add_body(m, &tree->body[i], &e) >= 0);
    for (int k = 0; k < 2; k++) {
        struct loop_def l = {
            .name = "loop", .body_a = k ? 3 : -1, .body_b = k ? 9 : 13, .joint = loop_joint};
        l.frame_a = (struct frame){{0.1, 0.2, -0.3, 0.9}, {0.3, 0.1, 0.2}};
        l.frame_b = (struct frame){{-0.4, 0.1, 0.5, 0.6}, {0.5, -0.1, 0.1}};
        assert_true(model_add_loop(m, &l, &e) >= 0);
    }
    memcpy(m->gravity, spec.gravity, sizeof spec.gravity);
    assert_true(model_finish(m, false, &e));
    s.model = m;
    s.state = state_make(m, &spec, s.a);
    return s;
}

static const enum model_joint closing[] = {JOINT_FIXED,       JOINT_REVOLUTE,   JOINT_PRISMATIC,
                                           JOINT_CYLINDRICAL, JOINT_SPHERICAL,  JOINT_PLANAR,
                                           JOINT_SLOT,        JOINT_POINT_PLANE};

static void bordered_system_agrees_with_articulated_bodies(void **state)
{
    (void)state;
    for (size_t j = 0; j < sizeof closing / sizeof *closing; j++)
        for (uint64_t seed = 1; seed < 5; seed++) {
            struct scene s = tangle(closing[j], seed);
            int n = s.model->nu, m = s.model->nrow;
            double *x = TAKE(s.a, n, double), *y = TAKE(s.a, n, double);
            double *lx = TAKE(s.a, m, double), *ly = TAKE(s.a, m, double);
            assert_int_equal(m, 2 * (6 - joint_nu(closing[j])));
            struct forward_report articulated = forward_by(&s, FORWARD_ABA, x, lx);
            struct forward_report report = forward_by(&s, FORWARD_CFA_ROBUST, y, ly);
            assert_int_equal(report.rank, articulated.rank);
            assert_true(relative_error(n, x, y) < 1e-9);
            assert_true(relative_error(m, lx, ly) < 1e-9);
            forward_by(&s, FORWARD_CFA_DIRECT, x, lx);
            assert_true(relative_error(n, x, y) < 1e-8);
            forward_by(&s, FORWARD_CFA_PAPER, x, lx);
            assert_true(relative_error(n, x, y) < 1e-6);
            scene_end(&s);
        }
}

/* rho and its derivative: W^T rho at a time h later grows by h times the constraint's acceleration,
 * which is zero. */
static void constraint_velocity_keeps_its_value(void **state)
{
    (void)state;
    for (size_t j = 0; j < sizeof closing / sizeof *closing; j++) {
        struct scene s = tangle(closing[j], 2);
        struct dynamics *d = dynamics_take(s.model, s.a);
        int m = s.model->nrow;
        double *before = TAKE(s.a, m, double), *after = TAKE(s.a, m, double),
               *qdd = TAKE(s.a, s.model->nu, double);
        double *q = s.state->q, *u = s.state->qd;
        const double h = 1e-6;
        forward_by(&s, FORWARD_ABA, qdd, NULL);
        double *q2 = TAKE(s.a, s.model->nq, double), *u2 = TAKE(s.a, s.model->nu, double);
        for (int side = 0; side < 2; side++) {
            double t = side ? h : -h;
            memcpy(q2, q, (size_t)s.model->nq * sizeof *q);
            for (int k = 0; k < s.model->nu; k++) u2[k] = u[k] + t * qdd[k];
            double *mid = TAKE(s.a, s.model->nu, double);
            for (int k = 0; k < s.model->nu; k++) mid[k] = u[k] + t / 2 * qdd[k];
            for (int i = 0; i < s.model->nbody; i++)
                body_step(&d->body[i], q2 + d->body[i].q_at, mid + d->body[i].u_at, t);
            loop_drift(d, q2, u2, NULL, side ? after : before);
        }
        double scale = 0;
        for (int k = 0; k < m; k++) scale = fmax(scale, fabs(after[k]));
        for (int k = 0; k < m; k++)
            assert_true(fabs(after[k] - before[k]) / (2 * h) < 2e-8 * (1 + 100 * scale));
        scene_end(&s);
    }
}

static void a_four_bar_has_three_redundant_constraints(void **state)
{
    (void)state;
    struct scene s = four_bar();
    double x[3], reference[3], lambda[5];
    struct forward_report report;
    assert_true(
        dynamics_type_of(PRECISION_QUAD)
            ->forward(s.model, s.state, FORWARD_CFA_DIRECT, s.a, reference, NULL, &report, NULL));
    assert_int_equal(report.rank, 2);
    assert_int_equal(report.nrow, 5);
    for (int method = 0; method < FORWARD_METHODS; method++) {
        report = forward_by(&s, (enum forward_method)method, x, lambda);
        assert_int_equal(report.rank, 2);
        assert_true(relative_error(3, x, reference) < 1e-12);
    }
    scene_end(&s);
}

/* The parallelogram moves as one pendulum: u' = (a, -a, a). */
static void a_parallelogram_keeps_its_shape(void **state)
{
    (void)state;
    struct scene s = four_bar();
    double x[3];
    forward_by(&s, FORWARD_CFA_ROBUST, x, NULL);
    assert_near(x[1], -x[0], 1e-12);
    assert_near(x[2], x[0], 1e-12);
    scene_end(&s);
}

/* The revolute cut joint and its two in-plane rows give the same motion. */
static void in_plane_rows_replace_the_revolute_joint(void **state)
{
    (void)state;
    struct scene s = four_bar();
    double x[3], y[3];
    forward_by(&s, FORWARD_CFA_DIRECT, x, NULL);
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(s.a, NULL);
    for (int i = 0; i < 3; i++) assert_true(model_add_body(m, &s.model->body[i], &e) >= 0);
    struct loop_def l = s.model->loop[0];
    l.nrow = 2;
    l.row[0][0] = l.row[1][1] = 1;
    assert_true(model_add_loop(m, &l, &e) >= 0);
    memcpy(m->gravity, s.model->gravity, sizeof m->gravity);
    assert_true(model_finish(m, false, &e));
    struct forward_report report;
    assert_true(exact()->forward(m, s.state, FORWARD_CFA_DIRECT, s.a, y, NULL, &report, NULL));
    assert_int_equal(report.rank, 2);
    assert_true(relative_error(3, x, y) < 1e-12);
    scene_end(&s);
}

/* Two planar arms of three links from the grounds at -1.8 and 1.8, the second one mirrored and of
 * its own mass; joined at their tips when `closed`. */
static struct model *two_arms(struct arena *a, double second_mass, bool closed)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < 6; i++) {
        double side = i < 3 ? 1 : -1, mass = i < 3 ? 1 : second_mass;
        struct body_def b = {.name = "link",
                             .parent = i % 3 == 0 ? -1 : i - 1,
                             .joint = JOINT_REVOLUTE,
                             .axis = {0, 0, side},
                             .mass = mass,
                             .com = {0.5 * side},
                             .inertia = {0.01 * mass, 0, 0, 0.1 * mass, 0, 0.1 * mass}};
        b.placement.p[0] = i % 3 == 0 ? -1.8 * side : side;
        assert_true(model_add_body(m, &b, &e) >= 0);
    }
    struct loop_def l = {
        .name = "grasp", .body_a = 2, .body_b = 5, .nrow = 2, .row = {{1}, {0, 1}}};
    l.frame_a.p[0] = 1, l.frame_b.p[0] = -1;
    if (closed) assert_true(model_add_loop(m, &l, &e) >= 0);
    m->gravity[1] = -9.81;
    assert_true(model_finish(m, false, &e));
    return m;
}

/* J (2 x 3) of the tip of an arm whose joints stand at q: axis x (tip - joint). */
static void tip_jacobian(double side, const double *q, double jacobian[2][3])
{
    double x[4], y[4], angle = 0;
    x[0] = -1.8 * side, y[0] = 0;
    for (int k = 0; k < 3; k++) {
        angle += side * q[k];
        x[k + 1] = x[k] + side * cos(angle), y[k + 1] = y[k] + side * sin(angle);
    }
    for (int k = 0; k < 3; k++) {
        jacobian[0][k] = -side * (y[3] - y[k]);
        jacobian[1][k] = side * (x[3] - x[k]);
    }
}

/* x (3) = M^-1 y for the arm's 3x3 block at `at` of mass (6 x 6), by Cramer's rule. */
static void block_solve(const double *mass, int at, const double y[3], double x[3])
{
    const double *r[3] = {mass + 6 * at + at, mass + 6 * (at + 1) + at, mass + 6 * (at + 2) + at};
    double det = 0, c[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[i][j] = r[(i + 1) % 3][(j + 1) % 3] * r[(i + 2) % 3][(j + 2) % 3] -
                      r[(i + 1) % 3][(j + 2) % 3] * r[(i + 2) % 3][(j + 1) % 3];
    for (int j = 0; j < 3; j++) det += r[0][j] * c[0][j];
    for (int j = 0; j < 3; j++) x[j] = (c[0][j] * y[0] + c[1][j] * y[1] + c[2][j] * y[2]) / det;
}

/* One arm by itself: a += J qdd of the free arm (2), L (2 x 2) += J M^-1 J^T. */
static void arm_alone(double side, const double *q, const double *mass, int at,
                      const double *free_qdd, double a[2], double L[2][2])
{
    double J[2][3], x[3];
    tip_jacobian(side, q, J);
    for (int i = 0; i < 2; i++) {
        a[i] = J[i][0] * free_qdd[0] + J[i][1] * free_qdd[1] + J[i][2] * free_qdd[2];
        block_solve(mass, at, J[i], x);
        for (int j = 0; j < 2; j++) L[i][j] += J[j][0] * x[0] + J[j][1] * x[1] + J[j][2] * x[2];
    }
}

/* Two chains joined at their tips: the force on the second one is f = (L1 + L2)^-1 (a1 - a2) with
 * the operational L_i = J_i M_i^-1 J_i^T and a_i of the open chains: the sum, as the difference of
 * mirrored arms would be singular. */
static void two_arms_share_the_load_at_their_tips(void **state)
{
    (void)state;
    for (int variant = 0; variant < 2; variant++) {
        struct arena *a = arena_create();
        const double q[3] = {0.9, -0.6, -0.5}, angle = q[0] + q[1] + q[2];
        struct model *m = two_arms(a, variant ? 1.7 : 1, true),
                     *open = two_arms(a, variant ? 1.7 : 1, false);
        struct state *s = state_take(m, a);
        for (int k = 0; k < 3; k++) s->q[k] = s->q[3 + k] = q[k];
        s->tau[0] = 3, s->tau[3] = 3 + variant;
        double x[6], lambda[2], free_qdd[6], mass[36], a1[2], a2[2], L[2][2] = {{0}};
        struct work w = {0};
        assert_true(exact()->forward(open, s, FORWARD_ABA, a, free_qdd, NULL, NULL, NULL));
        exact()->mass_matrix(open, s, a, mass, &w);
        arm_alone(1, q, mass, 0, free_qdd, a1, L);
        arm_alone(-1, q, mass, 3, free_qdd + 3, a2, L);
        double dx = a1[0] - a2[0], dy = a1[1] - a2[1], det = L[0][0] * L[1][1] - L[0][1] * L[1][0];
        double fx = (L[1][1] * dx - L[0][1] * dy) / det, fy = (L[0][0] * dy - L[1][0] * dx) / det;
        /* lambda is in the axes of the first arm's tip */
        for (int method = 0; method < FORWARD_METHODS; method++) {
            assert_true(
                exact()->forward(m, s, (enum forward_method)method, a, x, lambda, NULL, NULL));
            assert_near(lambda[0], cos(angle) * fx + sin(angle) * fy, 1e-9);
            assert_near(lambda[1], cos(angle) * fy - sin(angle) * fx, 1e-9);
            for (int k = 0; variant == 0 && k < 3; k++) assert_near(x[k], x[3 + k], 1e-9);
        }
        assert_true(fabs(fx) > 0.1);
        arena_destroy(a);
    }
}

/* Energy of a free four-bar: loop forces do no work; drift small, stabilisation and projection
 * smaller. */
static void loops_do_no_work_and_drift_is_mended(void **state)
{
    (void)state;
    double drift[3];
    for (int way = 0; way < 3; way++) {
        struct scene s = four_bar();
        struct dynamics_totals before, after;
        memset(s.state->tau, 0, 3 * sizeof(double));
        if (way == 1) s.model->loop[0].alpha = s.model->loop[0].beta = 50;
        exact()->totals(s.model, s.state, s.a, &before);
        for (int k = 0; k < 200; k++) {
            assert_true(exact()->advance(s.model, s.state, STEP_RK4, 5e-3, 1, s.a, NULL));
            struct arena_mark mark = arena_mark(s.a);
            if (way == 2)
                assert_true(
                    loop_project(dynamics_take(s.model, s.a), s.state->q, s.state->qd, 1, NULL));
            arena_release(s.a, mark);
        }
        exact()->totals(s.model, s.state, s.a, &after);
        double velocity;
        exact()->drift(s.model, s.state, s.a, &drift[way], &velocity);
        double e0 = before.kinetic + before.potential, e1 = after.kinetic + after.potential;
        assert_true(fabs(e1 - e0) < 1e-6 * (fabs(before.kinetic) + fabs(before.potential)));
        scene_end(&s);
    }
    assert_true(drift[0] < 1e-6);
    assert_true(drift[1] < 0.1 * drift[0]);
    assert_true(drift[2] < 1e-13);
}

/* Rings close at q = 0 and start with velocities that the loop allows, whatever the joints and the
 * base. */
static void rings_start_consistent(void **state)
{
    (void)state;
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_CYLINDRICAL,
                                             JOINT_UNIVERSAL};
    for (int j = 0; j < 4; j++)
        for (int n = 3; n < 12; n += 4)
            for (int floating = 0; floating < 2; floating++) {
                struct model_spec spec = spec_random(MODEL_RING, n, joint[j], 6);
                spec.base = floating ? BASE_FLOATING : BASE_FIXED;
                struct scene s = scene_of(&spec);
                double position, velocity;
                exact()->drift(s.model, s.state, s.a, &position, &velocity);
                assert_true(position < 1e-14 && velocity < 1e-12);
                scene_end(&s);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bordered_system_agrees_with_articulated_bodies),
        cmocka_unit_test(constraint_velocity_keeps_its_value),
        cmocka_unit_test(a_four_bar_has_three_redundant_constraints),
        cmocka_unit_test(a_parallelogram_keeps_its_shape),
        cmocka_unit_test(in_plane_rows_replace_the_revolute_joint),
        cmocka_unit_test(two_arms_share_the_load_at_their_tips),
        cmocka_unit_test(loops_do_no_work_and_drift_is_mended),
        cmocka_unit_test(rings_start_consistent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
