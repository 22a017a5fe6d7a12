/* test_dense_tally.c - counts of the dense serial codes against the published tallies, and their
 * growth. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/arena.h"
#include "model/model.h"
#include "kernel/dense_tally.h"
#include "spec/field.h"

static struct model *chain(struct arena *a, int n, enum model_joint joint)
{
    struct model *m = model_begin(a, NULL);
    struct err e;
    err_clear(&e);
    for (int i = 0; i < n; i++) {
        struct body_def b = {
            .parent = i - 1, .joint = joint, .axis = {0, 0, 1}, .mass = 1, .inertia = {1, 0, 0, 1,
            0, 1}};
        assert_int_equal(model_add_body(m, &b, &e), i);
    }
    assert_true(model_finish(m, false, &e));
    return m;
}

static double flops(const struct model *m, enum forward_method method)
{
    struct work w = {.flop = 7, .div = 3, .trig = 2};
    dense_tally_forward(m, method, &w);
    assert_int_equal(w.div, 3); /* what the structured code divided stays */
    assert_int_equal(w.trig, 2);
    return (double)w.flop;
}

/* Per body of a revolute chain: 2000, 3050, 6500 (tallies of general 6x6 operators, good to a few
 * per cent). */
static void revolute_tallies_are_the_published_ones(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct model *m = chain(a, 50, JOINT_REVOLUTE);
    struct work w = {.flop = 1};
    dense_tally_inverse(m, &w);
    assert_int_equal(w.flop, 50 * 2000);
    assert_true(fabs(flops(m, FORWARD_ABA) / 50 / 3050 - 1) < 0.03);
    assert_true(fabs(flops(m, FORWARD_CFA_PAPER) / 50 / 6500 - 1) < 0.03);
    assert_true(flops(m, FORWARD_CFA_DIRECT) < flops(m, FORWARD_CFA_PAPER));
    arena_destroy(a);
}

/* Composite bodies: 2000 + 828 + 77 a body and 77 a pair of bodies, and the factorisation. */
static void composite_bodies_grow_as_the_cube(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    for (int n = 10; n <= 400; n *= 2) {
        const struct model *m = chain(a, n, JOINT_REVOLUTE);
        double d = n, expected = d * (2000 + 828 + 77) + 77 * d * (d - 1) / 2 +
                                 d * (d + 1) * (2 * d + 1) / 6 + 2 * d * d;
        assert_true(fabs(flops(m, FORWARD_CRBA) / expected - 1) < 1e-12);
    }
    arena_destroy(a);
}

/* More freedom costs an inverse dynamics more, constraint forces less: there are fewer
 * constraints. */
static void freedom_counts(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct model *one = chain(a, 5, JOINT_REVOLUTE), *three = chain(a, 5, JOINT_SPHERICAL);
    assert_true(flops(three, FORWARD_ABA) > flops(one, FORWARD_ABA));
    assert_true(flops(three, FORWARD_CFA_PAPER) < flops(one, FORWARD_CFA_PAPER));
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(revolute_tallies_are_the_published_ones),
        cmocka_unit_test(composite_bodies_grow_as_the_cube),
        cmocka_unit_test(freedom_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
