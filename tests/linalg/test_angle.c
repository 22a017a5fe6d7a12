/* test_angle.c - our sine and cosine against the C library's in long double, and the batch against
 * the single. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/angle.h"

enum { N = 20000 };

/* Angles of all sizes, near multiples of pi/2, tiny ones. */
static double angle_of(struct random *r, int i)
{
    double x = random_uniform(r, -1, 1);
    switch (i % 5) {
    case 0: return 4 * x;
    case 1: return 1e3 * x;
    case 2: return 1e6 * x;
    case 3: return rint(1e5 * x) * 1.5707963267948966;
    default: return ldexp(x, -(i / 5) % 1000);
    }
}

static void errors_stay_under_one_ulp(void **state)
{
    (void)state;
    struct random r = random_make(1, 0, 0);
    for (int i = 0; i < N; i++) {
        double x = angle_of(&r, i), s, c;
        angle_sincos(x, &s, &c);
        assert_true(fabsl((long double)s - sinl((long double)x)) <=
                    0x1.0p-52L * fabsl(sinl((long double)x)));
        assert_true(fabsl((long double)c - cosl((long double)x)) <=
                    0x1.0p-52L * fabsl(cosl((long double)x)));
    }
}

static void huge_angles_and_special_values_go_to_the_library(void **state)
{
    (void)state;
    const double x[] = {1e9, -1e300, 2e6};
    double s, c;
    for (int i = 0; i < 3; i++) {
        angle_sincos(x[i], &s, &c);
        assert_true(s == sin(x[i]) && c == cos(x[i]));
    }
    angle_sincos(0, &s, &c);
    assert_true(s == 0 && c == 1);
    angle_sincos(NAN, &s, &c);
    assert_true(isnan(s) && isnan(c));
}

static void batch_equals_single_bit_by_bit(void **state)
{
    (void)state;
    static double x[N], s[N], c[N];
    struct random r = random_make(2, 0, 0);
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < N; i++) x[i] = angle_of(&r, i);
        if (round == 1) x[17] = 1e8;
        angle_sincos_batch(N, x, s, c);
        for (int i = 0; i < N; i++) {
            double s1, c1;
            angle_sincos(x[i], &s1, &c1);
            assert_true(s[i] == s1 && c[i] == c1);
        }
    }
}

/* Whole vectors, overlapping last ones, and too few for one; nothing is written beside the
 * batch. */
static void batches_of_all_lengths_are_the_same_bits(void **state)
{
    (void)state;
    enum { MOST = 40, GUARD = 3 };
    double x[MOST + 1], s[MOST + 2 * GUARD], c[MOST + 2 * GUARD];
    struct random r = random_make(3, 0, 0);
    for (int i = 0; i <= MOST; i++) x[i] = i % 7 == 0 ? -0.0 : angle_of(&r, i);
    for (int n = 0; n <= MOST; n++)
        for (int from = 0; from < 2 && from + n <= MOST; from++) {
            for (int i = 0; i < MOST + 2 * GUARD; i++) s[i] = c[i] = 7;
            angle_sincos_batch(n, x + from, s + GUARD, c + GUARD);
            for (int i = 0; i < n; i++) {
                double s1, c1;
                angle_sincos(x[from + i], &s1, &c1);
                assert_memory_equal(&s[GUARD + i], &s1, sizeof s1);
                assert_memory_equal(&c[GUARD + i], &c1, sizeof c1);
            }
            for (int i = 0; i < GUARD; i++) {
                assert_true(s[i] == 7 && c[i] == 7);
                assert_true(s[GUARD + n + i] == 7 && c[GUARD + n + i] == 7);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_stay_under_one_ulp),
        cmocka_unit_test(huge_angles_and_special_values_go_to_the_library),
        cmocka_unit_test(batch_equals_single_bit_by_bit),
        cmocka_unit_test(batches_of_all_lengths_are_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
