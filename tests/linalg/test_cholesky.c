/* test_cholesky.c - dense systems in quad precision: answers far beyond double, also of systems
 * that double precision cannot factor. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/cholesky.h"

enum { MOST = 40 };

/* m x = b for x_i = 1 / (i + 1), which no precision holds exactly; the largest error of what comes
 * back, over the largest number, 1. Negative: no factor. */
static double error_of(int n, const real *m, real scale)
{
    static real copy[MOST * MOST], x[MOST];
    struct arena *a = arena_create();
    for (int i = 0; i < n; i++) {
        x[i] = 0;
        for (int k = 0; k < n; k++) {
            copy[i * n + k] = scale * m[i * n + k];
            x[i] += copy[i * n + k] * (1 / (real)(k + 1));
        }
    }
    real worst = 0;
    const bool good = cholesky_answer(n, copy, x, a);
    for (int i = 0; i < n; i++) {
        const real wrong = real_fabs(x[i] - 1 / (real)(i + 1));
        if (!(wrong <= worst)) worst = wrong;
    }
    arena_destroy(a);
    return good ? (double)worst : -1;
}

/* B B^T + U with numbers of B in (-1, 1). */
static void random_matrix(int n, int seed, real *m)
{
    static real b[MOST * MOST];
    struct random r = random_make(1, 2, (uint64_t)seed);
    for (int i = 0; i < n * n; i++) b[i] = random_uniform(&r, -1, 1);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            m[i * n + j] = i == j;
            for (int k = 0; k < n; k++) m[i * n + j] += b[i * n + k] * b[j * n + k];
        }
}

/* 1 / (i + j + 1), whose condition grows by 30 a row: 1e13 for 10, 1e19 for 14. */
static void hilbert(int n, real *m)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) m[i * n + j] = 1 / (real)(i + j + 1);
}

static void quad_digits_of_a_double_factor(void **state)
{
    (void)state;
    static real m[MOST * MOST];
    static const int size[] = {1, 2, 3, 7, 20, MOST};
    for (int k = 0; k < 6; k++) {
        random_matrix(size[k], k, m);
        const double error = error_of(size[k], m, 1);
        assert_true(error >= 0 && error < 1e-24);
    }
    /* Three digits a correction are enough, too. */
    hilbert(10, m);
    const double error = error_of(10, m, 1);
    assert_true(error >= 0 && error < 1e-18);
}

/* As good as singular in double precision; numbers that doubles do not hold. */
static void systems_beyond_double(void **state)
{
    (void)state;
    static real m[MOST * MOST];
    hilbert(14, m);
    double error = error_of(14, m, 1);
    assert_true(error >= 0 && error < 1e-12);
    random_matrix(9, 1, m);
    error = error_of(9, m, 1e-310Q);
    assert_true(error >= 0 && error < 1e-24);
    error = error_of(9, m, 1e310Q);
    assert_true(error >= 0 && error < 1e-24);
}

static void what_is_not_definite_is_refused(void **state)
{
    (void)state;
    real m[] = {1, 2, 2, 1}, zero[] = {0};
    assert_true(error_of(2, m, 1) < 0);
    assert_true(error_of(1, zero, 1) < 0);
    assert_true(error_of(2, m, -1) < 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quad_digits_of_a_double_factor),
        cmocka_unit_test(systems_beyond_double),
        cmocka_unit_test(what_is_not_definite_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
