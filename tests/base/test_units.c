/* test_units.c - quantities with units: what is read, what is refused and how it is said, what is
 * printed. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "base/units.h"

static const char *why_not(const char *text, enum unit unit)
{
    static _Thread_local char why[256];
    double value = 42;
    if (units_parse(text, unit, &value, why, sizeof why)) fail_msg("'%s' was accepted", text);
    if (value != 42) fail_msg("'%s' was refused and yet stored", text);
    return why;
}

static void reads(const char *text, enum unit unit, double expected)
{
    double value = NAN;
    char why[256] = "";
    if (!units_parse(text, unit, &value, why, sizeof why))
        fail_msg("'%s' was refused: %s", text, why);
    if (value != expected) fail_msg("'%s' is %.17g, not %.17g", text, value, expected);
}

static void units_of_every_kind_are_read(void **state)
{
    (void)state;
    reads("-2.5", UNIT_NONE, -2.5);
    reads("12 us", UNIT_TIME, 12e-6);
    reads("3 s", UNIT_TIME, 3);
    reads("64 KiB", UNIT_BYTES, 65536);
    reads("24 bit", UNIT_BYTES, 3);
    reads("480 MB/s", UNIT_BANDWIDTH, 480e6);
    reads("1 GiB/s", UNIT_BANDWIDTH, 1073741824);
    reads("3.2 ns/B", UNIT_TIME_PER_BYTE, 3.2e-9);
    reads("1 us/kB", UNIT_TIME_PER_BYTE, 1e-9);
    reads("1 ns/bit", UNIT_TIME_PER_BYTE, 8e-9);
    reads("300 MHz", UNIT_FREQUENCY, 300e6);
    reads("46.8 Mflop/s", UNIT_FLOP_RATE, 46.8e6);
    reads("1 cycle", UNIT_CYCLES, 1);
    reads("31 cycles", UNIT_CYCLES, 31);
    reads("1.54 angstrom", UNIT_LENGTH, 1.54e-10);
    reads("250 g", UNIT_MASS, 0.25);
    reads("2 kg", UNIT_MASS, 2);
    reads("180 deg", UNIT_ANGLE, 3.14159265358979323846);
    reads("0.2 rad/s", UNIT_ANGULAR_RATE, 0.2);
    reads("2 rad/s^2", UNIT_ANGULAR_ACCELERATION, 2);
    reads("9.81 m/s^2", UNIT_ACCELERATION, 9.81);
    reads("5 %", UNIT_PERCENT, 0.05);
    reads("2 kN m/rad", UNIT_STIFFNESS, 2000);
    reads("3 mN m s/rad", UNIT_DAMPING, 3e-3);
    reads("4 N m", UNIT_TORQUE, 4);
}

static void an_atomic_mass_is_the_codata_value(void **state)
{
    (void)state;
    double value;
    char why[256];
    assert_true(units_parse("12 amu", UNIT_MASS, &value, why, sizeof why));
    assert_true(fabs(value / (12 * 1.66053906660e-27) - 1) < 1e-15);
}

static void bits_and_bytes_differ_by_eight(void **state)
{
    (void)state;
    reads("1 GB/s", UNIT_BANDWIDTH, 1e9);
    reads("1 Gb/s", UNIT_BANDWIDTH, 1.25e8);
    reads("1 Gbit/s", UNIT_BANDWIDTH, 1.25e8);
    reads("8 Mib/s", UNIT_BANDWIDTH, 1048576);
}

static void values_are_rounded_once(void **state)
{
    (void)state;
    /* The products 60 * 1e-9 and 4.35 * 1e-6 are not the doubles nearest to 6e-8 and 4.35e-6. */
    reads("60 ns", UNIT_TIME, 6e-8);
    reads("4.35 us", UNIT_TIME, 4.35e-6);
    reads("0.1e3 ps", UNIT_TIME, 1e-10);
    reads("7 %", UNIT_PERCENT, 0.07);
}

static void people_write_units_in_many_ways(void **state)
{
    (void)state;
    reads("  60ns ", UNIT_TIME, 6e-8);
    reads("3 \302\265s", UNIT_TIME, 3e-6);
    reads("3 \316\274s", UNIT_TIME, 3e-6);
    reads("2 N*m", UNIT_TORQUE, 2);
    reads("2 N\302\267m", UNIT_TORQUE, 2);
    reads("2 N  m", UNIT_TORQUE, 2);
    reads("9 m/s\302\262", UNIT_ACCELERATION, 9);
    reads("+.5e+1 MB", UNIT_BYTES, 5e6);
}

static void a_missing_unit_is_refused_with_an_example(void **state)
{
    (void)state;
    assert_string_equal(why_not("480", UNIT_BANDWIDTH),
                        "no unit; expected a bandwidth such as '480 MB/s'");
    assert_string_equal(why_not("0", UNIT_TIME), "no unit; expected a time such as '12 us'");
}

static void a_unit_of_another_kind_is_named(void **state)
{
    (void)state;
    assert_string_equal(why_not("5 MHz", UNIT_BANDWIDTH),
                        "'MHz' is the unit of a frequency; expected a bandwidth such as '480 "
                        "MB/s'");
    assert_string_equal(why_not("5 s", UNIT_NONE),
                        "unexpected unit 's'; expected a bare number such as '3'");
}

static void a_misspelt_unit_gets_a_suggestion(void **state)
{
    (void)state;
    assert_string_equal(why_not("480 mb/s", UNIT_BANDWIDTH),
                        "unknown unit 'mb/s'; did you mean 'MB/s'?");
    assert_string_equal(why_not("3 MHZ", UNIT_FREQUENCY),
                        "unknown unit 'MHZ'; did you mean 'MHz'?");
    assert_string_equal(why_not("3 KB", UNIT_BYTES),
                        "ambiguous unit 'KB'; write 'kB' for 1000 or 'KiB' for 1024");
    assert_non_null(
        strstr(why_not("3 parsecs", UNIT_BANDWIDTH), "'parsecs' is not the unit of a bandwidth"));
}

static void what_is_no_finite_number_is_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "inf s", "nan s", "-infinity s", "0x10 s", "1e999 s", "1e-999 s", "s",    "",    ".",
        "e5 s",  "- 1 s", "1,000 s",     "1 s s",  "1 s.",    "1 2 s",    "1e s", "1 S", "1 m"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_true(why_not(bad[i], UNIT_TIME)[0] != '\0');
    assert_true(why_not("1 x", UNIT_NONE)[0] != '\0');
    char endless[2000];
    memset(endless, '1', sizeof endless);
    memcpy(endless + sizeof endless - 3, " s", 3);
    assert_true(why_not(endless, UNIT_TIME)[0] != '\0');
}

static void prints(double value, enum unit unit, const char *expected)
{
    char buffer[64];
    units_print(value, unit, buffer, sizeof buffer);
    assert_string_equal(buffer, expected);
}

static void values_are_printed_for_people(void **state)
{
    (void)state;
    prints(480e6, UNIT_BANDWIDTH, "480 MB/s");
    prints(1.25e8, UNIT_BANDWIDTH, "125 MB/s");
    prints(6e-8, UNIT_TIME, "60 ns");
    prints(0, UNIT_TIME, "0 s");
    prints(4096, UNIT_BYTES, "4 KiB");
    prints(1500, UNIT_BYTES, "1.5 kB");
    prints(0.05, UNIT_PERCENT, "5 %");
    prints(-0.25, UNIT_NONE, "-0.25");
    prints(31, UNIT_CYCLES, "31 cycles");
    prints(0, UNIT_PERCENT, "0 %");
    prints(1e-30, UNIT_TIME, "1e-18 ps");
    prints(2, UNIT_MASS, "2 kg");
    /* whole numbers on both sides of 2^53, the last one of which every whole number is a double */
    prints(9007199254740991, UNIT_NONE, "9007199254740991");
    prints(9007199254740994, UNIT_NONE, "9007199254740994");
    prints(120300, UNIT_NONE, "120300");
    prints(1e15, UNIT_NONE, "1000000000000000");
    prints(NAN, UNIT_TIME, "nan s");
    prints(-INFINITY, UNIT_NONE, "-inf");
}

static void reads_back(double value, enum unit unit)
{
    char buffer[64], why[256] = "";
    double again = NAN;
    units_print(value, unit, buffer, sizeof buffer);
    bool ok = units_parse(buffer, unit, &again, why, sizeof why);
    if (!ok || again != value)
        fail_msg("%.17g prints as '%s', reads as %.17g (%s)", value, buffer, again, why);
}

static void what_is_printed_reads_back_to_the_same_double(void **state)
{
    (void)state;
    static const double edges[] = {
        0,    DBL_MIN, DBL_MAX, DBL_TRUE_MIN, DBL_EPSILON, 0.1,  1.0 / 3, 999.9999999999999,   1000,
        1024, 0x1p52,  0x1p53,  0x1p63,       1e16,        1e17, 1e-5,    9.999999999999999e-6};
    struct random r = random_make(20, 1, 1);
    for (int unit = 0; unit < UNIT_KINDS; unit++) {
        for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
            reads_back(edges[i], unit);
            reads_back(-edges[i], unit);
        }
        for (int i = 0; i < 1000; i++) {
            union {
                uint64_t word;
                double value;
            } any = {.word = random_u64(&r)};
            if (isfinite(any.value)) reads_back(any.value, unit);
            reads_back(random_uniform(&r, -1, 1) * pow(10, (double)random_below(&r, 30) - 15),
                       unit);
            reads_back((double)random_below(&r, 100000), unit);
        }
    }
}

static void every_kind_has_a_name_an_example_that_reads_and_an_si_symbol(void **state)
{
    (void)state;
    for (int unit = 0; unit < UNIT_KINDS; unit++) {
        double value;
        char why[256];
        assert_true(strlen(units_name(unit)) > 3);
        assert_true(units_parse(units_example(unit), unit, &value, why, sizeof why));
        assert_non_null(units_si(unit));
        for (int other = 0; other < unit; other++)
            assert_string_not_equal(units_si(other), units_si(unit));
    }
    assert_string_equal(units_si(UNIT_BANDWIDTH), "B_per_s");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_of_every_kind_are_read),
        cmocka_unit_test(an_atomic_mass_is_the_codata_value),
        cmocka_unit_test(bits_and_bytes_differ_by_eight),
        cmocka_unit_test(values_are_rounded_once),
        cmocka_unit_test(people_write_units_in_many_ways),
        cmocka_unit_test(a_missing_unit_is_refused_with_an_example),
        cmocka_unit_test(a_unit_of_another_kind_is_named),
        cmocka_unit_test(a_misspelt_unit_gets_a_suggestion),
        cmocka_unit_test(what_is_no_finite_number_is_refused),
        cmocka_unit_test(values_are_printed_for_people),
        cmocka_unit_test(what_is_printed_reads_back_to_the_same_double),
        cmocka_unit_test(every_kind_has_a_name_an_example_that_reads_and_an_si_symbol),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
