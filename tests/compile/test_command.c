/* test_command.c - command lines of gcc: sources, stages, outputs, dependencies, and what is
 * refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/text.h"
#include "compile/command.h"

/* A line as words, read; *a is to be destroyed. */
static bool read_line(const char *line, struct command *c, struct arena **a, struct err *e)
{
    *a = arena_create();
    struct words w = {.arena = *a};
    err_clear(e);
    words_add_parts(&w, line);
    return command_read(c, w.n, w.word, *a, e);
}

static void joined_are(const struct words *w, const char *expected)
{
    char all[1024] = "";
    for (int i = 0; i < w->n; i++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", i > 0 ? " " : "", w->word[i]);
    assert_string_equal(all, expected);
}

static void sources_options_and_libraries_go_to_their_steps(void **state)
{
    (void)state;
    struct command c;
    struct arena *a;
    struct err e;
    assert_true(read_line("-O2 -I inc -Dx='a b' main.c -o prog -L. obj.o -lfoo part.f90 -Wl,-z,now "
                          "-Wa,--warn -flto=auto -static -std=c11",
                          &c, &a, &e));
    assert_int_equal(c.stage, COMMAND_LINK);
    assert_string_equal(c.output, "prog");
    assert_int_equal(c.nsource, 2);
    assert_string_equal(c.source[1].path, "part.f90");
    joined_are(&c.compile, "-O2 -I inc -Dx=a b -L. -std=c11");
    joined_are(&c.link, "-O2 -I inc -Dx=a b main.c -L. obj.o -lfoo part.f90 -Wl,-z,now -std=c11");
    joined_are(&c.assemble, "-Wa,--warn");
    assert_string_equal(c.link.word[c.source[1].place], "part.f90");
    assert_string_equal(c.flags, "-O2 -std=c11");
    arena_destroy(a);
}

static const struct {
    const char *line;
    enum command_stage stage;
    int sources;
} stages[] = {
    {"-c a.c", COMMAND_OBJECT, 1},
    {"-S -c a.c", COMMAND_ASSEMBLY, 1},
    {"-c -S a.c b.c", COMMAND_ASSEMBLY, 2},
    {"a.o b.o", COMMAND_LINK, 0},
    {"-lfoo", COMMAND_LINK, 0},
    {"--version", COMMAND_PASS, 0},
    {"-v", COMMAND_PASS, 0},
    {"-dumpmachine", COMMAND_PASS, 0},
    {"-print-file-name=libm.a", COMMAND_PASS, 0},
    {"-E a.c", COMMAND_PASS, 1},
    {"-MM a.c", COMMAND_PASS, 1},
    {"-fsyntax-only a.c", COMMAND_PASS, 1},
    {"a.h", COMMAND_PASS, 0},
    {"-x c - -c", COMMAND_OBJECT, 1},
    {"-x c++ a.txt -x none b.o", COMMAND_LINK, 1},
    {"-xassembler-with-cpp a.asm -c", COMMAND_OBJECT, 1},
    {"-c a.S", COMMAND_OBJECT, 1},
    {"-include config.h -MF a.c -c b.c", COMMAND_OBJECT, 1},
};

static void each_line_has_its_stage(void **state)
{
    (void)state;
    for (unsigned i = 0; i < sizeof stages / sizeof stages[0]; i++) {
        struct command c;
        struct arena *a;
        struct err e;
        if (!read_line(stages[i].line, &c, &a, &e)) fail_msg("%s: %s", stages[i].line, e.text);
        if (c.stage != stages[i].stage || c.nsource != stages[i].sources)
            fail_msg("%s: stage %d, %d sources", stages[i].line, c.stage, c.nsource);
        arena_destroy(a);
    }
}

static void dependencies_keep_the_names_that_gcc_gives(void **state)
{
    (void)state;
    static const struct {
        const char *line, *object, *words;
    } cases[] = {
        {"-c src/a.c -MD", "a.o", "-MD -MQ a.o -MF a.d"},
        {"-c src/a.c -MMD -o out/b.o", "out/b.o", "-MMD -MQ out/b.o -MF out/b.d"},
        {"-c a.c -MD -MF x.d -MT y", "a.o", "-MD -MF x.d -MT y"},
        {"-c a.c -MT y.lo -MD -MP", "a.o", "-MT y.lo -MD -MF a.d"},
        {"a.c -MD -o dir/prog", "0.o", "-MD -MQ a.o -MF dir/prog-a.d"},
        {"-c a.c", "a.o", ""},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct command c;
        struct arena *a;
        struct err e;
        assert_true(read_line(cases[i].line, &c, &a, &e));
        struct words w = {.arena = a};
        command_dependency_words(&c, 0, cases[i].object, &w);
        joined_are(&w, cases[i].words);
        arena_destroy(a);
    }
}

static void what_cannot_be_is_refused_with_its_reason(void **state)
{
    (void)state;
    static const struct {
        const char *line, *reason;
    } cases[] = {
        {"-march=native -c a.c", "depend on this computer"},
        {"-fopenmp a.c", "one thread"},
        {"-fsanitize=address a.c", "sanitizers"},
        {"-m32 a.c", "x86-64"},
        {"-pg a.c", "simulated time"},
        {"-c a.c b.c -o x.o", "one source file; 2"},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct command c;
        struct arena *a;
        struct err e;
        assert_false(read_line(cases[i].line, &c, &a, &e));
        assert_int_equal(e.kind, ERR_USAGE);
        if (strstr(e.text, cases[i].reason) == NULL) fail_msg("%s: %s", cases[i].line, e.text);
        arena_destroy(a);
    }
}

static void words_in_files_are_read(void **state)
{
    (void)state;
    FILE *f = fopen("words.rsp", "w");
    assert_non_null(f);
    fputs("-DNAME=\"a \\\"b\\\"\"\n -c\t'one file.c'\n", f);
    fclose(f);
    struct command c;
    struct arena *a;
    struct err e;
    assert_true(read_line("-O1 @words.rsp @no-such-file", &c, &a, &e));
    assert_int_equal(c.stage, COMMAND_OBJECT);
    assert_string_equal(c.source[0].path, "one file.c");
    joined_are(&c.compile, "-O1 -DNAME=a \"b\"");
    arena_destroy(a);
    f = fopen("words.rsp", "w");
    fputs("@words.rsp", f);
    fclose(f);
    assert_false(read_line("@words.rsp", &c, &a, &e));
    assert_int_equal(e.kind, ERR_USAGE);
    arena_destroy(a);
    unlink("words.rsp");
}

static void outputs_have_the_source_s_name(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    assert_string_equal(command_default_output("src/x.y.c", "o", a), "x.y.o");
    assert_string_equal(command_default_output("../src.d/file", "s", a), "file.s");
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_options_and_libraries_go_to_their_steps),
        cmocka_unit_test(each_line_has_its_stage),
        cmocka_unit_test(dependencies_keep_the_names_that_gcc_gives),
        cmocka_unit_test(what_cannot_be_is_refused_with_its_reason),
        cmocka_unit_test(words_in_files_are_read),
        cmocka_unit_test(outputs_have_the_source_s_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
