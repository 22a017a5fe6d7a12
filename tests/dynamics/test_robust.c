/* test_robust.c - the robust way where constraint forces converge to a wrong answer; trajectories
 * against closed forms and against themselves; loops and bases that leave the plane. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "dynamics/dynamics.h"
#include "dynamics/dynamics_table.h"
#include "dynamics/planar.h"
#include "dynamics/trajectory.h"
#include "scene.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

/* --- the robust way --- */

/* A chain in which every other body is 10^-ratio times as heavy. */
static struct scene uneven(int n, int ratio, uint64_t seed)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, seed);
    struct scene s = scene_of(&spec);
    for (int i = 0; i < n; i += 2) {
        s.model->body[i].mass *= pow(10, -ratio);
        for (int k = 0; k < 6; k++) s.model->body[i].inertia[k] *= pow(10, -ratio);
    }
    s.model->constants = NULL; /* they were made of the masses before */
    return s;
}

enum { LONGEST = 24 };

/* What the constraint forces alone answer with all refinements; false: they broke down. */
static bool by_forces(const struct scene *s, double *ud, struct cfa_report *report)
{
    const struct cfa_options all = {.direct = true, .inner = 1, .outer = 12};
    struct work w = {0};
    struct dynamics *d = dynamics_take(s->model, s->a);
    dynamics_load(d, s->state);
    return cfa(d, s->state->q, s->state->qd, s->state->tau, &all, ud, NULL, report, &w);
}

/* Constraint forces whose refinements went on, and even shrank, but ended at a wrong answer: only
 * the size of the last correction tells. The robust way must see it and begin anew. */
static void an_answer_whose_corrections_stay_large_is_not_taken(void **state)
{
    (void)state;
    static const struct {
        int n, ratio;
        uint64_t seed;
    } row[] = {{2, 14, 5},  {2, 15, 1},  {2, 15, 2},  {4, 14, 4},  {4, 14, 5},  {5, 15, 4},
               {6, 14, 2},  {6, 14, 4},  {12, 13, 4}, {12, 14, 1}, {12, 14, 2}, {24, 12, 1},
               {24, 12, 3}, {24, 12, 4}, {24, 13, 1}, {24, 13, 2}, {24, 13, 5}};
    int wrong = 0, slightly = 0;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct scene s = uneven(row[k].n, row[k].ratio, row[k].seed);
        double reference[LONGEST], qdd[LONGEST], forces[LONGEST];
        struct forward_report report;
        struct cfa_report alone = {0};
        struct work w = {0};
        assert_true(dynamics_type_of(PRECISION_QUAD)
                        ->forward(s.model, s.state, FORWARD_ABA, s.a, reference, NULL, NULL, &w));
        const bool good = by_forces(&s, forces, &alone);
        const double error = good ? relative_error(row[k].n, forces, reference) : 0;
        assert_true(
            dynamics_type_of(PRECISION_DOUBLE)
                ->forward(s.model, s.state, FORWARD_CFA_ROBUST, s.a, qdd, NULL, &report, &w));
        assert_true(relative_error(row[k].n, qdd, reference) < 1e-14);
        /* corrections tell the error: within two decades above what the answer lacks */
        if (good) assert_true(alone.correction > 0.03 * error);
        if (good && error > 1e-11) assert_true(report.fell_back);
        assert_true(report.refined > 0);
        wrong += good && error > 1e-9;
        slightly += good && error > 1e-11 && error < 1e-9;
        scene_end(&s);
    }
    /* or the scenes no longer ask the question */
    assert_true(wrong >= 8);
    assert_true(slightly >= 1);
}

/* Where they have all digits they are kept, and the report counts what was done. */
static void an_answer_with_all_digits_is_kept(void **state)
{
    (void)state;
    for (int n = 1; n <= 13; n += 4) {
        struct scene s = uneven(n, 3, (uint64_t)n);
        double robust[LONGEST], forces[LONGEST];
        struct forward_report report;
        struct cfa_report alone = {0};
        struct work w = {0};
        assert_true(by_forces(&s, forces, &alone));
        assert_true(
            dynamics_type_of(PRECISION_DOUBLE)
                ->forward(s.model, s.state, FORWARD_CFA_ROBUST, s.a, robust, NULL, &report, &w));
        assert_false(report.fell_back);
        assert_memory_equal(robust, forces, sizeof *robust * (size_t)n);
        assert_int_equal(report.refined, alone.inner_done + alone.outer_done);
        assert_true(alone.correction <= 1e-12);
        assert_true(report.residual == alone.residual);
        scene_end(&s);
    }
}

/* --- trajectories --- */

/* One body of mass 2 on a slide along x, with a spring if asked for. */
static struct scene slider(double stiffness, double damping)
{
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    s.model = model_begin(s.a, NULL);
    const struct body_def b = {.name = "slider",
                               .parent = -1,
                               .joint = JOINT_PRISMATIC,
                               .axis = {1, 0, 0},
                               .placement.quat = {0, 0, 0, 1},
                               .mass = 2,
                               .inertia = {1, 0, 0, 1, 0, 1},
                               .stiffness = stiffness,
                               .damping = damping,
                               .rest = 0.25};
    assert_true(model_add_body(s.model, &b, &e) >= 0);
    if (!model_finish(s.model, false, &e)) fail_msg("%s", e.text);
    s.state = state_take(s.model, s.a);
    return s;
}

/* x = x0 + v t + F t^2 / 2 m: exact for every method of second order; of first order it lacks half
 * a step's change. */
static void a_constant_force_gives_a_parabola(void **state)
{
    (void)state;
    for (const char *const *name = trajectory_steppers(); *name; name++) {
        struct scene s = slider(0, 0);
        struct err e;
        err_clear(&e);
        s.state->q[0] = 1, s.state->qd[0] = -3, s.state->tau[0] = 8;
        const struct trajectory_options o = {.stepper = *name, .tolerance = 1e-10};
        struct trajectory_report report;
        if (!trajectory_advance(s.model, s.state, 0.5, &o, s.a, &report, &e))
            fail_msg("%s", e.text);
        const double allowed = strcmp(*name, "rk1imp") == 0 ? 1e-4 : 1e-8;
        assert_near(s.state->qd[0], -3 + 4 * 0.5, allowed);
        assert_near(s.state->q[0], 1 - 3 * 0.5 + 2 * 0.25, allowed);
        assert_true(report.steps > 0 && report.evaluations >= report.steps);
        scene_end(&s);
    }
}

/* x - rest = A exp(-d t) cos(w t + phase), with d = c / 2 m and w^2 = k / m - d^2. */
static void a_damped_spring_follows_its_closed_form(void **state)
{
    (void)state;
    struct scene s = slider(50, 3);
    struct err e;
    err_clear(&e);
    const double d = 3.0 / 4, w = sqrt(25 - d * d), T = 1.7;
    s.state->q[0] = 1.25, s.state->qd[0] = 0.5;
    const struct trajectory_options o = {.stepper = "rk8pd", .tolerance = 1e-12};
    assert_true(trajectory_advance(s.model, s.state, T, &o, s.a, NULL, &e));
    const double b = (0.5 + d) / w; /* x - rest = exp(-d t) (cos w t + b sin w t) */
    const double x = exp(-d * T) * (cos(w * T) + b * sin(w * T));
    const double v =
        exp(-d * T) * (w * (b * cos(w * T) - sin(w * T)) - d * (cos(w * T) + b * sin(w * T)));
    assert_near(s.state->q[0] - 0.25, x, 1e-10);
    assert_near(s.state->qd[0], v, 1e-9);
    scene_end(&s);
}

/* Fixed steps: so many, with so many evaluations each; and two halves are the whole, to the bit,
 * when the steps are the same. */
static void fixed_steps_are_counted_and_can_be_split(void **state)
{
    (void)state;
    static const char *const stepper[] = {"rk2", "rk4", "rkf45", "rkck", "rk8pd"};
    for (size_t k = 0; k < sizeof stepper / sizeof *stepper; k++) {
        struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 3, JOINT_REVOLUTE, 9);
        struct scene s = scene_of(&spec), t = scene_of(&spec);
        struct err e;
        err_clear(&e);
        struct trajectory_options o = {.stepper = stepper[k], .tolerance = 1e-9, .fixed_steps = 16};
        struct trajectory_report whole, half;
        assert_true(trajectory_advance(s.model, s.state, 0.25, &o, s.a, &whole, &e));
        assert_int_equal(whole.steps, 16);
        o.fixed_steps = 8;
        for (int part = 0; part < 2; part++) {
            assert_true(trajectory_advance(t.model, t.state, 0.125, &o, t.a, &half, &e));
            assert_int_equal(half.steps, 8);
            assert_int_equal(2 * half.evaluations, whole.evaluations);
        }
        assert_true(relative_error(3, t.state->q, s.state->q) < 1e-13);
        assert_true(relative_error(3, t.state->qd, s.state->qd) < 1e-13);
        scene_end(&s), scene_end(&t);
    }
}

/* Without friction time can be turned round: after negating all rates the system goes back to where
 * it came from. */
static void time_can_be_turned_round(void **state)
{
    (void)state;
    static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_FLOATING,
                                              JOINT_MIXED};
    for (size_t k = 0; k < sizeof joints / sizeof *joints; k++) {
        struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 3, joints[k], 21 + k);
        spec.external_force = spec.torque = 0;
        struct scene s = scene_of(&spec);
        const int nq = s.model->nq, nu = s.model->nu;
        double q[64], u[64];
        struct err e;
        err_clear(&e);
        memcpy(q, s.state->q, sizeof *q * (size_t)nq);
        memcpy(u, s.state->qd, sizeof *u * (size_t)nu);
        const struct trajectory_options o = {.stepper = "rk8pd", .tolerance = 1e-12};
        for (int way = 0; way < 2; way++) {
            if (!trajectory_advance(s.model, s.state, 0.2, &o, s.a, NULL, &e))
                fail_msg("%s", e.text);
            assert_true(way == 1 || relative_error(nq, s.state->q, q) > 1e-3);
            for (int i = 0; i < nu; i++) s.state->qd[i] = -s.state->qd[i];
            /* quaternions come back with unit length */
            for (int i = 0; i < s.model->nbody; i++) {
                const int first = joint_quaternion(s.model->body[i].joint);
                if (first < 0) continue;
                const double *c = s.state->q + s.model->q_at[i] + first;
                assert_near(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3], 1, 1e-15);
            }
        }
        assert_true(relative_error(nq, s.state->q, q) < 1e-9);
        assert_true(relative_error(nu, s.state->qd, u) < 1e-8);
        scene_end(&s);
    }
}

/* What fails leaves the state as it was, to the bit, and says why. */
static void a_trajectory_that_fails_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *stepper, *said;
        double tau, tolerance, duration;
        long fixed, most;
        enum err_kind kind;
    } row[] = {
        {"rk44", "rk4", 1, 1e-6, 1, 0, 0, ERR_USAGE},
        {"", "no integrator ''", 1, 1e-6, 1, 0, 0, ERR_USAGE},
        {"rk4", "duration", 1, 1e-6, -0.0, 0, 0, ERR_CHECK},
        {"rkck", "within 7 evaluations", 1, 1e-12, 1, 0, 7, ERR_CHECK},
        {"rk4", "within 7 evaluations", 1, 1e-6, 1, 100, 7, ERR_CHECK},
        {"rk4", "not a finite number", 1e308, 1e-6, 1e9, 3, 0, ERR_CHECK},
        {"rkf45", "", INFINITY, 1e-6, 1, 0, 2000, ERR_CHECK},
        {"msbdf", "", NAN, 1e-6, 1, 0, 2000, ERR_CHECK},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct scene s = slider(10, 0);
        struct err e;
        err_clear(&e);
        s.state->q[0] = 0.7, s.state->qd[0] = -0.3, s.state->tau[0] = row[k].tau;
        const struct trajectory_options o = {.stepper = row[k].stepper,
                                             .tolerance = row[k].tolerance,
                                             .fixed_steps = row[k].fixed,
                                             .most_evaluations = row[k].most};
        if (trajectory_advance(s.model, s.state, row[k].duration, &o, s.a, NULL, &e))
            fail_msg("row %d went through", (int)k);
        assert_int_equal(e.kind, row[k].kind);
        if (!strstr(e.text, row[k].said)) fail_msg("row %d: %s", (int)k, e.text);
        assert_true(s.state->q[0] == 0.7 && s.state->qd[0] == -0.3);
        scene_end(&s);
    }
}

/* As many evaluations as are allowed are enough; one less is not. */
static void the_last_allowed_evaluation_is_made(void **state)
{
    (void)state;
    struct trajectory_options o = {.stepper = "rkf45", .tolerance = 1e-8};
    struct trajectory_report report;
    for (int pass = 0; pass < 3; pass++) {
        struct scene s = slider(40, 0.1);
        struct err e;
        err_clear(&e);
        s.state->q[0] = 1;
        /* pass 0 counts them */
        const long needed = pass > 0 ? report.evaluations : 0;
        o.most_evaluations = pass == 2 ? needed - 1 : needed;
        assert_int_equal(trajectory_advance(s.model, s.state, 1, &o, s.a, &report, &e), pass < 2);
        assert_true(pass == 0 || report.evaluations == needed);
        assert_true(pass < 2 ? report.steps > 0 : report.steps == 0);
        if (pass == 2) report.evaluations = needed;
        scene_end(&s);
    }
}

/* --- what leaves the plane --- */

/* A frame turned by `angle` about x, y or z (0, 1, 2). */
static struct frame turned(int axis, double angle)
{
    struct frame f = {.quat = {0, 0, 0, cos(angle / 2)}};
    f.quat[axis] = sin(angle / 2);
    return f;
}

/* Two links on revolute joints about z, and a loop from the base to the last one. */
static struct model *closed_pair(struct arena *a, const struct loop_def *loop)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < 2; i++) {
        struct body_def b = {.name = "link",
                             .parent = i - 1,
                             .joint = JOINT_REVOLUTE,
                             .axis = {0, 0, 1},
                             .placement = {{0, 0, 0, 1}, {i, 0, 0}},
                             .mass = 1,
                             .inertia = {1, 0, 0, 1, 0, 1}};
        assert_true(model_add_body(m, &b, &e) >= 0);
    }
    if (model_add_loop(m, loop, &e) < 0 || !model_finish(m, true, &e)) fail_msg("%s", e.text);
    return m;
}

static void loops_that_leave_the_plane_are_named(void **state)
{
    (void)state;
    const double half = 1.5707963267948966;
    static const double tiny = 1e-13, small = 1e-9;
    const struct {
        enum model_joint joint;
        struct frame a, b;
        enum precision precision;
        bool planar;
    } row[] = {
        {JOINT_REVOLUTE, turned(0, 0), turned(0, 0), PRECISION_QUAD, true},
        /* turned about the normal, each by its own angle */
        {JOINT_REVOLUTE, turned(2, 0.3), turned(2, -1.1), PRECISION_DOUBLE, true},
        /* both tilted alike: the loop's z is in the plane, but both sides see one normal */
        {JOINT_REVOLUTE, turned(0, half), turned(0, half), PRECISION_DOUBLE, true},
        {JOINT_PRISMATIC, turned(1, half), turned(1, half), PRECISION_DOUBLE, true},
        {JOINT_SPHERICAL, turned(0, 0), turned(0, 0), PRECISION_DOUBLE, true},
        {JOINT_CYLINDRICAL, turned(0, 0), turned(2, 1), PRECISION_DOUBLE, true},
        {JOINT_PLANAR, turned(0, 0), turned(0, 0), PRECISION_DOUBLE, true},
        {JOINT_FIXED, turned(2, 1), turned(2, 1), PRECISION_DOUBLE, true},
        /* one side tilted: by a right angle, a little, upside down */
        {JOINT_REVOLUTE, turned(0, 0), turned(0, half), PRECISION_DOUBLE, false},
        {JOINT_REVOLUTE, turned(1, small), turned(0, 0), PRECISION_DOUBLE, false},
        {JOINT_REVOLUTE, turned(0, 0), turned(0, 2 * half), PRECISION_DOUBLE, false},
        {JOINT_FIXED, turned(1, half), turned(0, half), PRECISION_FLOAT, false},
        {JOINT_SPHERICAL, turned(0, small), turned(0, 0), PRECISION_FLOAT, false},
        /* rounding of a file's numbers: nothing in double, but something in quad precision */
        {JOINT_REVOLUTE, turned(0, tiny), turned(0, 0), PRECISION_DOUBLE, true},
        {JOINT_REVOLUTE, turned(0, tiny), turned(0, 0), PRECISION_QUAD, false},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        const struct loop_def loop = {.name = "ring",
                                      .body_a = k % 2 ? 1 : -1,
                                      .body_b = k % 2 ? -1 : 1,
                                      .joint = row[k].joint,
                                      .frame_a = row[k].a,
                                      .frame_b = row[k].b};
        const bool planar = planar_scene(closed_pair(a, &loop), NULL, row[k].precision, &e);
        if (planar != row[k].planar) fail_msg("row %d: %d %s", (int)k, planar, e.text);
        if (!planar) {
            assert_int_equal(e.kind, ERR_CONFIG);
            assert_non_null(strstr(e.text, "loop 'ring' leaves the plane"));
        }
        arena_destroy(a);
    }
}

/* Rows say themselves what they bind, so that any joint type may stand beside them. */
static void loops_of_rows_need_only_the_same_normal(void **state)
{
    (void)state;
    for (int tilted = 0; tilted < 2; tilted++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        struct loop_def loop = {
            .name = "rows", .body_a = 0, .body_b = 1, .nrow = 2, .joint = JOINT_SLOT};
        loop.frame_a = turned(0, 0), loop.frame_b = turned(1, tilted ? 0.5 : 0);
        loop.row[0][0] = loop.row[1][1] = 1;
        assert_int_equal(planar_scene(closed_pair(a, &loop), NULL, PRECISION_DOUBLE, &e), !tilted);
        arena_destroy(a);
    }
}

static void slides_alone_find_their_normal_and_bases_may_tilt_it(void **state)
{
    (void)state;
    static const struct {
        double axis[3][3];
        double base[6];
        bool planar;
    } row[] = {
        {{{1, 0, 0}, {1, 0, 0}, {-2, 0, 0}}, {0}, true}, /* one direction: any normal will do */
        {{{1, 0, 0}, {1, 1, 0}, {0, -3, 0}}, {0, 0, 0, 1, 2, 3}, true},
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, false},
        {{{1, 0, 0}, {1, 1, 0}, {0, 1, 1e-9}}, {0}, false},
        {{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 0, -4, 0, 0, 0}, true},
        {{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1e-6, -4, 0, 0, 0}, false},
        {{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {1e-300, 0, 0, 0, 0, 0}, false},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        struct model *m = model_begin(a, NULL);
        for (int i = 0; i < 3; i++) {
            struct body_def b = {.parent = i - 1,
                                 .joint = JOINT_PRISMATIC,
                                 .placement.quat = {0, 0, 0, 1},
                                 .mass = 1,
                                 .inertia = {1, 0, 0, 1, 0, 1}};
            snprintf(b.name, sizeof b.name, "slide%d", i);
            memcpy(b.axis, row[k].axis[i], sizeof b.axis);
            assert_true(model_add_body(m, &b, &e) >= 0);
        }
        if (!model_finish(m, false, &e)) fail_msg("%s", e.text);
        struct state *s = state_take(m, a);
        memcpy(s->base_acceleration, row[k].base, sizeof row[k].base);
        const bool planar = planar_scene(m, s, PRECISION_DOUBLE, &e);
        if (planar != row[k].planar) fail_msg("row %d: %s", (int)k, e.text);
        if (!planar)
            assert_non_null(strstr(e.text, k < 4 ? "the prismatic joint of 'slide2'"
                                                 : "base rotates out of the plane"));
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_answer_whose_corrections_stay_large_is_not_taken),
        cmocka_unit_test(an_answer_with_all_digits_is_kept),
        cmocka_unit_test(a_constant_force_gives_a_parabola),
        cmocka_unit_test(a_damped_spring_follows_its_closed_form),
        cmocka_unit_test(fixed_steps_are_counted_and_can_be_split),
        cmocka_unit_test(time_can_be_turned_round),
        cmocka_unit_test(a_trajectory_that_fails_changes_nothing),
        cmocka_unit_test(the_last_allowed_evaluation_is_made),
        cmocka_unit_test(loops_that_leave_the_plane_are_named),
        cmocka_unit_test(loops_of_rows_need_only_the_same_normal),
        cmocka_unit_test(slides_alone_find_their_normal_and_bases_may_tilt_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
