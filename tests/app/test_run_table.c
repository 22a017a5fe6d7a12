/* test_run_table.c - the table of a plan's runs: which rows in which order, which columns under
 * which names, what is refused; and what formulas find of stored runs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "../support/made_run.h"
#include "app/outcome.h"
#include "app/run_table.h"
#include "base/text.h"

enum { RUNS = 6 };

static struct store *database;
static struct run_spec run[RUNS]; /* n = 16, 32, 64 on 4 ranks, then on 8; the fifth failed */

static int open_database(void **state)
{
    struct err e;
    err_clear(&e);
    make_arena(state);
    database = store_open("table", STORE_SCRATCH, &e);
    if (database == NULL) return 1;
    for (int i = RUNS - 1; i >= 0; i--) { /* stored in another order than planned */
        run[i] = made_spec(arena, "t3e-300", 16 << i % 3, i < 3 ? 4 : 8, 0);
        struct run_result r = made_result(arena, &run[i]);
        /* the name by which programs of speedups know one of its baselines */
        snprintf(r.baseline[2].name, sizeof r.baseline[2].name, "fastest serial");
        r.measured_s = NAN;
        if (i == 4) {
            r.status = RUN_FAILED, r.nu = 0;
            snprintf(r.text, sizeof r.text, "it ended early");
        }
        if (!store_put(database, &run[i], NULL, &r, &e)) return 1;
    }
    return 0;
}

static int close_database(void **state)
{
    store_close(database);
    return drop_arena(state);
}

/* What the table of `p` is; "" and *e where it is refused. */
static const char *table(const struct plan *p, const char *columns, bool json, bool csv,
                         struct err *e)
{
    const struct run_table_look l = {.json = json, .csv = csv, .columns = columns};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    err_clear(e);
    const bool good = run_table_print(database, p, &l, out, e);
    fclose(out);
    const char *kept = arena_text(arena, good ? text : "");
    assert_true(good || e->kind != ERR_NONE);
    /* the check before any run says the same */
    struct err early;
    err_clear(&early);
    assert_true(run_table_check(p, &l, &early) == good);
    assert_int_equal(early.kind, e->kind);
    free(text);
    return kept;
}

static void rows_are_those_of_the_plan_in_its_order(void **state)
{
    static const int order[][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {5, 0, -1, -1}, {4, -1, -1, -1}};
    struct err e;
    (void)state;
    for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
        struct run_spec some[4];
        struct plan p = {.run = some};
        char expected[200] = "n,P\r\n";
        for (int i = 0; i < 4 && order[k][i] >= 0; i++) {
            some[p.nrun++] = run[order[k][i]];
            const size_t at = strlen(expected);
            snprintf(expected + at, sizeof expected - at, "%d,%d\r\n", run[order[k][i]].model.nbody,
                     run[order[k][i]].nrank);
        }
        const char *text = table(&p, "n,P", false, true, &e);
        char plain[400];
        size_t n = 0;
        for (const char *c = text; *c; c++)
            if (*c != '"') plain[n++] = *c;
        plain[n] = '\0';
        /* lines end with or without CR */
        if (strchr(plain, '\r') == NULL) {
            size_t m = 0;
            for (const char *c = expected; *c; c++)
                if (*c != '\r') expected[m++] = *c;
            expected[m] = '\0';
        }
        assert_string_equal(plain, expected);
    }
    /* a run that is not stored has no row */
    struct run_spec other = made_spec(arena, "t3e-300", 128, 4, 0);
    const struct plan none = {.nrun = 1, .run = &other};
    assert_null(strpbrk(table(&none, "n,P", false, true, &e), "0123456789"));
}

/* One value of a table with columns for programs. */
static const char *cell(const char *csv, int line, const char *name)
{
    const char *at = csv;
    int column = 0;
    for (const char *c = csv; strncmp(c, name, strlen(name)) != 0 ||
                              strchr(",\r\n", c[strlen(name)]) == NULL || (c > csv && c[-1] != ',');
         c++) {
        assert_true(*c != '\0' && *c != '\n');
        column += *c == ',';
    }
    for (; line > 0; line--) at = strchr(at, '\n') + 1;
    for (; column > 0; column--) at = at + strcspn(at, ",\n") + 1;
    struct text t = {0};
    text_add(&t, "%.*s", (int)strcspn(at, ",\r\n"), at);
    const char *kept = arena_text(arena, t.s);
    text_free(&t);
    return kept;
}

static void programs_get_every_column(void **state)
{
    struct err e;
    const struct plan p = {.nrun = RUNS, .run = run};
    (void)state;
    const char *csv = table(&p, NULL, false, true, &e);
    for (int i = 0; i < RUNS; i++) {
        const struct run_result r = made_result(arena, &run[i]);
        char n[16];
        snprintf(n, sizeof n, "%d", 16 << i % 3);
        assert_string_equal(cell(csv, i + 1, "n"), n);
        assert_string_equal(cell(csv, i + 1, "kernel"), "dynamics");
        assert_string_equal(cell(csv, i + 1, "level"), "link");
        assert_string_equal(cell(csv, i + 1, "status"), i == 4 ? "failed" : "ok");
        assert_string_equal(cell(csv, i + 1, "reason"), i == 4 ? "it ended early" : "");
        assert_string_equal(cell(csv, i + 1, "level_error"), "");
        if (i == 4) { /* what did not end has no time */
            assert_string_equal(cell(csv, i + 1, "makespan_us"), "");
            assert_string_equal(cell(csv, i + 1, "speedup_vs_fastest_serial"), "");
            assert_string_equal(cell(csv, i + 1, "relative_error"), "");
            continue;
        }
        const double time = (double)r.makespan_ps / 1e6,
                     speedup = (double)r.baseline[2].time_ps / (double)r.makespan_ps;
        assert_true(fabs(atof(cell(csv, i + 1, "makespan_us")) - time) < 1e-9 * time);
        assert_true(fabs(atof(cell(csv, i + 1, "speedup_vs_fastest_serial")) - speedup) < 1e-9);
        assert_true(atof(cell(csv, i + 1, "relative_error")) == 2e-13); /* the larger of both */
        assert_string_equal(cell(csv, i + 1, "measured_us"), "");
        assert_string_equal(cell(csv, i + 1, "message"), "");
    }
    assert_null(strstr(csv, "machine_error")); /* in words, for people */
    assert_null(strstr(csv, ",rep,"));
    /* the same as a document, and with fewer words for people */
    assert_non_null(strstr(table(&p, NULL, true, false, &e), "\"reason\""));
    assert_non_null(strstr(table(&p, NULL, true, false, &e), "\"reason\": null"));
    /* one name of two columns: the one in words, for who asks by name */
    assert_non_null(strstr(table(&p, "level_error", false, true, &e), "not known"));
    const char *people = table(&p, NULL, false, false, &e);
    assert_null(strstr(people, "reason"));
    assert_null(strstr(people, "measured_us")); /* nobody has one */
    const char *all = table(&p, "all", false, false, &e);
    assert_non_null(strstr(all, "reason"));
    assert_non_null(strstr(all, "measured_us"));
    assert_non_null(strstr(all, "not known"));
}

/* Each swept key by the end of its name that no other column has. */
static void swept_keys_have_short_names(void **state)
{
    static const struct {
        const char *key[3], *name[3];
    } row[] = {
        {{"machine.network.link.bandwidth"}, {"bandwidth"}},
        {{"machine.network.link.bandwidth", "machine.node.copy.bandwidth"},
         {"link.bandwidth", "copy.bandwidth"}},
        {{"machine.software.send.overhead", "machine.software.recv.overhead", "program.overhead"},
         {"send.overhead", "recv.overhead", "program.overhead"}},
        {{"machine.noise.seed", "seed"}, {"noise.seed", "seed"}},
        {{"program.width", "program.bandwidth"}, {"width", "bandwidth"}},
        {{"program.level"}, {"program.level"}}, /* there is a column "level" */
        {{"program.rep"}, {"program.rep"}},     /* and one "rep" at times */
        {{"program.status"}, {"program.status"}},
        {{"job.name"}, {"job"}},
        {{"machine.network.hop_latency"}, {"hop_latency"}}, /* whole words alone */
        {{"a.b", "c.a.b"}, {"a.b", "c.a.b"}},
        {{"machine.network.level", "ranks", "kernel.name"}, {NULL}}, /* columns of their own */
        {{"n_over_p"}, {"n_over_p"}},
    };
    struct err e;
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct plan_swept swept[3];
        struct plan p = {.nrun = 1, .run = run, .swept = swept};
        for (int k = 0; k < 3 && row[i].key[k]; k++)
            swept[p.nswept++] = (struct plan_swept){.key = row[i].key[k]};
        const char *csv = table(&p, NULL, false, true, &e);
        struct text head = {0};
        text_add(&head, ",P,");
        for (int k = 0; k < 3 && row[i].name[k]; k++) text_add(&head, "%s,", row[i].name[k]);
        text_add(&head, "makespan_us,");
        if (strstr(csv, head.s) == NULL) fail_msg("row %d: %s not in %s", (int)i, head.s, csv);
        text_free(&head);
    }
}

static void swept_settings_and_repetitions_have_values(void **state)
{
    struct err e;
    struct plan_swept swept[] = {{"machine.network.link.bandwidth", false}, {"n_over_p", true}};
    struct run_spec again = made_spec(arena, "t3e-300", 16, 4, 3);
    struct run_result r = made_result(arena, &again);
    (void)state;
    r.measured_s = 2.5e-6;
    assert_true(store_put(database, &again, NULL, &r, &e));
    const struct run_spec both[] = {run[1], again};
    const struct plan p = {.nrun = 2, .run = both, .nswept = 2, .swept = swept};
    const char *csv = table(&p, NULL, false, true, &e);
    assert_string_equal(cell(csv, 1, "rep"), "0");
    assert_string_equal(cell(csv, 2, "rep"), "3");
    assert_string_equal(cell(csv, 1, "n_over_p"), "8");
    assert_string_equal(cell(csv, 2, "n_over_p"), "4");
    assert_string_equal(cell(csv, 2, "bandwidth"), "unlimited");
    assert_true(fabs(atof(cell(csv, 2, "measured_us")) - 2.5) < 1e-9);
}

/* What is not the same for all programs: only those with bodies have an n, only micro-benchmarks
 * measure messages, alone and in one table. */
static void programs_have_what_they_mean(void **state)
{
    enum { SCENE = 1, MESSAGE = 2, SWEPT = 4 };
    static const unsigned plan[] = {SCENE, MESSAGE, SCENE | MESSAGE, SCENE | SWEPT,
                                    SCENE | MESSAGE | SWEPT};
    struct plan_swept swept[] = {{"kernel.message", false}};
    struct err e;
    struct run_spec bench = made_spec(arena, "t3e-300", 16, 4, 5);
    (void)state;
    text_copy(bench.kernel.name, sizeof bench.kernel.name, "pingpong");
    bench.kernel.message_bytes = 4096;
    made_identity(&bench, arena);
    struct run_result r = made_result(arena, &bench);
    r.nu = 0, r.measured_s = 2.5e-6;
    assert_true(store_put(database, &bench, NULL, &r, &e));
    for (size_t i = 0; i < sizeof plan / sizeof *plan; i++) {
        struct run_spec some[2];
        struct plan p = {.run = some, .nswept = plan[i] & SWEPT ? 1 : 0, .swept = swept};
        if (plan[i] & SCENE) some[p.nrun++] = run[0];
        if (plan[i] & MESSAGE) some[p.nrun++] = bench;
        const char *csv = table(&p, NULL, false, true, &e);
        for (int k = 0; k < p.nrun; k++) {
            const bool scene = (plan[i] & SCENE) && k == 0;
            assert_string_equal(cell(csv, k + 1, "n"), scene ? "16" : "");
            const char *message = cell(csv, k + 1, "message");
            if (!scene) assert_string_equal(message, "4 KiB");
            else assert_true((message[0] != '\0') == ((plan[i] & SWEPT) != 0));
        }
    }
}

static void columns_are_taken_as_asked_or_refused(void **state)
{
    static const struct {
        const char *columns, *words; /* NULL: they are there */
    } row[] = {
        {"P", NULL},
        {"P,P,n", NULL},
        {"reason,digest", NULL},
        {"bandwith", "no column 'bandwith'; did you mean 'bandwidth'?"},
        {"P,,n", "no column ''"},
        {"P,", "no column ''"},
        {",P", "no column ''"},
        {"n,all", "no column 'all'"},
        {"p", "no column 'p'"},
        {"xyzzyxyzzy", "no column 'xyzzyxyzzy'; expected some of machine, kernel, formulation"},
        {"P;DROP", "no column 'P;DROP'"},
    };
    struct plan_swept swept[] = {{"machine.network.link.bandwidth", false}};
    const struct plan p = {.nrun = 1, .run = run, .nswept = 1, .swept = swept};
    struct err e;
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const char *text = table(&p, row[i].columns, false, true, &e);
        if (row[i].words == NULL) {
            char head[64];
            snprintf(head, sizeof head, "%s", row[i].columns);
            assert_int_equal(strncmp(text, head, strlen(head)), 0);
        } else if (e.kind != ERR_USAGE || strstr(e.text, "machine_low") ||
                   !strstr(e.text, row[i].words))
            fail_msg("%s: '%s'", row[i].columns, e.text);
    }
    /* out of the command line */
    char *argv[] = {
        (char *)"mimdsim run", (char *)"a", (char *)"--csv", (char *)"--columns", (char *)"n,P",
        (char *)"b",           NULL};
    int argc = 6;
    struct run_table_look l;
    err_clear(&e);
    assert_true(run_table_take(&argc, argv, &l, &e));
    assert_true(argc == 3 && l.csv && !l.json && strcmp(l.columns, "n,P") == 0);
    assert_true(run_table_take(&argc, argv, &l, &e) && !l.csv && l.columns == NULL);
    char *empty[] = {(char *)"mimdsim run", (char *)"--columns=", NULL};
    argc = 2;
    assert_false(run_table_take(&argc, empty, &l, &e));
    assert_int_equal(e.kind, ERR_USAGE);
}

/* ---- outcomes */

static void outcomes_are_those_of_stored_runs(void **state)
{
    struct err e;
    struct outcome o;
    (void)state;
    err_clear(&e);
    for (int i = 0; i < RUNS; i++) {
        const struct run_result r = made_result(arena, &run[i]);
        assert_true(outcome_read(database, &run[i], &o, &e));
        assert_true(o.ok == (i != 4) && o.id == store_run_id(database, &run[i]) && o.id > 0);
        assert_true(fabs(o.makespan_s - 1e-12 * (double)r.makespan_ps) < 1e-15);
        assert_true(o.messages == (double)r.messages && o.sent_bytes == (double)r.bytes);
        const double speedup = (double)r.baseline[2].time_ps / (double)r.makespan_ps;
        if (i == 4) assert_true(isnan(o.speedup) && isnan(o.efficiency));
        else
            assert_true(fabs(o.speedup - speedup) < 1e-9 &&
                        fabs(o.efficiency * run[i].nrank - speedup) < 1e-9);
    }
    const struct run_spec other = made_spec(arena, "t3e-300", 256, 4, 0);
    assert_true(outcome_read(database, &other, &o, &e));
    assert_true(!o.ok && o.id == 0 && isnan(o.makespan_s) && isnan(o.messages));
}

static void formulas_look_at_settings_and_results(void **state)
{
    static const struct {
        const char *formula;
        double number;     /* NAN: not known */
        const char *words; /* NULL: it has a value */
    } row[] = {
        {"makespan * 2", 5e-4, NULL},
        {"speedup / P", 0.75, NULL},
        {"efficiency", 0.75, NULL},
        {"messages + n", 120 + 16, NULL},
        {"sent_bytes / messages", 10, NULL},
        {"makespan < 1 ms", 1, NULL},
        {"makespan < 1 us", 0, NULL},
        {"sent_bytes >= 1200 B", 1, NULL},
        {"makespan < 3 B", NAN, "goal: 'makespan < 3 B': "},
        {"makespn", NAN, "did you mean 'makespan'?"},
        {"speed_up", NAN, "did you mean 'speedup'?"},
        {"xyzzyxyzzy", NAN, "xyzzyxyzzy"},
        {"machine.name", NAN, "a text, not a number"},
    };
    const struct outcome o = {.ok = true,
                              .makespan_s = 2.5e-4,
                              .speedup = 3,
                              .efficiency = 0.75,
                              .messages = 120,
                              .sent_bytes = 1200};
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct err e;
        struct expression_value v;
        char why[200];
        err_clear(&e);
        const struct expression *x = expression_read(row[i].formula, arena, why, (int)sizeof why);
        assert_non_null(x);
        const bool good = outcome_value(x, &run[0], &o, "goal", "s.yaml", 7, &v, &e);
        if (good != (row[i].words == NULL)) fail_msg("%s: '%s'", row[i].formula, e.text);
        if (good) {
            if (fabs(v.number - row[i].number) > 1e-12)
                fail_msg("%s: %g", row[i].formula, v.number);
        } else {
            assert_int_equal(e.kind, ERR_DATA);
            assert_int_equal(e.line, 7);
            assert_string_equal(e.file, "s.yaml");
            if (!strstr(e.text, row[i].words)) fail_msg("%s: '%s'", row[i].formula, e.text);
        }
        /* what is not known compares with nothing */
        if (row[i].number != 1) continue;
        assert_true(outcome_value(x, &run[0], &outcome_unknown, "goal", "s.yaml", 7, &v, &e));
        assert_true(v.number == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_those_of_the_plan_in_its_order),
        cmocka_unit_test(programs_get_every_column),
        cmocka_unit_test(swept_keys_have_short_names),
        cmocka_unit_test(swept_settings_and_repetitions_have_values),
        cmocka_unit_test(programs_have_what_they_mean),
        cmocka_unit_test(columns_are_taken_as_asked_or_refused),
        cmocka_unit_test(outcomes_are_those_of_stored_runs),
        cmocka_unit_test(formulas_look_at_settings_and_results),
    };
    return cmocka_run_group_tests(tests, open_database, close_database);
}
