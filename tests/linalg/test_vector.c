/* test_vector.c - vectors of three, 3x3 matrices and screws: identities of the algebra, and outputs
 * that may be inputs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/inertia.h"
#include "linalg/spatial.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static void fill(struct random *r, double *x, int n)
{
    for (int i = 0; i < n; i++) x[i] = random_uniform(r, -1, 1);
}

/* A rotation by Rodrigues' formula, which uses nothing of what is tested: U + sin a K +
 * (1 - cos a) K^2. */
static void turn_about(double *m, const double *axis, double angle)
{
    const double norm = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double k[3] = {axis[0] / norm, axis[1] / norm, axis[2] / norm};
    const double K[9] = {0, -k[2], k[1], k[2], 0, -k[0], -k[1], k[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double square = 0;
            for (int l = 0; l < 3; l++) square += K[3 * i + l] * K[3 * l + j];
            m[3 * i + j] = (i == j) + sin(angle) * K[3 * i + j] + (1 - cos(angle)) * square;
        }
}

static void cross_products_obey_their_identities(void **state)
{
    (void)state;
    struct random r = random_make(11, 0, 0);
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
    double z[3];
    vec3_cross(z, x, y);
    assert_true(z[0] == 0 && z[1] == 0 && z[2] == 1);
    for (int trial = 0; trial < 100; trial++) {
        double a[3], b[3], c[3], ab[3], bc[3], ca[3], sum[3], skew[9], by_skew[3];
        fill(&r, a, 3), fill(&r, b, 3), fill(&r, c, 3);
        vec3_cross(ab, a, b), vec3_cross(bc, b, c), vec3_cross(ca, c, a);
        /* Jacobi: a x (b x c) + b x (c x a) + c x (a x b) = 0 */
        vec3_set(sum, 0, 0, 0);
        vec3_cross_add(sum, a, bc), vec3_cross_add(sum, b, ca), vec3_cross_add(sum, c, ab);
        for (int i = 0; i < 3; i++) assert_near(sum[i], 0, 1e-15);
        /* Lagrange: |a x b|^2 = |a|^2 |b|^2 - (a . b)^2; the triple product turns round */
        const double dot = vec3_dot(a, b), na = vec3_norm(a), nb = vec3_norm(b);
        assert_near(vec3_dot(ab, ab), na * na * nb * nb - dot * dot, 1e-14);
        assert_near(vec3_dot(ab, c), vec3_dot(a, bc), 1e-15);
        mat3_skew(skew, a);
        mat3_mul_vec(by_skew, skew, b);
        for (int i = 0; i < 3; i++) assert_near(by_skew[i], ab[i], 0);
        /* what was added is taken off again */
        vec3_copy(sum, c);
        vec3_cross_add(sum, a, b), vec3_cross_sub(sum, a, b);
        for (int i = 0; i < 3; i++) assert_near(sum[i], c[i], 1e-15);
    }
}

/* vec3.h: z may be x or y, y may be x. */
static void outputs_that_may_be_inputs_are_the_same_bits(void **state)
{
    (void)state;
    struct random r = random_make(12, 0, 0);
    double m[9], s[6], a[3], b[3], want[3], got[3];
    fill(&r, m, 9), fill(&r, s, 6), fill(&r, a, 3), fill(&r, b, 3);

    vec3_cross(want, a, b);
    vec3_copy(got, a), vec3_cross(got, got, b);
    assert_memory_equal(got, want, sizeof want);
    vec3_copy(got, b), vec3_cross(got, a, got);
    assert_memory_equal(got, want, sizeof want);
    mat3_mul_vec(want, m, a);
    vec3_copy(got, a), mat3_mul_vec(got, m, got);
    assert_memory_equal(got, want, sizeof want);
    mat3_mul_vec_transposed(want, m, a);
    vec3_copy(got, a), mat3_mul_vec_transposed(got, m, got);
    assert_memory_equal(got, want, sizeof want);
    sym3_mul_vec(want, s, a);
    vec3_copy(got, a), sym3_mul_vec(got, s, got);
    assert_memory_equal(got, want, sizeof want);
    vec3_scale(want, 0.3, a);
    vec3_copy(got, a), vec3_scale(got, 0.3, got);
    assert_memory_equal(got, want, sizeof want);
}

static void matrix_products_agree_on_transposes(void **state)
{
    (void)state;
    struct random r = random_make(13, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        double a[9], b[9], at[9], bt[9], ab[9], got[9], v[3], x[3], y[3];
        fill(&r, a, 9), fill(&r, b, 9), fill(&r, v, 3);
        mat3_transpose(at, a), mat3_transpose(bt, b);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                ab[3 * i + j] = 0;
                for (int k = 0; k < 3; k++) ab[3 * i + j] += a[3 * i + k] * b[3 * k + j];
            }
        mat3_mul(got, a, b);
        for (int i = 0; i < 9; i++) assert_near(got[i], ab[i], 1e-15);
        mat3_mul_transposed(got, a, bt);
        for (int i = 0; i < 9; i++) assert_near(got[i], ab[i], 1e-15);
        mat3_transposed_mul(got, at, b);
        for (int i = 0; i < 9; i++) assert_near(got[i], ab[i], 1e-15);
        mat3_mul_vec(x, at, v), mat3_mul_vec_transposed(y, a, v);
        for (int i = 0; i < 3; i++) assert_near(x[i], y[i], 0);
    }
}

static void rotations_keep_lengths_traces_and_cross_products(void **state)
{
    (void)state;
    struct random r = random_make(14, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        double axis[3], R[9], a[3], b[3], Ra[3], Rb[3], ab[3], turned[3], s[6], moved[6], full[9];
        double t[9], back[9];
        fill(&r, axis, 3), fill(&r, a, 3), fill(&r, b, 3), fill(&r, s, 6);
        turn_about(R, axis, random_uniform(&r, -3, 3));
        mat3_mul_vec(Ra, R, a), mat3_mul_vec(Rb, R, b);
        assert_near(vec3_norm(Ra), vec3_norm(a), 1e-15);
        vec3_cross(ab, a, b), mat3_mul_vec(ab, R, ab), vec3_cross(turned, Ra, Rb);
        for (int i = 0; i < 3; i++) assert_near(turned[i], ab[i], 1e-14);
        /* S' = R S R^T by full matrices; (R a)^T S' (R b) = a^T S b */
        sym3_rotate(moved, R, s);
        assert_near(moved[0] + moved[3] + moved[5], s[0] + s[3] + s[5], 1e-14);
        double before[3], after[3];
        sym3_mul_vec(before, s, b), sym3_mul_vec(after, moved, Rb);
        assert_near(vec3_dot(Ra, after), vec3_dot(a, before), 1e-14);
        sym3_expand(full, s);
        mat3_mul(t, R, full), mat3_mul_transposed(full, t, R);
        sym3_from_mat3(s, full);
        for (int i = 0; i < 6; i++) assert_near(s[i], moved[i], 1e-15);
        mat3_transposed_mul(back, R, R);
        for (int i = 0; i < 9; i++) assert_near(back[i], i % 4 == 0, 1e-15);
    }
}

static void a_turn_about_z_is_a_product_with_its_matrix(void **state)
{
    (void)state;
    struct random r = random_make(15, 0, 0);
    const double z[3] = {0, 0, 1};
    for (int trial = 0; trial < 50; trial++) {
        const double angle = random_uniform(&r, -4, 4);
        double E[9], Rz[9], want[9], got[9];
        fill(&r, E, 9), turn_about(Rz, z, angle);
        mat3_mul(want, E, Rz);
        mat3_turn_z(got, E, sin(angle), cos(angle));
        for (int i = 0; i < 9; i++) assert_near(got[i], want[i], 1e-15);
    }
}

static void a_shift_of_a_symmetric_block_is_a_product_with_its_skew_matrix(void **state)
{
    (void)state;
    struct random r = random_make(16, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        double b[9], p[3], c[6], d[9], skew[9], full[9], want[9];
        fill(&r, b, 9), fill(&r, p, 3), fill(&r, c, 6);
        mat3_add_skew_mul_sym3(d, b, p, c);
        mat3_skew(skew, p), sym3_expand(full, c), mat3_mul(want, skew, full);
        for (int i = 0; i < 9; i++) assert_near(d[i], b[i] + want[i], 1e-15);
    }
}

static void screws_add_scale_and_multiply(void **state)
{
    (void)state;
    const double x[6] = {1, 2, 3, 4, 5, 6}, y[6] = {6, -5, 4, -3, 2, -1};
    double z[6];
    assert_true(screw_dot(x, y) == 6 - 10 + 12 - 12 + 10 - 6);
    screw_copy(z, x), screw_axpy(z, -2, y);
    for (int i = 0; i < 6; i++) assert_true(z[i] == x[i] - 2 * y[i]);
    screw_add(z, y), screw_add(z, y);
    assert_memory_equal(z, x, sizeof x);
    screw_sub(z, x);
    for (int i = 0; i < 6; i++) assert_true(z[i] == 0);
    screw_copy(z, y), screw_zero(z);
    for (int i = 0; i < 6; i++) assert_true(z[i] == 0);
}

static void random_pose(struct random *r, struct xform *x)
{
    double axis[3];
    fill(r, axis, 3), fill(r, x->p, 3);
    turn_about(x->r, axis, random_uniform(r, -3, 3));
}

/* A force and a motion have the same power in both frames; that fixes each by the other. */
static void power_is_the_same_in_both_frames(void **state)
{
    (void)state;
    struct random r = random_make(17, 0, 0);
    for (int trial = 0; trial < 100; trial++) {
        struct xform x;
        double f[6], v[6], up[6], down[6];
        random_pose(&r, &x), fill(&r, f, 6), fill(&r, v, 6);
        xform_force(up, &x, f), xform_motion(down, &x, v);
        assert_near(screw_dot(up, v), screw_dot(f, down), 1e-14);
        /* without an angular part a motion only turns */
        vec3_set(v, 0, 0, 0);
        double slid[6], moved[6];
        xform_slide(slid, &x, v), xform_motion(moved, &x, v);
        for (int i = 0; i < 6; i++) assert_near(slid[i], moved[i], 0);
        xform_slide(v, &x, v);
        assert_memory_equal(v, slid, sizeof v);
    }
}

static void the_factors_of_a_transform_multiply_to_it(void **state)
{
    (void)state;
    struct random r = random_make(18, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform x;
        double shift[36] = {0}, turn[36] = {0}, f[6], t[6] = {0}, got[6] = {0}, want[6];
        random_pose(&r, &x), fill(&r, f, 6);
        xform_factors(&x, shift, turn);
        for (int i = 0; i < 36; i++) t[i / 6] += turn[i] * f[i % 6];
        for (int i = 0; i < 36; i++) got[i / 6] += shift[i] * t[i % 6];
        xform_force(want, &x, f);
        for (int i = 0; i < 6; i++) assert_near(got[i], want[i], 1e-15);
    }
}

/* a o (b o c) = (a o b) o c; the inverse of a product is the product of the inverses the other way
 * round. */
static void transforms_form_a_group(void **state)
{
    (void)state;
    struct random r = random_make(19, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform a, b, c, ab, bc, left, right, ia, ib, one;
        random_pose(&r, &a), random_pose(&r, &b), random_pose(&r, &c);
        xform_compose(&ab, &a, &b), xform_compose(&bc, &b, &c);
        xform_compose(&left, &a, &bc), xform_compose(&right, &ab, &c);
        for (int i = 0; i < 9; i++) assert_near(left.r[i], right.r[i], 1e-14);
        for (int i = 0; i < 3; i++) assert_near(left.p[i], right.p[i], 1e-14);
        xform_inverse(&ia, &a), xform_inverse(&ib, &b);
        xform_inverse(&left, &ab), xform_compose(&right, &ib, &ia);
        for (int i = 0; i < 3; i++) assert_near(left.p[i], right.p[i], 1e-14);
        xform_identity(&one);
        xform_compose(&left, &a, &one), xform_compose(&right, &one, &a);
        assert_memory_equal(left.r, a.r, sizeof a.r), assert_memory_equal(left.p, a.p, sizeof a.p);
        assert_memory_equal(right.r, a.r, sizeof a.r);
        assert_memory_equal(right.p, a.p, sizeof a.p);
    }
}

/* Kinetic energy is the same in every frame, and a point mass at p has the inertia of Steiner's
 * theorem. */
static void inertias_move_without_change_of_energy(void **state)
{
    (void)state;
    struct random r = random_make(20, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform x;
        struct inertia in = {.m = random_uniform(&r, 0.5, 2)}, moved;
        double v[6], down[6], f[6], g[6];
        random_pose(&r, &x), fill(&r, in.ms, 3), fill(&r, in.j, 6), fill(&r, v, 6);
        inertia_move(&moved, &x, &in);
        xform_motion(down, &x, v);
        inertia_mul(f, &in, down), inertia_mul(g, &moved, v);
        assert_near(screw_dot(f, down), screw_dot(g, v), 1e-13);
        assert_true(moved.m == in.m);
        const struct inertia point = {.m = 3};
        inertia_move(&moved, &x, &point);
        const double *p = x.p;
        assert_near(moved.j[0], 3 * (p[1] * p[1] + p[2] * p[2]), 1e-14);
        assert_near(moved.j[1], -3 * p[0] * p[1], 1e-14);
        assert_near(moved.j[4], -3 * p[1] * p[2], 1e-14);
        for (int i = 0; i < 3; i++) assert_near(moved.ms[i], 3 * p[i], 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cross_products_obey_their_identities),
        cmocka_unit_test(outputs_that_may_be_inputs_are_the_same_bits),
        cmocka_unit_test(matrix_products_agree_on_transposes),
        cmocka_unit_test(rotations_keep_lengths_traces_and_cross_products),
        cmocka_unit_test(a_turn_about_z_is_a_product_with_its_matrix),
        cmocka_unit_test(a_shift_of_a_symmetric_block_is_a_product_with_its_skew_matrix),
        cmocka_unit_test(screws_add_scale_and_multiply),
        cmocka_unit_test(power_is_the_same_in_both_frames),
        cmocka_unit_test(the_factors_of_a_transform_multiply_to_it),
        cmocka_unit_test(transforms_form_a_group),
        cmocka_unit_test(inertias_move_without_change_of_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
