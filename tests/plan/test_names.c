/* test_names.c - which file a name means, what kind of file it is, and what runs and machines are
 * called. */
#include "in_arena.h"

#include <sys/stat.h>

#include "plan/call.h"
#include "plan/data_dir.h"
#include "plan/file_kind.h"
#include "plan/machine_changes.h"
#include "plan/machine_file.h"
#include "plan/setting.h"

/* ---- names of files ---- */

static void make_folder(const char *name)
{
    char path[200];
    snprintf(path, sizeof path, "%s/%s", scratch.dir, name);
    assert_int_equal(mkdir(path, 0700), 0);
}

/* Shipped files in data/, the user's in mimdsim/. */
static void make_files(void)
{
    static const char *const folder[] = {
        "data",    "data/machines",    "data/scenarios",    "data/plots",
        "mimdsim", "mimdsim/machines", "mimdsim/scenarios", "beside"};
    static const char *const file[] = {
        "data/machines/b.yaml",      "data/machines/a.yaml", "data/machines/.h.yaml",
        "data/machines/note.txt",    "data/machines/.yaml",  "mimdsim/machines/b.yaml",
        "mimdsim/machines/own.yaml", "beside/b.yaml",        "data/plots/fig1.sql",
        "data/plots/fig1.gp",        "data/plots/wide.yaml", "data/scenarios/s.yaml"};
    char path[200];
    for (size_t i = 0; i < sizeof folder / sizeof *folder; i++) make_folder(folder[i]);
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) scratch_write(&scratch, file[i], "");
    snprintf(path, sizeof path, "%s/data", scratch.dir);
    setenv("MIMDSIM_DATA", path, 1);
}

static const char *in_scratch(const char *name)
{
    struct text t = {0};
    text_add(&t, "%s/%s", scratch.dir, name);
    const char *path = arena_text(a, t.s);
    text_free(&t);
    return path;
}

static void names_are_those_of_both_folders_once_and_sorted(void **state)
{
    (void)state;
    int n;
    make_files();
    const char **name = data_dir_names("machines", a, &n);
    assert_int_equal(n, 3);
    assert_string_equal(name[0], "a");
    assert_string_equal(name[1], "b");
    assert_string_equal(name[2], "own");
    name = data_dir_names("plots", a, &n);
    assert_int_equal(n, 1);
    assert_string_equal(name[0], "fig1");
    data_dir_names("nowhere", a, &n);
    assert_int_equal(n, 0);
    assert_true(data_dir_has_figure("fig1", "f", 3, a, &e));
    assert_false(data_dir_has_figure("fig2", "f", 3, a, &e));
    refused(ERR_DATA, 3, "fig1");
    /* a relative folder of the user's does not count */
    setenv("XDG_DATA_HOME", "relative", 1);
    setenv("HOME", "", 1);
    data_dir_names("machines", a, &n);
    assert_int_equal(n, 2);
}

static void a_name_means_the_nearest_file(void **state)
{
    (void)state;
    make_files();
    const char *near = in_scratch("beside");
    assert_string_equal(data_dir_find("machines", "b", near, a, &e), in_scratch("beside/b.yaml"));
    assert_string_equal(data_dir_find("machines", "b", NULL, a, &e),
                        in_scratch("data/machines/b.yaml"));
    assert_string_equal(data_dir_find("machines", "own", near, a, &e),
                        in_scratch("mimdsim/machines/own.yaml"));
    assert_string_equal(data_dir_find("machines", "b.yaml", near, a, &e),
                        in_scratch("beside/b.yaml"));
    assert_string_equal(data_dir_find("machines", "../beside/b.yaml", near, a, &e),
                        in_scratch("beside/../beside/b.yaml"));
    assert_string_equal(
        data_dir_find("machines", in_scratch("data/machines/note.txt"), near, a, &e),
        in_scratch("data/machines/note.txt"));
    static const char *const wrong[][2] = {{"owm", "did you mean 'own'"},
                                           {"", "no machine ''"},
                                           {"b.yml", "no file 'b.yml'"},
                                           {"no/b", "the machine of that name"},
                                           {"s", "no machine 's'"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_null(data_dir_find("machines", wrong[i][0], NULL, a, &e));
        refused(ERR_NO_INPUT, 0, wrong[i][1]);
    }
}

static void parts_of_paths(void **state)
{
    (void)state;
    static const char *const row[][3] = {{"a.yaml", "", "a"},    {"x/a.yaml", "x", "a"},
                                         {"/a.yaml", "/", "a"},  {"x/y/a.b.yaml", "x/y", "a.b"},
                                         {"a.yml", "", "a"},     {"a.json", "", "a.json"},
                                         {".yaml", "", ".yaml"}, {"x.yaml/a", "x.yaml", "a"},
                                         {"x/", "x", ""},        {"a.yaml.bak", "", "a.yaml.bak"}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        assert_string_equal(data_dir_of(row[i][0], a), row[i][1]);
        assert_string_equal(data_dir_stem(row[i][0], a), row[i][2]);
    }
}

/* ---- kinds of files ---- */

static void files_are_known_by_what_is_in_them(void **state)
{
    (void)state;
    static const char sqlite[] = "SQLite format 3";
    static const struct {
        const char *name, *text;
        size_t size; /* 0: the length of the text */
        enum file_kind kind;
    } row[] = {
        {"1.yaml", "machine: t3e-300\n", 0, FILE_SCENARIO},
        {"2.yaml", "topology: {}\n", 0, FILE_MACHINE},
        {"3.yml", "title: T\nbase: t3e-300\n", 0, FILE_MACHINE},
        {"4.yaml", "title: T\nquestion: Q\n", 0, FILE_UNKNOWN},
        {"5.yaml", "- machine: t3e-300\n", 0, FILE_UNKNOWN},
        {"6.yaml", "other: 1\n", 0, FILE_UNKNOWN},
        {"7.yaml", "machine: [\n", 0, FILE_UNKNOWN},
        {"8.txt", "machine: t3e-300\n", 0, FILE_UNKNOWN},
        {"9.yaml", sqlite, sizeof sqlite, FILE_DATABASE},
        {"10", sqlite, sizeof sqlite, FILE_DATABASE},
        {"11", sqlite, sizeof sqlite - 1, FILE_UNKNOWN},
        {"15", "SQLite format 3\n", 0, FILE_UNKNOWN},
        {"12.urdf", "", 0, FILE_ROBOT},
        {"13.json", "", 0, FILE_CASES},
        {"14.JSON", "", 0, FILE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const char *path = in_scratch(row[i].name);
        FILE *out = fopen(path, "wb");
        const size_t size = row[i].size > 0 ? row[i].size : strlen(row[i].text);
        assert_non_null(out);
        assert_int_equal(fwrite(row[i].text, 1, size, out), size);
        fclose(out);
        if (file_kind_of(path, a) != row[i].kind) fail_msg("%s", row[i].name);
    }
    assert_int_equal(file_kind_of(scratch.dir, a), FILE_UNKNOWN);
    assert_int_equal(file_kind_of(in_scratch("missing.urdf"), a), FILE_UNKNOWN);
    assert_int_equal(file_kind_of("speedup-t3e", a), FILE_SCENARIO);
    assert_int_equal(file_kind_of("t3e-300", a), FILE_MACHINE);
    assert_int_equal(file_kind_of_tree(NULL), FILE_UNKNOWN);
}

static void a_mistaken_file_is_answered_with_its_verb(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum file_kind wanted;
        const char *part; /* NULL: the first error stays */
    } row[] = {
        {"t3e-300", FILE_SCENARIO, "t3e-300 is a machine, not a scenario: `mimdsim machines"},
        {"speedup-t3e", FILE_DATABASE, "is a scenario, not a database: `mimdsim run"},
        {"speedup-t3e", FILE_SCENARIO, NULL},
        {"nothing-of-the-kind", FILE_SCENARIO, NULL},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        err_set(&e, ERR_NO_INPUT, "first");
        assert_int_equal(file_kind_refuse(row[i].name, row[i].wanted, &e), row[i].part != NULL);
        if (row[i].part != NULL) refused(ERR_USAGE, 0, row[i].part);
        else refused(ERR_NO_INPUT, 0, "first");
    }
    const char *robot = scratch_write(&scratch, "r.urdf", "<robot/>");
    assert_true(file_kind_refuse(robot, FILE_CASES, &e));
    refused(ERR_USAGE, 0, "is a robot, not a file of reference cases: a scenario names it");
}

/* ---- what was changed of a machine ---- */

static struct machine_spec shipped(const char *name)
{
    struct machine_file m;
    if (!machine_file_read(&m, name, NULL, a, &e)) fail_msg("%s", e.text);
    return m.spec;
}

static void changes_are_what_the_machine_has_otherwise(void **state)
{
    (void)state;
    struct machine_changes c = {.arena = a};
    struct run_spec run = {.machine = shipped("t3e-300")};
    char first[65];
    machine_changes_note(&c, &run);
    assert_string_equal(run.machine_changes, "{}");
    assert_int_equal(strlen(run.machine_hash), 64);
    snprintf(first, sizeof first, "%s", run.machine_hash);
    /* level and tolerance are questions */
    run.machine.network.level = LEVEL_LOGGP;
    run.machine.network.tolerance = 0.5;
    machine_changes_note(&c, &run);
    assert_string_equal(run.machine_changes, "{}");
    run.machine.network.hop_latency = 61e-9;
    run.machine.software.send_overhead = 1e-6;
    machine_changes_note(&c, &run);
    assert_string_equal(run.machine_changes, "{\"network.hop_latency\": \"61 ns\", "
                                             "\"software.send.overhead\": \"1 us\"}");
    /* compared with the same shipped machine */
    assert_string_equal(run.machine_hash, first);
    /* nothing is shipped under that name, nor outside the folder */
    static const char *const none[] = {"mine", "../machines/t3e-300", ""};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        snprintf(run.machine.name, sizeof run.machine.name, "%s", none[i]);
        machine_changes_note(&c, &run);
        assert_null(run.machine_changes);
        assert_string_equal(run.machine_hash, "");
    }
    /* asked again after others: the same answer */
    run.machine = shipped("t3e-300");
    machine_changes_note(&c, &run);
    assert_string_equal(run.machine_changes, "{}");
    assert_string_equal(run.machine_hash, first);
}

static void changes_between_two_machines(void **state)
{
    (void)state;
    struct machine_spec own = shipped("t3e-300"), from = own;
    struct text t = {0};
    machine_changes_between(&from, &own, &t);
    own.network.level = LEVEL_FLIT;
    machine_changes_between(&from, &own, &t);
    assert_string_equal(t.s, "{}{}");
    own.network.link_bandwidth *= 2;
    machine_changes_between(&from, &own, &t);
    assert_string_equal(t.s + 4, "{\"network.link.bandwidth\": \"960 MB/s\"}");
    text_free(&t);
}

/* A machine that was changed never has the plain name of the shipped one. */
static void runs_are_called_by_what_was_changed(void **state)
{
    (void)state;
    struct machine_changes c = {.arena = a};
    struct calls calls = {.arena = a};
    struct machine_spec file = shipped("t3e-300");
    struct setting hop, level, label;
    assert_true(setting_make(&hop, "machine.network.hop_latency", "1 us", "f", 1, a, &e));
    assert_true(setting_make(&level, "level", "link", "f", 1, a, &e));
    assert_true(setting_make(&label, "name", "mine", "f", 1, a, &e));
    struct setting both[2] = {hop, level}, named[2] = {label, hop};
    const struct {
        const char *label;
        struct call_point point;
        const char *called;
    } row[] = {
        {"", {.swept = false, .n = 0}, "t3e-300"},
        {"", {.swept = true, .n = 2, .at = both}, "t3e-300, hop_latency 1 us"},
        {"fast", {.swept = true, .n = 2, .at = both}, "fast, hop_latency 1 us"},
        /* of one point only: the name is meant for it */
        {"fast", {.swept = false, .n = 2, .at = both}, "fast"},
        {"mine", {.swept = true, .n = 2, .at = named}, "mine"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct run_spec run = {.machine = file};
        snprintf(run.label, sizeof run.label, "%s", row[i].label);
        for (int k = 0; k < row[i].point.n; k++) setting_apply(&row[i].point.at[k], &run, a);
        machine_changes_note(&c, &run);
        call_run(&calls, &run, &file, &row[i].point, 1);
        assert_string_equal(run.called, row[i].called);
    }
    /* of a machine that is not shipped its own file is what it is compared with */
    struct run_spec run = {.machine = file};
    snprintf(run.machine.name, sizeof run.machine.name, "mine");
    struct machine_spec own = run.machine;
    run.machine.network.hop_latency = 1e-6;
    machine_changes_note(&c, &run);
    call_run(&calls, &run, &own, NULL, 0);
    assert_string_equal(run.called, "mine, hop_latency 1 us");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(names_are_those_of_both_folders_once_and_sorted),
        TEST(a_name_means_the_nearest_file),
        TEST(parts_of_paths),
        TEST(files_are_known_by_what_is_in_them),
        TEST(a_mistaken_file_is_answered_with_its_verb),
        TEST(changes_are_what_the_machine_has_otherwise),
        TEST(changes_between_two_machines),
        TEST(runs_are_called_by_what_was_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
