/* test_programs.c - people's own programs in scenarios: keys that they declare, values checked,
 * files of others refused. */
#include "scratch.h"

#include <sys/stat.h>

#include "spec/field.h"
#include "spec/identity.h"

static int open_with_folder(void **state)
{
    char path[160];
    open_scratch(state);
    snprintf(path, sizeof path, "%s/inside", scratch.dir);
    assert_int_equal(mkdir(path, 0700), 0);
    return 0;
}

static const char *const methods[] = {"ring", "doubling", NULL};

/* Two programs: `sum` has n, block, method and dt; any other file has only n, of other bounds. */
static const struct program_sheet *declare(void *context, const char *path, struct arena *a,
                                           struct err *e)
{
    static const struct field all[] = {
        {.key = "n",
         .kind = FIELD_INT64,
         .min = 1,
         .max = 1e6,
         .fallback = "1000",
         .doc = "numbers"},
        {.key = "block",
         .kind = FIELD_INT64,
         .unit = UNIT_BYTES,
         .min = 1,
         .max = 1e9,
         .fallback = "8 KiB",
         .doc = "size of a block"},
        {.key = "method",
         .kind = FIELD_CHOICE,
         .choice = methods,
         .fallback = "ring",
         .doc = "algorithm"},
        {.key = "seed",
         .kind = FIELD_INT64,
         .max = 10,
         .fallback = "7",
         .doc = "a word of scenarios, too"},
    };
    static const struct field one[] = {
        {.key = "n", .kind = FIELD_INT64, .min = 1, .max = 10, .fallback = "5", .doc = "numbers"}};
    (void)e;
    const bool sum = strstr(path, "sum") != NULL;
    struct program_sheet *s = TAKE(a, 1, struct program_sheet);
    *s = (struct program_sheet){.kind = PROGRAM_KERNEL,
                                .title = "adds",
                                .image = arena_text(a, path),
                                .nparameter = sum ? 4 : 1,
                                .parameter = sum ? all : one};
    snprintf(s->name, sizeof s->name, "%s", sum ? "sum" : "other");
    snprintf(s->hash, sizeof s->hash, "%s", sum ? "aa" : "bb");
    ++*(int *)context;
    return s;
}

static int asked; /* how often a program was looked at */

static struct plan_options options(const char *const *set, int nset)
{
    return (struct plan_options){
        .nset = nset, .set = set, .program = declare, .program_context = &asked};
}

static void write_program(const char *name) { scratch_write(&scratch, name, "int x;\n"); }

/* A scenario in folder inside/ that names `program`, with `more` lines. */
static const char *scenario(const char *program, const char *more)
{
    char text[1024];
    snprintf(text, sizeof text, "schema_version: 1\nmachine: t3e-300\nranks: 4\nprogram: %s\n%s",
             program, more);
    return scratch_write(&scratch, "inside/s.yaml", text);
}

static struct plan planned(const char *path, const char *const *set, int nset)
{
    struct plan p;
    struct err e;
    err_clear(&e);
    struct plan_options o = options(set, nset);
    if (!plan_read(&p, path, &o, &e)) fail_msg("%s:%d: %s", e.file, e.line, e.text);
    return p;
}

static void refused(const char *path, const char *const *set, int nset, enum err_kind kind,
                    int line, const char *text)
{
    struct plan p;
    struct err e;
    err_clear(&e);
    struct plan_options o = options(set, nset);
    if (plan_read(&p, path, &o, &e)) fail_msg("not refused: %s", text);
    if (strstr(e.text, text) == NULL) fail_msg("'%s' does not say '%s'", e.text, text);
    assert_int_equal(e.kind, kind);
    assert_int_equal(e.line, line);
}

static void declared_parameters_are_keys(void **state)
{
    (void)state;
    write_program("inside/sum.c");
    struct plan p = planned(
        scenario("sum.c", "n: [100, 200]\nblock: 16 KiB\nseed: 3\nprogram.seed: 4\n"), NULL, 0);
    assert_int_equal(p.nrun, 2);
    for (int i = 0; i < 2; i++) {
        const struct run_spec *r = &p.run[i];
        assert_string_equal(r->kernel.name, "sum");
        assert_true(r->kernel.own);
        assert_int_equal(r->program.kind, PROGRAM_KERNEL);
        assert_int_equal(r->model.nbody, 100 * (i + 1));
        assert_int_equal(r->seed, 3);
        assert_string_equal(r->program.parameters,
                            i ? "n = 200\nblock = 16 KiB\nmethod = ring\nseed = 4\n"
                              : "n = 100\nblock = 16 KiB\nmethod = ring\nseed = 4\n");
        assert_non_null(strstr(r->config_text, "program.file = sha256 aa\n"));
        assert_non_null(strstr(r->config_text, i ? "program.n = 200\n" : "program.n = 100\n"));
    }
    assert_string_not_equal(p.run[0].config_hash, p.run[1].config_hash);
    assert_int_equal(p.nswept, 1);
    assert_string_equal(p.swept[0].key, "program.n");
    assert_true(p.swept[0].number);
    plan_free(&p);
    /* The command line wins, by the short and the long name; equal values are equal runs. */
    static const char *const set[] = {"program.n=300", "method=doubling", "block=16384 B"};
    struct plan q = planned(scenario("sum.c", "n: [100, 200]\nblock: 16 KiB\n"), set, 3);
    assert_int_equal(q.nrun, 1);
    assert_string_equal(q.run[0].program.parameters,
                        "n = 300\nblock = 16 KiB\nmethod = doubling\nseed = 7\n");
    plan_free(&q);
}

static void n_of_a_program_is_the_n_of_plans(void **state)
{
    (void)state;
    write_program("inside/sum.c");
    struct plan p = planned(scenario("sum.c", "n_over_p: [10, 20]\n"), NULL, 0);
    assert_int_equal(p.nrun, 2);
    assert_non_null(strstr(p.run[1].program.parameters, "n = 80\n"));
    assert_int_equal(p.run[1].model.nbody, 80);
    plan_free(&p);
    static const char *const set[] = {"ranks=n", "n=6"};
    p = planned(scenario("sum.c", "only: n >= ranks\n"), set, 2);
    assert_int_equal(p.run[0].nrank, 6);
    plan_free(&p);
    refused(scenario("sum.c", "n_over_p: 1000000\n"), NULL, 0, ERR_DATA, 5,
            "n_over_p gives n = 4000000");
}

static void wrong_values_and_keys_are_refused_with_their_place(void **state)
{
    (void)state;
    write_program("inside/sum.c");
    refused(scenario("sum.c", "n: 0\n"), NULL, 0, ERR_DATA, 5, "numbers of program sum");
    refused(scenario("sum.c", "n: [1, 2000000]\n"), NULL, 0, ERR_DATA, 5, "'2000000'");
    refused(scenario("sum.c", "block: 7\n"), NULL, 0, ERR_DATA, 5, "no unit");
    refused(scenario("sum.c", "method: rnig\n"), NULL, 0, ERR_DATA, 5, "did you mean 'ring'?");
    refused(scenario("sum.c", "metod: ring\n"), NULL, 0, ERR_DATA, 5, "did you mean 'method'?");
    refused(scenario("sum.c", "program.blok: 1 B\n"), NULL, 0, ERR_DATA, 5,
            "did you mean 'block'?");
    refused(scenario("sum.c", "kernel: ring\n"), NULL, 0, ERR_DATA, 4, "exclude each other");
    static const char *const set[] = {"metod=ring"}, *const wrong[] = {"n=x"};
    refused(scenario("sum.c", ""), set, 1, ERR_DATA, 0, "did you mean 'method'?");
    refused(scenario("sum.c", ""), wrong, 1, ERR_DATA, 0, "not a whole number");
    const char *without = scratch_write(
        &scratch, "inside/none.yaml",
        "schema_version: 1\nmachine: t3e-300\nranks: 4\nkernel: ring\nprogram.n: 4\n");
    refused(without, NULL, 0, ERR_DATA, 5, "no program of your own is given");
    refused(scenario("nothere.c", ""), NULL, 0, ERR_NO_INPUT, 4, "there is no such file");
}

static void programs_can_be_swept(void **state)
{
    (void)state;
    write_program("inside/sum.c");
    write_program("inside/next.c");
    struct plan p = planned(scenario("[sum.c, next.c]", "n: 6\n"), NULL, 0);
    assert_int_equal(p.nrun, 2);
    assert_string_equal(p.run[0].kernel.name, "sum");
    assert_string_equal(p.run[1].kernel.name, "other");
    assert_string_equal(p.run[1].program.parameters, "n = 6\n");
    plan_free(&p);
    /* What suits one and not the other is refused, as both runs are wanted. */
    refused(scenario("[sum.c, next.c]", "n: 60\n"), NULL, 0, ERR_DATA, 5, "of program other");
    /* The same beside a built-in one. */
    const char *both =
        scratch_write(&scratch, "inside/both.yaml",
                      "schema_version: 1\nmachine: t3e-300\nranks: 4\nsweep:\n  variant:\n"
                      "    - {kernel: ring}\n    - {program: sum.c, block: 1 KiB}\n");
    p = planned(both, NULL, 0);
    assert_int_equal(p.nrun, 2);
    assert_false(p.run[0].kernel.own);
    assert_null(p.run[0].program.parameters);
    assert_true(p.run[1].kernel.own);
    assert_non_null(strstr(p.run[1].program.parameters, "block = 1 KiB\n"));
    plan_free(&p);
}

static void files_outside_the_folder_need_permission(void **state)
{
    (void)state;
    char link[160], target[160], absolute[160], set[200];
    write_program("sum.c");
    asked = 0;
    refused(scenario("../sum.c", ""), NULL, 0, ERR_DATA, 4, "--allow-programs");
    snprintf(absolute, sizeof absolute, "%s/sum.c", scratch.dir);
    refused(scenario(absolute, ""), NULL, 0, ERR_DATA, 4, "--allow-programs");
    refused(scenario("[../inside/../sum.c]", ""), NULL, 0, ERR_DATA, 4, "--allow-programs");
    snprintf(link, sizeof link, "%s/inside/link.c", scratch.dir);
    snprintf(target, sizeof target, "%s/sum.c", scratch.dir);
    assert_int_equal(symlink(target, link), 0);
    refused(scenario("link.c", ""), NULL, 0, ERR_DATA, 4, "--allow-programs");
    assert_int_equal(asked, 0); /* nothing was looked at */
    /* What the user types is the user's wish, and so is the option. */
    snprintf(set, sizeof set, "program=%s", absolute);
    const char *const sets[] = {set};
    struct plan p = planned(scenario("../sum.c", ""), sets, 1);
    plan_free(&p);
    struct err e;
    err_clear(&e);
    struct plan_options o = options(NULL, 0);
    o.allow_programs = true;
    assert_true(plan_read(&p, scenario("link.c", ""), &o, &e));
    plan_free(&p);
}

static void a_program_makes_a_scenario_by_itself(void **state)
{
    (void)state;
    write_program("inside/sum.c");
    char path[160];
    snprintf(path, sizeof path, "%s/inside/sum.c", scratch.dir);
    static const char *const set[] = {"n=50"};
    struct plan p = planned(path, set, 1);
    assert_int_equal(p.nrun, 5);
    assert_string_equal(p.name, "sum");
    assert_string_equal(p.question, "adds");
    assert_int_equal(p.run[4].nrank, 16);
    assert_non_null(strstr(p.run[4].program.parameters, "n = 50\n"));
    plan_free(&p);
    /* Verbs that take no programs say so. */
    struct err e;
    err_clear(&e);
    assert_false(plan_read(&p, path, NULL, &e));
    assert_int_equal(e.kind, ERR_USAGE);
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(declared_parameters_are_keys),
        cmocka_unit_test(n_of_a_program_is_the_n_of_plans),
        cmocka_unit_test(wrong_values_and_keys_are_refused_with_their_place),
        cmocka_unit_test(programs_can_be_swept),
        cmocka_unit_test(files_outside_the_folder_need_permission),
        cmocka_unit_test(a_program_makes_a_scenario_by_itself),
    };
    return cmocka_run_group_tests(test, open_with_folder, close_scratch);
}
