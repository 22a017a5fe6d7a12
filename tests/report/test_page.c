/* test_page.c - pages written twice, and how far times are known, in words: what stands in the
 * Markdown and in the HTML, whatever texts are given. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../support/scratch.h"
#include "base/text.h"
#include "report/how_sure.h"
#include "report/page.h"
#include "report/report.h"

/* A folder with the look of pages in plots/, and what a page of it becomes. */
struct folder {
    char name[300];
    struct text md, html;
};

static void put_file(const char *folder, const char *name, const char *text)
{
    char path[600];
    FILE *f = fopen(scratch_path(path, sizeof path, folder, name), "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void begin(struct folder *d, struct page *p, const char *title)
{
    char plots[400];
    struct err e;
    err_clear(&e);
    *d = (struct folder){0};
    scratch_make(d->name, sizeof d->name);
    assert_true(report_folder(scratch_path(plots, sizeof plots, d->name, "plots"), &e));
    put_file(d->name, "plots/report.css", "p {}\n");
    put_file(d->name, "plots/report.js", "abc");
    *p = (struct page){.figures = "figures", .data_dir = d->name};
    if (!page_open(p, title, &e)) fail_msg("%s", e.text);
}

static void end(struct folder *d, struct page *p)
{
    char path[400];
    struct err e;
    err_clear(&e);
    if (!page_close(p, d->name, "page", true, &e)) fail_msg("%s", e.text);
    assert_true(text_read_file(&d->md, scratch_path(path, sizeof path, d->name, "page.md"), &e));
    assert_true(
        text_read_file(&d->html, scratch_path(path, sizeof path, d->name, "page.html"), &e));
}

static void drop(struct folder *d)
{
    text_free(&d->md);
    text_free(&d->html);
    scratch_remove(d->name);
}

static void has(const struct text *t, const char *part)
{
    if (strstr(t->s, part) == NULL) fail_msg("no '%s' in:\n%s", part, t->s);
}

static void both_files_say_the_same(void **state)
{
    (void)state;
    struct folder d;
    struct page p;
    begin(&d, &p, "A <report> & more");
    page_heading(&p, 2, "First: part");
    page_paragraph(&p, "It is 3 < 4 & \"so\" on.");
    page_heading(&p, 3, "Below");
    end(&d, &p);
    assert_memory_equal(d.md.s, "# A ", 4);
    has(&d.md, "\n## First: part\n\n");
    has(&d.md, "\n### Below\n\n");
    assert_null(strstr(d.md.s, "<report>")); /* Markdown would take it for HTML */
    has(&d.html, "<title>A &lt;report&gt; &amp; more</title>");
    has(&d.html, "<h1>A &lt;report&gt; &amp; more</h1>");
    has(&d.html, "<h2 id=\"first-part\">First: part</h2>");
    has(&d.html, "<h3>Below</h3>");
    has(&d.html, "<p>It is 3 &lt; 4 &amp; &quot;so&quot; on.</p>");
    has(&d.html, "<style>\np {}\n</style>");
    /* the one script that may run: SHA-256 of "abc" (FIPS 180-2, appendix B.1) in base64 */
    has(&d.html, "script-src 'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='\"");
    has(&d.html, "default-src 'none'");
    has(&d.html, "<script>abc</script>\n</body>\n</html>\n");
    drop(&d);
}

static void contents_list_the_headings_that_follow(void **state)
{
    (void)state;
    struct folder d;
    struct page p;
    begin(&d, &p, "Title");
    page_heading(&p, 2, "Before");
    page_contents(&p);
    page_heading(&p, 2, "After <all>");
    page_heading(&p, 3, "Deeper");
    page_heading(&p, 2, "10 % of n_half");
    end(&d, &p);
    has(&d.html, "<nav>\n<ul>\n<li><a href=\"#after-all\">After &lt;all&gt;</a></li>\n"
                 "<li><a href=\"#10--of-n_half\">10 % of n_half</a></li>\n</ul>\n</nav>\n");
    has(&d.html, "<h2 id=\"10--of-n_half\">");
    has(&d.md, "](#after-all)\n- [");
    const char *contents = strstr(d.md.s, "## Contents"), *list = strstr(d.md.s, "- ["),
               *after = strstr(d.md.s, "## After");
    assert_true(contents != NULL && list > contents && after > list);
    assert_null(strstr(d.md.s, "(#before)"));
    assert_null(strstr(d.md.s, "(#deeper)"));
    drop(&d);
}

static void equal_headings_have_links_of_their_own(void **state)
{
    (void)state;
    struct folder d;
    struct page p;
    begin(&d, &p, "Runs");
    page_contents(&p);
    page_heading(&p, 2, "runs!");
    page_heading(&p, 3, "T3E, as it is");
    page_heading(&p, 2, "T3E as it is");
    page_heading(&p, 2, "Runs 1");
    page_heading(&p, 2, "Runs");
    page_heading(&p, 2, "Gr\xc3\xb6\xc3\x9f" "e \xe2\x80\x93 so");
    end(&d, &p);
    /* The title, the lesser heading and a heading that looks like a counted one take part. */
    static const char *const anchor[] = {"runs-1", "t3e-as-it-is-1", "runs-1-1", "runs-2",
                                         "gr\xc3\xb6\xc3\x9f" "e--so"};
    for (size_t i = 0; i < sizeof anchor / sizeof *anchor; i++) {
        char part[80];
        snprintf(part, sizeof part, "<h2 id=\"%s\">", anchor[i]);
        has(&d.html, part);
        snprintf(part, sizeof part, "<a href=\"#%s\">", anchor[i]);
        has(&d.html, part);
        snprintf(part, sizeof part, "](#%s)", anchor[i]);
        has(&d.md, part);
        if (strstr(strstr(d.md.s, part) + 1, part) != NULL) fail_msg("twice: %s", part);
    }
    drop(&d);
}

static void cells_of_tables(void **state)
{
    (void)state;
    struct folder d;
    struct page p;
    begin(&d, &p, "Title");
    page_row(&p, true, 3, (const char *const[]){"a", "b", "c"});
    page_row(&p, false, 3, (const char *const[]){"-1.5e-3", "pass", NULL});
    page_row(&p, false, 3, (const char *const[]){"12 %", "fail", "a|b\nc <d>"});
    page_row(&p, false, 3,
             (const char *const[]){"12345678901234567890x", "1234567890123456789x", "99%"});
    page_table_end(&p);
    end(&d, &p);
    has(&d.md, "| a | b | c |\n|---|---|---|\n");
    has(&d.html, "<tr><th>a</th><th>b</th><th>c</th></tr>\n</thead>\n<tbody>\n");
    has(&d.html, "<tr><td class=\"number\">-1.5e-3</td><td class=\"pass\">pass</td>");
    has(&d.html, "<td class=\"short\">12 %</td><td class=\"fail\">fail</td>");
    has(&d.html, "&lt;d&gt;</td></tr>");
    has(&d.html, "<td>12345678901234567890x</td><td class=\"short\">1234567890123456789x</td>"
                 "<td class=\"number\">99%</td>");
    /* a bar or a line end in a cell would break the row */
    const char *row = strstr(d.md.s, "12 %");
    assert_non_null(row);
    const size_t length = strcspn(row, "\n");
    assert_true(row[length - 1] == '|' && memchr(row, 'd', length) != NULL);
    const char *bar = memchr(row, 'b', length);
    assert_true(bar != NULL && (bar[-2] == '\\' || bar[-1] != '|'));
    drop(&d);
}

static void nothing_is_written_that_is_not_kept(void **state)
{
    (void)state;
    struct folder d;
    struct page p;
    char path[400];
    struct err e;
    err_clear(&e);
    begin(&d, &p, "Title");
    assert_true(page_close(&p, d.name, "page", false, &e));
    assert_int_equal(access(scratch_path(path, sizeof path, d.name, "page.md"), F_OK), -1);
    /* a folder that is not there */
    put_file(d.name, "page.md", "older");
    p = (struct page){.figures = "figures", .data_dir = d.name};
    assert_true(page_open(&p, "Title", &e));
    char none[400];
    assert_false(page_close(&p, scratch_path(none, sizeof none, d.name, "none"), "page", true, &e));
    assert_int_equal(e.kind, ERR_CREATE);
    /* a picture that could not be read spoils the page, and the older one stays */
    err_clear(&e);
    p = (struct page){.figures = "figures", .data_dir = d.name};
    assert_true(page_open(&p, "Title", &e));
    err_set(&p.trouble, ERR_IO, "a picture is broken");
    assert_false(page_close(&p, d.name, "page", true, &e));
    assert_string_equal(e.text, "a picture is broken");
    err_clear(&e);
    assert_true(text_read_file(&d.md, scratch_path(path, sizeof path, d.name, "page.md"), &e));
    assert_string_equal(d.md.s, "older");
    /* without its look there is no page, and it is closed all the same */
    unlink(scratch_path(path, sizeof path, d.name, "plots/report.css"));
    p = (struct page){.figures = "figures", .data_dir = d.name};
    assert_false(page_open(&p, "Title", &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    assert_true(page_close(&p, d.name, "page", false, &e));
    drop(&d);
}

static void errors_in_words(void **state)
{
    (void)state;
    static const struct {
        struct how_sure h;
        const char *sentence, *brief;
    } cases[] = {
        {{0}, "", ""},
        {{.runs = 40},
         "How sure: the network level is not known to be right (mimdsim accuracy measures it); "
         "what the parameters of the machine leave open is not known (mimdsim run --uncertainty "
         "64 tells); the arithmetic is not checked.",
         "error of level not known, machine not known, arithmetic not known"},
        {{.runs = 40,
          .level = 12,
          .machine = 40,
          .arithmetic = 1,
          .level_error = 0.012,
          .machine_low = -0.234,
          .machine_high = 0.11,
          .arithmetic_error = 8e-10},
         "How sure: the network level is within 1.2 % (12 of 40 runs); what the parameters of the "
         "machine leave open is -23 to +11 %; the arithmetic is within 8e-10 (1 of 40 runs).",
         "error of level <= 1.2 % (12 of 40 runs), machine -23..+11 %, arithmetic <= 8e-10 (1 of "
         "40 runs)"},
        {{.runs = 1, .level = 1, .machine = 1, .arithmetic = 1},
         "How sure: the network level is within 0 %; what the parameters of the machine leave open "
         "is +0 to +0 %; the arithmetic is within 0.",
         "error of level <= 0 %, machine +0..+0 %, arithmetic <= 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct text sentence = {0}, brief = {0};
        text_add(&sentence, "%s", "");
        text_add(&brief, "%s", "");
        how_sure_sentence(&cases[i].h, &sentence);
        how_sure_short(&cases[i].h, &brief);
        assert_string_equal(sentence.s, cases[i].sentence);
        assert_string_equal(brief.s, cases[i].brief);
        text_free(&sentence);
        text_free(&brief);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_files_say_the_same),
        cmocka_unit_test(contents_list_the_headings_that_follow),
        cmocka_unit_test(equal_headings_have_links_of_their_own),
        cmocka_unit_test(cells_of_tables),
        cmocka_unit_test(nothing_is_written_that_is_not_kept),
        cmocka_unit_test(errors_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
