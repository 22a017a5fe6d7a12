/* test_random.c - random streams: the published generator, independent streams, unbiased and in
 * range. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"

static void the_generator_is_xoshiro256starstar(void **state)
{
    (void)state;
    /* From state {1, 2, 3, 4}: the first two outputs by hand, the next by the authors' reference
     * program. */
    struct random r = {{1, 2, 3, 4}};
    static const uint64_t expected[] = {11520, 0, 1509978240, 1215971899390074240};
    for (int i = 0; i < 4; i++) assert_true(random_u64(&r) == expected[i]);
}

static void streams_are_repeated_by_name_and_differ_between_names(void **state)
{
    (void)state;
    struct random a = random_make(7, 1, 2), again = random_make(7, 1, 2);
    for (int i = 0; i < 100; i++) assert_true(random_u64(&a) == random_u64(&again));
    static const uint64_t names[][3] = {{7, 1, 2}, {7, 2, 1}, {8, 1, 2}, {7, 1, 3},
                                        {7, 2, 2}, {0, 0, 0}, {1, 2, 7}};
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < i; j++) {
            struct random x = random_make(names[i][0], names[i][1], names[i][2]);
            struct random y = random_make(names[j][0], names[j][1], names[j][2]);
            int equal = 0;
            for (int k = 0; k < 64; k++) equal += random_u64(&x) == random_u64(&y);
            assert_int_equal(equal, 0);
        }
}

static void uniform_numbers_stay_below_the_end_and_fill_the_interval(void **state)
{
    (void)state;
    struct random r = random_make(1, 0, 0);
    double sum = 0, square = 0;
    enum { N = 200000 };
    for (int i = 0; i < N; i++) {
        double x = random_uniform(&r, -3, 5);
        assert_true(x >= -3 && x < 5);
        sum += x;
        square += (x - 1) * (x - 1);
    }
    assert_true(fabs(sum / N - 1) < 0.03);             /* 6 standard errors */
    assert_true(fabs(square / N - 64.0 / 12) < 0.07);
    for (int i = 0; i < 10000; i++) assert_true(random_uniform(&r, 1, 1 + 0x1p-52) == 1);
}

static void normal_numbers_have_the_moments_of_the_normal_law(void **state)
{
    (void)state;
    struct random r = random_make(2, 0, 0);
    double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
    enum { N = 200000 };
    for (int i = 0; i < N; i++) {
        double x = random_normal(&r);
        m1 += x / N;
        m2 += x * x / N;
        m3 += x * x * x / N;
        m4 += x * x * x * x / N;
    }
    assert_true(fabs(m1) < 0.0135 && fabs(m2 - 1) < 0.02 && fabs(m3) < 0.055 &&
                fabs(m4 - 3) < 0.14);
}

static void integers_below_n_are_equally_likely(void **state)
{
    (void)state;
    struct random r = random_make(3, 0, 0);
    int count[6] = {0};
    for (int i = 0; i < 60000; i++) {
        uint64_t k = random_below(&r, 6);
        assert_true(k < 6);
        count[k]++;
    }
    for (int k = 0; k < 6; k++) assert_in_range(count[k], 9400, 10600);
    for (int i = 0; i < 100; i++) assert_true(random_below(&r, 1) == 0);
    /* n = 3 2^62: a plain remainder would give the lowest third half of all cases instead of a
     * third. */
    int low = 0;
    for (int i = 0; i < 30000; i++) low += random_below(&r, UINT64_C(3) << 62) < UINT64_C(1) << 62;
    assert_in_range(low, 9400, 10600);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_generator_is_xoshiro256starstar),
        cmocka_unit_test(streams_are_repeated_by_name_and_differ_between_names),
        cmocka_unit_test(uniform_numbers_stay_below_the_end_and_fill_the_interval),
        cmocka_unit_test(normal_numbers_have_the_moments_of_the_normal_law),
        cmocka_unit_test(integers_below_n_are_equally_likely),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
