/* test_text.c - nearest names, growing texts, files, shortest numbers. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/random.h"
#include "base/text.h"

static const char *const KEYS[] = {"bandwidth", "latency", "level",      "torus",
                                   "mesh",      "t3e-300", "hop_latency"};
enum { NKEY = sizeof KEYS / sizeof KEYS[0] };

static void the_nearest_name_is_found(void **state)
{
    (void)state;
    assert_string_equal(text_nearest("bandwith", KEYS, NKEY), "bandwidth");  /* one missing */
    assert_string_equal(text_nearest("bandwdith", KEYS, NKEY), "bandwidth"); /* two swapped */
    assert_string_equal(text_nearest("Latencyy", KEYS, NKEY), "latency"); /* one more, other case */
    assert_string_equal(text_nearest("hop-latency", KEYS, NKEY), "hop_latency");
    assert_string_equal(text_nearest("t3e300", KEYS, NKEY), "t3e-300");
    assert_string_equal(text_nearest("MESH", KEYS, NKEY), "mesh");
}

static void what_is_far_from_all_has_no_nearest_name(void **state)
{
    (void)state;
    assert_null(text_nearest("colour", KEYS, NKEY));
    assert_null(text_nearest("x", KEYS, NKEY));
    assert_null(text_nearest("mesh", KEYS, 0));
    char endless[300];
    memset(endless, 'm', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_null(text_nearest(endless, KEYS, NKEY));
}

static void an_abbreviation_is_understood(void **state)
{
    (void)state;
    static const char *const names[] = {"paragon-osf1-ad", "paragon-osf1", "quad-ppro"};
    assert_string_equal(text_nearest("Paragon", names, 3), "paragon-osf1");
    assert_null(text_nearest("pa", names, 3));
    assert_null(text_nearest("ppro", names, 3));
}

static void the_first_of_equally_near_names_wins(void **state)
{
    (void)state;
    static const char *const names[] = {"axb", "ayb"};
    assert_string_equal(text_nearest("azb", names, 2), "axb");
}

static void a_text_grows_and_is_given_back(void **state)
{
    (void)state;
    struct text t = {0};
    for (int i = 0; i < 5000; i++) text_add(&t, "%d,", i);
    assert_int_equal(t.length, strlen(t.s));
    assert_int_equal(t.length, 10 * 2 + 90 * 3 + 900 * 4 + 4000 * 5);
    assert_memory_equal(t.s, "0,1,2,3,", 8);
    text_add_bytes(&t, "a\0b", 3);
    assert_memory_equal(t.s + t.length - 3, "a\0b", 4);
    text_free(&t);
    assert_null(t.s);
    text_add_bytes(&t, NULL, 0);
    assert_string_equal(t.s, "");
    text_free(&t);
}

static void files_of_every_size_are_read_whole(void **state)
{
    (void)state;
    char path[] = "test_text_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    static const size_t sizes[] = {0, 1, 65535, 65536, 65537, 300000};
    struct text t = {0};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct err e = {0};
        FILE *out = fopen(path, "wb");
        for (size_t k = 0; k < sizes[i]; k++) fputc("mimdsim"[k % 7], out);
        fclose(out);
        assert_true(text_read_file(&t, path, &e));
        assert_int_equal(t.length, sizes[i]);
        assert_int_equal(t.s[t.length], '\0');
        for (size_t k = 0; k < sizes[i]; k++) assert_int_equal(t.s[k], "mimdsim"[k % 7]);
    }
    text_free(&t);
    unlink(path);
}

static void a_file_that_is_not_there_and_a_folder_are_refused(void **state)
{
    (void)state;
    struct text t = {0};
    struct err e = {0};
    assert_false(text_read_file(&t, "no such file", &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    assert_string_equal(e.file, "no such file");
    err_clear(&e);
    assert_false(text_read_file(&t, ".", &e));
    assert_int_equal(e.kind, ERR_DATA);
    text_free(&t);
}

static void a_copy_is_cut_to_its_buffer(void **state)
{
    (void)state;
    char buffer[4] = "zzz";
    text_copy(buffer, sizeof buffer, "abcdef");
    assert_string_equal(buffer, "abc");
    text_copy(buffer, sizeof buffer, "");
    assert_string_equal(buffer, "");
    text_copy(buffer, 1, "x");
    assert_string_equal(buffer, "");
}

static void numbers_are_as_short_as_they_read_back(void **state)
{
    (void)state;
    char s[32];
    text_real(s, 0.1);
    assert_string_equal(s, "0.1");
    text_real(s, 1.0 / 3);
    assert_string_equal(s, "0.3333333333333333");
    struct random r = random_make(3, 0, 0);
    for (int i = 0; i < 20000; i++) {
        double x = random_normal(&r) * pow(10, (double)random_below(&r, 600) - 300);
        text_real(s, x);
        assert_true(strtod(s, NULL) == x);
    }
    text_real(s, -DBL_MAX);
    assert_true(strtod(s, NULL) == -DBL_MAX);
}

static void integers_are_written_as_printf_writes_them(void **state)
{
    (void)state;
    static const int64_t value[] = {0, 9, -1, 10, -100, INT64_MAX, INT64_MIN, 1234567890123};
    struct text by_hand = {0}, printed = {0};
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        text_add_integer(&by_hand, value[i]);
        text_add(&printed, "%lld", (long long)value[i]);
    }
    assert_string_equal(by_hand.s, printed.s);
    text_free(&by_hand);
    text_free(&printed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_name_is_found),
        cmocka_unit_test(integers_are_written_as_printf_writes_them),
        cmocka_unit_test(what_is_far_from_all_has_no_nearest_name),
        cmocka_unit_test(an_abbreviation_is_understood),
        cmocka_unit_test(the_first_of_equally_near_names_wins),
        cmocka_unit_test(a_text_grows_and_is_given_back),
        cmocka_unit_test(files_of_every_size_are_read_whole),
        cmocka_unit_test(a_file_that_is_not_there_and_a_folder_are_refused),
        cmocka_unit_test(a_copy_is_cut_to_its_buffer),
        cmocka_unit_test(numbers_are_as_short_as_they_read_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
