/* test_err.c - errors as values: the first cause wins, texts are cut and not overrun, statuses are
 * those documented. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/err.h"

static void the_first_cause_wins(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    assert_int_equal(e.kind, ERR_NONE);
    assert_false(err_set_at(&e, ERR_DATA, "a.yaml", 7, "unknown key '%s'", "colour"));
    assert_false(err_set(&e, ERR_IO, "later"));
    assert_int_equal(e.kind, ERR_DATA);
    assert_int_equal(e.line, 7);
    assert_string_equal(e.file, "a.yaml");
    assert_string_equal(e.text, "unknown key 'colour'");
}

static void context_comes_in_front(void **state)
{
    (void)state;
    struct err e = {0};
    err_set(&e, ERR_CONFIG, "P is 300");
    assert_false(err_in(&e, "run 3"));
    assert_false(err_in(&e, "scenario fig6"));
    assert_string_equal(e.text, "scenario fig6: run 3: P is 300");
}

static void endless_texts_are_cut(void **state)
{
    (void)state;
    char endless[2000];
    memset(endless, 'x', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    struct err e = {0};
    err_set_at(&e, ERR_DATA, endless, 1, "%s", endless);
    assert_int_equal(strlen(e.file), sizeof e.file - 1);
    assert_int_equal(strlen(e.text), sizeof e.text - 1);
    err_in(&e, endless);
    assert_int_equal(strlen(e.text), sizeof e.text - 1);
}

/* What a user needs of "cannot open PATH: REASON" are the ends of the path, and the reason. */
static void a_long_path_keeps_its_ends_and_its_reason(void **state)
{
    (void)state;
    char path[4000] = "/data/ada/";
    memset(path + 10, 'd', sizeof path - 10);
    strcpy(path + sizeof path - 8, "/my.db");
    struct err e = {0};
    err_set_at(&e, ERR_DATA, path, 1, "cannot open %s: %s", path, "Read-only file system");
    assert_ptr_equal(strstr(e.text, "cannot open /data/ada/ddd"), e.text);
    assert_non_null(strstr(e.text, "ddd ... ddd"));
    assert_non_null(strstr(e.text, "/my.db: Read-only file system"));
    assert_ptr_equal(strstr(e.file, "/data/ada/ddd"), e.file);
    assert_string_equal(e.file + strlen(e.file) - 6, "/my.db");
    err_in(&e, path);
    assert_ptr_equal(strstr(e.text, "/data/ada/ddd"), e.text);
    assert_non_null(strstr(e.text, "/my.db: Read-only file system"));
}

/* A text of one size too long for each place of the cut: no half of a character is left. */
static void characters_stay_whole(void **state)
{
    (void)state;
    char text[2000] = "";
    for (int i = 0; i < 4; i++) {
        memset(text, 'x', sizeof text);
        for (size_t at = (size_t)i; at + 5 < sizeof text; at += 4)
            memcpy(text + at, "\xe2\x82\xacx", 4);
        text[sizeof text - 5] = '\0';
        struct err e = {0};
        err_set(&e, ERR_DATA, "%s", text);
        const char *gap = strstr(e.text, " ... ");
        assert_non_null(gap);
        assert_true((gap[-1] & 0xC0) != 0xC0 && (gap[5] & 0xC0) != 0x80);
        assert_true((gap[-1] & 0xC0) != 0x80 || (gap[-3] & 0xF0) == 0xE0);
    }
}

static void exit_statuses_are_those_of_the_manual(void **state)
{
    (void)state;
    static const struct {
        enum err_kind kind;
        int status;
        const char *word;
    } known[] = {{ERR_NONE, 0, "ok"},
                 {ERR_CHECK, 1, "check-failed"},
                 {ERR_USAGE, 64, "usage"},
                 {ERR_DATA, 65, "bad-data"},
                 {ERR_NO_INPUT, 66, "no-input"},
                 {ERR_UNAVAILABLE, 69, "missing"},
                 {ERR_DEADLOCK, 70, "deadlock"},
                 {ERR_INTERNAL, 71, "system"},
                 {ERR_CREATE, 73, "cannot-create"},
                 {ERR_IO, 74, "io"},
                 {ERR_BUSY, 75, "busy"},
                 {ERR_CONFIG, 78, "config"}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        assert_int_equal(err_exit_status(known[i].kind), known[i].status);
        assert_string_equal(err_word(known[i].kind), known[i].word);
    }
}

/* printed: what err_print writes to standard error. */
static void printed(const struct err *e, char *buffer, size_t size)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    fflush(stderr);
    int saved = dup(STDERR_FILENO);
    dup2(ends[1], STDERR_FILENO);
    err_print(e);
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    close(ends[1]);
    ssize_t n = read(ends[0], buffer, size - 1);
    close(ends[0]);
    buffer[n < 0 ? 0 : n] = '\0';
}

static void an_error_is_printed_with_the_place_it_has(void **state)
{
    (void)state;
    char out[2000];
    struct err e = {0};
    err_set_at(&e, ERR_DATA, "a.yaml", 7, "bad");
    printed(&e, out, sizeof out);
    assert_string_equal(out, "mimdsim: a.yaml:7: bad\n");
    err_clear(&e);
    err_set_at(&e, ERR_DATA, "a.yaml", 0, "bad");
    printed(&e, out, sizeof out);
    assert_string_equal(out, "mimdsim: a.yaml: bad\n");
    err_clear(&e);
    err_set(&e, ERR_DATA, "bad");
    printed(&e, out, sizeof out);
    assert_string_equal(out, "mimdsim: bad\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_cause_wins),
        cmocka_unit_test(context_comes_in_front),
        cmocka_unit_test(endless_texts_are_cut),
        cmocka_unit_test(a_long_path_keeps_its_ends_and_its_reason),
        cmocka_unit_test(characters_stay_whole),
        cmocka_unit_test(exit_statuses_are_those_of_the_manual),
        cmocka_unit_test(an_error_is_printed_with_the_place_it_has),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
