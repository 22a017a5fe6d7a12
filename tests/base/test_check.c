/* test_check.c - a failed CHECK says where and in which run, and aborts; so do misuses of the
 * base. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/json.h"

#include "../support/last_words.h"

static void fail_plainly(void)
{
    int n = 3;
    CHECK(n == 4);
}

static void describe(void *context, char *buffer, int size)
{
    snprintf(buffer, (size_t)size, "rank %d", *(int *)context);
}

static void fail_in_a_run(void)
{
    int rank = 17;
    check_note_set(describe, &rank);
    CHECK(rank < 4);
}

static void describe_badly(void *context, char *buffer, int size)
{
    (void)buffer;
    (void)size;
    CHECK(context != NULL);
}

static void fail_while_describing(void)
{
    check_note_set(describe_badly, NULL);
    CHECK(0 && "the first failure");
}

static void a_failure_names_its_place_and_condition(void **state)
{
    (void)state;
    char out[2000];
    expect_abort(fail_plainly, out, sizeof out);
    assert_non_null(strstr(out, "test_check.c:"));
    assert_non_null(strstr(out, "CHECK(n == 4) failed"));
}

static void a_failure_in_a_run_tells_of_the_run(void **state)
{
    (void)state;
    char out[2000];
    expect_abort(fail_in_a_run, out, sizeof out);
    assert_non_null(strstr(out, "failed; rank 17\n"));
}

static void a_failing_note_does_not_come_back_for_ever(void **state)
{
    (void)state;
    char out[2000];
    expect_abort(fail_while_describing, out, sizeof out);
    assert_non_null(strstr(out, "CHECK(context != "));
}

static void a_check_that_holds_is_silent(void **state)
{
    (void)state;
    CHECK(1 + 1 == 2);
}

static void json_left_open(void)
{
    struct json j = json_make(stderr);
    json_object(&j);
    json_finish(&j);
}

static void json_value_without_key(void)
{
    struct json j = json_make(stderr);
    json_object(&j);
    json_int(&j, 1);
}

static void json_two_documents(void)
{
    struct json j = json_make(stderr);
    json_int(&j, 1);
    json_int(&j, 2);
}

static void mark_released_twice(void)
{
    struct arena *a = arena_create();
    struct arena_mark outer = arena_mark(a);
    arena_take(a, 10000000);
    struct arena_mark inner = arena_mark(a);
    arena_release(a, outer);
    arena_release(a, inner);
}

static void take_too_much(void)
{
    arena_take(arena_create(), SIZE_MAX - 100);
}

static void misuse_of_the_base_is_found(void **state)
{
    (void)state;
    char out[2000];
    void (*const misuses[])(void) = {json_left_open, json_value_without_key, json_two_documents,
                                     mark_released_twice};
    for (size_t i = 0; i < sizeof misuses / sizeof misuses[0]; i++) {
        expect_abort(misuses[i], out, sizeof out);
        assert_non_null(strstr(out, "CHECK("));
    }
}

/* Memory that cannot be had is nobody's mistake: a message and a status, no abort. */
static void memory_that_is_refused_ends_with_its_status(void **state)
{
    (void)state;
    char out[2000];
    const int status = words_of(take_too_much, out, sizeof out);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 71);
    assert_non_null(strstr(out, "out of memory"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_failure_names_its_place_and_condition),
        cmocka_unit_test(a_failure_in_a_run_tells_of_the_run),
        cmocka_unit_test(a_failing_note_does_not_come_back_for_ever),
        cmocka_unit_test(a_check_that_holds_is_silent),
        cmocka_unit_test(misuse_of_the_base_is_found),
        cmocka_unit_test(memory_that_is_refused_ends_with_its_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
