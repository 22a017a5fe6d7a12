/* test_plan.c - scenarios become the runs they describe; what is wrong is refused with its
 * place. */
#include "scratch.h"

#include "io/document.h"
#include "spec/identity.h"

enum { YAML_LARGE = DOCUMENT_MAX_SETTINGS + 2 };

static void the_speedup_scenario_has_its_points_in_order(void **state)
{
    (void)state;
    static const int n[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 45, 48, 64, 96, 128};
    struct plan p = scratch_plan("speedup-t3e", NULL, 0);
    assert_int_equal(p.nrun, 28);
    assert_string_equal(p.name, "speedup-t3e");
    assert_true(strlen(p.question) > 10);
    assert_int_equal(p.nfigure, 2);
    assert_string_equal(p.figure[1], "fig6");
    assert_int_equal(p.nunused, 0);
    for (int i = 0; i < 28; i++) {
        const struct run_spec *r = &p.run[i];
        struct run_spec again = *r;
        assert_int_equal(r->nrank, n[i % 14]);
        assert_int_equal(r->model.nbody, n[i % 14]);
        assert_int_equal(r->machine.network.level, i < 14 ? LEVEL_LINK : LEVEL_LOGGP);
        assert_string_equal(r->machine.name, "t3e-300");
        assert_string_equal(r->kernel.name, "dynamics");
        assert_int_equal(r->model.generator, MODEL_SERIAL_CHAIN);
        run_identify(&again, p.arena);
        assert_string_equal(r->config_hash, again.config_hash);
        assert_string_equal(r->config_text, again.config_text);
        for (int j = 0; j < i; j++) assert_string_not_equal(r->config_hash, p.run[j].config_hash);
    }
    plan_free(&p);
}

static void a_path_and_a_name_mean_the_same_runs(void **state)
{
    (void)state;
    struct plan a = scratch_plan("speedup-t3e", NULL, 0);
    struct plan b = scratch_plan(MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", NULL, 0);
    assert_int_equal(a.nrun, b.nrun);
    for (int i = 0; i < a.nrun; i++)
        assert_string_equal(a.run[i].config_hash, b.run[i].config_hash);
    plan_free(&a);
    plan_free(&b);
}

/* Order, comments, spelling of units and nesting of keys are no part of a run. */
static void layout_does_not_change_the_identity(void **state)
{
    (void)state;
    static const char *const spelling[] = {
        "schema_version: 1\nmachine: t3e-300\nkernel: {name: forward, solver: cr}\nranks: "
        "4\nmodel: {n: 8}\nseed: 3\n",
        "# other order\nschema_version: 1\nseed: 3\nn: 8\nranks: 4\nkernel:\n  solver: cr\n  name: "
        "'forward'\n"
        "machine:\n  name: t3e-300\n",
        "{\"schema_version\": 1, \"kernel.solver\": \"cr\", \"kernel.name\": "
        "\"forward\",\n\t\"machine.name\": \"t3e-300\", \"ranks\": 4, \"model.n\": 8, \"seed\": 3}",
        "schema_version: 1\nmachine: {name: t3e-300, network: {link: {bandwidth: 0.48 "
        "GB/s}}}\nkernel: forward\n"
        "kernel.solver: cr\nranks: [4]\nsweep: {n: [8]}\nseed: 3\n",
    };
    char first[65];
    for (size_t i = 0; i < sizeof spelling / sizeof *spelling; i++) {
        struct plan p = scratch_plan(scratch_write(&scratch, "same.yaml", spelling[i]), NULL, 0);
        assert_int_equal(p.nrun, 1);
        if (i == 0) memcpy(first, p.run[0].config_hash, sizeof first);
        assert_string_equal(p.run[0].config_hash, first);
        plan_free(&p);
    }
}

static void sweeps_are_cross_products_in_stated_order(void **state)
{
    (void)state;
    const char *path = scratch_write(
        &scratch, "cross.yaml",
        "schema_version: 1\nmachine: t3e-300\nranks: [2, 4, 8]\nkernel: dynamics\nrepetitions: 2\n"
        "machine.noise.compute: 1 %\nsweep:\n  n_over_p: [1, 16]\n  variant:\n"
        "    - {kernel.solver: pcr, kernel.formulation: direct}\n"
        "    - {kernel: {solver: cr}}\n");
    struct plan p = scratch_plan(path, NULL, 0);
    static const int ranks[] = {2, 4, 8};
    assert_int_equal(p.nrun, 3 * 2 * 2 * 2);
    for (int i = 0; i < p.nrun; i++) {
        const struct run_spec *r = &p.run[i];
        assert_int_equal(r->rep, i % 2);
        assert_int_equal(r->kernel.solver, i / 2 % 2 ? SOLVER_CR : SOLVER_PCR);
        assert_int_equal(r->kernel.formulation, i / 2 % 2 ? FORMULATION_PAPER : FORMULATION_DIRECT);
        assert_int_equal(r->nrank, ranks[i / 8]);
        assert_int_equal(r->model.nbody, r->nrank * (i / 4 % 2 ? 16 : 1));
    }
    assert_string_equal(p.run[0].config_hash, p.run[1].config_hash);
    assert_int_equal(p.nunused, 0);
    plan_free(&p);
}

static void runs_without_chance_are_made_once(void **state)
{
    (void)state;
    const char *path = scratch_write(&scratch, "once.yaml",
                                     "schema_version: 1\nmachine: t3e-300\nranks: n\nkernel: "
                                     "dynamics\nrepetitions: 5\n"
                                     "sweep: {n: [4, 8], machine.noise.compute: [0 %, 1 %]}\n");
    struct plan p = scratch_plan(path, NULL, 0);
    assert_int_equal(p.nrun, 2 * (1 + 5));
    assert_int_equal(p.nunused, 0);
    plan_free(&p);
    static const char *const quiet[] = {"machine.noise.compute=0 %"};
    p = scratch_plan(path, quiet, 1);
    for (int i = 0; i < p.nrun; i++) assert_int_equal(p.run[i].rep, 0);
    assert_non_null(
        strstr(p.unused[0], "repetitions: nothing is random in these runs, so each is made once"));
    plan_free(&p);
}

static void only_leaves_points_out(void **state)
{
    (void)state;
    const char *path =
        scratch_write(&scratch, "only.yaml",
                      "schema_version: 1\nmachine: [t3e-300]\nkernel: dynamics\nranks: [2, 8, 128, "
                      "256]\n"
                      "only: [n >= ranks, ranks <= processors]\nsweep: {n: [4, 300]}\n");
    struct plan p = scratch_plan(path, NULL, 0);
    assert_int_equal(p.nrun, 4); /* (2,4) (2,300) (8,300) (128,300) */
    assert_int_equal(p.run[1].model.nbody, 300);
    assert_int_equal(p.run[3].nrank, 128);
    plan_free(&p);
}

static void the_command_line_is_applied_last(void **state)
{
    (void)state;
    const char *const set[] = {"n=[4,8]",
                               "level=loggp",
                               "machine.network.link.bandwidth=960 MB/s",
                               "machine.topology.dims=[16,8,8]",
                               "repetitions=3", "machine.noise.compute=1 %",
                               "kernel.operators=dense"};
    struct plan p = scratch_plan("speedup-t3e", set, 7);
    assert_int_equal(p.nrun, 6);
    assert_int_equal(p.run[5].nrank, 8);
    assert_int_equal(p.run[5].rep, 2);
    assert_true(p.run[0].machine.network.link_bandwidth == 960e6);
    assert_int_equal(p.run[0].machine.topology.dims[0], 16);
    assert_int_equal(p.run[0].machine.network.level, LEVEL_LOGGP);
    assert_int_equal(p.run[0].kernel.operators, OPERATORS_DENSE);
    plan_free(&p);
    struct err e;
    struct plan_options o = {.machine = "t3e-300-mpt", .nset = 1, .set = set};
    err_clear(&e);
    assert_true(plan_read(&p, "speedup-t3e", &o, &e));
    assert_string_equal(p.run[0].machine.name, "t3e-300-mpt");
    assert_true(p.run[0].machine.software.send_overhead == 1.2e-6);
    plan_free(&p);
}

/* What is wrong with a setting is said with --set as its place. */
static void wrong_options_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *set, *expected;
        enum err_kind kind;
    } wrong[] = {
        {"n", "expected key=value", ERR_USAGE},
        {"=3", "expected key=value", ERR_USAGE},
        {"n=0", "model.n: '0': out of range", ERR_DATA},
        {"n=", "not a whole number", ERR_DATA},
        {"n=[2,", "is not a list", ERR_DATA},
        {"n=[2,[3]]", "a list within a list", ERR_DATA},
        {"machine.network.link.bandwith=1 GB/s",
         "did you mean 'machine.network.link.bandwidth'?", ERR_DATA},
        {"machine.network.link.bandwidth=1 GHz", "unit of a frequency", ERR_DATA},
        {"rank=4", "did you mean 'ranks'?", ERR_DATA},
        {"zzzzzzzzzzzzzz=4", "expected ranks, seed", ERR_DATA},
        {"machine=t3e-30", "did you mean 't3e-300'?", ERR_NO_INPUT},
        {"machine.title=x", "unknown key", ERR_DATA},
        {"scenario=x", "unknown key", ERR_DATA},
        {"repetitions=0", "out of range", ERR_DATA},
        {"n=129", "129 ranks, but machine 't3e-300' has 128 processors", ERR_CONFIG},
        {"machine.topology.family=fat-tree",
         "topology.dims has 3 numbers; its family takes 2", ERR_CONFIG},
        {"machine.topology.dims=[1000,1000,1000]", "more than 16777216 processors", ERR_CONFIG},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct plan p;
        struct err e;
        struct plan_options o = {.nset = 1, .set = &wrong[i].set};
        err_clear(&e);
        if (plan_read(&p, "speedup-t3e", &o, &e)) fail_msg("--set %s is accepted", wrong[i].set);
        assert_null(p.arena);
        assert_int_equal(e.kind, wrong[i].kind);
        if (strstr(e.text, wrong[i].expected) == NULL)
            fail_msg("--set %s: %s", wrong[i].set, e.text);
    }
}

#define HEAD "schema_version: 1\nmachine: t3e-300\nkernel: dynamics\nranks: 4\n"

static const struct bad_file {
    const char *text;
    int line;
    enum err_kind kind;
    const char *expected;
} bad_files[] = {
    {"", 1, ERR_DATA, "empty"},
    {"# nothing\n", 1, ERR_DATA, "empty"},
    {"just text\n", 1, ERR_DATA, "expected 'key: value'"},
    {"- a\n- b\n", 1, ERR_DATA, "expected 'key: value'"},
    {"a: [1, 2\nb: 3\n", 2, ERR_DATA, "not YAML"},
    {"a: 1\n  b: 2\n", 2, ERR_DATA, "not YAML"},
    {"a:\t- 1\n\tb: 2\n", 0, ERR_DATA, "not YAML"},
    {"\xff\xfe\x01", 0, ERR_DATA, "not YAML"},
    {"schema_version: 1\n---\nb: 2\n", 2, ERR_DATA, "second document"},
    {HEAD "n: &x 4\n", 5, ERR_DATA, "anchors"},
    {HEAD "n: *x\n", 5, ERR_DATA, "aliases"},
    {HEAD "n: !!int 4\n", 5, ERR_DATA, "tags"},
    {HEAD "? [a, b]\n: 3\n", 5, ERR_DATA, "a key has to be a name"},
    {"machine: t3e-300\n", 1, ERR_DATA, "schema_version is missing"},
    {"schema_version: 2\n", 1, ERR_DATA, "this program reads version 1"},
    {"schema_version: 1\nkernel: dynamics\nranks: 2\n", 1, ERR_DATA, "machine is missing"},
    {"schema_version: 1\nmachine: t3e-300\n", 1, ERR_DATA, "ranks is missing"},
    {HEAD "modle:\n  n: 4\n", 5, ERR_DATA, "unknown key 'modle'; did you mean 'model'?"},
    {HEAD "model:\n  n: 4\n  lenght: 1 m\n", 7, ERR_DATA,
     "unknown key 'lenght' in 'model'; did you mean 'length'?"},
    {HEAD "model:\n  qqqq: 4\n", 6, ERR_DATA, "expected one of generator, n, joint"},
    {HEAD "model:\n  length: 1\n", 6, ERR_DATA, "model.length: '1': no unit; expected a length"},
    {HEAD "model:\n  length: 1 s\n", 6, ERR_DATA, "unit of a time"},
    {HEAD "model:\n  mass: .inf kg\n", 6, ERR_DATA, "finite"},
    {HEAD "model:\n  mass: -1 kg\n", 6, ERR_DATA, "out of range"},
    {HEAD "model:\n  n: 0\n", 6, ERR_DATA, "model.n: '0': out of range"},
    {HEAD "model:\n  n: 4\n  n: 5\n", 7, ERR_DATA, "duplicate key 'n'; first given in line 6"},
    {HEAD "model:\n  n: 4\nn: 5\n", 7, ERR_DATA, "duplicate key 'model.n'; first given in line 6"},
    {HEAD "ranks: 5\n", 5, ERR_DATA, "duplicate key 'ranks'"},
    {HEAD "sweep: {ranks: [1, 2]}\n", 5, ERR_DATA,
     "'ranks' is swept here and set for all runs in line 4"},
    {HEAD "sweep:\n  n: [2, 3]\n  model.n: [4]\n", 7, ERR_DATA,
     "duplicate key 'model.n'; first swept in line 6"},
    {HEAD "sweep: {n: 4}\n", 5, ERR_DATA, "needs a list"},
    {HEAD "sweep: {n: []}\n", 5, ERR_DATA, "needs a list"},
    {HEAD "sweep: [n]\n", 5, ERR_DATA, "axes such as"},
    {HEAD "sweep:\n  n:\n    - 2\n    - two\n", 8, ERR_DATA, "model.n: 'two': not a whole number"},
    {HEAD "sweep: {variant: [3]}\n", 5, ERR_DATA, "each variant is a mapping"},
    {HEAD "sweep: {kernel.solver: [{a: 1}]}\n", 5, ERR_DATA, "takes values, not settings"},
    {HEAD "sweep: {sovler: [cr]}\n", 5, ERR_DATA, "unknown key 'sovler'"},
    {HEAD "kernel.solver: crr\n", 5, ERR_DATA, "did you mean 'cr'?"},
    {HEAD "machine.network: 4\n", 5, ERR_DATA, "'machine.network' is a group"},
    {HEAD "seed: many\n", 5, ERR_DATA, "not a seed"},
    {HEAD "repetitions: -2\n", 5, ERR_DATA, "out of range"},
    {HEAD "figures: fig6\n", 5, ERR_DATA, "a list such as"},
    {HEAD "only: n > three\n", 5, ERR_DATA, "unknown name 'three'"},
    {HEAD "only: {n: 3}\n", 5, ERR_DATA, "a list of conditions"},
    {HEAD "question: [a]\n", 5, ERR_DATA, "one line of text"},
    {HEAD "n: {value: 4, class: P}\nmodel.length: {class: P}\n", 6, ERR_DATA, "expected a value"},
    {HEAD "n_over_p: 4\nn: 4\n", 5, ERR_DATA, "n_over_p determines n already"},
    {"schema_version: 1\nmachine: t3e-300\nranks: n\nn_over_p: 2\n", 4, ERR_DATA,
     "needs ranks as numbers"},
    {"schema_version: 1\nmachine: nowhere\nranks: 2\n", 2, ERR_NO_INPUT, "no machine 'nowhere'"},
    {"schema_version: 1\nmachine: ./nowhere.yaml\nranks: 2\n", 2, ERR_NO_INPUT,
     "no file './nowhere.yaml'"},
    {"schema_version: 1\nmachine: t3e-300\nranks: 129\n", 3, ERR_CONFIG,
     "enlarge machine.topology.dims"},
    {"schema_version: 1\nmachine: t3e-300\nranks: n\nsweep:\n  n: [300, 200]\n", 5, ERR_CONFIG,
     "300 ranks"},
    {HEAD "only: n >= ranks\nn: 2\n", 0, ERR_CONFIG, "'only' excludes all runs"},
    {HEAD "model: {generator: urdf}\n", 0, ERR_DATA, "model.path is missing"},
    {HEAD "model: {generator: urdf, path: nowhere.urdf}\n", 0, ERR_NO_INPUT, "cannot open"},
    {HEAD "repetitions: 100000\nsweep: {n: [1,2,3,4,5,6,7,8,9,10,11,12]}\n", 0, ERR_CONFIG,
     "has 1200000 runs; expected at most 100000"},
};

static void wrong_files_are_refused_with_line_and_reason(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad_files / sizeof *bad_files; i++) {
        const struct bad_file *b = &bad_files[i];
        const char *path = scratch_write(&scratch, "bad.yaml", b->text);
        struct plan p;
        struct err e;
        err_clear(&e);
        if (plan_read(&p, path, NULL, &e)) fail_msg("accepted:\n%s", b->text);
        if (strstr(e.text, b->expected) == NULL) fail_msg("%s\ngives: %s", b->text, e.text);
        assert_int_equal(e.kind, b->kind);
        if (b->line != 0 && e.line != b->line) fail_msg("%s\nline %d: %s", b->text, e.line, e.text);
        if (e.line != 0) assert_string_equal(e.file, path);
        err_clear(&e);
        assert_false(plan_check_file(path, NULL, &e));
    }
}

static void missing_and_strange_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum err_kind kind;
    } files[] = {{"speedup-t3", ERR_NO_INPUT},
                 {"/nowhere/x.yaml", ERR_NO_INPUT},
                 {"", ERR_NO_INPUT},
                 {"/", ERR_DATA},
                 {"/dev/zero", ERR_DATA}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct plan p;
        struct err e;
        err_clear(&e);
        assert_false(plan_read(&p, files[i].name, NULL, &e));
        assert_int_equal(e.kind, files[i].kind);
        assert_true(e.text[0] != '\0');
    }
}

static void deep_and_large_files_are_refused(void **state)
{
    (void)state;
    enum { DEEP = 100000 };
    char *text = malloc(YAML_LARGE);
    struct plan p;
    struct err e;
    memset(text, '[', DEEP);
    memcpy(text, "a: ", 3);
    text[DEEP] = '\0';
    err_clear(&e);
    assert_false(plan_read(&p, scratch_write(&scratch, "deep.yaml", text), NULL, &e));
    assert_non_null(strstr(e.text, "nested deeper than 17 levels"));
    memset(text, ' ', YAML_LARGE - 1);
    text[YAML_LARGE - 1] = '\0';
    err_clear(&e);
    assert_false(plan_read(&p, scratch_write(&scratch, "large.yaml", text), NULL, &e));
    assert_int_equal(e.kind, ERR_DATA);
    free(text);
}

static void settings_that_do_not_act_are_reported(void **state)
{
    (void)state;
    const char *path = scratch_write(
        &scratch, "idle.yaml",
        HEAD "model: {n: 8, branch: 3, mass_ratio: 10}\nmachine.noise.background.message: 64 B\n"
             "sweep: {kernel.solver: [cr, pcr], kernel.hybrid_levels: [2, 3]}\n");
    const char *const set[] = {"kernel.repeat=4", "machine.network.buffer=20", "level=loggp"};
    static const char *const expected[] = {
        "model.branch: ",         "model.mass_ratio: ", "machine.noise.background.message: ",
        "kernel.hybrid_levels: ", "kernel.repeat: ",    "machine.network.buffer: "};
    struct plan p = scratch_plan(path, set, 3);
    assert_int_equal(p.nrun, 4);
    assert_int_equal(p.nunused, 6);
    for (int i = 0; i < 6; i++) assert_ptr_equal(strstr(p.unused[i], expected[i]), p.unused[i]);
    plan_free(&p);
    const char *const acting[] = {"kernel.solver=cr-pcr", "machine.noise.background.load=10 %",
                                  "level=link"};
    p = scratch_plan(path, acting, 3);
    assert_int_equal(p.nunused, 2); /* branch and mass_ratio */
    plan_free(&p);
}

/* A model's file counts by its content, wherever it lies. */
static void a_model_file_is_part_of_the_identity(void **state)
{
    (void)state;
    static const char scene[] = HEAD "model: {generator: urdf, path: robot.urdf}\n";
    char hash[3][65];
    for (int i = 0; i < 3; i++) {
        scratch_write(&scratch, "robot.urdf", i < 2 ? "<robot/>" : "<robot name='x'/>");
        struct plan p = scratch_plan(scratch_write(&scratch, "scene.yaml", scene), NULL, 0);
        memcpy(hash[i], p.run[0].config_hash, sizeof hash[i]);
        assert_int_equal(access(p.run[0].model.path, R_OK), 0);
        assert_null(strstr(p.run[0].config_text, scratch.dir));
        plan_free(&p);
    }
    assert_string_equal(hash[0], hash[1]);
    assert_string_not_equal(hash[0], hash[2]);
}

static void every_scenario_that_we_ship_is_valid(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const char **stem, **title;
    struct err e;
    int n;
    err_clear(&e);
    assert_true(plan_list("scenarios", a, &stem, &title, &n, &e));
    assert_true(n >= 1);
    for (int i = 0; i < n; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/scenarios/%s.yaml", MIMDSIM_SRCDIR, stem[i]);
        /* its program is compiled by those that run it: tests/cli/reality.bats */
        if (strcmp(stem[i], "calibrate-code") == 0) continue;
        if (!plan_check_file(path, NULL, &e)) fail_msg("%s:%d: %s", e.file, e.line, e.text);
        if (strlen(title[i]) < 10) fail_msg("%s asks no question", stem[i]);
        struct plan p = scratch_plan(stem[i], NULL, 0);
        if (p.nunused > 0) fail_msg("%s: %s", stem[i], p.unused[0]);
        plan_free(&p);
    }
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_speedup_scenario_has_its_points_in_order),
        cmocka_unit_test(a_path_and_a_name_mean_the_same_runs),
        cmocka_unit_test(layout_does_not_change_the_identity),
        cmocka_unit_test(sweeps_are_cross_products_in_stated_order),
        cmocka_unit_test(runs_without_chance_are_made_once),
        cmocka_unit_test(only_leaves_points_out),
        cmocka_unit_test(the_command_line_is_applied_last),
        cmocka_unit_test(wrong_options_are_refused),
        cmocka_unit_test(wrong_files_are_refused_with_line_and_reason),
        cmocka_unit_test(missing_and_strange_files_are_refused),
        cmocka_unit_test(deep_and_large_files_are_refused),
        cmocka_unit_test(settings_that_do_not_act_are_reported),
        cmocka_unit_test(a_model_file_is_part_of_the_identity),
        cmocka_unit_test(every_scenario_that_we_ship_is_valid),
    };
    return cmocka_run_group_tests(tests, open_scratch, close_scratch);
}
