/* test_lab.c - lessons of the test's own: numbers by name, marks in texts, copies, damaged files.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "io/document.h"
#include "lab/lab.h"
#include "../support/scratch.h"

/* A folder of data with one lesson in it, labs/toy. */
struct fixture {
    char folder[192], path[512];
    struct arena *arena;
    struct err e;
};

static const char *in(struct fixture *f, const char *file)
{
    snprintf(f->path, sizeof f->path, "%s/%s", f->folder, file);
    return f->path;
}

static void write_file(struct fixture *f, const char *file, const char *text)
{
    FILE *out = fopen(in(f, file), "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static bool contains(struct fixture *f, const char *file, const char *text)
{
    struct text t = {0};
    assert_true(text_read_file(&t, in(f, file), &f->e));
    const bool yes = t.s != NULL && strstr(t.s, text) != NULL;
    text_free(&t);
    return yes;
}

static const char toy[] = "schema_version: 1\n"
                          "title: A toy\n"
                          "goal: None\n"
                          "minutes: 5\n"
                          "numbers:\n"
                          "  P: [4, 8, 16]\n"
                          "  k: {of: P, 4: 2, 8: 3, 16: 4}\n"
                          "questions:\n"
                          "  rounds:\n"
                          "    text: How many rounds do @P@ ranks take?\n"
                          "    unit: rounds\n"
                          "    theory: \"@k@\"\n"
                          "picture:\n"
                          "  set: [\"ranks=2,@P@\"]\n"
                          "  x: P\n"
                          "  y: makespan_s\n"
                          "  by: tree\n"
                          "  by-mpi: arguments\n"
                          "sliders:\n"
                          "  P: {text: ranks, key: ranks, values: [2, 8, 100]}\n"
                          "  L: {text: latency, key: l, unit: us, own: 2.5, values: [10, 0]}\n";

static int begin(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    scratch_make(f->folder, sizeof f->folder);
    f->arena = arena_create();
    err_clear(&f->e);
    mkdir(in(f, "labs"), 0700);
    mkdir(in(f, "labs/toy"), 0700);
    mkdir(in(f, "labs/solutions"), 0700);
    write_file(f, "labs/toy/lab.yaml", toy);
    write_file(f, "labs/toy/toy.c", "int p = @P@;\n");
    write_file(f, "labs/toy/toy-mpi.c", "int q = @P@;\n");
    write_file(f, "labs/toy/README.md", "@student@ at me@example.org: complete `@program@`\n");
    write_file(f, "labs/toy/scenario.yaml",
               "program: @program@\n@kernel@n: 1\n@mpi@m: 2\nend: @k@");
    setenv("MIMDSIM_DATA", f->folder, 1);
    *state = f;
    return 0;
}

static int end(void **state)
{
    struct fixture *f = *state;
    scratch_remove(f->folder);
    arena_destroy(f->arena);
    free(f);
    return 0;
}

static void read_toy(struct fixture *f, struct lab *l, const char *student, bool mpi)
{
    const bool ok = lab_read(l, "toy", student, mpi, f->arena, &f->e);
    if (!ok) print_error("%s\n", f->e.text);
    assert_true(ok);
}

/* Whatever the name, k is the logarithm of P; without a name P is the first of the list. */
static void a_number_follows_another(void **state)
{
    struct fixture *f = *state;
    static const char *const logarithm[] = {"4", "2", "8", "3", "16", "4"};
    struct lab l;
    bool seen[3] = {false};
    for (int i = 0; i < 30; i++) {
        char name[8];
        snprintf(name, sizeof name, "s%d", i);
        read_toy(f, &l, i == 0 ? "" : name, false);
        assert_int_equal(l.nnumber, 2);
        int which = 0;
        while (which < 3 && strcmp(l.number[0].value, logarithm[2 * which]) != 0) which++;
        assert_true(which < 3);
        assert_string_equal(l.number[1].value, logarithm[2 * which + 1]);
        assert_string_equal(l.question[0].theory, l.number[1].value);
        if (i == 0) assert_int_equal(which, 0);
        seen[which] = true;
    }
    assert_true(seen[0] && seen[1] && seen[2]);
}

/* Marks become values, lines of the other kind go, and what is no mark stays. */
static void templates_are_filled(void **state)
{
    struct fixture *f = *state;
    static const char template[] =
        "a@b@c @P@@k@ @ @@ @student@\n@kernel@own\n@mpi@ x @P@\nlast@mpi@";
    static const char *const wanted[] = {"a@b@c 42 @ @@ Ann\nown\nlast",
                                         "a@b@c 42 @ @@ Ann\n x 4\nlast"};
    for (int mpi = 0; mpi < 2; mpi++) {
        struct lab l;
        struct text t = {0};
        read_toy(f, &l, "", mpi);
        l.student = "Ann";
        lab_fill(&l, template, &t);
        assert_string_equal(t.s, wanted[mpi]);
        text_free(&t);
    }
}

/* Name, question and unit of each, and room for the student's numbers. */
static void a_text_has_the_table_of_questions(void **state)
{
    struct fixture *f = *state;
    struct lab l;
    struct text t = {0};
    read_toy(f, &l, "", false);
    lab_fill(&l, "before\n@questions@\nbehind @P@\n", &t);
    assert_string_equal(
        t.s, "before\n| in answers.yaml | question | unit | your formula | your number |\n"
             "|---|---|---|---|--:|\n"
             "| rounds | How many rounds do 4 ranks take? | rounds | | |\nbehind 4\n");
    text_free(&t);
}

static void the_picture_is_of_the_kind(void **state)
{
    struct fixture *f = *state;
    for (int mpi = 0; mpi < 2; mpi++) {
        struct lab l;
        read_toy(f, &l, "", mpi);
        assert_string_equal(l.picture.x, "P");
        assert_string_equal(l.picture.by, mpi ? "arguments" : "tree");
        assert_int_equal(l.picture.nset, 1);
        assert_string_equal(l.picture.set[0], "ranks=2,4");
    }
}

/* The values of a slider stand in their order, the own one among them, once. */
static void sliders_have_the_own_value(void **state)
{
    struct fixture *f = *state;
    static const char *const ranks[] = {"2", "4", "8", "100"}, *const latency[] = {"0 us", "2.5 us",
                                                                                   "10 us"};
    struct lab l;
    read_toy(f, &l, "", false);
    assert_int_equal(l.nslider, 2);
    assert_int_equal(l.slider[0].nvalue, 4);
    for (int i = 0; i < 4; i++) assert_string_equal(l.slider[0].value[i], ranks[i]);
    assert_int_equal(l.slider[0].own, 1);
    assert_int_equal(l.slider[1].nvalue, 3);
    for (int i = 0; i < 3; i++) assert_string_equal(l.slider[1].value[i], latency[i]);
    assert_int_equal(l.slider[1].own, 1);
    assert_int_equal(lab_points(&l), 12);
    /* one whose own value is listed already has it once */
    for (int i = 0; i < 40; i++) {
        char name[8];
        snprintf(name, sizeof name, "s%d", i);
        read_toy(f, &l, name, false);
        assert_string_equal(l.slider[0].value[l.slider[0].own], l.number[0].value);
        assert_int_equal(l.slider[0].nvalue, strcmp(l.number[0].value, "8") == 0 ? 3 : 4);
    }
}

/* The copy has the program of its kind alone, and is an attempt. */
static void a_copy_is_an_attempt(void **state)
{
    struct fixture *f = *state;
    static const char *const folder[] = {"kernel", "mpi"}, *const program[] = {"toy.c",
                                                                               "toy-mpi.c"};
    for (int mpi = 0; mpi < 2; mpi++) {
        struct lab l, again;
        const struct node *answers;
        char path[256], file[300];
        read_toy(f, &l, "Ann", mpi);
        snprintf(path, sizeof path, "%s/%s", f->folder, folder[mpi]);
        assert_true(lab_copy(&l, path, &f->e));
        for (int i = 0; i < 2; i++) {
            snprintf(file, sizeof file, "%s/%s", path, program[i]);
            assert_int_equal(access(file, R_OK) == 0, i == mpi);
        }
        snprintf(file, sizeof file, "%s/README.md", folder[mpi]);
        assert_true(contains(f, file, "Ann at me@example.org: complete"));
        snprintf(file, sizeof file, "%s/scenario.yaml", folder[mpi]);
        assert_true(
            contains(f, file, mpi ? "program: toy-mpi.c\nm: 2\nend: " : "program: toy.c\nn: 1\n"));
        /* read back, it is the same lesson */
        assert_true(lab_attempt(&again, path, &answers, f->arena, &f->e));
        assert_string_equal(again.student, "Ann");
        assert_int_equal(again.mpi, mpi);
        assert_non_null(document_find(answers, "answers"));
        /* nothing is written over it */
        assert_false(lab_copy(&l, path, &f->e));
        assert_int_equal(f->e.kind, ERR_CREATE);
        err_clear(&f->e);
    }
}

/* Half of a lesson is taken back. */
static void a_copy_is_whole_or_not_there(void **state)
{
    struct fixture *f = *state;
    struct lab l;
    char path[256];
    read_toy(f, &l, "", false);
    unlink(in(f, "labs/toy/scenario.yaml"));
    snprintf(path, sizeof path, "%s/half", f->folder);
    assert_false(lab_copy(&l, path, &f->e));
    assert_int_not_equal(access(path, F_OK), 0);
}

/* Damaged lessons are told with line and reason. */
static void damage_is_told(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *was, *is, *says;
        int line;
    } damage[] = {
        {"{of: P, ", "{of: Q, ", "k: of 'Q', which is no number before it", 7},
        {"[4, 8, 16]", "[5]", "k: nothing for P = 5", 7},
        {"[4, 8, 16]", "[]", "P: expected a list of numbers", 6},
        {"[4, 8, 16]", "4", "P: expected a list of numbers", 6},
        {"    unit: rounds\n", "", "question 'rounds' has no 'unit'", 9},
        {"  y: makespan_s\n", "", "picture: expected x and y", 13},
        {"own: 2.5, ", "", "slider 'L': expected own or a number of that name", 21},
        {"[10, 0]", "[1, 2, 3, 4, 5, 6, 7, 8]", "fewer than 8 values", 21},
        {"[\"ranks=2,@P@\"]", "[a, b, c, d, e]", "more than 4 settings", 14},
    };
    for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
        struct text t = {0};
        struct lab l;
        const char *at = strstr(toy, damage[i].was);
        assert_non_null(at);
        text_add_bytes(&t, toy, (size_t)(at - toy));
        text_add(&t, "%s%s", damage[i].is, at + strlen(damage[i].was));
        write_file(f, "labs/toy/lab.yaml", t.s);
        text_free(&t);
        assert_false(lab_read(&l, "toy", "", false, f->arena, &f->e));
        assert_int_equal(f->e.kind, ERR_DATA);
        assert_non_null(strstr(f->e.text, damage[i].says));
        assert_int_equal(f->e.line, damage[i].line);
        err_clear(&f->e);
    }
}

static void names_are_those_of_folders(void **state)
{
    struct fixture *f = *state;
    const char **name;
    struct lab l;
    assert_int_equal(lab_names(f->arena, &name), 1);
    assert_string_equal(name[0], "toy");
    static const char *const none[] = {"tyo", "../labs/toy", ".", ""};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        assert_false(lab_read(&l, none[i], "", false, f->arena, &f->e));
        assert_int_equal(f->e.kind, ERR_NO_INPUT);
        if (i == 0) assert_non_null(strstr(f->e.text, "did you mean 'toy'?"));
        err_clear(&f->e);
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin, end)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_number_follows_another),
        TEST(templates_are_filled),
        TEST(a_text_has_the_table_of_questions),
        TEST(the_picture_is_of_the_kind),
        TEST(sliders_have_the_own_value),
        TEST(a_copy_is_an_attempt),
        TEST(a_copy_is_whole_or_not_there),
        TEST(damage_is_told),
        TEST(names_are_those_of_folders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
