/* test_size.c - sizes never wrap: what does not fit is too large, and is refused by name. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/size.h"

static void products_and_sums_that_fit_are_exact(void **state)
{
    (void)state;
    assert_true(size_product(46344, 46344) == (size_t)46344 * 46344);
    assert_true(size_product(0, SIZE_MAX) == 0);
    assert_true(size_product(SIZE_MAX, 1) == SIZE_MAX);
    assert_true(size_sum(SIZE_MAX - 5, 5) == SIZE_MAX);
    assert_true(size_count(INT64_C(1) << 31, INT64_C(1) << 31) == INT64_C(1) << 62);
}

static void what_does_not_fit_is_too_large(void **state)
{
    (void)state;
    assert_true(size_product((size_t)1 << 32, (size_t)1 << 32) == SIZE_TOO_LARGE);
    assert_true(size_product(size_product((size_t)1 << 40, (size_t)1 << 40), 8) == SIZE_TOO_LARGE);
    assert_true(size_product((size_t)-1, 8) == SIZE_TOO_LARGE); /* a negative int, converted */
    assert_true(size_sum(SIZE_TOO_LARGE, 1) == SIZE_TOO_LARGE);
    assert_true(size_count(INT64_C(1) << 40, INT64_C(1) << 40) == INT64_MAX);
    assert_true(size_count(INT64_MAX, 2) == INT64_MAX);
}

/* The exit status of a process that takes an array of n numbers. */
static int status_of(int64_t n)
{
    int status;
    pid_t child = fork();
    if (child == 0) {
        struct arena *a = arena_create();
        close(2);
        _exit(TAKE(a, n, double) != NULL ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void an_array_of_a_size_that_wrapped_is_refused_as_memory_is(void **state)
{
    (void)state;
    assert_int_equal(status_of(10), 0);
    assert_int_equal(status_of(-1), 71);
    assert_int_equal(status_of(INT64_MAX / 4), 71);
}

static void what_needs_more_than_there_is_says_what_and_how_much(void **state)
{
    (void)state;
    struct err e = {0};
    assert_true(size_in_memory(1 << 20, "", 0, "a table", &e));
    assert_false(size_in_memory((size_t)1 << 60, "x.yaml", 7, "dims: the tables", &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_int_equal(e.line, 7);
    assert_non_null(
        strstr(e.text, "dims: the tables would take 1.15e+09 GB of memory; this computer has "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_and_sums_that_fit_are_exact),
        cmocka_unit_test(what_does_not_fit_is_too_large),
        cmocka_unit_test(an_array_of_a_size_that_wrapped_is_refused_as_memory_is),
        cmocka_unit_test(what_needs_more_than_there_is_says_what_and_how_much),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
