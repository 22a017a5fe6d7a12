/* test_texts.c - cells, markup, names of files, descriptions of figures, whole pictures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "base/text.h"
#include "report/csv.h"
#include "report/figure_text.h"
#include "report/images.h"
#include "report/markup.h"
#include "report/report.h"
#include "../support/scratch.h"

static void cell_is(const char *s, bool last, const char *expected)
{
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    csv_cell(f, s, last);
    fclose(f);
    assert_string_equal(out, expected);
    free(out);
}

static void cells_are_quoted_where_they_must_be(void **state)
{
    (void)state;
    cell_is(NULL, false, ",");
    cell_is("", true, "\r\n");
    cell_is("plain text", false, "plain text,");
    cell_is("a,b", false, "\"a,b\",");
    cell_is("say \"hi\"", false, "\"say \"\"hi\"\"\",");
    cell_is("\"", true, "\"\"\"\"\r\n");
    cell_is("two\nlines", false, "\"two\nlines\",");
    cell_is("a\rb", false, "\"a\rb\",");
    cell_is(" a", false, "\" a\",");
    cell_is("a ", false, "\"a \",");
    cell_is(" ", true, "\" \"\r\n");
    cell_is("'a;b'", false, "'a;b',");
}

/* One record after RFC 4180 back into its cells, by a reader of its own. */
static int read_record(const char *s, char cell[8][64])
{
    int n = 0;
    for (;; n++) {
        char *to = cell[n];
        if (*s == '"') {
            for (s++; *s != '"' || s[1] == '"'; s++) {
                if (*s == '"') s++;
                *to++ = *s;
            }
            s++;
        } else
            while (*s != ',' && *s != '\r') *to++ = *s++;
        *to = '\0';
        if (*s == '\r') break;
        s++;
    }
    assert_string_equal(s, "\r\n");
    return n + 1;
}

static void random_cells_read_back(void **state)
{
    (void)state;
    static const char letters[] = "ab \",\r\n'x";
    struct random r = random_make(31, 0, 0);
    for (int round = 0; round < 3000; round++) {
        char given[8][64], back[8][64], *out = NULL;
        size_t size = 0;
        const int n = 1 + (int)random_below(&r, 8);
        FILE *f = open_memstream(&out, &size);
        for (int i = 0; i < n; i++) {
            const int length = (int)random_below(&r, 12);
            for (int k = 0; k < length; k++)
                given[i][k] = letters[random_below(&r, sizeof letters - 1)];
            given[i][length] = '\0';
            csv_cell(f, given[i], i + 1 == n);
        }
        fclose(f);
        assert_int_equal(read_record(out, back), n);
        for (int i = 0; i < n; i++) assert_string_equal(back[i], given[i]);
        free(out);
    }
}

static void texts_become_plain(void **state)
{
    (void)state;
    char s[] = "a\tb\nc\"d\x7f\x1b[1me \xc3\xa9";
    csv_plain(s);
    assert_string_equal(s, "a b c'd  [1me \xc3\xa9");
}

static void markup_is_escaped(void **state)
{
    (void)state;
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    markup_escape(f, "<a href=\"x\">&amp;'\n\t\x01\xc3\xa9</a>");
    putc('|', f);
    markup_escape_bytes(f, "a<b\0c>d", 5);
    putc('|', f);
    markup_escape_bytes(f, "abc", 0);
    fclose(f);
    assert_memory_equal(out,
                        "&lt;a href=&quot;x&quot;&gt;&amp;amp;&#39;\n  \xc3\xa9&lt;/a&gt;|"
                        "a&lt;b c|",
                        size);
    free(out);
}

static void lines_of_descriptions(void **state)
{
    (void)state;
    static const char sql[] = "-- A figure.\n-- needs: run x\nSELECT 1 -- each: no mark\n"
                              "-- each: y";
    char word[32] = "before";
    const char *rest = figure_line(sql, "-- needs: ", word, sizeof word);
    assert_string_equal(word, "run x");
    assert_non_null(rest);
    assert_memory_equal(rest, "SELECT 1", 8);
    rest = figure_line(sql, "-- each: ", word, sizeof word);
    assert_string_equal(word, "y");
    assert_string_equal(rest, "");
    assert_null(figure_line(sql, "-- other: ", word, sizeof word));
    assert_string_equal(word, "y"); /* as it was */
    assert_null(figure_line("", "-- each: ", word, sizeof word));
    char small[4];
    figure_line(sql, "-- needs: ", small, sizeof small);
    assert_string_equal(small, "run");
    figure_line("-- each: abc", "-- each: ", small, sizeof small);
    assert_string_equal(small, "abc");
}

static void named(const char *figure, const char *s, const char *expected)
{
    char *name = figure_file_name(figure, s);
    const size_t n = strlen(expected);
    if (n > 0 && expected[n - 1] == '*') {
        /* and a fingerprint of eight digits */
        assert_memory_equal(name, expected, n - 1);
        assert_int_equal(strlen(name), n + 8);
        assert_int_equal(strspn(name + n, "0123456789abcdef"), 8);
        assert_int_equal(name[n - 1], '-');
    } else assert_string_equal(name, expected);
    free(name);
}

static void names_of_files_are_harmless(void **state)
{
    (void)state;
    named("accuracy", "accuracy", "accuracy");
    named("accuracy", "accuracy-four-bar", "accuracy-four-bar");
    named("accuracy", "accuracy-t3e-300, hop_latency 60 us", "accuracy-t3e-300, hop_latency 60 us");
    named("accuracy", "accuracyx", "accuracy-accuracyx*");
    named("accuracy", "four-bar", "accuracy-four-bar*");
    named("accuracy", "", "accuracy-*");
    named("fig", "fig-../../etc/passwd", "fig-.._.._etc_passwd*");
    named("fig", "fig-a\nb\"c`d$e\\f", "fig-a_b_c_d_e_f*");
    named("fig", "fig-''", "fig-_'*");
    named("fig", "fig-it's", "fig-it's");
    named("fig", "fig-\xc3\xa9", "fig-\xc3\xa9");
    /* 120 bytes are the most; longer ones are cut and told apart */
    char s[200];
    memset(s, 'a', sizeof s);
    memcpy(s, "fig-", 4);
    s[120] = '\0';
    named("fig", s, s);
    s[120] = 'a', s[121] = '\0';
    char cut[200];
    snprintf(cut, sizeof cut, "%.120s*", s);
    named("fig", s, cut);
}

/* Names that differ stay different, whatever is in them. */
static void different_texts_have_different_names(void **state)
{
    (void)state;
    static const char letters[] = "a/_'-\"b";
    enum { NAMES = 300 };
    struct random r = random_make(17, 0, 0);
    char text[NAMES][16], *name[NAMES];
    for (int i = 0; i < NAMES; i++) {
        const int length = (int)random_below(&r, 5);
        int n = snprintf(text[i], sizeof text[i], "%s", random_below(&r, 2) ? "fig-" : "");
        for (int k = 0; k < length; k++)
            text[i][n++] = letters[random_below(&r, sizeof letters - 1)];
        text[i][n] = '\0';
        name[i] = figure_file_name("fig", text[i]);
        assert_memory_equal(name[i], "fig", 3);
        assert_null(strpbrk(name[i], "/\"\\$`\n"));
        for (int k = 0; k < i; k++)
            assert_int_equal(strcmp(name[i], name[k]) == 0, strcmp(text[i], text[k]) == 0);
    }
    for (int i = 0; i < NAMES; i++) free(name[i]);
}

static void put_file(const char *folder, const char *name, const char *bytes, size_t n)
{
    char path[600];
    FILE *f = fopen(scratch_path(path, sizeof path, folder, name), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    fclose(f);
}

static void about(const char *folder, const char *sql, const char *title, const char *needs)
{
    struct text t = {0}, n = {0};
    put_file(folder, "plots/x.sql", sql, strlen(sql));
    report_figure_about(folder, "x", &t, &n);
    assert_string_equal(t.s, title);
    assert_string_equal(n.s, needs);
    text_free(&t);
    text_free(&n);
}

static void titles_are_first_sentences(void **state)
{
    (void)state;
    char folder[400], plots[500];
    struct err e;
    err_clear(&e);
    scratch_make(folder, sizeof folder);
    assert_true(report_folder(scratch_path(plots, sizeof plots, folder, "plots"), &e));
    about(folder, "-- Speedup over n. More of it.\n-- needs: run speedup\nSELECT", "Speedup over n",
          "run speedup");
    about(folder, "-- Two\n-- lines and 1.5 times that.\nSELECT", "Two lines and 1.5 times that",
          "");
    about(folder, "-- No end\n-- needs: run x\n", "No end", "run x");
    about(folder, "-- No end\n-- each: SELECT 1\n", "No end", "");
    about(folder, "-- And so on ... to the end.\n", "And so on ... to the end", "");
    about(folder, "-- At the end of the file", "At the end of the file", "");
    about(folder, "SELECT 1", "", "");
    about(folder, "", "", "");
    /* too long for a line: cut before a clause, else before a word */
#define FIFTY "aaaaaaaaa bbbbbbbbb ccccccccc ddddddddd eeeeeeeee "
    about(folder, "-- " FIFTY "x, " FIFTY "y.\n", FIFTY "x, " FIFTY "y", "");
    about(folder, "-- " FIFTY "f; " FIFTY "g, " FIFTY "h.\n", FIFTY "f", "");
    about(folder, "-- " FIFTY "f, " FIFTY FIFTY "h.\n", FIFTY "f", "");
    about(folder, "-- " FIFTY FIFTY FIFTY "h.\n", FIFTY FIFTY "aaaaaaaaa ...", "");
    about(folder, "-- a; " FIFTY FIFTY FIFTY "h.\n", "a; " FIFTY FIFTY "...", "");
    struct text t = {0}, n = {0};
    report_figure_about(folder, "none", &t, &n);
    assert_string_equal(t.s, "");
    text_free(&t);
    text_free(&n);
    scratch_remove(folder);
}

static void pictures_are_whole_or_not_there(void **state)
{
    (void)state;
    static const char png[] = "\x89PNG\r\n\x1a\n....\0\0\0\0IEND\xae\x42\x60\x82",
                      svg[] = "<svg>...</svg>\n\n";
    const size_t npng = sizeof png - 1, nsvg = sizeof svg - 1;
    char folder[400];
    struct err e;
    scratch_make(folder, sizeof folder);
    err_clear(&e);
    assert_false(images_check(folder, "figures", "a", &e)); /* neither */
    assert_int_equal(e.kind, ERR_UNAVAILABLE);
    put_file(folder, "a.png", png, npng);
    err_clear(&e);
    assert_true(images_check(folder, "figures", "a", &e));
    put_file(folder, "a.svg", svg, nsvg);
    assert_true(images_check(folder, "figures", "a", &e));
    /* what is there has its end, also beside a whole one */
    for (size_t cut = 1; cut <= 12; cut++) {
        put_file(folder, "a.png", png, npng - cut);
        err_clear(&e);
        assert_false(images_check(folder, "figures", "a", &e));
        assert_int_equal(e.kind, ERR_IO);
        assert_non_null(strstr(e.text, "figures/a.png"));
    }
    put_file(folder, "a.png", png, npng);
    for (size_t cut = 3; cut <= nsvg; cut++) {
        put_file(folder, "a.svg", svg, nsvg - cut);
        err_clear(&e);
        assert_false(images_check(folder, "figures", "a", &e));
        assert_non_null(strstr(e.text, "figures/a.svg"));
    }
    images_remove(folder, "a");
    char path[500];
    assert_int_equal(access(scratch_path(path, sizeof path, folder, "a.png"), F_OK), -1);
    assert_int_equal(access(scratch_path(path, sizeof path, folder, "a.svg"), F_OK), -1);
    err_clear(&e);
    assert_false(images_check(folder, "figures", "a", &e));
    images_remove(folder, "a"); /* again: nothing is there */
    put_file(folder, "a.svg", svg, nsvg);
    err_clear(&e);
    assert_true(images_check(folder, "figures", "a", &e));
    scratch_remove(folder);
}

static void folders_are_made_with_those_above(void **state)
{
    (void)state;
    char folder[400], deep[600], file[700];
    struct err e;
    err_clear(&e);
    scratch_make(folder, sizeof folder);
    assert_true(report_folder(scratch_path(deep, sizeof deep, folder, "a/b/c"), &e));
    put_file(deep, "here", "x", 1);
    assert_true(report_folder(deep, &e)); /* there already */
    assert_false(report_folder(scratch_path(file, sizeof file, deep, "here/d"), &e));
    assert_int_equal(e.kind, ERR_CREATE);
    err_clear(&e);
    assert_false(report_folder(scratch_path(file, sizeof file, deep, "here"), &e));
    assert_int_equal(e.kind, ERR_CREATE);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_quoted_where_they_must_be),
        cmocka_unit_test(random_cells_read_back),
        cmocka_unit_test(texts_become_plain),
        cmocka_unit_test(markup_is_escaped),
        cmocka_unit_test(lines_of_descriptions),
        cmocka_unit_test(names_of_files_are_harmless),
        cmocka_unit_test(different_texts_have_different_names),
        cmocka_unit_test(titles_are_first_sentences),
        cmocka_unit_test(pictures_are_whole_or_not_there),
        cmocka_unit_test(folders_are_made_with_those_above),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
