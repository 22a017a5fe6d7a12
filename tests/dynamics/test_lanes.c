/* test_lanes.c - several states of a tree at once: every lane has the bits of the serial code, at
 * every width that this host has.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "dynamics/differences.h"
#include "dynamics/dynamics.h"
#include "dynamics/integrate.h"
#include "dynamics/lanes_type.h"
#include "scene.h"

enum { WIDEST = 8, BODIES = 7, MOST = 6 * BODIES + BODIES };

/* A random tree under every load there is; springs where its joints have one. */
static struct model_spec spec_loaded(int n, enum model_joint joint, uint64_t seed)
{
    struct model_spec spec = spec_random(MODEL_RANDOM_TREE, n, joint, seed);
    spec.base = seed % 2 ? BASE_FIXED : BASE_MOVING;
    for (int k = 0; k < 6; k++) spec.base_acceleration[k] = 0.1 * (k + 1);
    spec.stiffness = 3, spec.damping = 0.5;
    if (seed % 3 == 0) spec.external_force = 0;
    return spec;
}

/* States of one scene, side by side as lanes want them and one by one. */
struct states {
    double q[WIDEST][MOST], u[WIDEST][MOST];
    double lanes_q[WIDEST * MOST], lanes_u[WIDEST * MOST];
};

static void states_make(struct states *x, const struct scene *s, int width, uint64_t seed)
{
    struct random r = random_make(seed, 1, 0);
    for (int k = 0; k < width; k++) {
        for (int i = 0; i < s->model->nq; i++)
            x->q[k][i] = s->state->q[i] + random_uniform(&r, -1, 1);
        for (int i = 0; i < s->model->nu; i++)
            x->u[k][i] = s->state->qd[i] + random_uniform(&r, -1, 1);
    }
    /* an angle that is left to the C library: its neighbours keep their bits */
    if (s->model->nq > 0) x->q[width / 2][0] = 3e6;
    for (int k = 0; k < width; k++) {
        for (int i = 0; i < s->model->nq; i++) x->lanes_q[i * width + k] = x->q[k][i];
        for (int i = 0; i < s->model->nu; i++) x->lanes_u[i * width + k] = x->u[k][i];
    }
}

/* Fails the test where a lane differs in a bit. */
static void compare(const struct scene *s, const struct lanes_type *type, uint64_t seed)
{
    const struct model *m = s->model;
    const int width = type->width;
    struct states x;
    double ud[WIDEST * MOST], one[MOST];
    struct dynamics *d = dynamics_take(m, s->a);
    dynamics_load(d, s->state);
    states_make(&x, s, width, seed);
    struct lanes *l = type->hold(m, s->state, s->a);
    assert_true(type->forward(l, x.lanes_q, x.lanes_u, s->state->tau, ud));
    for (int k = 0; k < width; k++) {
        assert_true(dynamics_forward(d, x.q[k], x.u[k], s->state->tau, one, NULL));
        for (int i = 0; i < m->nu; i++)
            if (memcmp(&one[i], &ud[i * width + k], sizeof *one) != 0)
                fail_msg("width %d, lane %d, number %d: %a instead of %a", width, k, i,
                         ud[i * width + k], one[i]);
    }
}

/* All joint types on trees, in general and, of turns alone, by the shorter code. */
static void every_lane_has_the_serial_bits(void **state)
{
    (void)state;
    for (int width = 4; width <= WIDEST; width += 4) {
        const struct lanes_type *type = lanes_type_of(width);
        if (!type) continue; /* this host's registers are not so wide */
        assert_int_equal(type->width, width);
        for (int joint = JOINT_FIXED; joint <= JOINT_MIXED; joint++)
            for (uint64_t seed = 1; seed <= 4; seed++) {
                const struct model_spec spec = spec_loaded(BODIES, (enum model_joint)joint, seed);
                struct scene s = scene_of(&spec);
                compare(&s, type, seed);
                s.model->general_joints = true;
                compare(&s, type, seed);
                scene_end(&s);
            }
    }
}

/* One lane that breaks down leaves no answer in any: the caller asks the serial code. */
static void a_lane_that_breaks_down_is_told(void **state)
{
    (void)state;
    for (int joint = JOINT_REVOLUTE; joint <= JOINT_UNIVERSAL; joint++) {
        const struct model_spec spec = spec_loaded(BODIES, (enum model_joint)joint, 1);
        struct scene s = scene_of(&spec);
        struct states x;
        double ud[WIDEST * MOST];
        for (int width = 4; width <= WIDEST; width += 4) {
            const struct lanes_type *type = lanes_type_of(width);
            if (!type) continue;
            struct lanes *l = type->hold(s.model, s.state, s.a);
            for (int k = 0; k < width; k++) {
                states_make(&x, &s, width, 1);
                for (int i = 0; i < s.model->nq; i++) x.lanes_q[i * width + k] = NAN;
                const bool good = type->forward(l, x.lanes_q, x.lanes_u, s.state->tau, ud);
                /* a displacement along an axis turns nothing: no pivot depends on it */
                if (joint == JOINT_REVOLUTE || joint == JOINT_UNIVERSAL) assert_false(good);
            }
        }
        scene_end(&s);
    }
}

/* The Jacobian of s by lanes of `type` and column by column, with at most so many evaluations. */
static void compare_jacobians(const struct scene *s, const struct lanes_type *type, const double *y,
                              long most)
{
    const int n = s->model->nq + s->model->nu;
    double *by_lanes = TAKE(s->a, (size_t)n * (size_t)n + 1, double),
           *by_columns = TAKE(s->a, (size_t)n * (size_t)n + 1, double);
    struct differences wide = differences_make(s->model, s->state, most, type, s->a),
                       narrow = differences_make(s->model, s->state, most, NULL, s->a);
    assert_int_equal(differences_jacobian(&wide, y, by_lanes),
                     differences_jacobian(&narrow, y, by_columns));
    assert_memory_equal(by_lanes, by_columns, (size_t)(n * n) * sizeof *by_lanes);
    assert_int_equal(wide.evaluations, narrow.evaluations);
}

/* Columns that fill no last register, evaluations that end on the way, states that break down, and
 * loops, which have no lanes. */
static void jacobians_are_the_same_by_lanes_and_by_columns(void **state)
{
    (void)state;
    for (int width = 4; width <= WIDEST; width += 4)
        for (int bodies = 1; bodies <= BODIES && lanes_type_of(width); bodies++)
            for (int loops = 0; loops < 2; loops++) {
                struct model_spec spec =
                    spec_loaded(bodies, bodies % 2 ? JOINT_REVOLUTE : JOINT_MIXED, 2);
                if (loops) spec = spec_random(MODEL_FOUR_BAR, 3, JOINT_REVOLUTE, 1);
                struct scene s = scene_of(&spec);
                double y[2 * MOST];
                const int nq = s.model->nq, n = nq + s.model->nu;
                memcpy(y, s.state->q, (size_t)nq * sizeof *y);
                memcpy(y + nq, s.state->qd, (size_t)s.model->nu * sizeof *y);
                compare_jacobians(&s, lanes_type_of(width), y, 1000);
                compare_jacobians(&s, lanes_type_of(width), y, 2 * n);
                compare_jacobians(&s, lanes_type_of(width), y, 2 * n - 1);
                y[n / 2] = NAN;
                compare_jacobians(&s, lanes_type_of(width), y, 1000);
                scene_end(&s);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lane_has_the_serial_bits),
        cmocka_unit_test(a_lane_that_breaks_down_is_told),
        cmocka_unit_test(jacobians_are_the_same_by_lanes_and_by_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
