/* test_guest_sheet.c - what compiled programs declare: read without running them, or refused with
 * what is wrong. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "base/digest.h"
#include "base/text.h"
#include "guest/guest_program.h"
#include "spec/field.h"
#include "support/arena_fixture.h"
#include "support/guests.h"
#include "support/scratch.h"

static const struct program_sheet *sheet_of(int form, const char *path, const char *hash,
                                            struct err *e)
{
    char folder[192], image[512], option[32];
    scratch_make(folder, sizeof folder);
    snprintf(option, sizeof option, "-DFORM=%d", form);
    guests_build(folder, "declared.c", option, image);
    err_clear(e);
    const struct program_sheet *s = guest_sheet(image, path, hash, arena, e);
    if (s != NULL) {
        assert_string_equal(s->image, image);
        if (hash[0] == '\0') { /* the image's own */
            struct text t = {0};
            char hex[65];
            assert_true(text_read_file(&t, image, e));
            digest_sha256_hex(t.s, t.length, hex);
            assert_string_equal(s->hash, hex);
            text_free(&t);
        } else assert_string_equal(s->hash, hash);
    }
    scratch_remove(folder);
    return s;
}

static void kernels_are_read_with_their_parameters(void **state)
{
    struct err e;
    char why[200];
    (void)state;
    const struct program_sheet *s = sheet_of(0, "there/my.prog.c", "", &e);
    if (s == NULL) fail_msg("%s", e.text);
    assert_int_equal(s->kind, PROGRAM_KERNEL);
    assert_string_equal(s->name, "my"); /* of the file that the user knows */
    assert_string_equal(s->title, "A title");
    assert_true(s->nparameter == 2 && s->nrank == 0);
    const struct field *count = program_sheet_find(s, "count"),
                       *wait = program_sheet_find(s, "wait");
    assert_true(count != NULL && wait != NULL && program_sheet_find(s, "other") == NULL);
    assert_string_equal(count->fallback, "12");
    assert_string_equal(wait->fallback, "2 us");
    assert_string_equal(count->doc, "how many");
    /* bounds are inclusive; values come out in one form */
    assert_string_equal(program_parameter_text(count, "100", arena, why, (int)sizeof why), "100");
    assert_null(program_parameter_text(count, "101", arena, why, (int)sizeof why));
    assert_null(program_parameter_text(count, "-1", arena, why, (int)sizeof why));
    assert_string_equal(program_parameter_text(wait, "0.5 ms", arena, why, (int)sizeof why),
                        "500 us");
    assert_null(program_parameter_text(wait, "1001 ms", arena, why, (int)sizeof why));
    assert_null(program_parameter_text(wait, "1", arena, why, (int)sizeof why)); /* no unit */
}

/* A declaration goes before main, a program's own name before the file's; built-in names stay. */
static void names_of_built_in_programs_keep_their_meaning(void **state)
{
    struct err e;
    (void)state;
    const struct program_sheet *s = sheet_of(1, "mine.c", "abc", &e);
    if (s == NULL) fail_msg("%s", e.text);
    assert_int_equal(s->kind, PROGRAM_KERNEL);
    assert_string_equal(s->name, "barrier-own");
    assert_true(s->nparameter == 0 && s->title[0] == '\0');
    s = sheet_of(7, "x/allreduce.c", "", &e); /* only main */
    if (s == NULL) fail_msg("%s", e.text);
    assert_int_equal(s->kind, PROGRAM_MPI);
    assert_string_equal(s->name, "allreduce-own");
    assert_int_equal(s->nparameter, 0);
}

static void declarations_that_are_not_sound_are_refused(void **state)
{
    static const struct {
        int form;
        const char *words;
    } row[] = {{2, "the program declares no function .run"},
               {3, ".tolerance is below zero or not a number"},
               {4, "parameter 'count' is declared twice"},
               {5, "parameter 'count' of the program: its variable is initialised with 12: "},
               {6, "made for another version of mimdsim"},
               {8, "neither PROGRAM(...) (mimdsim/program.h) nor main"}};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct err e;
        assert_null(sheet_of(row[i].form, "mine.c", "", &e));
        if (e.kind != ERR_DATA || strcmp(e.file, "mine.c") != 0 || !strstr(e.text, row[i].words))
            fail_msg("form %d: %d %s '%s'", row[i].form, e.kind, e.file, e.text);
    }
}

static void what_is_no_image_is_refused(void **state)
{
    char folder[192], path[512];
    struct err e;
    (void)state;
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "a.text");
    err_clear(&e);
    assert_null(guest_sheet(path, path, "", arena, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    assert_null(
        guest_sheet(path, path, "abc", arena, &e)); /* also where nobody reads it for a hash */
    assert_int_equal(e.kind, ERR_NO_INPUT);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    assert_true(fputs("no program at all", f) >= 0 && fclose(f) == 0);
    err_clear(&e);
    assert_null(guest_sheet(path, path, "", arena, &e));
    assert_int_equal(e.kind, ERR_DATA);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_are_read_with_their_parameters),
        cmocka_unit_test(names_of_built_in_programs_keep_their_meaning),
        cmocka_unit_test(declarations_that_are_not_sound_are_refused),
        cmocka_unit_test(what_is_no_image_is_refused),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
