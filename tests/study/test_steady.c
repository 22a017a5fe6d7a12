/* test_steady.c - warm-up, interval, trend and quantiles of series whose answers are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>

#include <cmocka.h>

#include "base/random.h"
#include "study/steady.h"

enum { N = 4000 };

/* A transient of `length` values that begins `height` above the mean 10 of noise with deviation 1.
 */
static void series(double *x, int n, int length, double height, uint64_t seed)
{
    struct random r = random_make(seed, 1, 2);
    for (int i = 0; i < n; i++)
        x[i] = 10 + random_normal(&r) + (i < length ? height * (length - i) / length : 0);
}

/* The transient is left out, and not much more; without one little is. */
static void warm_up_ends_with_the_transient(void **state)
{
    (void)state;
    static const int length[] = {200, 500, 1000};
    double x[N];
    bool settled;
    for (uint64_t seed = 0; seed < 20; seed++)
        for (int k = 0; k < 3; k++) {
            series(x, N, length[k], 20, seed);
            int64_t d = steady_mser(x, N, &settled);
            assert_true(settled);
            assert_int_equal(d % 5, 0);
            assert_true((double)d > 0.8 * length[k] && d < length[k] + 400);
            struct steady s = steady_state(x, N);
            assert_true(s.settled && fabs(s.mean - 10) < 0.12);
        }
}

/* By hand: batches of five with means 9, 1, 1, 1, 1, 1, 1, 1 leave out one batch. */
static void mser_of_a_series_by_hand(void **state)
{
    (void)state;
    double x[80];
    bool settled;
    for (int i = 0; i < 40; i++) x[i] = i < 5 ? 9 : 1;
    assert_int_equal(steady_mser(x, 40, &settled), 5);
    assert_true(settled);
    /* nothing varies: nothing is left out */
    for (int i = 0; i < 40; i++) x[i] = 1;
    assert_int_equal(steady_mser(x, 40, &settled), 0);
    /* a step in the second half: the minimum is behind it, and half is left out */
    for (int i = 0; i < 80; i++) x[i] = i < 50 ? 9 : 1;
    assert_int_equal(steady_mser(x, 80, &settled), 40);
    assert_false(settled);
}

/* Of 2000 series without memory the interval contains the mean in about 95 %. */
static void intervals_contain_the_mean_as_often_as_they_say(void **state)
{
    (void)state;
    double x[N];
    int covered = 0, rising = 0;
    for (uint64_t seed = 0; seed < 2000; seed++) {
        series(x, 1000, 0, 0, seed);
        struct steady s = steady_state(x, 1000);
        covered += fabs(s.mean - 10) <= s.half;
        rising += s.trend > s.trend_99;
        assert_true(s.half > 0 && fabs(s.lag) < 1);
    }
    assert_in_range(covered, 1840, 1940);
    /* one of 200 by chance: 10 expected */
    assert_in_range(rising, 0, 25);
}

static void growth_is_seen(void **state)
{
    (void)state;
    double x[N];
    struct random r = random_make(1, 1, 1);
    for (int i = 0; i < N; i++) x[i] = 0.01 * i + random_normal(&r);
    struct steady s = steady_state(x, N);
    assert_false(s.settled);
    assert_true(s.trend > 10 * s.trend_99);
    /* what falls has a trend of the other sign */
    for (int i = 0; i < N; i++) x[i] = -x[i];
    assert_true(steady_state(x, N).trend < -s.trend_99);
}

/* Neighbours that are alike: the autocorrelation of long batches tells it. */
static void slow_series_have_correlated_batches(void **state)
{
    (void)state;
    double x[N], slow = 0;
    struct random r = random_make(3, 1, 1);
    for (int i = 0; i < N; i++) x[i] = slow = 0.999 * slow + random_normal(&r);
    assert_true(steady_state(x, N).lag > 0.45);
    /* nothing varies: no interval, no trend */
    for (int i = 0; i < N; i++) x[i] = 3;
    struct steady s = steady_state(x, N);
    assert_true(s.half == 0 && s.trend == 0 && s.lag == 0 && s.mean == 3);
}

static void quantiles_are_by_nearest_rank(void **state)
{
    (void)state;
    const double x[] = {1, 2, 3, 4};
    assert_true(steady_quantile(x, 4, 0.5) == 2 && steady_quantile(x, 4, 0.51) == 3);
    assert_true(steady_quantile(x, 4, 0) == 1 && steady_quantile(x, 4, 1) == 4 &&
                steady_quantile(x, 1, 0.99) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(warm_up_ends_with_the_transient),
        cmocka_unit_test(mser_of_a_series_by_hand),
        cmocka_unit_test(intervals_contain_the_mean_as_often_as_they_say),
        cmocka_unit_test(growth_is_seen),
        cmocka_unit_test(slow_series_have_correlated_batches),
        cmocka_unit_test(quantiles_are_by_nearest_rank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
