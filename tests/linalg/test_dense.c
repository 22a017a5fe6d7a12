/* test_dense.c - small dense operators against plain definitions, on random matrices of all
 * sizes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "linalg/dense.h"

static void fill(struct random *r, int n, double *x)
{
    for (int i = 0; i < n; i++) x[i] = random_uniform(r, -1, 1);
}

/* positive: a random symmetric positive definite A (c x c). */
static void positive(struct random *r, int c, double *A)
{
    double B[36];
    fill(r, c * c, B);
    for (int i = 0; i < c; i++)
        for (int j = 0; j < c; j++) {
            A[i * c + j] = i == j ? 0.1 : 0;
            for (int k = 0; k < c; k++) A[i * c + j] += B[i * c + k] * B[j * c + k];
        }
}

static void pack(int c, const double *A, double *packed)
{
    for (int i = 0; i < c; i++)
        for (int j = 0; j <= i; j++) packed[packed_index(i, j)] = A[i * c + j];
}

static uint64_t operations(const struct work *w) { return w->flop + w->div + w->sqrt; }

static void factor_and_solve_invert(void **state)
{
    (void)state;
    struct random r = random_make(1, 0, 0);
    for (int round = 0; round < 20; round++)
        for (int c = 0; c <= 6; c++)
            for (int m = 1; m <= 7; m += 3) {
                double A[36], G[21], X[42], B[42] = {0};
                struct work w = {0};
                positive(&r, c, A);
                pack(c, A, G);
                fill(&r, c * m, X);
                for (int i = 0; i < c; i++)
                    for (int l = 0; l < m; l++)
                        for (int k = 0; k < c; k++) B[i * m + l] += A[i * c + k] * X[k * m + l];
                assert_true(dense_factor(c, G, G, &w));
                assert_int_equal(operations(&w), c * (c + 1) * (2 * c + 1) / 6);
                dense_solve(c, m, G, B, &w);
                for (int i = 0; i < c * m; i++) assert_true(fabs(B[i] - X[i]) < 1e-10);
            }
}

static void what_is_not_positive_definite_is_refused(void **state)
{
    (void)state;
    double A[] = {1, 2, 1}, zero[] = {0}, nan[] = {NAN};
    struct work w = {0};
    assert_false(dense_factor(2, A, A, &w));
    assert_false(dense_factor(1, zero, zero, &w));
    assert_false(dense_factor(1, nan, nan, &w));
}

static void products_are_sums_of_products(void **state)
{
    (void)state;
    struct random r = random_make(2, 0, 0);
    for (int a = 0; a <= 6; a++)
        for (int b = 1; b <= 6; b++)
            for (int k = 1; k <= 6; k++) {
                double A[36], At[36], B[36], C[36], D[36];
                struct work w = {0};
                fill(&r, a * k, A);
                fill(&r, k * b, B);
                for (int i = 0; i < a; i++)
                    for (int l = 0; l < k; l++) At[l * a + i] = A[i * k + l];
                dense_product(a, b, k, A, B, C, &w);
                assert_int_equal(operations(&w), a * b * (2 * k - 1));
                dense_product_tn(a, b, k, At, B, D, &w);
                for (int i = 0; i < a; i++)
                    for (int j = 0; j < b; j++) {
                        double sum = 0;
                        for (int l = 0; l < k; l++) sum += A[i * k + l] * B[l * b + j];
                        assert_true(fabs(C[i * b + j] - sum) < 1e-14);
                        assert_true(fabs(D[i * b + j] - sum) < 1e-14);
                    }
            }
}

static void general_systems_are_solved_with_pivoting(void **state)
{
    (void)state;
    struct random r = random_make(3, 0, 0);
    for (int n = 1; n <= 6; n++)
        for (int round = 0; round < 20; round++) {
            double A[36], kept[36], X[18], B[18] = {0};
            struct work w = {0};
            fill(&r, n * n, A);
            A[0] = 0; /* needs an interchange, except for n = 1 */
            if (n == 1) A[0] = 2;
            memcpy(kept, A, sizeof kept);
            fill(&r, n * 3, X);
            for (int i = 0; i < n; i++)
                for (int l = 0; l < 3; l++)
                    for (int k = 0; k < n; k++) B[i * 3 + l] += kept[i * n + k] * X[k * 3 + l];
            assert_true(dense_solve_general(n, 3, A, B, &w));
            for (int i = 0; i < n; i++) /* residual, not error: A may be badly conditioned */
                for (int l = 0; l < 3; l++) {
                    double rest = 0, size = 0;
                    for (int k = 0; k < n; k++) {
                        rest += kept[i * n + k] * (X[k * 3 + l] - B[k * 3 + l]);
                        size += fabs(kept[i * n + k] * B[k * 3 + l]);
                    }
                    assert_true(fabs(rest) <= 1e-13 * (size + 1));
                }
        }
    double singular[4] = {1, 2, 2, 4}, b[2] = {1, 1};
    struct work w = {0};
    assert_false(dense_solve_general(2, 1, singular, b, &w));
}

static void an_inverse_times_its_matrix_is_one(void **state)
{
    (void)state;
    struct random r = random_make(4, 0, 0);
    for (int c = 1; c <= 6; c++) {
        double A[36], inverse[36], unit[36];
        struct work w = {0};
        positive(&r, c, A);
        memcpy(inverse, A, sizeof A);
        assert_true(dense_invert(c, inverse, &w));
        assert_int_equal(operations(&w), 2 * c * c * c);
        dense_product(c, c, c, A, inverse, unit, &w);
        for (int i = 0; i < c * c; i++) assert_true(fabs(unit[i] - (i % (c + 1) == 0)) < 1e-10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(factor_and_solve_invert),
        cmocka_unit_test(what_is_not_positive_definite_is_refused),
        cmocka_unit_test(products_are_sums_of_products),
        cmocka_unit_test(general_systems_are_solved_with_pivoting),
        cmocka_unit_test(an_inverse_times_its_matrix_is_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
