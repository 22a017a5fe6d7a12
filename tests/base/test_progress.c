/* test_progress.c - the host's clock and memory, and when progress speaks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/progress.h"

static void the_clock_goes_forward_in_seconds(void **state)
{
    (void)state;
    double before = host_seconds();
    nanosleep(&(struct timespec){0, 20000000}, NULL);
    double spent = host_seconds() - before;
    assert_true(spent >= 0.02 && spent < 20);
}

static void the_peak_follows_touched_memory(void **state)
{
    (void)state;
    long before = host_peak_bytes(), size = 64l << 20, slack = 4l << 20;
    volatile char *p = malloc((size_t)size);
    for (long i = 0; i < size; i += 1024) p[i] = 1;
    /* sanitizers add their own */
    assert_in_range(host_peak_bytes(), before + size - slack, before + 8 * size);
    free((void *)p);
    assert_true(host_peak_bytes() >= before + size - slack);
}

/* shown: what progress writes to standard error for `done` of 100, had it begun `age` seconds
 * ago. */
static void shown(struct progress *p, double done, double age, char *buffer, size_t size)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    int saved = dup(STDERR_FILENO);
    dup2(ends[1], STDERR_FILENO);
    p->start -= age;
    p->last -= age;
    progress_show(p, done);
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    close(ends[1]);
    ssize_t n = read(ends[0], buffer, size - 1);
    close(ends[0]);
    buffer[n < 0 ? 0 : n] = '\0';
}

static void nothing_is_said_in_the_first_second(void **state)
{
    (void)state;
    char out[400];
    struct progress p = progress_make("runs", 100, false);
    p.tty = true;
    shown(&p, 10, 0, out, sizeof out);
    assert_string_equal(out, "");
}

static void a_terminal_gets_one_line_rewritten(void **state)
{
    (void)state;
    char out[400];
    struct progress p = progress_make("runs", 100, false);
    p.tty = true;
    shown(&p, 25, 2, out, sizeof out);
    assert_non_null(strstr(out, "\rruns: 25 %"));
    assert_non_null(strstr(out, "6 s left"));
    assert_null(strchr(out, '\n'));
}

static void a_file_gets_a_line_every_ten_seconds(void **state)
{
    (void)state;
    char out[400];
    struct progress p = progress_make("runs", 100, false);
    p.tty = false;
    shown(&p, 10, 5, out, sizeof out);
    assert_string_equal(out, "");
    shown(&p, 50, 95, out, sizeof out);
    assert_non_null(strstr(out, "runs: 50 %"));
    assert_non_null(strstr(out, "1 min 40 s left\n"));
    assert_null(strchr(out, '\r'));
    shown(&p, 51, 0, out, sizeof out);
    assert_string_equal(out, "");
}

static void what_has_not_ended_yet_shows_its_detail(void **state)
{
    (void)state;
    char out[400];
    struct progress p = progress_make("runs", 1, false);
    p.tty = true;
    p.detail = "3 million events";
    assert_false(progress_due(&p));
    shown(&p, 0, 2, out, sizeof out);
    assert_string_equal(out, "\rruns: 0 of 1; 3 million events\033[K");
    p.quiet = true;
    assert_false(progress_due(&p));
}

static void quiet_is_quiet(void **state)
{
    (void)state;
    char out[400];
    struct progress p = progress_make("runs", 100, true);
    shown(&p, 50, 100, out, sizeof out);
    assert_string_equal(out, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_clock_goes_forward_in_seconds),
        cmocka_unit_test(the_peak_follows_touched_memory),
        cmocka_unit_test(nothing_is_said_in_the_first_second),
        cmocka_unit_test(a_terminal_gets_one_line_rewritten),
        cmocka_unit_test(a_file_gets_a_line_every_ten_seconds),
        cmocka_unit_test(what_has_not_ended_yet_shows_its_detail),
        cmocka_unit_test(quiet_is_quiet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
