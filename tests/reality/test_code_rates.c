/* test_code_rates.c - prices of code are found again from times that a known processor would take,
 * exact and with noise, also where a loop takes the longest of several times. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "reality/code_rates.h"

/* A loop: how often each price counts, and what no price explains [cycles]. */
struct loop {
    double issue, div, root, chain, step, rest, load, whole, add, multiply, fetch, late, product;
    double round; /* cycles of a round by itself, with 40 instructions that wait */
};

static const struct loop loops[] = {
    {7, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {8, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {6, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {5, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {4, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {30, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {12, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {9, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {14, 0, 0, 0, 1, 20, 0, 0, 0, 0, 0, 0, 0, 0}, {9, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {9, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {8, 0, 0, 0, 1, 0, 5, 0, 0, 0, 0, 0, 0, 0},
    {9, 0, 0, 0, 1, 0, 7, 0, 0, 0, 0, 0, 0, 0}, {12, 0, 0, 0, 1, 0, 0, 11, 0, 0, 0, 0, 0, 0},
    {9, 0, 0, 1, 0, 0, 1, 9, 0, 0, 0, 0, 0, 0}, {9, 0, 0, 0, 1, 0, 2, 2, 8, 1, 0, 0, 0, 0},
    {9, 0, 0, 0, 1, 0, 2, 2, 1, 9, 0, 0, 0, 0}, {12, 0, 0, 0, 1, 0, 2, 2, 1, 1, 4, 0, 0, 0},
    {6, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0}, {6, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0, 1, 0},
    {6, 0, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0}, {6, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 90},
    {6, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 50},
};
enum { LOOPS = sizeof loops / sizeof loops[0] };

static const double truth[CODE_PRICES] = {0.2, 6,   9,   2.8, 0.9, 0.5,  0.3,
                                          0.6, 0.7, 1.1, 3.4, 3.8, 0.008};
static int asked;

/* The longer of what is issued and the chain, as node_cost_bound_of has it; 1 cycle is 1 ns. */
static bool time_of(void *context, int i, const double *price, double *seconds, struct err *e)
{
    const struct loop *l = &loops[i];
    const double issue = l->issue * price[0] + l->rest,
                 divide = l->div * price[1] + l->root * price[2],
                 chain = l->chain * price[3] + l->step * price[4] + l->late * price[10] +
                         l->product * price[11],
                 window = l->round * 40 / (40 + code_price_window(price)),
                 units = fmax(
                     fmax(l->load * price[5], l->whole * price[6]),
                     fmax(fmax(l->add * price[7], l->multiply * price[8]), l->fetch * price[9]));
    asked++;
    if (context != NULL && *(const int *)context == asked) return err_set(e, ERR_CHECK, "no time");
    *seconds = 1e-9 * fmax(fmax(fmax(issue, divide), chain), fmax(units, window));
    return true;
}

static void measure(struct code_rates *r, double noise)
{
    struct err e;
    *r = (struct code_rates){.n = LOOPS};
    for (int i = 0; i < LOOPS; i++) {
        assert_true(time_of(NULL, i, truth, &r->sample[i].seconds, &e));
        r->sample[i].seconds *= 1 + (i % 2 ? noise : -noise);
    }
}

static void prices_are_found_again(void **state)
{
    (void)state;
    struct code_rates r;
    struct err e;
    err_clear(&e);
    measure(&r, 0);
    assert_true(code_rates_fit(&r, time_of, NULL, &e));
    for (int j = 0; j < CODE_PRICES; j++)
        assert_true(fabs(r.price[j] - truth[j]) <= 0.02 * truth[j]);
    assert_true(r.residual < 0.02);
    assert_true(r.median_residual <= r.residual);
    /* what is fitted is what the prices give */
    double seconds;
    assert_true(time_of(NULL, 3, r.price, &seconds, &e));
    assert_true(fabs(seconds - r.sample[3].fitted) <= 1e-15);
}

static void noise_stays_in_the_residual(void **state)
{
    (void)state;
    struct code_rates r;
    struct err e;
    err_clear(&e);
    measure(&r, 0.05);
    assert_true(code_rates_fit(&r, time_of, NULL, &e));
    assert_true(r.residual < 0.15);
    assert_true(r.median_residual < 0.08);
    for (int j = 0; j < CODE_PRICES; j++) {
        assert_true(r.price[j] >= 0);
        assert_true(fabs(r.price[j] - truth[j]) <= 0.5 * truth[j]);
    }
}

static void what_cannot_be_fitted_is_said(void **state)
{
    (void)state;
    struct code_rates r;
    struct err e;
    err_clear(&e);
    measure(&r, 0);
    r.n = CODE_PRICES - 1;
    assert_false(code_rates_fit(&r, time_of, NULL, &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "12 loops are too few"));
    /* a time that cannot be told, at any place */
    for (int stop = 1; stop < 40; stop++) {
        measure(&r, 0);
        err_clear(&e);
        asked = 0;
        assert_false(code_rates_fit(&r, time_of, &stop, &e));
        assert_string_equal(e.text, "no time");
    }
    assert_string_equal(code_price_name(0), "issue");
    assert_string_equal(code_price_name(4), "step");
    assert_string_equal(code_price_name(6), "whole");
    assert_string_equal(code_price_name(9), "fetch");
    assert_string_equal(code_price_name(11), "multiply_latency");
    assert_string_equal(code_price_name(CODE_WINDOW), "window");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prices_are_found_again),
        cmocka_unit_test(noise_stays_in_the_residual),
        cmocka_unit_test(what_cannot_be_fitted_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
