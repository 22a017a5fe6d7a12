/* test_rest.c - what is at rest has the same serial answers without its velocity terms, for less
 * work. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/planar_dynamics.h"
#include "scene.h"

static void expect_equal(const double *x, const double *y, int n)
{
    for (int i = 0; i < n; i++) assert_true(x[i] == y[i]);
}

static void expect_less(const struct work *less, const struct work *more)
{
    assert_true(less->flop < more->flop && less->trig == more->trig && less->call == more->call);
}

/* What is held for many accelerations gives the same, however often it is asked, and nothing of the
 * accelerations before: `tau` are the forces of the state's own. */
static void held_is_the_same(struct scene *s, const struct dynamics_type *t, const double *tau)
{
    const int nu = s->model->nu;
    struct held *held = t->hold(s->model, s->state, s->a);
    struct state other = *s->state;
    double *want = TAKE(s->a, nu + 1, double), *got = TAKE(s->a, nu + 1, double);
    other.qdd = TAKE(s->a, nu + 1, double);
    for (int i = 0; i < nu; i++) other.qdd[i] = 1 + i;
    t->inverse(s->model, &other, s->a, want, &(struct work){0});
    t->inverse_held(held, other.qdd, got);
    expect_equal(got, want, nu);
    t->inverse_held(held, s->state->qdd, got);
    expect_equal(got, tau, nu);
}

/* Inverse and forward dynamics of one scene by every method in one precision, with velocity terms
 * and without. */
static void compare(struct scene *s, enum precision precision)
{
    const struct dynamics_type *t = dynamics_type_of(precision);
    const int nu = s->model->nu;
    double *with = TAKE(s->a, nu + 1, double), *without = TAKE(s->a, nu + 1, double);
    struct work more = {0}, less = {0};
    s->state->at_rest = false;
    t->inverse(s->model, s->state, s->a, with, &more);
    s->state->at_rest = true;
    t->inverse(s->model, s->state, s->a, without, &less);
    expect_equal(without, with, nu);
    expect_less(&less, &more);
    held_is_the_same(s, t, without);
    for (int m = 0; m < FORWARD_METHODS; m++) {
        more = less = (struct work){0};
        s->state->at_rest = false;
        const bool good =
            t->forward(s->model, s->state, (enum forward_method)m, s->a, with, NULL, NULL, &more);
        s->state->at_rest = true;
        assert_true(good == t->forward(s->model, s->state, (enum forward_method)m, s->a, without,
                                       NULL, NULL, &less));
        if (!good) continue;
        expect_equal(without, with, nu);
        expect_less(&less, &more);
    }
}

static void velocity_terms_of_zero_change_no_digit(void **state)
{
    (void)state;
    static const enum model_generator generator[] = {MODEL_SERIAL_CHAIN, MODEL_RANDOM_TREE,
                                                     MODEL_FOUR_BAR, MODEL_RING};
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_MIXED, JOINT_SPHERICAL};
    for (int g = 0; g < 4; g++)
        for (int j = 0; j < 3; j++)
            for (uint64_t seed = 1; seed < 6; seed++) {
                const bool closed = g > 1;
                if (closed && joint[j] != JOINT_REVOLUTE) continue;
                struct model_spec spec = spec_random(
                    generator[g], generator[g] == MODEL_FOUR_BAR ? 3 : 9, joint[j], seed);
                spec.rate = 0;
                if (seed % 2) spec.external_force = 0;
                if (seed == 3) memset(spec.gravity, 0, sizeof spec.gravity);
                if (closed) spec.inertia = INERTIA_UNIFORM, spec.external_force = 0;
                if (!closed && seed == 4) spec.base = BASE_FLOATING;
                struct scene s = scene_of(&spec);
                memset(s.state->qd, 0, (size_t)s.model->nu * sizeof(double));
                compare(&s, PRECISION_DOUBLE);
                if (seed == 1) compare(&s, PRECISION_FLOAT);
                scene_end(&s);
            }
}

static void planar_codes_leave_them_out_too(void **state)
{
    (void)state;
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, 12, JOINT_REVOLUTE, 2);
    spec.axes = AXES_PARALLEL;
    spec.rate = 0;
    struct scene s = scene_of(&spec);
    double with[12], without[12];
    struct work more = {0}, less = {0};
    planar_inverse(s.model, s.state, s.a, with, &more);
    s.state->at_rest = true;
    planar_inverse(s.model, s.state, s.a, without, &less);
    expect_equal(without, with, 12);
    expect_less(&less, &more);
    scene_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(velocity_terms_of_zero_change_no_digit),
        cmocka_unit_test(planar_codes_leave_them_out_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
