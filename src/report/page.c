/* page.c - Markdown and HTML side by side; see page.h.
 *
 * Every part of a report is written to both files by one call, so that they cannot differ. The
 * HTML file needs nothing beside it (pictures are inside); the Markdown file refers to the
 * folder of figures. */
#include "report/page.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/beside.h"
#include "base/check.h"
#include "base/digest.h"
#include "base/escape.h"
#include "base/text.h"
#include "report/markup.h"
#include "report/report.h"
#include "report/svg.h"

/* Base64, RFC 4648, section 4: three bytes are four digits of six bits; a short end is filled
 * with '='. */
static void base64(FILE *out, const unsigned char *s, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        /* bytes behind the end count as 0 */
        unsigned a = s[i], b = i + 1 < n ? s[i + 1] : 0, c = i + 2 < n ? s[i + 2] : 0;
        putc(digit[a >> 2], out);
        putc(digit[(a & 3) << 4 | b >> 4], out);
        putc(i + 1 < n ? digit[(b & 15) << 2 | c >> 6] : '=', out);
        putc(i + 2 < n ? digit[c & 63] : '=', out);
    }
}

/* The fingerprint by which a browser knows the one script that may run. */
static void put_script_source(FILE *html, const struct text *script)
{
    char hex[65], pair[3] = "";
    unsigned char hash[32];
    digest_sha256_hex(script->s, script->length, hex);
    for (int i = 0; i < 32; i++) {
        memcpy(pair, hex + 2 * i, 2);
        hash[i] = (unsigned char)strtoul(pair, NULL, 16);
    }
    fputs("'sha256-", html);
    base64(html, hash, sizeof hash);
    fputs("'", html);
}

/* HTML that is complete in itself: no style sheet, no script, no font from elsewhere. Texts of a
 * database are escaped, pictures are read and written again; the policy is the second lock: the
 * browser fetches nothing and runs no script but ours. */
void page_head(FILE *html, const struct text *style, const struct text *script)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
          "style-src 'unsafe-inline'; script-src ",
          html);
    put_script_source(html, script);
    fprintf(html, "\">\n<style>\n%s</style>\n", style->s);
}

/* The contents of data_dir/plots/NAME, never NULL. */
static bool read_part(const struct page *p, const char *name, struct text *t, struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/plots/%s", p->data_dir, name);
    bool ok = text_read_file(t, path.s, e);
    text_add(t, "%s", "");
    text_free(&path);
    return ok;
}

/* Everything is written to memory: the list of contents needs headings that are not known yet, and
 * the files appear whole. */
bool page_open(struct page *p, const char *title, struct err *e)
{
    struct text style = {0};
    *p = (struct page){.figures = p->figures, .data_dir = p->data_dir};
    const bool ok =
        read_part(p, "report.css", &style, e) && read_part(p, "report.js", &p->script, e);
    p->md = text_stream(&p->text_md);
    p->html = text_stream(&p->text_html);
    if (ok) {
        page_head(p->html, &style, &p->script);
        fputs("<title>", p->html);
        markup_escape(p->html, title);
        fputs("</title>\n</head>\n<body>\n", p->html);
        page_heading(p, 1, title);
    }
    text_free(&style);
    return ok;
}

/* The list goes here when it is known. */
void page_contents(struct page *p)
{
    CHECK(!p->has_contents);
    page_heading(p, 2, "Contents");
    fputs("<nav>\n<ul>\n", p->html);
    fflush(p->md);
    fflush(p->html);
    p->has_contents = true;
    p->list_at_md = p->text_md.length;
    p->list_at_html = p->text_html.length;
}

/* One of the two files: what came before the list of contents, the list, and the rest. */
static bool write_file(const char *folder, const char *name, const char *ending,
                       const struct text *body, size_t list_at, const struct text *list,
                       struct err *e)
{
    struct text path = {0}, all = {0};
    text_add(&path, "%s/%s.%s", folder, name, ending);
    text_add_bytes(&all, body->s, list_at);
    if (list->length > 0) text_add_bytes(&all, list->s, list->length);
    text_add_bytes(&all, body->s + list_at, body->length - list_at);
    const bool ok = beside_write(path.s, all.s, all.length, e);
    text_free(&path);
    text_free(&all);
    return ok;
}

bool page_close(struct page *p, const char *folder, const char *name, bool keep, struct err *e)
{
    fprintf(p->html, "<script>%s</script>\n</body>\n</html>\n", p->script.s ? p->script.s : "");
    text_stream_end(p->md);
    text_stream_end(p->html);
    if (p->has_contents) {
        text_add(&p->list_md, "\n");
        text_add(&p->list_html, "</ul>\n</nav>\n");
    }
    const bool whole = p->trouble.kind == ERR_NONE;
    if (keep && !whole) *e = p->trouble;
    const bool ok =
        !keep ||
        (whole && write_file(folder, name, "md", &p->text_md, p->list_at_md, &p->list_md, e) &&
         write_file(folder, name, "html", &p->text_html, p->list_at_html, &p->list_html, e));
    struct text *const mine[] = {&p->text_md, &p->text_html, &p->list_md, &p->list_html,
                                 &p->script,  &p->anchors};
    for (int i = 0; i < 6; i++) text_free(mine[i]);
    *p = (struct page){0};
    return ok;
}

/* The words of a heading as GitHub writes them into links: small letters, hyphens for blanks,
 * punctuation left out, letters beyond ASCII as they are. */
static void add_slug(struct text *out, const char *heading)
{
    for (const unsigned char *c = (const unsigned char *)heading; *c; c++) {
        const char letter = *c == ' ' ? '-' : (char)tolower(*c);
        /* UTF-8 of U+2000 to U+206F: dashes, quotes, the comma that stands for one in a name. */
        const bool punctuation = c[0] == 0xe2 && (c[1] == 0x80 || c[1] == 0x81) && c[2] != 0;
        if (punctuation) c += 2;
        else if (*c >= 0x80 || isalnum(*c) || letter == '-' || letter == '_')
            text_add_bytes(out, &letter, 1);
    }
}

/* Whether a line of `list`, each ended by '\n', is `word`. */
static bool has_line(const struct text *list, const char *word)
{
    const size_t n = strlen(word);
    for (const char *line = list->s; line != NULL && *line; line = strchr(line, '\n') + 1)
        if (strncmp(line, word, n) == 0 && line[n] == '\n') return true;
    return false;
}

/* The anchor of a heading. Of headings with equal words the second has "-1" behind them, the third
 * "-2", as GitHub counts them over all levels: Markdown and HTML have the same links, and each
 * leads to its own heading. */
static void add_anchor(struct page *p, struct text *out, const char *heading)
{
    text_add(out, "%s", "");
    add_slug(out, heading);
    const size_t words = out->length;
    for (int k = 1; has_line(&p->anchors, out->s); k++) {
        out->length = words;
        text_add(out, "-%d", k);
    }
    text_add(&p->anchors, "%s\n", out->s);
}

/* One line of the contents. */
static void list_heading(struct page *p, const char *text, const char *anchor)
{
    struct text md = {0}, html = {0};
    FILE *to_md = text_stream(&md), *to_html = text_stream(&html);
    escape_markdown(to_md, text, false);
    markup_escape(to_html, text);
    text_stream_end(to_md);
    text_stream_end(to_html);
    text_add(&p->list_md, "- [%s](#%s)\n", md.s, anchor);
    text_add(&p->list_html, "<li><a href=\"#%s\">%s</a></li>\n", anchor, html.s);
    text_free(&md);
    text_free(&html);
}

/* Every heading takes part in the count of equal ones; links lead to those of level 2 alone, which
 * the contents list. */
void page_heading(struct page *p, int level, const char *text)
{
    struct text anchor = {0};
    add_anchor(p, &anchor, text);
    fprintf(p->md, "%.*s ", level, "####");
    escape_markdown(p->md, text, false);
    fputs("\n\n", p->md);
    if (level == 2) fprintf(p->html, "<h2 id=\"%s\">", anchor.s);
    else fprintf(p->html, "<h%d>", level);
    markup_escape(p->html, text);
    fprintf(p->html, "</h%d>\n", level);
    if (level == 2 && p->has_contents) list_heading(p, text, anchor.s);
    text_free(&anchor);
}

void page_paragraph(struct page *p, const char *text)
{
    escape_markdown(p->md, text, true);
    fputs("\n\n", p->md);
    fputs("<p>", p->html);
    markup_escape(p->html, text);
    fputs("</p>\n", p->html);
}

enum { SHORT_CELL = 20 }; /* bytes: "0.815 to 0.892" stays on one line */

/* The class decides alignment and line breaks in the style sheet. */
static const char *cell_class(const char *s)
{
    if (strcmp(s, "pass") == 0) return " class=\"pass\"";
    if (strcmp(s, "fail") == 0) return " class=\"fail\"";
    /* made of the characters of a number only */
    if (*s && s[strspn(s, "-+.0123456789e%")] == '\0') return " class=\"number\"";
    return strlen(s) <= SHORT_CELL ? " class=\"short\"" : "";
}

/* A row in both. In Markdown the head is followed by a line of hyphens; HTML needs none. */
void page_row(struct page *p, bool head, int n, const char *const *cell)
{
    fputs(head ? "<div class=\"wide\">\n<table>\n<thead>\n<tr>" : "<tr>", p->html);
    putc('|', p->md);
    for (int i = 0; i < n; i++) {
        const char *s = cell[i] ? cell[i] : "";
        putc(' ', p->md);
        escape_markdown(p->md, s, false);
        fputs(" |", p->md);
        fprintf(p->html, head ? "<th>" : "<td%s>", cell_class(s));
        markup_escape(p->html, s);
        fputs(head ? "</th>" : "</td>", p->html);
    }
    putc('\n', p->md);
    fputs(head ? "</tr>\n</thead>\n<tbody>\n" : "</tr>\n", p->html);
    for (int i = 0; head && i < n; i++) fputs(i + 1 < n ? "|---" : "|---|\n", p->md);
    /* Not 0: a table is open. */
    p->columns = n;
}

void page_table_end(struct page *p)
{
    /* No table is open: an end too many does no harm. */
    if (!p->columns) return;
    fputs("\n", p->md);
    fputs("</tbody>\n</table>\n</div>\n", p->html);
    p->columns = 0;
}

/* Of queries in this room: more columns than a page is wide. */
enum { MOST_COLUMNS = 32 };

/* Names of columns as headings: "largest_error" is "largest error". A name in quotes in SQL is
 * as it is. */
static void add_heading(struct page *p, int n, const char *const *name)
{
    char word[MOST_COLUMNS][64];
    const char *words[MOST_COLUMNS] = {0};
    for (int i = 0; i < n; i++) {
        text_copy(word[i], sizeof word[i], name[i]);
        for (char *c = strchr(word[i], '_'); c != NULL; c = strchr(c, '_')) *c = ' ';
        words[i] = word[i];
    }
    page_row(p, true, n, words);
}

/* One row of a query. Whole numbers have all their digits, reals four. */
static bool add_row(void *context, int ncolumn, const char *const *name,
                    const struct store_value *value)
{
    struct page *p = context;
    char number[MOST_COLUMNS][40];
    const char *cell[MOST_COLUMNS];
    if (ncolumn > MOST_COLUMNS) ncolumn = MOST_COLUMNS;
    /* The head is written when the first row comes: an empty table has none. */
    if (!p->columns) add_heading(p, ncolumn, name);
    for (int i = 0; i < ncolumn; i++) {
        cell[i] = value[i].kind == STORE_TEXT   ? value[i].text
                  : value[i].kind == STORE_NULL ? ""
                                                : number[i];
        if (value[i].kind == STORE_INT)
            snprintf(number[i], sizeof number[i], "%lld", (long long)value[i].integer);
        if (value[i].kind == STORE_REAL)
            snprintf(number[i], sizeof number[i], "%.4g", value[i].real);
    }
    page_row(p, false, ncolumn, cell);
    return true;
}

/* p->columns tells afterwards whether there was any row. */
bool page_table(struct page *p, struct store *s, const char *sql, int nparam,
                const char *const *param, const char *empty, struct err *e)
{
    p->columns = 0;
    bool ok = store_query(s, sql, nparam, param, NULL, add_row, p, e);
    if (ok && !p->columns) page_paragraph(p, empty);
    page_table_end(p);
    return ok;
}

/* A path as Markdown takes it for a link's target: what would end or quote it is
 * percent-encoded. */
static void put_target(FILE *md, const char *path)
{
    for (; *path; path++)
        if (strchr(" %()<>\"'", *path)) fprintf(md, "%%%02X", (unsigned)(unsigned char)*path);
        else putc(*path, md);
}

/* Markdown refers to the file beside it, by the last part of the folder's path. */
static void put_picture_md(struct page *p, const char *name)
{
    const char *slash = strrchr(p->figures, '/');
    fputs("![", p->md);
    escape_markdown(p->md, name, false);
    fputs("](", p->md);
    put_target(p->md, slash && slash[1] ? slash + 1 : p->figures);
    putc('/', p->md);
    put_target(p->md, name);
    fputs(".svg)\n\n", p->md);
}

/* The picture of a drawing: HTML contains it, so that it can be sent alone. False: it was not
 * drawn, or is no picture of ours, which is no error of the report. */
static bool put_picture(struct page *p, const char *name)
{
    struct text path = {0}, svg = {0}, clean = {0};
    struct err ignored;
    char prefix[24];
    err_clear(&ignored);
    text_add(&path, "%s/%s.svg", p->figures, name);
    snprintf(prefix, sizeof prefix, "f%d-", ++p->nfigure);
    /* In memory first: half a picture would spoil the page. */
    FILE *out = text_stream(&clean);
    bool ok = text_read_file(&svg, path.s, &ignored) && svg_clean(&svg, prefix, out, &ignored);
    text_stream_end(out);
    /* One that is there and cannot be read is told at the end, the first of them. */
    if (!ok && ignored.kind != ERR_DATA && access(path.s, F_OK) == 0 && p->trouble.kind == ERR_NONE)
        p->trouble = ignored;
    if (ok) {
        put_picture_md(p, name);
        fwrite(clean.s, 1, clean.length, p->html);
    }
    text_free(&clean);
    text_free(&path);
    text_free(&svg);
    return ok;
}

/* Caption below; what was not drawn is told. */
static void put_caption(struct page *p, const char *caption, int drawn, int missing)
{
    if (drawn > 0) {
        fputs("<figcaption>", p->html);
        markup_escape(p->html, caption);
        fputs("</figcaption></figure>\n", p->html);
        escape_markdown(p->md, caption, false);
        fputs("\n\n", p->md);
    } else page_paragraph(p, caption);
    if (missing > 0)
        page_paragraph(
            p, "This figure was not drawn: gnuplot is missing or no run is stored for it. Its data "
               "are in the CSV file of the same name.");
}

void page_figure(struct page *p, const char *name, const char *caption)
{
    fputs("<figure>\n", p->html);
    const bool drawn = put_picture(p, name);
    if (!drawn) fputs("</figure>\n", p->html);
    put_caption(p, caption, drawn, !drawn);
}

void page_figures(struct page *p, struct store *s, const char *name, const char *caption)
{
    struct report_drawings d = {0};
    struct err ignored;
    int drawn = 0;
    err_clear(&ignored);
    /* Without rows there is no drawing: told like a missing one. A description that cannot be read,
     * which the error names as its file, is told at the end. */
    const int n = report_drawings_find(s, p->data_dir, name, &d, &ignored) ? d.n : 0;
    const bool unread =
        ignored.file[0] != '\0' || ignored.kind == ERR_IO || ignored.kind == ERR_INTERNAL;
    if (n == 0 && unread && p->trouble.kind == ERR_NONE) p->trouble = ignored;
    fputs("<figure>\n", p->html);
    for (int i = 0; i < n; i++) drawn += put_picture(p, d.as[i]);
    if (drawn == 0) fputs("</figure>\n", p->html);
    put_caption(p, caption, drawn, n == 0 || drawn < n);
    report_drawings_free(&d);
}
