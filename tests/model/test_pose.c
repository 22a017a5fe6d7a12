/* test_pose.c - facts of joint types, poses and states of generated scenes, and reference vectors
 * changed on purpose. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "base/random.h"
#include "model/generator.h"
#include "model/pose.h"
#include "model/vector.h"
#include "model/vector_model.h"
#include "model/vector_perturb.h"

#define PI 3.14159265358979323846

/* By hand from the comments of spec/joint_list.h: what q and u are. `linear`: a letter for each
 * component of u. */
static const struct {
    enum model_joint joint;
    const char *name;
    int nq, nu, quaternion;
    const char *linear; /* l: linear, a: angular */
    enum joint_plane plane;
    unsigned traits;
} facts[] = {
    {JOINT_FIXED, "fixed", 0, 0, -1, "", PLANE_STAYS, 0},
    {JOINT_REVOLUTE, "revolute", 1, 1, -1, "a", PLANE_TURNS, JOINT_AXIS},
    {JOINT_PRISMATIC, "prismatic", 1, 1, -1, "l", PLANE_SLIDES, JOINT_AXIS},
    {JOINT_HELICAL, "helical", 1, 1, -1, "a", PLANE_LEAVES,
     JOINT_AXIS | JOINT_PITCH | JOINT_IN_TREES},
    {JOINT_CYLINDRICAL, "cylindrical", 2, 2, -1, "al", PLANE_LEAVES,
     JOINT_AXIS | JOINT_CLOSES_RINGS},
    {JOINT_UNIVERSAL, "universal", 2, 2, -1, "aa", PLANE_LEAVES,
     JOINT_AXIS | JOINT_ALONG_X | JOINT_TWO_AXES | JOINT_IN_TREES},
    {JOINT_SPHERICAL, "spherical", 4, 3, 0, "aaa", PLANE_LEAVES, JOINT_CLOSES_RINGS},
    {JOINT_PLANAR, "planar", 3, 3, -1, "all", PLANE_MOVES,
     JOINT_AXIS | JOINT_NORMAL | JOINT_CLOSES_RINGS},
    {JOINT_SLOT, "slot", 5, 4, 0, "aaal", PLANE_LEAVES,
     JOINT_AXIS | JOINT_ALONG_X | JOINT_AS_IT_LIES},
    {JOINT_POINT_PLANE, "point-plane", 6, 5, 0, "aaall", PLANE_LEAVES,
     JOINT_AXIS | JOINT_NORMAL | JOINT_AS_IT_LIES},
    {JOINT_FLOATING, "floating", 7, 6, 3, "lllaaa", PLANE_LEAVES, 0},
};
enum { TYPES = sizeof facts / sizeof *facts };

static void facts_of_joint_types(void **state)
{
    (void)state;
    assert_int_equal(TYPES, JOINT_MIXED);
    for (int i = 0; i < TYPES; i++) {
        const enum model_joint j = facts[i].joint;
        assert_string_equal(joint_name(j), facts[i].name);
        assert_int_equal(joint_nq(j), facts[i].nq);
        assert_int_equal(joint_nu(j), facts[i].nu);
        assert_int_equal(joint_quaternion(j), facts[i].quaternion);
        assert_int_equal(joint_plane(j), facts[i].plane);
        for (int k = 0; k < facts[i].nu; k++)
            assert_int_equal(joint_is_linear(j, k), facts[i].linear[k] == 'l');
        for (unsigned bit = 1; bit <= JOINT_CLOSES_RINGS; bit *= 2)
            assert_int_equal(joint_has(j, (enum joint_trait)bit), (facts[i].traits & bit) != 0);
    }
}

static double length(const double *x, int n)
{
    double s = 0;
    for (int i = 0; i < n; i++) s += x[i] * x[i];
    return sqrt(s);
}

/* Straight: zero; folded: half a turn from the second body on, once a joint; coiled: turned but
 * not shifted; random: both, within a link. */
static void poses_of_every_joint_type(void **state)
{
    (void)state;
    struct model_spec spec = {.seed = 4};
    for (int i = 0; i < TYPES; i++)
        for (int body = 0; body < 40; body++) {
            double q[4][8] = {{0}};
            const enum model_joint j = facts[i].joint;
            for (int pose = 0; pose < 4; pose++) {
                spec.pose = (enum model_pose)pose;
                pose_coordinates(&spec, j, body, 0.25, q[pose]);
                assert_true(q[pose][joint_nq(j)] == 0); /* not a number more */
            }
            const int at = facts[i].quaternion;
            bool turned = false;
            for (int pose = 0; pose < 4 && at >= 0; pose++)
                assert_true(fabs(length(q[pose] + at, 4) - 1) < 1e-14);
            if (at >= 0) {
                assert_true(q[POSE_STRAIGHT][at + 3] == 1);
                assert_true(q[POSE_FOLDED][at + (body > 0 ? 2 : 3)] == 1);
                assert_true(fabs(q[POSE_COILED][at]) > 0 && fabs(q[POSE_RANDOM][at]) > 0);
            }
            const char *letters = joint_coordinates(j);
            for (int k = 0, n = 0; letters[k] != '\0'; n += letters[k++] == 'q' ? 4 : 1) {
                if (letters[k] == 'q') continue;
                assert_true(q[POSE_STRAIGHT][n] == 0);
                if (letters[k] == 'd') {
                    assert_true(q[POSE_FOLDED][n] == 0 && q[POSE_COILED][n] == 0);
                    assert_true(fabs(q[POSE_RANDOM][n]) <= 0.25 && q[POSE_RANDOM][n] != 0);
                } else {
                    assert_true(q[POSE_FOLDED][n] == (body > 0 && !turned ? PI : 0));
                    assert_true(fabs(q[POSE_COILED][n]) <= PI && q[POSE_COILED][n] != 0);
                    turned = true;
                }
            }
        }
}

/* Uniform over the rotations: each component has mean 0 and mean square 1/4, and the images of an
 * axis mean 0 and mean square 1/3. Standard errors of 20000 are below 0.004. */
static void quaternions_are_uniform(void **state)
{
    (void)state;
    enum { DRAWS = 20000 };
    struct random r = random_make(77, 1, 2);
    double mean[4] = {0}, square[4] = {0}, z = 0, zz = 0;
    for (int i = 0; i < DRAWS; i++) {
        double q[4];
        pose_quaternion(&r, q);
        assert_true(fabs(length(q, 4) - 1) < 1e-14);
        for (int k = 0; k < 4; k++) mean[k] += q[k] / DRAWS, square[k] += q[k] * q[k] / DRAWS;
        const double up = 1 - 2 * (q[0] * q[0] + q[1] * q[1]); /* z of the turned z axis */
        z += up / DRAWS, zz += up * up / DRAWS;
    }
    for (int k = 0; k < 4; k++) assert_true(fabs(mean[k]) < 0.02 && fabs(square[k] - 0.25) < 0.01);
    assert_true(fabs(z) < 0.02 && fabs(zz - 1 / 3.0) < 0.01);
}

static struct model *chain(struct model_spec *spec, int n, enum model_joint joint)
{
    struct err e;
    err_clear(&e);
    *spec = (struct model_spec){.generator = MODEL_SERIAL_CHAIN,
                                .nbody = n,
                                .joint = joint,
                                .pose = POSE_RANDOM,
                                .axes = AXES_TWISTED,
                                .length = 1,
                                .radius = 0.05,
                                .mass = 1,
                                .mass_ratio = 1,
                                .rate = 1,
                                .torque = 1,
                                .branch = 2,
                                .seed = 5};
    struct model *m = generator_model(spec, arena, &e);
    if (m == NULL) fail_msg("%s", e.text);
    return m;
}

static void a_taken_state_is_at_rest(void **state)
{
    (void)state;
    struct model_spec spec;
    for (int i = 0; i < TYPES; i++) {
        if (facts[i].joint == JOINT_FIXED) continue;
        const struct model *m = chain(&spec, 3, facts[i].joint);
        struct state *s = state_take(m, arena);
        for (int k = 0; k < m->nu; k++)
            assert_true(s->qd[k] == 0 && s->qdd[k] == 0 && s->tau[k] == 0);
        double sum = 0;
        for (int k = 0; k < m->nq; k++) sum += fabs(s->q[k]);
        assert_true(sum == (facts[i].quaternion >= 0 ? 3 : 0));
        if (facts[i].quaternion >= 0)
            for (int b = 0; b < 3; b++)
                assert_true(s->q[m->q_at[b] + facts[i].quaternion + 3] == 1);
        assert_null(s->fext);
        assert_false(s->at_rest);
        double *fext = state_fext_need(s, m, arena);
        assert_ptr_equal(state_fext_need(s, m, arena), fext);
        for (int k = 0; k < 18; k++) assert_true(fext[k] == 0);
    }
}

/* Settings scale what is drawn, and only that which they are for. */
static void settings_scale_what_is_drawn(void **state)
{
    (void)state;
    struct model_spec spec;
    const struct model *m = chain(&spec, 6, JOINT_CYLINDRICAL);
    const struct state *one = state_generate(m, &spec, arena);
    assert_null(one->fext);
    spec.rate = 3, spec.torque = 5, spec.external_force = 2;
    const struct state *more = state_generate(m, &spec, arena);
    for (int i = 0; i < m->nq; i++) assert_true(one->q[i] == more->q[i]);
    for (int i = 0; i < m->nu; i++) {
        assert_true(fabs(more->qd[i] - 3 * one->qd[i]) <= 1e-15 * fabs(more->qd[i]));
        assert_true(fabs(more->qdd[i] - 9 * one->qdd[i]) <= 1e-14 * fabs(more->qdd[i]));
        assert_true(fabs(more->tau[i] - 5 * one->tau[i]) <= 1e-15 * fabs(more->tau[i]));
        assert_true(one->qd[i] != 0 && one->tau[i] != one->qd[i]);
    }
    assert_non_null(more->fext);
    /* a slide's rate is that of a turn times a link's length */
    spec.rate = 1, spec.torque = 1, spec.external_force = 0, spec.length = 4;
    const struct state *longer_links = state_generate(m, &spec, arena);
    for (int i = 0; i < m->nu; i += 2) {
        assert_true(longer_links->qd[i] == one->qd[i]);
        assert_true(fabs(longer_links->qd[i + 1] - 4 * one->qd[i + 1]) <= 1e-14);
        assert_true(fabs(longer_links->tau[i + 1] - one->tau[i + 1] / 4) <= 1e-14);
    }
    spec.length = 1;
    /* the base moves only where it is asked to */
    spec.base_acceleration[1] = 7, spec.base_acceleration[5] = 8;
    assert_true(state_generate(m, &spec, arena)->base_acceleration[5] == 0);
    spec.base = BASE_MOVING;
    const struct state *moving = state_generate(m, &spec, arena);
    assert_true(moving->base_acceleration[1] == 7 && moving->base_acceleration[5] == 8);
    /* a body's numbers do not depend on how many follow */
    const struct model *longer = chain(&spec, 9, JOINT_CYLINDRICAL);
    const struct state *s = state_generate(longer, &spec, arena);
    assert_memory_equal(s->q, one->q, (size_t)m->nq * sizeof *s->q);
    assert_memory_equal(s->qd, one->qd, (size_t)m->nu * sizeof *s->qd);
}

static struct vector_case *read_case(const char *name)
{
    struct vector_case *c = arena_take(arena, sizeof *c);
    struct err e;
    char path[400];
    err_clear(&e);
    const char *top = getenv("srcdir");
    snprintf(path, sizeof path, "%s/tests/data/vectors/%s.json", top ? top : ".", name);
    if (!vector_read(path, c, arena, &e)) fail_msg("%s", e.text);
    return c;
}

static void changed(const double *x, const double *y, int n, double size)
{
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]));
    for (int i = 0; i < n; i++) {
        if (!(fabs(x[i] - y[i]) <= size * largest * (1 + 1e-9)))
            fail_msg("%d: %g became %g", i, x[i], y[i]);
        assert_true(largest == 0 || x[i] != y[i]);
    }
}

static void perturbed_vectors_differ_by_the_size_that_is_asked(void **state)
{
    (void)state;
    static const char *const names[] = {"serial_mixed_n0007", "tree_floatbase_n0031",
                                        "closed_two_6R_weld6", "fext_serial_n0007"};
    const double size = 1e-3;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const struct vector_case *c = read_case(names[k]), *again = read_case(names[k]);
        struct random r = random_make(6, 0, 0), same = random_make(6, 0, 0);
        const struct vector_case *x = vector_perturb(c, size, &r, arena),
                                 *y = vector_perturb(c, size, &same, arena);
        assert_int_equal(x->nbody, c->nbody);
        for (int i = 0; i < c->nbody; i++) {
            const struct vector_body *a = &c->body[i], *b = &x->body[i];
            assert_true(a->parent == b->parent && a->joint == b->joint);
            changed(&a->mass, &b->mass, 1, size);
            changed(a->com, b->com, 3, size);
            changed(a->placement.p, b->placement.p, 3, size);
            changed(a->placement.quat, b->placement.quat, 4, size);
            if (vector_joint_nv(a->joint) == 1) changed(a->axis, b->axis, 3, size);
            const double root[3] = {sqrt(a->inertia[0]), sqrt(a->inertia[3]), sqrt(a->inertia[5])};
            for (int p = 0, n = 0; p < 3; p++)
                for (int q = p; q < 3; q++, n++)
                    assert_true(fabs(a->inertia[n] - b->inertia[n]) <=
                                size * root[p] * root[q] * (1 + 1e-9));
            changed(c->q + a->q, x->q + a->q, vector_joint_nq(a->joint) == 7 ? 3 : 0, size);
            const int n = vector_joint_nv(a->joint), part = n < 3 ? n : 3;
            for (int j = 0; j < n; j += part) {
                changed(c->qd + a->v + j, x->qd + a->v + j, part, size);
                changed(c->tau + a->v + j, x->tau + a->v + j, part, size);
            }
            /* the original stays as it was, and a seed names one vector */
            assert_memory_equal(a, &again->body[i], offsetof(struct vector_body, name));
            assert_true(b->mass == y->body[i].mass && b->inertia[4] == y->body[i].inertia[4]);
        }
        changed(c->gravity, x->gravity, 3, size);
        for (int i = 0; i < c->nloop; i++)
            for (int j = 0; j < c->loop[i].nrow; j++) {
                changed(c->loop[i].row[j], x->loop[i].row[j], 3, size);
                changed(c->loop[i].row[j] + 3, x->loop[i].row[j] + 3, 3, size);
            }
        assert_true((c->external == NULL) == (x->external == NULL));
        for (int i = 0; c->external != NULL && i < 2 * c->nbody; i++)
            changed(c->external + 3 * i, x->external + 3 * i, 3, size);
        assert_ptr_equal(c->tau_id, x->tau_id); /* answers are those of c */
    }
}

static void an_even_scene_has_equal_balls(void **state)
{
    (void)state;
    const struct vector_case *c = read_case("x_massratio_rand_n0096");
    const struct vector_case *x = vector_even(c, arena);
    const double moment = x->body[0].inertia[0];
    assert_true(moment > 0);
    for (int i = 0; i < c->nbody; i++) {
        const double *j = x->body[i].inertia;
        assert_true(x->body[i].mass == 1 && j[0] == moment && j[3] == moment && j[5] == moment);
        assert_true(j[1] == 0 && j[2] == 0 && j[4] == 0);
        assert_int_equal(x->body[i].parent, c->body[i].parent);
        assert_memory_equal(&x->body[i].placement, &c->body[i].placement,
                            sizeof c->body[i].placement);
        assert_memory_equal(x->body[i].com, c->body[i].com, sizeof c->body[i].com);
    }
    assert_true(c->body[0].mass != 1 || c->body[1].mass != 1);
    assert_ptr_equal(x->q, c->q);
}

static void joints_of_vectors_have_their_numbers(void **state)
{
    (void)state;
    static const struct {
        enum vector_joint joint;
        const char *name;
        int nq, nv;
    } cases[] = {{VECTOR_FIXED, "fixed", 0, 0},
                 {VECTOR_REVOLUTE, "revolute", 1, 1},
                 {VECTOR_PRISMATIC, "prismatic", 1, 1},
                 {VECTOR_SPHERICAL, "spherical", 4, 3},
                 {VECTOR_FLOATING, "floating", 7, 6}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_string_equal(vector_joint_name(cases[i].joint), cases[i].name);
        assert_int_equal(vector_joint_nq(cases[i].joint), cases[i].nq);
        assert_int_equal(vector_joint_nv(cases[i].joint), cases[i].nv);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facts_of_joint_types),
        cmocka_unit_test(poses_of_every_joint_type),
        cmocka_unit_test(quaternions_are_uniform),
        cmocka_unit_test(a_taken_state_is_at_rest),
        cmocka_unit_test(settings_scale_what_is_drawn),
        cmocka_unit_test(perturbed_vectors_differ_by_the_size_that_is_asked),
        cmocka_unit_test(an_even_scene_has_equal_balls),
        cmocka_unit_test(joints_of_vectors_have_their_numbers),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
