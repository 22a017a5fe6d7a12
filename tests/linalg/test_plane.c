/* test_plane.c - vectors and transforms of the plane against what the same motion is in space. */
#define SPACE 3
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/planar.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static void fill(struct random *r, double *x, int n)
{
    for (int i = 0; i < n; i++) x[i] = random_uniform(r, -1, 1);
}

static struct xform random_pose(struct random *r)
{
    const double angle = random_uniform(r, -3, 3);
    struct xform x = {.c = cos(angle), .s = sin(angle)};
    fill(r, x.p, 2);
    return x;
}

/* The transform [1, p x r; 0, r] of a force [about the normal; x, y] as a matrix, by its
 * definition: f' = r f, n' = n + p_x f'_y - p_y f'_x. */
static void matrix_of(const struct xform *x, double m[9])
{
    const double r[4] = {x->c, -x->s, x->s, x->c};
    m[0] = 1, m[3] = m[6] = 0;
    for (int j = 0; j < 2; j++) {
        m[1 + j] = x->p[0] * r[2 + j] - x->p[1] * r[j];
        m[4 + j] = r[j];
        m[7 + j] = r[2 + j];
    }
}

static void forces_go_up_by_the_matrix_and_motions_down_by_its_transpose(void **state)
{
    (void)state;
    struct random r = random_make(21, 0, 0);
    for (int trial = 0; trial < 100; trial++) {
        const struct xform x = random_pose(&r);
        double m[9], v[3], up[3], down[3], kept[3];
        matrix_of(&x, m), fill(&r, v, 3);
        xform_force(up, &x, v), xform_motion(down, &x, v);
        for (int i = 0; i < 3; i++) {
            assert_near(up[i], m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2], 1e-15);
            assert_near(down[i], m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2], 1e-15);
        }
        /* y may be the argument */
        screw_copy(kept, v), xform_force(kept, &x, kept);
        assert_memory_equal(kept, up, sizeof up);
        screw_copy(kept, v), xform_motion(kept, &x, kept);
        assert_memory_equal(kept, down, sizeof down);
        v[0] = 0;
        xform_slide(up, &x, v), xform_motion(down, &x, v);
        for (int i = 0; i < 3; i++) assert_near(up[i], down[i], 0);
    }
}

/* A quarter turn with the child's origin at (2, 0): its x axis is the parent's y axis. A force of
 * 1 along it pulls at an arm of 2. */
static void a_quarter_turn_by_hand(void **state)
{
    (void)state;
    const struct xform x = {.c = 0, .s = 1, .p = {2, 0}};
    const double force[3] = {0, 1, 0}, spin[3] = {1, 0, 0};
    double y[3], p[2];
    xform_force(y, &x, force);
    assert_true(y[0] == 2 && y[1] == 0 && y[2] == 1);
    /* turning with 1 about the parent's origin carries (2, 0) along +y, which is the child's x */
    xform_motion(y, &x, spin);
    assert_true(y[0] == 1 && y[1] == 2 && y[2] == 0);
    xform_shift(&x, 3, 1, p);
    assert_true(p[0] == 1 && p[1] == 3);
}

static void composing_is_the_product_of_the_matrices(void **state)
{
    (void)state;
    struct random r = random_make(22, 0, 0);
    for (int trial = 0; trial < 100; trial++) {
        const struct xform a = random_pose(&r), b = random_pose(&r);
        struct xform c, one, same;
        double ma[9], mb[9], mc[9];
        xform_compose(&c, &a, &b);
        matrix_of(&a, ma), matrix_of(&b, mb), matrix_of(&c, mc);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) sum += ma[3 * i + k] * mb[3 * k + j];
                assert_near(mc[3 * i + j], sum, 1e-14);
            }
        xform_identity(&one);
        xform_compose(&same, &one, &a);
        assert_true(same.c == a.c && same.s == a.s && same.p[0] == a.p[0] && same.p[1] == a.p[1]);
    }
}

static void the_factors_multiply_to_the_transform(void **state)
{
    (void)state;
    struct random r = random_make(23, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        const struct xform x = random_pose(&r);
        double shift[9] = {0}, turn[9] = {0}, m[9];
        xform_factors(&x, shift, turn), matrix_of(&x, m);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) sum += shift[3 * i + k] * turn[3 * k + j];
                assert_near(m[3 * i + j], sum, 1e-15);
            }
    }
}

static void screws_of_the_plane_have_three_numbers(void **state)
{
    (void)state;
    const double x[3] = {1, 2, 3}, y[3] = {-2, 5, 7};
    double z[4] = {9, 9, 9, 9};
    assert_true(screw_dot(x, y) == -2 + 10 + 21);
    screw_zero(z), screw_add(z, x), screw_axpy(z, 3, y), screw_sub(z, y);
    for (int i = 0; i < 3; i++) assert_true(z[i] == x[i] + 2 * y[i]);
    assert_true(z[3] == 9); /* nothing is written beyond */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_go_up_by_the_matrix_and_motions_down_by_its_transpose),
        cmocka_unit_test(a_quarter_turn_by_hand),
        cmocka_unit_test(composing_is_the_product_of_the_matrices),
        cmocka_unit_test(the_factors_multiply_to_the_transform),
        cmocka_unit_test(screws_of_the_plane_have_three_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
