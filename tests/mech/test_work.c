/* test_work.c - operation counts: linear where the algorithm is, near the tallies of physics 2.5, zero where nothing is
 * done. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mech/dense_work.h"
#include "mech/dynamics_table.h"
#include "scene.h"

static double total(const struct work *w)
{
    return (double)w->flop + (double)w->div + (double)w->sqrt + 20 * (double)w->trig;
}

/* Operations of one call on an all-revolute chain; sine or cosine counts 20, as in the tallies. */
static double forward_work(int n, enum forward_method method, bool dense)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 1);
    spec.external_force = 0;
    struct scene s = scene_of(&spec);
    struct work w = {0};
    double *x = TAKE(s.a, n, double);
    if (dense)
        dense_work_forward(s.model, method, &w);
    else
        dynamics_type_of(PRECISION_DOUBLE)->forward(s.model, s.state, method, s.a, x, NULL, NULL, &w);
    scene_end(&s);
    return total(&w);
}

static double inverse_work(int n, bool dense)
{
    struct model_spec spec = spec_random(MODEL_SERIAL_CHAIN, n, JOINT_REVOLUTE, 1);
    spec.external_force = 0;
    struct scene s = scene_of(&spec);
    struct work w = {0};
    double *x = TAKE(s.a, n, double);
    if (dense)
        dense_work_inverse(s.model, &w);
    else
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

#define RNEA(n) inverse_work(n, false)
#define RNEA_DENSE(n) inverse_work(n, true)
#define ABA(n) forward_work(n, FORWARD_ABA, false)
#define ABA_DENSE(n) forward_work(n, FORWARD_ABA, true)
#define PAPER(n) forward_work(n, FORWARD_CFA_PAPER, false)
#define PAPER_DENSE(n) forward_work(n, FORWARD_CFA_PAPER, true)
#define DIRECT(n) forward_work(n, FORWARD_CFA_DIRECT, false)

/* The tallies are 340, 950 and 1400; ours may be lower, where the fast paths exploit more, but hardly higher. */
static void optimised_code_does_no_more_than_the_tallies(void **state)
{
    (void)state;
    assert_slope(RNEA, 200, 340);
    assert_slope(ABA, 500, 950);
    assert_slope(PAPER, 1200, 1400 * 1.1);
    assert_slope(DIRECT, 1200, 1400 * 1.1);
}

static void dense_code_costs_what_the_tallies_say(void **state)
{
    (void)state;
    assert_slope(RNEA_DENSE, 2000 * 0.9, 2000 * 1.1);
    assert_slope(ABA_DENSE, 3050 * 0.9, 3050 * 1.1);
    assert_slope(PAPER_DENSE, 6500 * 0.9, 6500 * 1.1);
}

/* The mass matrix's way grows with the cube: at n = 96, n^3/3 dominates. */
static void factoring_the_mass_matrix_is_cubic(void **state)
{
    (void)state;
    double ratio = forward_work(192, FORWARD_CRBA, false) / forward_work(96, FORWARD_CRBA, false);
    assert_true(ratio > 6.5 && ratio < 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(optimised_code_does_no_more_than_the_tallies),
        cmocka_unit_test(dense_code_costs_what_the_tallies_say),
        cmocka_unit_test(factoring_the_mass_matrix_is_cubic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
