/* test_sorted.c - numbers in rising order, and quantiles between them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "base/sorted.h"

enum { MOST = 300 };

/* How many of x are below, and how many equal to v: what an order must have before v. */
static void count(const double *x, size_t n, double v, size_t *below, size_t *equal)
{
    *below = *equal = 0;
    for (size_t i = 0; i < n; i++) *below += x[i] < v, *equal += x[i] == v;
}

/* Each number stands where as many smaller ones as there are come before it: rising, none lost,
 * none twice. */
static void numbers_stand_at_their_ranks(void **state)
{
    (void)state;
    struct random r = random_make(4711, 0, 0);
    for (size_t n = 0; n <= MOST; n = n < 4 ? n + 1 : 3 * n / 2) {
        double x[MOST], sorted[MOST];
        for (size_t i = 0; i < n; i++) {
            /* many equal ones, both signs, and the ends of what a double holds */
            x[i] = floor(random_uniform(&r, -20, 20));
            if (random_below(&r, 20) == 0) x[i] = random_below(&r, 2) ? INFINITY : -INFINITY;
            if (random_below(&r, 20) == 0) x[i] = 5e-324 * (double)random_below(&r, 3);
            sorted[i] = x[i];
        }
        sort_numbers(sorted, n);
        for (size_t i = 0; i < n; i++) {
            size_t below, equal;
            count(x, n, sorted[i], &below, &equal);
            assert_true(equal > 0 && i >= below && i < below + equal);
        }
    }
}

/* Type 7 by hand: place (n - 1) share, in proportion between its neighbours. */
static void quantiles_lie_between_neighbours(void **state)
{
    (void)state;
    static const double one[] = {7}, four[] = {1, 2, 4, 8}, five[] = {-3, 0, 0, 10, 30};
    static const struct {
        const double *x;
        int n;
        double share, expected;
    } row[] = {
        {one, 1, 0, 7},       {one, 1, 0.3, 7},    {one, 1, 1, 7},        {four, 4, 0, 1},
        {four, 4, 1, 8},      {four, 4, 0.5, 3},   {four, 4, 0.25, 1.75}, {four, 4, 0.75, 5},
        {four, 4, 0.9, 6.8},  {five, 5, 0.5, 0},   {five, 5, 0.25, 0},    {five, 5, 0.125, -1.5},
        {five, 5, 0.875, 20}, {five, 5, 0.75, 10},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const double found = sorted_quantile(row[i].x, row[i].n, row[i].share);
        if (fabs(found - row[i].expected) > 1e-14)
            fail_msg("row %zu: %.17g, expected %.17g", i, found, row[i].expected);
    }
}

/* Of evenly spaced numbers every share is its own quantile; a larger share has no smaller one. */
static void quantiles_rise_with_their_share(void **state)
{
    (void)state;
    double even[101], random_one[64];
    struct random r = random_make(12, 0, 0);
    for (int i = 0; i < 101; i++) even[i] = i / 100.0;
    for (int i = 0; i < 64; i++) random_one[i] = random_uniform(&r, -1, 1);
    sort_numbers(random_one, 64);
    double last = -1;
    for (int k = 0; k <= 1000; k++) {
        const double share = k / 1000.0, q = sorted_quantile(random_one, 64, share);
        assert_true(fabs(sorted_quantile(even, 101, share) - share) < 1e-14);
        assert_true(q >= last);
        last = q;
    }
    assert_true(last == random_one[63]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_stand_at_their_ranks),
        cmocka_unit_test(quantiles_lie_between_neighbours),
        cmocka_unit_test(quantiles_rise_with_their_share),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
