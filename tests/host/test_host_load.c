/* test_host_load.c - what the system tells of its load and processors, and statistics of
 * repetitions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "base/progress.h"
#include "host/host_comm.h"
#include "host/host_load.h"

/* Own work is not others'. */
static void own_work_is_not_load(void **state)
{
    (void)state;
    const struct host_load_begin b = host_load_start();
    const double own = host_processor_seconds();
    const int64_t until = host_clock_ns() + 400000000;
    while (host_clock_ns() < until) continue;
    const double used = host_processor_seconds() - own;
    const struct host_load with = host_load_read(&b, used), without = host_load_read(&b, 0);
    assert_true(with.others >= 0 && with.others < without.others);
    assert_true(without.others - with.others <= used / 0.4 + 1e-9);
    assert_true(with.before >= 0 && with.after >= 0);
}

static void too_short_to_tell(void **state)
{
    (void)state;
    const struct host_load_begin b = host_load_start();
    assert_true(isnan(host_load_read(&b, 0).others));
}

static void processors_are_counted(void **state)
{
    char name[64] = "?";
    (void)state;
    assert_int_equal(host_processors(0x5), 2);
    assert_int_equal(host_processors(UINT64_C(1) << 61), 1);
    assert_true(host_processors(UINT64_C(1) << 62) >= 1);
    assert_true(host_processors(host_processor_set()) >= 1);
    host_name(name, (int)sizeof name);
    assert_true(strlen(name) > 0 && strcmp(name, "?") != 0);
    host_processor_name(name, (int)sizeof name);
    assert_null(strchr(name, '\n'));
}

/* Quartiles of type 7: between neighbours. */
static void quartiles(void **state)
{
    double five[] = {5, 1, 4, 2, 3}, four[] = {4, 3, 2, 1}, one[] = {7};
    (void)state;
    struct real_times t = real_times_of(five, 5);
    assert_true(t.min == 1 && t.lower == 2 && t.median == 3 && t.upper == 4 && t.max == 5);
    t = real_times_of(four, 4);
    assert_true(t.lower == 1.75 && t.median == 2.5 && t.upper == 3.25);
    t = real_times_of(one, 1);
    assert_true(t.min == 7 && t.lower == 7 && t.median == 7 && t.upper == 7 && t.max == 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(own_work_is_not_load), cmocka_unit_test(too_short_to_tell),
        cmocka_unit_test(processors_are_counted), cmocka_unit_test(quartiles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
