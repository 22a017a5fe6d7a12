/* test_figure.c - figures come out of the database alone, the same bytes each time, and fail with a
 * reason. */
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

#include "../support/made_run.h"
#include "../support/scratch.h"
#include "base/arena.h"
#include "base/text.h"
#include "report/report.h"

struct fixture {
    char folder[200], out[256];
    struct store *s;
    struct err e;
};

static void write_file(struct fixture *f, const char *name, const char *text)
{
    char path[256];
    FILE *out = fopen(scratch_path(path, sizeof path, f->folder, name), "w");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static const char *const points =
    "SELECT run_id, P, speedup FROM v_speedup WHERE baseline_ordinal = 0 ORDER BY P;\n";
static const char *const script =
    "set encoding utf8\n"
    "do for [format in \"png svg\"] {\n"
    "set terminal (format eq 'png' ? 'pngcairo' : 'svg'); set output figure.'.'.format\n"
    "set title 'A curve' font ',20'; plot figure.'.csv' using 'P':'speedup' with linespoints; "
    "unset output }\n";

static int make_fixture(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    char path[256];
    scratch_make(f->folder, sizeof f->folder);
    scratch_path(f->out, sizeof f->out, f->folder, "a/b");
    mkdir(scratch_path(path, sizeof path, f->folder, "plots"), 0777);
    write_file(f, "plots/style.gp", "set datafile separator comma\nset datafile columnheaders\n");
    write_file(f, "plots/curve.sql", points);
    write_file(f, "plots/curve.gp", script);
    write_file(f, "plots/not-drawn.sql", points);
    f->s = store_open(scratch_path(path, sizeof path, f->folder, "t.db"), STORE_WRITE, &f->e);
    assert_non_null(f->s);
    struct arena *a = arena_create();
    for (int p = 2; p <= 128; p *= 2)
        for (int level = 0; level < 2; level++) {
            struct run_spec spec = made_spec(a, "t3e-300", p, p, 0);
            spec.machine.network.level = level ? LEVEL_LINK : LEVEL_LOGGP;
            made_identity(&spec, a);
            const struct run_result r = made_result(a, &spec);
            assert_true(store_put(f->s, &spec, NULL, &r, &f->e));
        }
    arena_destroy(a);
    *state = f;
    return 0;
}

static int drop_fixture(void **state)
{
    struct fixture *f = *state;
    store_close(f->s);
    scratch_remove(f->folder);
    unsetenv("MIMDSIM_GNUPLOT");
    free(f);
    return 0;
}

static struct text read_out(struct fixture *f, const char *name)
{
    char path[256];
    struct text t = {0};
    struct err e = {0};
    if (!text_read_file(&t, scratch_path(path, sizeof path, f->out, name), &e))
        fail_msg("%s", e.text);
    return t;
}

static bool exists(struct fixture *f, const char *name)
{
    char path[256];
    return access(scratch_path(path, sizeof path, f->out, name), F_OK) == 0;
}

/* A program in gnuplot's place: a shell script of one line, called in the folder of the results. */
static void use_program(struct fixture *f, const char *line)
{
    char path[256];
    struct text text = {0};
    text_add(&text, "#!/bin/sh\n%s\n", line);
    write_file(f, "program", text.s);
    text_free(&text);
    scratch_path(path, sizeof path, f->folder, "program");
    assert_int_equal(chmod(path, 0700), 0);
    setenv("MIMDSIM_GNUPLOT", path, 1);
}

static bool has_gnuplot(void) { return system("command -v gnuplot >/dev/null 2>&1") == 0; }

/* Draw, or skip the test where gnuplot is not installed. */
static void draw(struct fixture *f, const char *data_dir, const char *name)
{
    if (!has_gnuplot()) skip();
    if (!report_figure(f->s, data_dir, name, f->out, &f->e)) fail_msg("%s", f->e.text);
}

static void a_figure_is_four_files(void **state)
{
    struct fixture *f = *state;
    draw(f, f->folder, "curve");
    struct text png = read_out(f, "curve.png"), svg = read_out(f, "curve.svg"),
                csv = read_out(f, "curve.csv");
    assert_memory_equal(png.s, "\x89PNG", 4);
    assert_non_null(strstr(svg.s, "</svg>"));
    assert_memory_equal(csv.s, "run_id,P,speedup\r\n", 18);
    int lines = 0;
    for (const char *c = csv.s; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, 1 + 14);
    text_free(&png);
    text_free(&svg);
    text_free(&csv);
}

static void drawing_again_gives_the_same_bytes(void **state)
{
    struct fixture *f = *state;
    static const char *const file[] = {"curve.png", "curve.svg", "curve.csv", "curve.gp"};
    struct text first[4];
    draw(f, f->folder, "curve");
    for (int i = 0; i < 4; i++) first[i] = read_out(f, file[i]);
    draw(f, f->folder, "curve");
    for (int i = 0; i < 4; i++) {
        struct text again = read_out(f, file[i]);
        assert_int_equal(again.length, first[i].length);
        assert_memory_equal(again.s, first[i].s, again.length);
        text_free(&again);
        text_free(&first[i]);
    }
}

static void the_script_redraws_without_this_program(void **state)
{
    struct fixture *f = *state;
    draw(f, f->folder, "curve");
    struct text first = read_out(f, "curve.svg"), command = {0};
    text_add(&command, "cd '%s' && rm curve.svg && gnuplot -d curve.gp", f->out);
    assert_int_equal(system(command.s), 0);
    struct text again =
        read_out(f, "curve.svg"); /* gnuplot's own: without what this program makes of it */
    assert_true(strstr(first.s, "<title>A curve</title>") &&
                strstr(again.s, "<title>Gnuplot</title>"));
    text_free(&first);
    text_free(&again);
    text_free(&command);
}

static void the_picture_names_version_runs_and_configurations(void **state)
{
    struct fixture *f = *state;
    draw(f, f->folder, "curve");
    struct text gp = read_out(f, "curve.gp"), line = read_out(f, "curve.provenance");
    assert_memory_equal(gp.s, "figure = 'curve'\n", 17);
    assert_memory_equal(line.s, "error of level not known, machine not known, arithmetic ", 56);
    assert_non_null(strstr(line.s, "; mimdsim "));
    assert_non_null(strstr(line.s, ", 14 runs, configurations "));
    text_free(&gp);
    text_free(&line);
}

static void without_gnuplot_data_and_script_are_written(void **state)
{
    struct fixture *f = *state;
    setenv("MIMDSIM_GNUPLOT", "/nonexistent/gnuplot", 1);
    assert_false(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_UNAVAILABLE);
    assert_non_null(strstr(f->e.text, "gnuplot-nox"));
    assert_true(exists(f, "curve.csv") && exists(f, "curve.gp"));
    assert_false(exists(f, "curve.png") || exists(f, "curve.svg"));
}

static void an_old_image_does_not_outlive_a_failed_drawing(void **state)
{
    struct fixture *f = *state;
    draw(f, f->folder, "curve");
    write_file(f, "plots/curve.gp", "set output 'curve.png'\nplot nonsense(x)\n");
    assert_false(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_UNAVAILABLE);
    assert_non_null(strstr(f->e.text, "line "));
    assert_non_null(strstr(f->e.text, "nonsense"));
    assert_false(exists(f, "curve.png") || exists(f, "curve.svg"));
}

/* Each ends with a message that says which, without a picture, and soon. */
static void a_program_that_misbehaves_is_told_as_such(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *line, *says;
        enum err_kind kind;
    } bad[] = {
        {"exit 0", "has ended without a picture", ERR_UNAVAILABLE},
        {": >curve.svg; : >curve.png", "curve.png was not drawn to its end", ERR_IO},
        {"echo '<svg></svg>' >curve.svg; echo '\\0211PNG' >curve.png",
         "curve.png was not drawn to its end", ERR_IO},
        {"echo '<svg><g></g>' >curve.svg", "curve.svg was not drawn to its end", ERR_IO},
        {"kill -9 $$", "was ended by signal 9", ERR_UNAVAILABLE},
        {"exec sleep 100", "had not drawn", ERR_UNAVAILABLE},
        {"sleep 100 & sleep 100", "had not drawn", ERR_UNAVAILABLE},
        {"exec 2>&-; exec sleep 100", "had not drawn", ERR_UNAVAILABLE},
        {"yes complaint | head -c 50000000 >&2; exit 1", "complaint", ERR_UNAVAILABLE},
        {"exec yes complaint >&2", "had not drawn", ERR_UNAVAILABLE},
        {"head -c 1000000 /dev/urandom >&2; exit 3", "could not draw", ERR_UNAVAILABLE},
    };
    setenv("MIMDSIM_GNUPLOT_SECONDS", "0.3", 1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        err_clear(&f->e);
        if (bad[i].kind == ERR_UNAVAILABLE && strstr(bad[i].line, "50000000"))
            setenv("MIMDSIM_GNUPLOT_SECONDS", "60", 1);
        else setenv("MIMDSIM_GNUPLOT_SECONDS", "0.3", 1);
        use_program(f, bad[i].line);
        if (report_figure(f->s, f->folder, "curve", f->out, &f->e))
            fail_msg("%s: taken for a drawing", bad[i].line);
        if (f->e.kind != bad[i].kind || !strstr(f->e.text, bad[i].says))
            fail_msg("%s: %s", bad[i].line, f->e.text);
        assert_false(exists(f, "curve.png") || exists(f, "curve.svg"));
        assert_true(exists(f, "curve.csv") && exists(f, "curve.gp"));
    }
    /* A program that leaves another one behind has ended all the same. */
    unsetenv("MIMDSIM_GNUPLOT_SECONDS");
    err_clear(&f->e);
    use_program(f, "echo '<svg></svg>' >curve.svg; sleep 3 & exit 0");
    if (!report_figure(f->s, f->folder, "curve", f->out, &f->e)) fail_msg("%s", f->e.text);
}

static void several_tables_become_several_files(void **state)
{
    struct fixture *f = *state;
    struct text sql = {0};
    text_add(&sql,
             "-- needs: x\n%s-- table: stages\nSELECT name FROM v_stage WHERE P = 2 ORDER BY "
             "run_id, stage;\n"
             "-- table: none\nSELECT 1 AS x WHERE 0;\n",
             points);
    write_file(f, "plots/curve.sql", sql.s);
    text_free(&sql);
    use_program(f, "echo '<svg></svg>' >curve.svg");
    assert_true(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    struct text stages = read_out(f, "curve.stages.csv"), none = read_out(f, "curve.none.csv");
    assert_memory_equal(stages.s, "name\r\nPre-processing\r\nNE[1]\r\n", 29);
    assert_string_equal(none.s, "x\r\n");
    text_free(&stages);
    text_free(&none);
}

/* What gnuplot cannot read in a cell, quotes and line ends, is replaced. */
static void cells_are_quoted_where_rfc_4180_says_so(void **state)
{
    struct fixture *f = *state;
    write_file(f, "plots/curve.sql",
               "SELECT 'a,b' AS \"x\"\"y\", 'say \"hi\"' AS q, NULL AS n, 0.1 AS r, 1e300*10 AS "
               "big, 'two' || char(10) || 'lines' AS t, ' b ' AS blank, 'end' AS e");
    use_program(f, "echo '<svg></svg>' >curve.svg");
    assert_true(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    struct text csv = read_out(f, "curve.csv");
    assert_string_equal(csv.s, "\"x\"\"y\",q,n,r,big,t,blank,e\r\n"
                               "\"a,b\",say 'hi',,0.1,1e+301,two lines,\" b \",end\r\n");
    text_free(&csv);
}

static void an_unknown_figure_names_the_nearest(void **state)
{
    struct fixture *f = *state;
    assert_false(report_figure(f->s, f->folder, "cruve", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    assert_non_null(strstr(f->e.text, "did you mean 'curve'"));
    static const char *const bad[] = {"zzzzzz", "../plots/curve", "not-drawn", "", "style"};
    for (int i = 0; i < 5; i++) {
        err_clear(&f->e);
        assert_false(report_figure(f->s, f->folder, bad[i], f->out, &f->e));
        assert_int_equal(f->e.kind, ERR_NO_INPUT);
    }
}

static void a_figure_without_rows_says_what_to_run(void **state)
{
    struct fixture *f = *state;
    write_file(f, "plots/curve.sql",
               "-- About nothing.\n-- needs: mimdsim run x.yaml\nSELECT 1 AS x WHERE 0;\n");
    assert_false(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    assert_non_null(strstr(f->e.text, "first: mimdsim run x.yaml"));
}

static void a_figure_of_several_rows_is_drawn_for_each_or_for_one(void **state)
{
    struct fixture *f = *state;
    struct report_drawings d;
    write_file(f, "plots/curve.sql",
               "-- each: SELECT DISTINCT level, 'curve-' || level FROM run ORDER BY 1\n-- needs: "
               "mimdsim run x.yaml\n"
               "SELECT run_id, P, speedup FROM v_speedup WHERE baseline_ordinal = 0 AND level = ?1 "
               "ORDER BY P;\n");
    draw(f, f->folder, "curve-loggp");
    assert_true(exists(f, "curve-loggp.svg"));
    assert_false(exists(f, "curve-link.csv"));
    draw(f, f->folder, "curve");
    assert_true(exists(f, "curve-link.svg"));
    assert_false(exists(f, "curve.csv"));
    struct text csv = read_out(f, "curve-link.csv");
    int lines = 0;
    for (const char *c = csv.s; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, 1 + 7);
    text_free(&csv);
    assert_true(report_drawings_find(f->s, f->folder, "curve", &d, &f->e));
    assert_int_equal(d.n, 2);
    assert_string_equal(d.as[0], "curve-link");
    report_drawings_free(&d);
    assert_false(report_figure(f->s, f->folder, "curve-flit", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_NO_INPUT);
    assert_non_null(strstr(f->e.text, "first: mimdsim run x.yaml"));
}

static void wrong_sql_names_the_figure(void **state)
{
    struct fixture *f = *state;
    write_file(f, "plots/curve.sql", "SELECT nonsense FROM run");
    assert_false(report_figure(f->s, f->folder, "curve", f->out, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    assert_non_null(strstr(f->e.text, "curve"));
    assert_non_null(strstr(f->e.text, "nonsense"));
    assert_false(exists(f, "curve.csv"));
}

static void a_folder_that_cannot_be_made_is_said(void **state)
{
    struct fixture *f = *state;
    char path[256];
    write_file(f, "file", "x");
    assert_false(report_figure(f->s, f->folder, "curve",
                               scratch_path(path, sizeof path, f->folder, "file/x"), &f->e));
    assert_int_equal(f->e.kind, ERR_CREATE);
    err_clear(&f->e);
    assert_false(report_figure(f->s, f->folder, "curve",
                               scratch_path(path, sizeof path, f->folder, "file"), &f->e));
    assert_int_equal(f->e.kind, ERR_CREATE);
}

static void figures_are_listed_in_order(void **state)
{
    struct fixture *f = *state;
    write_file(f, "plots/another.sql", points);
    write_file(f, "plots/another.gp", "");
    char **name;
    assert_int_equal(report_figures(f->folder, &name), 2);
    assert_string_equal(name[0], "another");
    assert_string_equal(name[1], "curve");
    for (int i = 0; i < 2; i++) free(name[i]);
    free(name);
    assert_int_equal(report_figures("/nonexistent", &name), 0);
    free(name);
}

/* Runs of the four machines with several bodies a processor, one of them with its timeline. */
static void put_machines(struct fixture *f)
{
    static const char *const machine[] = {"t3e-300", "paragon", "origin2000", "quad-ppro"};
    struct arena *a = arena_create();
    for (int m = 0; m < 4; m++)
        for (int p = 1; p <= 16; p *= 2)
            for (int ratio = 1; ratio <= 4; ratio *= 2) {
                struct run_spec spec = made_spec(a, machine[m], p * ratio, p, 0);
                struct run_result r = made_result(a, &spec);
                strcpy(r.baseline[0].name, "fastest serial");
                strcpy(r.baseline[3].name, "parallel code on one processor");
                if (p == 4 && ratio == 1) made_spans(&r, a);
                assert_true(store_put(f->s, &spec, NULL, &r, &f->e));
            }
    arena_destroy(a);
}

/* Two rows each for the figures that are not about runs. */
static void put_tables(struct fixture *f)
{
    static const char *const ladder[] = {
        "scenario", "ladder", "at", "method", "rung", "ordinal", "quantity", "reference",
        "relative_error", "host_s", "machine_ps", "status", "family", "text"};
    static const char *const case_[] = {"suite",   "subject", "algorithm",      "precision",
                                        "ordinal", "status",  "relative_error", "reason"};
    static const char *const left_out[] = {
        "scenario", "what",         "ordinal",      "why",        "class",           "at",
        "host_s",   "host_saved_s", "host_noise_s", "machine_ps", "machine_saved_ps"};
    static const char *const claim[] = {"id",   "variant", "statement", "test",
                                        "unit", "share",   "verdict"};
    for (int i = 0; i < 2; i++) {
        const struct store_value rung[] = {store_text("made"),
                                           store_text("network"),
                                           store_text("P=4"),
                                           store_text(i ? "link" : "loggp"),
                                           store_text("x"),
                                           store_int(i),
                                           store_text("makespan"),
                                           store_text("flit"),
                                           i ? store_real(0.01) : store_null(),
                                           store_real(0.1 + i),
                                           store_int(1000),
                                           store_text(i ? "ok" : "failed"),
                                           store_text("made"),
                                           store_text("")};
        const struct store_value row[] = {store_text("made"),
                                          store_text("heavy tip"),
                                          store_text(i ? "aba" : "cfa"),
                                          store_text("double"),
                                          store_int(i),
                                          store_text(i ? "ok" : "failed"),
                                          i ? store_real(0) : store_null(),
                                          store_text("")};
        const struct store_value held[] = {
            store_text(i ? "C1" : "C10"),   store_text(""), store_text("it rises, sharply"),
            store_text("S(24) > S(16)"),    store_text(""), i ? store_real(0.5) : store_null(),
            store_text(i ? "pass" : "fail")};
        assert_true(store_insert(f->s, "ladder", 14, ladder, rung, &f->e));
        assert_true(store_insert(f->s, "stability", 8, case_, row, &f->e));
        const struct store_value out[] = {store_text("made"),
                                          store_text(i ? "timeline" : "branches"),
                                          store_int(i),
                                          store_text("nobody asks, ever"),
                                          store_text("exact"),
                                          store_text("P=4"),
                                          i ? store_real(0.1) : store_null(),
                                          i ? store_real(0.02) : store_null(),
                                          i ? store_real(0.01) : store_null(),
                                          i ? store_int(7) : store_null(),
                                          i ? store_int(0) : store_null()};
        assert_true(store_insert(f->s, "omission", 11, left_out, out, &f->e));
        assert_true(store_insert(f->s, "claim", 7, claim, held, &f->e));
    }
}

/* Of real runs only: figures.bats, attacks.bats (explain), jobs.bats (interference, shares) draw
 * them. */
static const char *const of_other_rows[] = {
    "explain", "interference", "linkmap", "load", "pingpong", "roofline", "shares", "slack",
    "speedup", "uncertainty",  "why"};
static bool is_of_other_rows(const char *figure)
{
    for (size_t k = 0; k < sizeof of_other_rows / sizeof *of_other_rows; k++)
        if (strcmp(of_other_rows[k], figure) == 0) return true;
    return false;
}

static void every_shipped_figure_can_be_drawn(void **state)
{
    struct fixture *f = *state;
    char **name;
    put_machines(f);
    put_tables(f);
    int n = report_figures(MIMDSIM_SRCDIR, &name), others = 0;
    assert_true(n >= 9);
    for (int i = 0; i < n; i++) {
        others += is_of_other_rows(name[i]);
        struct report_drawings drawings;
        char svg[160];
        if (!is_of_other_rows(name[i])) {
            draw(f, MIMDSIM_SRCDIR, name[i]);
            assert_true(report_drawings_find(f->s, MIMDSIM_SRCDIR, name[i], &drawings, &f->e));
            for (int k = 0; k < drawings.n; k++) {
                snprintf(svg, sizeof svg, "%s.svg", drawings.as[k]);
                struct text drawn = read_out(f, svg);
                assert_non_null(strstr(drawn.s, "</svg>"));
                /* a title of its own, and nothing that needs a script */
                assert_false(strstr(drawn.s, "Gnuplot") || strstr(drawn.s, "gnuplot_svg"));
                text_free(&drawn);
            }
            report_drawings_free(&drawings);
        }
        free(name[i]);
    }
    free(name);
    assert_int_equal(others, sizeof of_other_rows / sizeof *of_other_rows); /* each is a figure */
    struct text csv = read_out(f, "fig6.csv");
    assert_non_null(strstr(csv.s, "series,baseline,P,makespan_ps,baseline_ps,speedup,parallel"));
    text_free(&csv);
}

static void every_shipped_figure_says_what_to_run_first(void **state)
{
    struct fixture *f = *state;
    char path[256], **name;
    struct store *empty =
        store_open(scratch_path(path, sizeof path, f->folder, "empty.db"), STORE_WRITE, &f->e);
    int n = report_figures(MIMDSIM_SRCDIR, &name);
    for (int i = 0; i < n; i++) {
        assert_false(report_figure(empty, MIMDSIM_SRCDIR, name[i], f->out, &f->e));
        if (f->e.kind != ERR_NO_INPUT || strstr(f->e.text, "first: mimdsim ") == NULL)
            fail_msg("%s", f->e.text);
        err_clear(&f->e);
        free(name[i]);
    }
    free(name);
    store_close(empty);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_fixture, drop_fixture)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_figure_is_four_files),
        TEST(drawing_again_gives_the_same_bytes),
        TEST(the_script_redraws_without_this_program),
        TEST(the_picture_names_version_runs_and_configurations),
        TEST(without_gnuplot_data_and_script_are_written),
        TEST(an_old_image_does_not_outlive_a_failed_drawing),
        TEST(a_program_that_misbehaves_is_told_as_such),
        TEST(several_tables_become_several_files),
        TEST(cells_are_quoted_where_rfc_4180_says_so),
        TEST(an_unknown_figure_names_the_nearest),
        TEST(a_figure_without_rows_says_what_to_run),
        TEST(a_figure_of_several_rows_is_drawn_for_each_or_for_one),
        TEST(wrong_sql_names_the_figure),
        TEST(a_folder_that_cannot_be_made_is_said),
        TEST(figures_are_listed_in_order),
        TEST(every_shipped_figure_can_be_drawn),
        TEST(every_shipped_figure_says_what_to_run_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
