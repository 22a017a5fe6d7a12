/* test_variance.c - Sobol' indices against closed forms: the functions of Ishigami and of Sobol',
 * and a sum. */
#include "study/variance.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

typedef double function(const double *x, int k);

/* Evaluate f at the design; the shares come back. Returns the variance. */
static double shares_of(function *f, int n, int k, struct variance_share *share)
{
    const int64_t rows = variance_rows(n, k);
    double *u = malloc((size_t)(rows * k) * sizeof *u), *y = malloc((size_t)rows * sizeof *y);
    variance_design(0, n, k, u);
    for (int64_t i = 0; i < rows; i++) y[i] = f(&u[i * k], k);
    const double variance = variance_shares(n, k, y, share);
    free(u);
    free(y);
    return variance;
}

static void is_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.4f, not %.4f", value, expected);
}

/* Ishigami and Homma 1990: sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, x_i uniform in (-pi, pi). */
static double ishigami(const double *x, int k)
{
    (void)k;
    const double a = M_PI * (2 * x[0] - 1), b = M_PI * (2 * x[1] - 1), c = M_PI * (2 * x[2] - 1);
    return sin(a) + 7 * sin(b) * sin(b) + 0.1 * pow(c, 4) * sin(a);
}

static void ishigami_has_its_closed_form(void **state)
{
    (void)state;
    const double a = 7, b = 0.1, p4 = pow(M_PI, 4), p8 = p4 * p4,
                 v1 = 0.5 * (1 + b * p4 / 5) * (1 + b * p4 / 5), v2 = a * a / 8,
                 v13 = b * b * p8 * (1. / 18 - 1. / 50), v = v1 + v2 + v13;
    struct variance_share s[3];
    is_near(shares_of(ishigami, 4096, 3, s), v, 0.02 * v);
    is_near(s[0].first, v1 / v, 0.02);
    is_near(s[1].first, v2 / v, 0.02);
    is_near(s[2].first, 0, 0.02);
    is_near(s[0].total, (v1 + v13) / v, 0.02);
    is_near(s[1].total, v2 / v, 0.02);
    is_near(s[2].total, v13 / v, 0.02);
}

/* Sobol's g: the product of (|4 x_i - 2| + a_i) / (1 + a_i); V_i = 1 / (3 (1 + a_i)^2). */
static const double g_a[] = {0, 1, 4.5, 9, 99, 99, 99, 99};

static double g_function(const double *x, int k)
{
    double y = 1;
    for (int i = 0; i < k; i++) y *= (fabs(4 * x[i] - 2) + g_a[i]) / (1 + g_a[i]);
    return y;
}

static void g_has_its_closed_form(void **state)
{
    (void)state;
    enum { K = 8 };
    struct variance_share s[K];
    double all = 1;
    for (int i = 0; i < K; i++) all *= 1 + 1 / (3 * (1 + g_a[i]) * (1 + g_a[i]));
    const double v = all - 1;
    is_near(shares_of(g_function, 8192, K, s), v, 0.03 * v);
    for (int i = 0; i < K; i++) {
        const double vi = 1 / (3 * (1 + g_a[i]) * (1 + g_a[i]));
        is_near(s[i].first, vi / v, 0.03);
        is_near(s[i].total, vi * (all / (1 + vi)) / v, 0.03);
    }
}

/* Without interactions first and total are one, and they add up; more inputs than Sobol' has pairs
 * of dimensions. */
static double weighted_sum(const double *x, int k)
{
    double y = 1e6; /* a large mean must not drown anything */
    for (int i = 0; i < k; i++) y += (i % 4 == 0 ? 3 : 1) * x[i];
    return y;
}

static void a_sum_has_no_interactions(void **state)
{
    (void)state;
    static const int inputs[] = {4, 24};
    for (int c = 0; c < 2; c++) {
        const int k = inputs[c];
        struct variance_share s[24];
        shares_of(weighted_sum, 4096, k, s);
        double weights = 0, sum = 0;
        for (int i = 0; i < k; i++) weights += i % 4 == 0 ? 9 : 1;
        for (int i = 0; i < k; i++) {
            is_near(s[i].first, (i % 4 == 0 ? 9 : 1) / weights, 0.05);
            is_near(s[i].total, (i % 4 == 0 ? 9 : 1) / weights, 0.03);
            sum += s[i].total;
        }
        is_near(sum, 1, 0.06);
    }
}

/* The standard error says how far the estimate is off: in most cases less than twice that. */
static void standard_errors_cover_the_error(void **state)
{
    (void)state;
    struct variance_share s[8];
    double all = 1, v;
    int covered = 0, cases = 0;
    for (int i = 0; i < 8; i++) all *= 1 + 1 / (3 * (1 + g_a[i]) * (1 + g_a[i]));
    v = all - 1;
    for (int n = 64; n <= 1024; n *= 2) {
        shares_of(g_function, n, 8, s);
        for (int i = 0; i < 4; i++, cases += 2) {
            const double vi = 1 / (3 * (1 + g_a[i]) * (1 + g_a[i]));
            assert_true(s[i].first_error > 0 && s[i].total_error > 0);
            covered += fabs(s[i].first - vi / v) <= 2 * s[i].first_error;
            covered += fabs(s[i].total - vi * all / (1 + vi) / v) <= 2 * s[i].total_error;
        }
    }
    assert_true(covered >= 0.9 * cases);
}

static double constant(const double *x, int k)
{
    (void)x, (void)k;
    return 7;
}

static void nothing_to_share_is_not_known(void **state)
{
    (void)state;
    struct variance_share s[2];
    assert_true(shares_of(constant, 16, 2, s) == 0);
    assert_true(isnan(s[0].first) && isnan(s[1].total));
}

static void bands_are_quantiles_of_what_is_finite(void **state)
{
    (void)state;
    double y[101], none[] = {NAN};
    for (int i = 0; i < 100; i++) y[i] = 99 - i;
    y[100] = NAN;
    const struct variance_band b = variance_band(101, y);
    assert_int_equal(b.n, 100);
    is_near(b.low, 4.95, 1e-12);
    is_near(b.median, 49.5, 1e-12);
    is_near(b.high, 94.05, 1e-12);
    is_near(b.mean, 49.5, 1e-12);
    is_near(b.deviation, sqrt(100 * 101 / 12.), 1e-9);
    assert_true(isnan(variance_band(1, none).median));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ishigami_has_its_closed_form),
        cmocka_unit_test(g_has_its_closed_form),
        cmocka_unit_test(a_sum_has_no_interactions),
        cmocka_unit_test(standard_errors_cover_the_error),
        cmocka_unit_test(nothing_to_share_is_not_known),
        cmocka_unit_test(bands_are_quantiles_of_what_is_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
