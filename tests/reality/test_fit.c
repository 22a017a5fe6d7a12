/* test_fit.c - prices and lines out of times that are known to have been made of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "reality/fit.h"

static void near(double x, double y) { assert_true(fabs(x - y) <= 1e-9 * fabs(y) + 1e-300); }

/* Exact data give the exact line. */
static void lines(void **state)
{
    const double x[] = {0, 8, 64, 1024}, y[] = {3e-7, 3.008e-7, 3.064e-7, 4.024e-7};
    (void)state;
    const struct fit_line l = fit_line_of(x, y, 4);
    near(l.at_zero, 3e-7);
    near(l.slope, 1e-10);
    assert_true(l.residual < 1e-9);
}

/* A falling line would have a negative slope: it is a constant, and the residual says so. */
static void falling_lines(void **state)
{
    const double x[] = {0, 100}, y[] = {2, 1}, one[] = {5}, alike[] = {7, 7}, two[] = {1, 3};
    (void)state;
    struct fit_line l = fit_line_of(x, y, 2);
    assert_true(l.slope == 0 && l.at_zero > 1 && l.at_zero < 2 && l.residual > 0.1);
    l = fit_line_of(one, y, 1);
    assert_true(l.at_zero == 2 && l.slope == 0 && l.residual == 0);
    l = fit_line_of(alike, two, 2);
    assert_true(l.slope == 0 && l.at_zero > 1 && l.at_zero < 3);
    const double nothing[] = {0, 0};
    l = fit_line_of(x, nothing, 2);
    assert_true(l.at_zero == 0 && l.slope == 0);
}

/* Three prices of very different size, of counts of very different size. */
static void prices(void **state)
{
    double count[12 * 3], y[12], x[3], residual;
    const double price[3] = {2.5e-10, 4e-8, 1e-6};
    (void)state;
    for (int i = 0; i < 12; i++) {
        const double row[3] = {1e3 * (i + 1) * (i + 1), 7.0 * (i + 1), 1};
        y[i] = 0;
        for (int j = 0; j < 3; j++) {
            count[3 * i + j] = row[j];
            y[i] += row[j] * price[j];
        }
    }
    assert_true(fit_prices(count, y, 12, 3, x, &residual));
    for (int j = 0; j < 3; j++) assert_true(fabs(x[j] - price[j]) < 1e-6 * price[j]);
    assert_true(residual < 1e-9);
}

/* No price is negative: what would be is left out, and the others are fitted without it. */
static void no_price_is_negative(void **state)
{
    const double count[] = {1, 1, 1, 2, 1, 3, 1, 4}, y[] = {4, 3, 2, 1};
    double x[2], residual;
    (void)state;
    assert_true(fit_prices(count, y, 4, 2, x, &residual));
    assert_true(x[0] > 0 && x[1] == 0 && residual > 0.1);
}

/* A class that no sample has costs nothing, and asks for no equation of its own. */
static void unused_classes(void **state)
{
    const double count[] = {1, 0, 2, 0}, y[] = {3, 6}, none[] = {0, 0};
    double x[2], residual;
    (void)state;
    assert_true(fit_prices(count, y, 2, 2, x, &residual));
    near(x[0], 3);
    assert_true(x[1] == 0);
    assert_false(fit_prices(none, y, 1, 2, x, &residual));
    const double two[] = {1, 2};
    assert_false(fit_prices(two, y, 1, 2, x, &residual));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines), cmocka_unit_test(falling_lines), cmocka_unit_test(prices),
        cmocka_unit_test(no_price_is_negative), cmocka_unit_test(unused_classes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
