/* test_lab_page.c - the report of a made-up attempt: what stands in the page, and what cannot break
 * out of it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/scratch.h"
#include "lab/lab_page.h"

/* An attempt with one run of two ranks, and one slider of two places. */
struct made {
    struct lab lab;
    struct lab_result check;
    struct run_result result;
    struct span *span;
    struct path_step step[3];
    lab_shares point[2];
    struct lab_page_run run;
    struct lab_page page;
};

static void make(struct made *m, int64_t nspan)
{
    *m = (struct made){.lab = {.name = "toy",
                               .title = "A <toy>",
                               .goal = "None",
                               .student = "Ann",
                               .program = "toy.c",
                               .nslider = 1,
                               .slider = {{.text = "ranks",
                                           .key = "ranks",
                                           .nvalue = 2,
                                           .own = 1,
                                           .value = {"</script>", "4"}}}},
                       .check = {.program = "ok", .right = 1, .nanswer = 1}};
    m->lab.question[0] = (struct lab_question){.text = "How <many>?"};
    m->check.answer[0] = (struct lab_answer){
        .unit = "ps", .given = true, .predicted = -1234567, .simulated = 89, .verdict = "wrong"};
    m->step[0] = (struct path_step){0, 40, PATH_COMPUTE, 0, 0, -1, 0, {0}};
    m->step[1] = (struct path_step){40, 100, PATH_END, 0, 0, -1, 0, {0}};
    m->step[2] = (struct path_step){100, 160, PATH_COMPUTE, 1, 0, -1, 0, {0}};
    m->span = calloc((size_t)nspan, sizeof *m->span);
    for (int64_t i = 0; i < nspan; i++)
        m->span[i] = (struct span){(int)(i % 2), 0, SPAN_SEND, i, i + 1, -1, 77, -1};
    m->result = (struct run_result){.makespan_ps = 160,
                                    .nrank = 2,
                                    .nspan = nspan,
                                    .span = m->span,
                                    .npath = 3,
                                    .path = m->step};
    m->point[1][0] = 160; /* the first place cannot run */
    m->run = (struct lab_page_run){"one & only", &m->result, m->point};
    m->page = (struct lab_page){
        .lab = &m->lab, .check = &m->check, .source = "a < b && c", .nrun = 1, .run = &m->run};
}

/* The page as a text, the caller's to free. */
static struct text written(const struct lab_page *p)
{
    char folder[192], path[256];
    struct err e;
    struct text t = {0};
    err_clear(&e);
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "report.html");
    if (!lab_page_write(p, path, &e)) print_error("%s\n", e.text);
    assert_int_equal(e.kind, ERR_NONE);
    assert_true(text_read_file(&t, path, &e));
    scratch_remove(folder);
    return t;
}

static void shares_add_up(void **state)
{
    (void)state;
    struct made m;
    lab_shares share;
    int64_t sum = 0;
    make(&m, 0);
    lab_shares_of(&m.result, share);
    assert_int_equal(share[0], 160);
    assert_int_equal(share[1 + PATH_COMPUTE], 100);
    assert_int_equal(share[1 + PATH_END], 60);
    for (int c = 0; c < PATH_CAUSES; c++) sum += share[1 + c];
    assert_int_equal(sum, share[0]);
    free(m.span);
}

static void the_page_says_all(void **state)
{
    (void)state;
    char steps[100]; /* causes by number, as list "causes" of the page counts them */
    snprintf(steps, sizeof steps, "\"path\": [[0, 40, %d, 0], [40, 100, %d, 0], [100, 160, %d, 1]]",
             PATH_COMPUTE, PATH_END, PATH_COMPUTE);
    const char *const said[] = {
        "<title>A &lt;toy&gt;, Ann</title>",
        "How &lt;many&gt;?",
        "one &amp; only",
        "<td class=\"number\">-1&#8239;234&#8239;567</td>",
        "a &lt; b &amp;&amp; c",
        "<td>computing</td><td class=\"number\">100</td><td class=\"number\">62.5 %</td>",
        "<td>end latency</td><td class=\"number\">60</td><td class=\"number\">37.5 %</td>",
        "\"spans\": [[0, 1, 0, 1, -1, 77, -1], [1, 1, 1, 2, -1, 77, -1]]",
        steps,
        "\"grid\": [[null, [160, "};
    struct made m;
    make(&m, 2);
    struct text t = written(&m.page);
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        if (strstr(t.s, said[i]) == NULL) print_error("not there: %s\n", said[i]);
        assert_non_null(strstr(t.s, said[i]));
    }
    assert_null(strstr(t.s, "Answers to the questions"));
    text_free(&t);
    free(m.span);
}

/* A value that ends the element of the data would begin markup. */
static void no_text_leaves_its_place(void **state)
{
    (void)state;
    struct made m;
    make(&m, 2);
    m.page.notes = "<img src=x onerror=alert(1)>";
    struct text t = written(&m.page);
    assert_non_null(strstr(t.s, "\"\\u003c/script>\""));
    assert_non_null(strstr(t.s, "&lt;img src=x"));
    assert_null(strstr(t.s, "<img"));
    int scripts = 0;
    for (const char *s = t.s; (s = strstr(s, "</script>")) != NULL; s++) scripts++;
    assert_int_equal(scripts, 2);
    text_free(&t);
    free(m.span);
}

/* A page with too many marks would not open; what it leaves out is told. */
static void a_large_run_has_its_path_alone(void **state)
{
    (void)state;
    for (int more = 0; more < 2; more++) {
        struct made m;
        make(&m, LAB_PAGE_SPANS + more);
        struct text t = written(&m.page);
        assert_int_equal(strstr(t.s, "\"omitted\": 20001,") != NULL, more);
        assert_int_equal(strstr(t.s, "\"spans\": []") != NULL, more);
        assert_non_null(strstr(t.s, "\"path\": [[0, 40"));
        text_free(&t);
        free(m.span);
    }
}

/* Without a run there is nothing for a script to draw. */
static void no_run_no_script(void **state)
{
    (void)state;
    struct made m;
    make(&m, 2);
    m.page.nrun = 0;
    m.check.program = "failed: <here>";
    struct text t = written(&m.page);
    assert_null(strstr(t.s, "<script"));
    assert_null(strstr(t.s, "<svg"));
    assert_non_null(strstr(t.s, "Program: failed: &lt;here&gt;."));
    text_free(&t);
    free(m.span);
}

/* A folder that is not there: an error with a name, and nothing written. */
static void a_place_that_is_not_there(void **state)
{
    (void)state;
    struct made m;
    struct err e;
    err_clear(&e);
    make(&m, 2);
    assert_false(lab_page_write(&m.page, "no/such/folder/report.html", &e));
    assert_int_equal(e.kind, ERR_CREATE);
    free(m.span);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_add_up),
        cmocka_unit_test(the_page_says_all),
        cmocka_unit_test(no_text_leaves_its_place),
        cmocka_unit_test(a_large_run_has_its_path_alone),
        cmocka_unit_test(no_run_no_script),
        cmocka_unit_test(a_place_that_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
