/* test_process.c - programs as children: texts both ways, statuses, programs that are not there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/process.h"

/* What a command of the shell gives for `in`. */
static int shell(const char *command, const struct text *in, struct text *out)
{
    struct err e;
    int status = -1;
    const char *const word[] = {"/bin/sh", "-c", command, NULL};
    err_clear(&e);
    assert_true(process_run(word, in, out, &status, &e));
    assert_int_equal(e.kind, ERR_NONE);
    return status;
}

static void statuses_are_those_of_the_shell(void **state)
{
    (void)state;
    struct text out = {0};
    assert_int_equal(shell("exit 0", NULL, &out), 0);
    assert_int_equal(shell("exit 37", NULL, &out), 37);
    assert_int_equal(shell("kill -TERM $$", NULL, &out), 128 + 15);
    text_free(&out);
}

/* More than a pipe holds, both ways at once: neither waits for the other for ever. */
static void long_texts_pass_both_ways(void **state)
{
    (void)state;
    struct text in = {0}, out = {0};
    for (int i = 0; i < 100000; i++) text_add(&in, "line %d\n", i);
    assert_int_equal(shell("cat", &in, &out), 0);
    assert_int_equal(out.length, in.length);
    assert_memory_equal(out.s, in.s, in.length);
    text_free(&in);
    text_free(&out);
}

/* A child that does not read what it is given is no error of ours. */
static void a_child_need_not_read(void **state)
{
    (void)state;
    struct text in = {0}, out = {0};
    for (int i = 0; i < 100000; i++) text_add(&in, "line %d\n", i);
    assert_int_equal(shell("echo done; exit 3", &in, &out), 3);
    assert_string_equal(out.s, "done\n");
    text_free(&in);
    text_free(&out);
}

/* Messages are kept apart from what the program writes. */
static void what_a_child_says_is_collected_alone(void **state)
{
    (void)state;
    struct err e;
    int status = -1;
    struct text said = {0};
    const char *const word[] = {"sh", "-c", "echo table; echo wrong >&2; exit 4", NULL};
    err_clear(&e);
    assert_true(process_said(word, &said, &status, &e));
    assert_int_equal(status, 4);
    assert_string_equal(said.s, "wrong\n");
    text_free(&said);
}

static void a_program_that_is_not_there_is_named(void **state)
{
    (void)state;
    struct err e;
    int status;
    const char *const word[] = {"no-such-program", NULL};
    err_clear(&e);
    assert_false(process_run(word, NULL, NULL, &status, &e));
    assert_int_equal(e.kind, ERR_UNAVAILABLE);
    assert_string_equal(e.text, "'no-such-program' is not installed, or not in PATH");
    err_clear(&e);
    assert_false(process_replace(word, &e));
    assert_int_equal(e.kind, ERR_UNAVAILABLE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statuses_are_those_of_the_shell),
        cmocka_unit_test(long_texts_pass_both_ways),
        cmocka_unit_test(a_child_need_not_read),
        cmocka_unit_test(what_a_child_says_is_collected_alone),
        cmocka_unit_test(a_program_that_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
