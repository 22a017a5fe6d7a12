/* test_work.c - operation counts of the serial algorithms against the tallies of physics 2.5. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "scene.h"

static double total(const struct work *w)
{
    return (double)w->flop + (double)w->div + (double)w->sqrt + 20 * (double)w->trig;
}

/* Operations of one call on an all-revolute chain; sine or cosine counts 20, as in the tallies. */
static double forward_work(int n, enum forward_method method)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 1);
    spec.external_force = 0;
    struct scene s = scene_of(&spec);
    struct work w = {0};
    double *x = TAKE(s.a, n, double);
    dynamics_type_of(PRECISION_DOUBLE)->forward(s.model, s.state, method, s.a, x, NULL, NULL, &w);
    scene_end(&s);
    return total(&w);
}

static double inverse_work(int n)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 1);
    spec.external_force = 0;
    struct scene s = scene_of(&spec);
    struct work w = {0};
    double *x = TAKE(s.a, n, double);
    dynamics_type_of(PRECISION_DOUBLE)->inverse(s.model, s.state, s.a, x, &w);
    scene_end(&s);
    return total(&w);
}

/* Per body, from the slope between two sizes. */
#define assert_slope(f, low, high)                                                                                     \
    do {                                                                                                               \
        double slope = ((f(96)) - (f(32))) / 64;                                                                       \
        assert_true(slope >= (low) && slope <= (high));                                                                \
    } while (0)

#define RNEA(n) inverse_work(n)
#define ABA(n) forward_work(n, FORWARD_ABA)
#define PAPER(n) forward_work(n, FORWARD_CFA_PAPER)
#define DIRECT(n) forward_work(n, FORWARD_CFA_DIRECT)

/* The tallies are 340, 950 and 1400; ours may be lower, where the fast paths exploit more, but hardly higher. */
static void optimised_code_does_no_more_than_the_tallies(void **state)
{
    (void)state;
    assert_slope(RNEA, 200, 340);
    assert_slope(ABA, 500, 950);
    assert_slope(PAPER, 1200, 1400 * 1.1);
    assert_slope(DIRECT, 1200, 1400 * 1.1);
}

/* The mass matrix's way grows with the cube: at n = 96, n^3/3 dominates. */
static void factoring_the_mass_matrix_is_cubic(void **state)
{
    (void)state;
    double ratio = forward_work(192, FORWARD_CRBA) / forward_work(96, FORWARD_CRBA);
    assert_true(ratio > 6.5 && ratio < 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(optimised_code_does_no_more_than_the_tallies),
        cmocka_unit_test(factoring_the_mass_matrix_is_cubic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
