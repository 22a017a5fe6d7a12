/* test_generator.c - generated models against what their words promise: shapes, masses, units, and
 * the same numbers for the same seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "linalg/angle.h"
#include "model/generator.h"

static const double PI = 3.14159265358979323846;

/* Links of a metre and a kilogram, revolute and twisted. */
static struct model_spec usual(enum model_generator generator, int n)
{
    return (struct model_spec){.generator = generator,
                               .nbody = n,
                               .joint = JOINT_REVOLUTE,
                               .axes = AXES_TWISTED,
                               .length = 1,
                               .radius = 0.05,
                               .mass = 1,
                               .mass_ratio = 1,
                               .gravity = {0, 0, -9.81},
                               .branch = 2,
                               .seed = 1};
}

static struct model *made(const struct model_spec *spec, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct model *m = generator_model(spec, a, &e);
    if (!m) fail_msg("%s", e.text);
    return m;
}

/* The rotation of a quaternion x y z w, of any length, on a vector: v + 2 q x (q x v + w v) / |q|^2
 * (Rodrigues). */
static void turn(const double q[4], const double v[3], double out[3])
{
    const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    double t[3];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        t[k] = q[i] * v[j] - q[j] * v[i] + q[3] * v[k];
    }
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = v[k] + 2 * (q[i] * t[j] - q[j] * t[i]) / n;
    }
}

/* Where a point of body i is in the base frame at q = 0. */
static void to_base(const struct model *m, int i, double p[3])
{
    for (; i >= 0; i = m->body[i].parent) {
        double turned[3];
        turn(m->body[i].placement.quat, p, turned);
        for (int k = 0; k < 3; k++) p[k] = turned[k] + m->body[i].placement.p[k];
    }
}

/* --- shapes --- */

static void parents_are_those_of_the_generator(void **state)
{
    (void)state;
    static const struct {
        enum model_generator generator;
        int branch, parent[9];
    } shapes[] = {
        {MODEL_SERIAL_CHAIN, 2, {-1, 0, 1, 2, 3, 4, 5, 6, 7}},
        {MODEL_STAR, 2, {-1, 0, 0, 0, 0, 0, 0, 0, 0}},
        {MODEL_COMB, 3, {-1, 0, 0, 0, 3, 3, 3, 6, 6}},
        {MODEL_DENDRIMER, 2, {-1, 0, 0, 1, 1, 2, 2, 3, 3}},
        {MODEL_DENDRIMER, 3, {-1, 0, 0, 0, 1, 1, 1, 2, 2}},
    };
    struct arena *a = arena_create();
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        struct model_spec spec = usual(shapes[s].generator, 9);
        spec.branch = shapes[s].branch;
        const struct model *m = made(&spec, a);
        assert_int_equal(m->nbody, 9);
        for (int i = 0; i < 9; i++) assert_int_equal(m->body[i].parent, shapes[s].parent[i]);
        assert_int_equal(m->is_chain, shapes[s].generator == MODEL_SERIAL_CHAIN);
    }
    arena_destroy(a);
}

static void a_random_tree_has_parents_before_children_and_depends_on_its_seed(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_RANDOM_TREE, 200);
    const struct model *m = made(&spec, a), *again = made(&spec, a);
    spec.seed = 2;
    const struct model *other = made(&spec, a);
    int equal = 0;
    for (int i = 0; i < 200; i++) {
        assert_true(m->body[i].parent < i);
        assert_int_equal(m->body[i].parent, again->body[i].parent);
        equal += m->body[i].parent == other->body[i].parent;
    }
    assert_true(equal < 100);
    arena_destroy(a);
}

/* The first n bodies of a larger model are those of the smaller one, bit by bit. */
static void bodies_do_not_depend_on_how_many_follow(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_SERIAL_CHAIN, 40);
    spec.inertia = INERTIA_RANDOM;
    spec.joint = JOINT_MIXED;
    spec.mass_ratio = 1e6;
    const struct model *large = made(&spec, a);
    spec.nbody = 13;
    const struct model *small = made(&spec, a);
    for (int i = 0; i < 13; i++)
        assert_memory_equal(&large->body[i], &small->body[i], sizeof(struct body_def));
    arena_destroy(a);
}

/* --- bodies --- */

/* A cylinder about its middle: m r^2 / 2 along, m (l^2 / 12 + r^2 / 4) across. */
static void rods_are_cylinders(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_SERIAL_CHAIN, 3);
    spec.length = 0.5, spec.radius = 0.1, spec.mass = 2;
    const struct model *m = made(&spec, a);
    for (int i = 0; i < 3; i++) {
        const struct body_def *b = &m->body[i];
        assert_true(b->mass == 2 && b->com[0] == 0.25 && b->com[1] == 0 && b->com[2] == 0);
        assert_true(fabs(b->inertia[0] - 0.01) < 1e-16);
        assert_true(fabs(b->inertia[3] - 2 * (0.25 / 12 + 0.01 / 4)) < 1e-16);
        assert_true(b->inertia[5] == b->inertia[3]);
        assert_true(b->inertia[1] == 0 && b->inertia[2] == 0 && b->inertia[4] == 0);
        assert_true(b->placement.p[0] == (i > 0 ? 0.5 : 0));
    }
    arena_destroy(a);
}

/* Masses within the ratio; inertias that a body can have: the triangle inequality of the diagonal
 * holds in every frame (model_finish checks the principal ones). */
static void random_bodies_are_physical_and_within_their_ratio(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (uint64_t seed = 1; seed <= 50; seed++) {
        struct model_spec spec = usual(MODEL_SERIAL_CHAIN, 20);
        spec.inertia = INERTIA_RANDOM;
        spec.seed = seed;
        spec.mass_ratio = 1e4;
        const struct model *m = made(&spec, a);
        for (int i = 0; i < 20; i++) {
            const double *x = m->body[i].inertia;
            assert_true(m->body[i].mass >= 1e-2 && m->body[i].mass <= 1e2);
            assert_true(x[0] + x[3] > x[5] && x[3] + x[5] > x[0] && x[5] + x[0] > x[3]);
        }
    }
    arena_destroy(a);
}

static void a_floating_base_is_the_first_joint_only(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_COMB, 6);
    spec.base = BASE_FLOATING;
    const struct model *m = made(&spec, a);
    for (int i = 0; i < 6; i++)
        assert_int_equal(m->body[i].joint, i == 0 ? JOINT_FLOATING : JOINT_REVOLUTE);
    assert_int_equal(m->nu, 6 + 5);
    arena_destroy(a);
}

/* --- loops --- */

/* Both frames of the closure are at the same place at q = 0. */
static void rings_and_four_bars_close(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (int n = 2; n <= 33; n++)
        for (int floating = 0; floating <= (n >= 3); floating++) {
            struct model_spec spec = usual(MODEL_RING, n);
            spec.base = floating ? BASE_FLOATING : BASE_FIXED;
            spec.length = 0.7;
            const struct model *m = made(&spec, a);
            assert_int_equal(m->nloop, 1);
            const struct loop_def *loop = &m->loop[0];
            double from[3], to[3];
            memcpy(from, loop->frame_a.p, sizeof from);
            memcpy(to, loop->frame_b.p, sizeof to);
            to_base(m, loop->body_a, from);
            to_base(m, loop->body_b, to);
            for (int k = 0; k < 3; k++) assert_true(fabs(from[k] - to[k]) < 1e-12);
        }
    /* The four-bar closes where its crank is upright: coupler and ground stay parallel. */
    struct model_spec spec = usual(MODEL_FOUR_BAR, 3);
    const struct model *m = made(&spec, a);
    assert_int_equal(m->nbody, 3);
    assert_true(m->body[1].placement.p[0] == 1 && m->body[2].placement.p[0] == 1.5);
    assert_true(m->loop[0].frame_a.p[0] == 1.5 && m->loop[0].frame_b.p[0] == 1);
    assert_true(m->body[0].mass == 1 && m->body[1].mass == 1.5 && m->body[2].mass == 1);
    arena_destroy(a);
}

static void a_ring_of_two_sides_is_refused(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_RING, 1);
    struct err e;
    err_clear(&e);
    assert_null(generator_model(&spec, a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "at least 3 sides, here 2"));
    arena_destroy(a);
}

/* --- polymers --- */

/* Bonds of 1.53 angstrom, tetrahedral angles between them, CH2 groups of 14.027 amu. */
static void polymers_have_the_bonds_of_carbon(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_POLYMER, 12);
    const struct model *m = made(&spec, a);
    double place[12][3] = {{0}};
    for (int i = 0; i < 12; i++) to_base(m, i, place[i]);
    assert_true(m->metre == 1e-10 && m->second == 1e-12);
    for (int i = 0; i < 12; i++) assert_true(fabs(m->body[i].mass - 14.027) < 1e-12);
    for (int i = 1; i + 1 < 12; i++) {
        double before[3], after[3], dot = 0, one = 0, two = 0;
        for (int k = 0; k < 3; k++) {
            before[k] = place[i - 1][k] - place[i][k], after[k] = place[i + 1][k] - place[i][k];
            dot += before[k] * after[k], one += before[k] * before[k], two += after[k] * after[k];
        }
        assert_true(fabs(sqrt(one) - 1.53) < 1e-12 && fabs(sqrt(two) - 1.53) < 1e-12);
        assert_true(fabs(acos(dot / sqrt(one * two)) - 109.47 * PI / 180) < 1e-9);
    }
    /* 9.81 m/s^2 in angstrom a square picosecond. */
    assert_true(fabs(m->gravity[2] + 9.81e-14) < 1e-25);
    arena_destroy(a);
}

/* --- springs and units --- */

/* Links far from a metre or a kilogram get units that are powers of two; what a user gives in SI
 * is the same spring in both. */
static void springs_are_in_si_whatever_the_units_of_the_model(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    static const enum model_joint joints[] = {JOINT_REVOLUTE, JOINT_PRISMATIC};
    for (int j = 0; j < 2; j++) {
        struct model_spec spec = usual(MODEL_SERIAL_CHAIN, 3);
        spec.joint = joints[j];
        spec.stiffness = 3, spec.damping = 0.25;
        spec.length = 1e-9, spec.radius = 1e-10, spec.mass = 1e-24, spec.torque = 1e-20;
        const struct model *m = made(&spec, a);
        int exponent;
        assert_true(frexp(m->metre, &exponent) == 0.5 && frexp(m->kilogram, &exponent) == 0.5);
        /* N m/rad = kg m^2/s^2, N/m = kg/s^2. */
        const double area = joints[j] == JOINT_REVOLUTE ? m->metre * m->metre : 1;
        const double unit = m->kilogram * area / (m->second * m->second);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(m->body[i].stiffness * unit - 3) < 1e-12);
            assert_true(fabs(m->body[i].damping * unit * m->second - 0.25) < 1e-12);
            assert_true(fabs(m->body[i].mass * m->kilogram / 1e-24 - 1) < 1e-12);
        }
    }
    arena_destroy(a);
}

/* A joint of several degrees of freedom has no spring, and neither have closed chains. */
static void springs_are_on_joints_of_one_degree_only(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct model_spec spec = usual(MODEL_SERIAL_CHAIN, 30);
    spec.joint = JOINT_MIXED;
    spec.stiffness = 1;
    const struct model *m = made(&spec, a);
    for (int i = 0; i < 30; i++)
        assert_int_equal(m->body[i].stiffness > 0, joint_nu(m->body[i].joint) == 1);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parents_are_those_of_the_generator),
        cmocka_unit_test(a_random_tree_has_parents_before_children_and_depends_on_its_seed),
        cmocka_unit_test(bodies_do_not_depend_on_how_many_follow),
        cmocka_unit_test(rods_are_cylinders),
        cmocka_unit_test(random_bodies_are_physical_and_within_their_ratio),
        cmocka_unit_test(a_floating_base_is_the_first_joint_only),
        cmocka_unit_test(rings_and_four_bars_close),
        cmocka_unit_test(a_ring_of_two_sides_is_refused),
        cmocka_unit_test(polymers_have_the_bonds_of_carbon),
        cmocka_unit_test(springs_are_in_si_whatever_the_units_of_the_model),
        cmocka_unit_test(springs_are_on_joints_of_one_degree_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
