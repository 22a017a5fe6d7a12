/* test_picoseconds.c - durations are exact as long as they fit, and never wrap. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/picoseconds.h"

static void durations_that_fit_are_the_nearest_picosecond(void **state)
{
    (void)state;
    assert_int_equal(ps_rounded(0), 0);
    assert_int_equal(ps_rounded(1.5), 2);
    assert_int_equal(ps_rounded(0x1p52), INT64_C(1) << 52);
    assert_int_equal(ps_later(5, 7), 12);
    assert_int_equal(ps_later(PS_LAST, PS_LAST - 1), PS_TOO_LONG - 1);
    assert_int_equal(ps_times(1 << 20, 1 << 20), INT64_C(1) << 40);
    assert_int_equal(ps_times(1, PS_LAST), PS_LAST);
}

static void what_is_longer_than_time_is_too_long(void **state)
{
    (void)state;
    assert_int_equal(ps_rounded(0x1p60), PS_TOO_LONG);
    assert_int_equal(ps_rounded(1e300), PS_TOO_LONG);
    assert_int_equal(ps_rounded(INFINITY), PS_TOO_LONG);
    assert_int_equal(ps_rounded(NAN), PS_TOO_LONG);
    assert_int_equal(ps_later(PS_TOO_LONG, PS_TOO_LONG), PS_TOO_LONG);
    assert_int_equal(ps_times(INT64_C(1) << 40, INT64_C(1) << 40), PS_TOO_LONG);
    assert_int_equal(ps_times(2, PS_LAST), PS_TOO_LONG);
    /* three of them and a clock still fit */
    assert_true(INT64_MAX - 3 * PS_TOO_LONG > PS_LAST);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(durations_that_fit_are_the_nearest_picosecond),
        cmocka_unit_test(what_is_longer_than_time_is_too_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
