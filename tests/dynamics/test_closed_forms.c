/* test_closed_forms.c - systems whose motion textbooks give: pendulums, the falling rod, the top,
 * the hanging chain. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "scene.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static const double gravity = 9.81;

/* Rod along x on a joint about z, gravity along -y. */
static struct body_def rod(int parent, double length, double mass)
{
    struct body_def b = {.name = "rod",
                         .parent = parent,
                         .joint = JOINT_REVOLUTE,
                         .axis = {0, 0, 1},
                         .mass = mass,
                         .com = {0.5 * length},
                         .inertia = {0.01 * mass, 0, 0, mass * length * length / 12, 0,
                                     mass * length * length / 12}};
    b.placement.p[0] = parent >= 0 ? length : 0;
    return b;
}

static struct model *model_of(const struct body_def *body, int n, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    for (int i = 0; i < n; i++) assert_true(model_add_body(m, &body[i], &e) >= 0);
    m->gravity[1] = -gravity;
    assert_true(model_finish(m, false, &e));
    return m;
}

static void forward_by(const struct model *m, const struct state *s, enum forward_method method,
                       struct arena *a, double *qdd)
{
    assert_true(
        dynamics_type_of(PRECISION_DOUBLE)->forward(m, s, method, a, qdd, NULL, NULL, NULL));
}

/* m g l cos(q) / (J + m l^2), q from the horizontal. */
static void physical_pendulum(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct body_def b = rod(-1, 1.4, 2.5);
    b.inertia[3] = 0.3, b.inertia[5] = 0.29, b.com[0] = 0.6;
    struct model *m = model_of(&b, 1, a);
    struct state *s = state_take(m, a);
    for (double q = -3; q < 3; q += 0.37)
        for (int method = 0; method < FORWARD_METHODS; method++) {
            double qdd;
            s->q[0] = q, s->qd[0] = 2;
            forward_by(m, s, (enum forward_method)method, a, &qdd);
            assert_near(qdd, -2.5 * gravity * 0.6 * cos(q) / (0.29 + 2.5 * 0.36), 1e-13);
        }
    arena_destroy(a);
}

static void a_horizontal_rod_released_falls_with_3g_over_2l(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct body_def b = rod(-1, 1.7, 3);
    struct model *m = model_of(&b, 1, a);
    double qdd;
    forward_by(m, state_take(m, a), FORWARD_CFA_DIRECT, a, &qdd);
    assert_near(qdd, -3 * gravity / (2 * 1.7), 1e-14);
    arena_destroy(a);
}

/* Two uniform rods, from Lagrange's equations with absolute angles a, b from the horizontal:
 *   (m/3 + m) L^2 a'' + m L^2 / 2 cos(a-b) b'' = - m L^2 / 2 sin(a-b) b'^2 - 3/2 m g L cos a
 *   m L^2 / 3 b'' + m L^2 / 2 cos(a-b) a'' =   m L^2 / 2 sin(a-b) a'^2 - m g L / 2 cos b */
static void planar_double_pendulum(void **state)
{
    (void)state;
    const double m = 1.3, L = 0.8, A = 0.4, B = -1.1, wa = 1.7, wb = -2.2;
    struct arena *a = arena_create();
    struct body_def b[2] = {rod(-1, L, m), rod(0, L, m)};
    struct model *model = model_of(b, 2, a);
    struct state *s = state_take(model, a);
    s->q[0] = A, s->q[1] = B - A, s->qd[0] = wa, s->qd[1] = wb - wa;
    double m11 = 4.0 / 3 * m * L * L, m12 = 0.5 * m * L * L * cos(A - B), m22 = m * L * L / 3;
    double f1 = -0.5 * m * L * L * sin(A - B) * wb * wb - 1.5 * m * gravity * L * cos(A);
    double f2 = 0.5 * m * L * L * sin(A - B) * wa * wa - 0.5 * m * gravity * L * cos(B);
    double det = m11 * m22 - m12 * m12, aa = (m22 * f1 - m12 * f2) / det,
           bb = (m11 * f2 - m12 * f1) / det;
    for (int method = 0; method < FORWARD_METHODS; method++) {
        double qdd[2];
        forward_by(model, s, (enum forward_method)method, a, qdd);
        assert_near(qdd[0], aa, 1e-12);
        assert_near(qdd[1], bb - aa, 1e-12);
    }
    arena_destroy(a);
}

/* A free body without torque: J w' = - w x J w about its centre, which falls with g. */
static void torque_free_top(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct body_def b = {.name = "top", .parent = -1, .joint = JOINT_FLOATING, .mass = 2,
                         .inertia = {0.3, 0, 0, 0.4, 0, 0.55}};
    struct model *m = model_of(&b, 1, a);
    struct state *s = state_take(m, a);
    const double w[3] = {1.1, -2.3, 0.7};
    memcpy(s->qd + 3, w, sizeof w);
    for (int method = 0; method < FORWARD_METHODS; method++) {
        double qdd[6];
        forward_by(m, s, (enum forward_method)method, a, qdd);
        assert_near(qdd[3], (0.4 - 0.55) * w[1] * w[2] / 0.3, 1e-14);
        assert_near(qdd[4], (0.55 - 0.3) * w[2] * w[0] / 0.4, 1e-14);
        assert_near(qdd[5], (0.3 - 0.4) * w[0] * w[1] / 0.55, 1e-14);
        assert_near(qdd[1], -gravity, 1e-14);
        assert_near(qdd[0], 0, 1e-14);
    }
    arena_destroy(a);
}

static void a_chain_hanging_at_rest_stays_and_carries_the_weight_below(void **state)
{
    (void)state;
    enum { N = 12 };
    struct arena *a = arena_create();
    struct body_def b[N];
    for (int i = 0; i < N; i++) b[i] = rod(i - 1, 1, 1 + i);
    struct model *m = model_of(b, N, a);
    struct state *s = state_take(m, a);
    double x[N];
    s->q[0] = -asin(1); /* down */
    for (int method = 0; method < FORWARD_METHODS; method++) {
        forward_by(m, s, (enum forward_method)method, a, x);
        for (int i = 0; i < N; i++) assert_near(x[i], 0, 1e-11);
    }
    dynamics_type_of(PRECISION_DOUBLE)->inverse(m, s, a, x, NULL);
    for (int i = 0; i < N; i++) assert_near(x[i], 0, 1e-12);
    /* the same chain on prismatic joints along x, which now is up: each carries everything outwards
     * of it */
    for (int i = 0; i < N; i++) b[i].joint = JOINT_PRISMATIC, b[i].axis[0] = 1, b[i].axis[2] = 0;
    m = model_of(b, N, a);
    m->gravity[1] = 0, m->gravity[0] = -gravity;
    dynamics_type_of(PRECISION_DOUBLE)->inverse(m, state_take(m, a), a, x, NULL);
    double weight = 0;
    for (int i = N - 1; i >= 0; i--) assert_near(x[i], weight += (1 + i) * gravity, 1e-11);
    arena_destroy(a);
}

/* A screw under its weight: (J + m p^2) q'' = - m g p; in the unit-length velocity u = s q'. */
static void a_helical_joint_trades_turn_for_advance(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const double pitch = 0.2, s = sqrt(1 + pitch * pitch);
    struct body_def b = {.name = "screw",
                         .parent = -1,
                         .joint = JOINT_HELICAL,
                         .axis = {0, 1, 0},
                         .pitch = pitch,
                         .mass = 3,
                         .inertia = {0.3, 0, 0, 0.4, 0, 0.3}};
    struct model *m = model_of(&b, 1, a);
    for (int method = 0; method < FORWARD_METHODS; method++) {
        double x;
        forward_by(m, state_take(m, a), (enum forward_method)method, a, &x);
        assert_near(x / s, -3 * gravity * pitch / (0.4 + 3 * pitch * pitch), 1e-14);
    }
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(physical_pendulum),
        cmocka_unit_test(a_horizontal_rod_released_falls_with_3g_over_2l),
        cmocka_unit_test(planar_double_pendulum),
        cmocka_unit_test(torque_free_top),
        cmocka_unit_test(a_chain_hanging_at_rest_stays_and_carries_the_weight_below),
        cmocka_unit_test(a_helical_joint_trades_turn_for_advance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
