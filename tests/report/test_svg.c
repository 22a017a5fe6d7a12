/* test_svg.c - pictures come out as shapes and texts, with a title and tooltips, and with nothing
 * that runs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "report/markup.h"
#include "report/svg.h"

/* As gnuplot 5.4 writes it: head, a curve with a name, a point with a tooltip. */
static const char drawn[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"  standalone=\"no\"?>\n"
    "<svg width=\"400\" height=\"300\" viewBox=\"0 0 400 300\" xmlns=\"http://www.w3.org/2000/svg\""
    " xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n<title>Gnuplot</title>\n<desc>Produced by "
    "GNUPLOT</desc>\n"
    "<defs><circle id='gpDot' r='0.5'/><use xlink:href='#gpDot' id='gpPt6'/></defs>\n"
    "<g font-size=\"11.00\"><text>small</text></g>\n"
    "<g id=\"gnuplot_plot_1\" ><title>over &lt;b&gt; &amp; c</title><path stroke='rgb(1,2,3)' "
    "d='M1,2 L3,4'/></g>\n"
    "<g id=\"gnuplot_plot_2\" ><title>gnuplot_plot_2</title>\n"
    "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'P = 4: it&apos;s 2 &lt; 3')\""
    " onmouseout=\"gnuplot_svg.hideHypertext()\"><title> </title>\n"
    "<use xlink:href='#gpPt6' transform='translate(1,2)'/></g></g>\n"
    "<g font-size=\"16.00\"><text>A &quot;title&quot; <tspan>&lt;i&gt;</tspan></text></g>\n"
    "<g font-size=\"13\"><text>later</text></g></svg>\n";

/* The cleaned picture, for the caller to free; NULL with *e when it was refused. */
static char *clean(const char *svg, const char *prefix, struct err *e)
{
    struct text t = {0};
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    assert_non_null(f);
    err_clear(e);
    text_add(&t, "%s", svg);
    bool ok = svg_clean(&t, prefix, f, e);
    assert_int_equal(fclose(f), 0);
    text_free(&t);
    if (ok) return out;
    free(out);
    return NULL;
}

static void has(const char *svg, const char *part)
{
    if (!strstr(svg, part)) fail_msg("no '%s' in %s", part, svg);
}

static void lacks(const char *svg, const char *part)
{
    if (strstr(svg, part)) fail_msg("'%s' in %s", part, svg);
}

static void the_largest_text_is_the_title(void **state)
{
    struct err e;
    char *svg = clean(drawn, NULL, &e);
    (void)state;
    has(svg, "<title>A &quot;title&quot; &lt;i&gt;</title>");
    lacks(svg, "Gnuplot");
    lacks(svg, "GNUPLOT");
    /* a file of its own begins as XML, a part of a page does not */
    assert_memory_equal(svg, "<?xml ", 6);
    free(svg);
    svg = clean(drawn, "f1-", &e);
    assert_memory_equal(svg, "<svg ", 5);
    free(svg);
}

static void tooltips_become_titles(void **state)
{
    struct err e;
    char *svg = clean(drawn, NULL, &e);
    (void)state;
    has(svg, "<title>P = 4: it&#39;s 2 &lt; 3</title>");
    has(svg, "<title>over &lt;b&gt; &amp; c</title>");
    lacks(svg, "onmouse");
    lacks(svg, "gnuplot_plot");
    lacks(svg, "<title> </title>");
    /* once more: the same picture */
    char *again = clean(svg, NULL, &e);
    assert_string_equal(again, svg);
    free(again);
    free(svg);
}

static void identifiers_get_a_prefix_and_references_follow(void **state)
{
    struct err e;
    char *svg = clean(drawn, "f7-", &e);
    (void)state;
    has(svg, "id=\"f7-gpDot\"");
    has(svg, "xlink:href=\"#f7-gpDot\" id=\"f7-gpPt6\"");
    has(svg, "<use xlink:href=\"#f7-gpPt6\" transform");
    free(svg);
}

/* Each of these could run a script, fetch a file or cover the page. */
static void what_draws_nothing_is_left_out(void **state)
{
    static const char *const bad[] = {
        "<script>alert(1)</script>", "<foreignObject><p>x</p></foreignObject>",
        "<style>*{}</style>",
        "<a xlink:href='javascript:alert(1)'><text>x</text></a>",
        "<image xlink:href='http://a/b'/>",
        "<iframe src='x'/>", "<animate attributeName='href'/>", "<set attributeName='onclick'/>",
        "<g onclick='alert(1)'/>", "<path d='M0,0' onload='alert(1)'/>",
        "<use xlink:href='http://a#b'/>",
        "<use href='data:text/xml,a'/>", "<rect style='background:u'/>",
        "<rect fill='url(http://a)'/>",
        "<rect class='c'/>", "<text xml:base='http://a'>y</text>"};
    static const char *const sign[] = {"alert",  "foreign", "style", "javascript", "http://a",
                                       "iframe", "animate", "<set",  "onclick",    "onload",
                                       "data:",  "url(",    "class", "base"};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct text t = {0};
        struct err e;
        text_add(
            &t,
            "<svg xmlns:xlink=\"http://www.w3.org/1999/xlink\"><g>%s<text>kept</text></g></svg>",
            bad[i]);
        char *svg = clean(t.s, "p-", &e);
        has(svg, "<text>kept</text>");
        for (size_t k = 0; k < sizeof sign / sizeof *sign; k++) lacks(svg, sign[k]);
        free(svg);
        text_free(&t);
    }
}

static void what_is_no_picture_is_refused(void **state)
{
    static const char *const bad[] = {
        "", "no picture", "<svg>", "<svg><g></svg>", "<svg>\xff\xfe</svg>", "<svg>&nothing;</svg>",
        "<!DOCTYPE svg [<!ENTITY a 'b'><!ENTITY c '&a;&a;'>]><svg><text>&c;</text></svg>"};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err e;
        assert_null(clean(bad[i], NULL, &e));
        assert_int_equal(e.kind, ERR_DATA);
    }
}

/* A depth that no picture has: the first pass keeps sizes for so many elements only. */
static void deep_pictures_do_no_harm(void **state)
{
    struct text t = {0};
    struct err e;
    (void)state;
    text_add(&t, "<svg>");
    for (int i = 0; i < 5000; i++) text_add(&t, "<g font-size=\"9\">");
    text_add(&t, "<text>deep</text>");
    for (int i = 0; i < 5000; i++) text_add(&t, "</g>");
    text_add(&t, "</svg>");
    char *svg = clean(t.s, NULL, &e);
    has(svg, "deep");
    free(svg);
    text_free(&t);
}

static void markup_is_escaped_byte_by_byte(void **state)
{
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    (void)state;
    markup_escape(f, "<a href='x' b=\"y\">&\x01\xc2\xb5\n");
    assert_int_equal(fclose(f), 0);
    assert_string_equal(out, "&lt;a href=&#39;x&#39; b=&quot;y&quot;&gt;&amp; \xc2\xb5\n");
    free(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_largest_text_is_the_title),
        cmocka_unit_test(tooltips_become_titles),
        cmocka_unit_test(identifiers_get_a_prefix_and_references_follow),
        cmocka_unit_test(what_draws_nothing_is_left_out),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(deep_pictures_do_no_harm),
        cmocka_unit_test(markup_is_escaped_byte_by_byte),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
