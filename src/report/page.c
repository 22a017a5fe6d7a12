/* page.c - Markdown and HTML side by side; see page.h. */
#include "report/page.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

static const char style[] =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>\n"
    "body { font: 16px/1.5 'DejaVu Sans', Verdana, sans-serif; color: #1a1a1a; max-width: 62em; "
    "margin: 2em auto; padding: 0 1em }\n"
    "h1, h2, h3 { line-height: 1.25; font-weight: 600 } h2 { margin-top: 2.2em; border-bottom: 1px "
    "solid #ccc }\n"
    "table { border-collapse: collapse; margin: 1em 0; font-size: 0.8em; display: block; "
    "overflow-x: auto }\n"
    "th, td { text-align: left; vertical-align: top; padding: 0.25em 0.7em; border-bottom: 1px "
    "solid #ddd }\n"
    "th { border-bottom: 2px solid #888 } td.pass { background: #d5e8f3 } td.fail { background: "
    "#b0401a; color: #fff }\n"
    "td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }\n"
    "td.short, td.pass, td.fail { white-space: nowrap }\n"
    "nav ul { columns: 18em; padding-left: 1.2em }\n"
    "figure { margin: 1.5em 0 } figure img { width: 100%; height: auto } figcaption { font-size: "
    "0.85em; color: #444 }\n</style>\n";

static FILE *make_file(const char *folder, const char *name, const char *ending, struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/%s.%s", folder, name, ending);
    FILE *f = fopen(path.s, "w");
    if (!f) err_set(e, ERR_CREATE, "cannot make %s: %s", path.s, strerror(errno));
    text_free(&path);
    return f;
}

static void escape(FILE *html, const char *s)
{
    for (; *s; s++) {
        if (*s == '<') fputs("&lt;", html);
        else if (*s == '>') fputs("&gt;", html);
        else if (*s == '&') fputs("&amp;", html);
        else if (*s == '"') fputs("&quot;", html);
        else putc(*s, html);
    }
}

/* Text for Markdown: what would be taken for markup is escaped. */
static void escape_md(FILE *md, const char *s, bool cell)
{
    for (; *s; s++) {
        if (strchr("<>*_`[]", *s) || (cell && *s == '|')) putc('\\', md);
        putc(*s == '\n' ? ' ' : *s, md);
    }
}

bool page_open(struct page *p, const char *folder, const char *name, const char *title,
               const char *figures, struct err *e)
{
    *p = (struct page){.figures = figures};
    p->md = make_file(folder, name, "md", e);
    p->html = p->md ? make_file(folder, name, "html", e) : NULL;
    if (!p->html) return false;
    fputs(style, p->html);
    fputs("<title>", p->html);
    escape(p->html, title);
    fputs("</title>\n</head>\n<body>\n", p->html);
    page_heading(p, 1, title);
    return true;
}

/* The file of a page with contents: their list, then what waited. */
static FILE *join(FILE *front, FILE *waiting, char *const *rest, const size_t *size,
                  const struct text *list)
{
    CHECK(fclose(waiting) == 0); /* in memory */
    fputs(list->s ? list->s : "", front);
    fwrite(*rest, 1, *size, front);
    free(*rest);
    return front;
}

/* All headings are known. */
static void write_contents(struct page *p)
{
    text_add(&p->list_md, "\n");
    text_add(&p->list_html, "</ul>\n</nav>\n");
    p->md = join(p->front_md, p->md, &p->rest_md, &p->size_md, &p->list_md);
    p->html = join(p->front_html, p->html, &p->rest_html, &p->size_html, &p->list_html);
    text_free(&p->list_md);
    text_free(&p->list_html);
}

void page_contents(struct page *p)
{
    CHECK(!p->front_md);
    page_heading(p, 2, "Contents");
    fputs("<nav>\n<ul>\n", p->html);
    p->front_md = p->md;
    p->front_html = p->html;
    p->md = open_memstream(&p->rest_md, &p->size_md);
    p->html = open_memstream(&p->rest_html, &p->size_html);
    CHECK(p->md && p->html);
}

bool page_close(struct page *p, struct err *e)
{
    bool ok = true;
    if (p->front_md) write_contents(p);
    if (p->html) fputs("</body>\n</html>\n", p->html);
    for (int i = 0; i < 2; i++) {
        FILE *f = i ? p->html : p->md;
        if (!f) continue;
        bool bad = ferror(f) != 0;
        if (fclose(f) != 0 || bad) ok = err_set(e, ERR_IO, "the report cannot be written");
    }
    *p = (struct page){0};
    return ok;
}

/* The name that links to a heading: as GitHub makes it of a heading in Markdown. */
static void add_anchor(struct text *out, const char *heading)
{
    for (const char *c = heading; *c; c++) {
        char letter = (char)tolower((unsigned char)*c);
        if (letter == ' ') letter = '-';
        if (isalnum((unsigned char)letter) || letter == '-' || letter == '_')
            text_add_bytes(out, &letter, 1);
    }
}

/* One line of the contents. */
static void list_heading(struct page *p, const char *text, const char *anchor)
{
    char *md = NULL, *html = NULL;
    size_t size;
    FILE *to_md = open_memstream(&md, &size), *to_html = open_memstream(&html, &size);
    CHECK(to_md && to_html);
    escape_md(to_md, text, false);
    escape(to_html, text);
    CHECK(fclose(to_md) == 0 && fclose(to_html) == 0);
    text_add(&p->list_md, "- [%s](#%s)\n", md, anchor);
    text_add(&p->list_html, "<li><a href=\"#%s\">%s</a></li>\n", anchor, html);
    free(md);
    free(html);
}

void page_heading(struct page *p, int level, const char *text)
{
    struct text anchor = {0};
    add_anchor(&anchor, text);
    text_add(&anchor, "%s", "");
    fprintf(p->md, "%.*s ", level, "####");
    escape_md(p->md, text, false);
    fputs("\n\n", p->md);
    if (level == 2) fprintf(p->html, "<h2 id=\"%s\">", anchor.s);
    else fprintf(p->html, "<h%d>", level);
    escape(p->html, text);
    fprintf(p->html, "</h%d>\n", level);
    if (level == 2 && p->front_md) list_heading(p, text, anchor.s);
    text_free(&anchor);
}

void page_paragraph(struct page *p, const char *text)
{
    escape_md(p->md, text, false);
    fputs("\n\n", p->md);
    fputs("<p>", p->html);
    escape(p->html, text);
    fputs("</p>\n", p->html);
}

enum { SHORT_CELL = 20 }; /* bytes: "0.815 to 0.892" stays on one line */

static const char *cell_class(const char *s)
{
    if (strcmp(s, "pass") == 0) return " class=\"pass\"";
    if (strcmp(s, "fail") == 0) return " class=\"fail\"";
    if (*s && s[strspn(s, "-+.0123456789e%")] == '\0') return " class=\"number\"";
    return strlen(s) <= SHORT_CELL ? " class=\"short\"" : "";
}

void page_row(struct page *p, bool head, int n, const char *const *cell)
{
    fputs(head ? "<table>\n<tr>" : "<tr>", p->html);
    putc('|', p->md);
    for (int i = 0; i < n; i++) {
        const char *s = cell[i] ? cell[i] : "";
        putc(' ', p->md);
        escape_md(p->md, s, true);
        fputs(" |", p->md);
        fprintf(p->html, head ? "<th>" : "<td%s>", cell_class(s));
        escape(p->html, s);
        fputs(head ? "</th>" : "</td>", p->html);
    }
    putc('\n', p->md);
    fputs("</tr>\n", p->html);
    for (int i = 0; head && i < n; i++) fputs(i + 1 < n ? "|---" : "|---|\n", p->md);
    p->columns = n;
}

void page_table_end(struct page *p)
{
    if (!p->columns) return;
    fputs("\n", p->md);
    fputs("</table>\n", p->html);
    p->columns = 0;
}

enum { MOST_COLUMNS = 32 };

/* Columns by their names in SQL, in words. */
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

static bool add_row(void *context, int ncolumn, const char *const *name,
                    const struct store_value *value)
{
    struct page *p = context;
    char number[MOST_COLUMNS][40];
    const char *cell[MOST_COLUMNS];
    if (ncolumn > MOST_COLUMNS) ncolumn = MOST_COLUMNS;
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

bool page_table(struct page *p, struct store *s, const char *sql, int nparam,
                const char *const *param, const char *empty, struct err *e)
{
    p->columns = 0;
    bool ok = store_query(s, sql, nparam, param, NULL, add_row, p, e);
    if (ok && !p->columns) page_paragraph(p, empty);
    page_table_end(p);
    return ok;
}

/* RFC 4648. */
static void base64(FILE *out, const unsigned char *s, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        unsigned a = s[i], b = i + 1 < n ? s[i + 1] : 0, c = i + 2 < n ? s[i + 2] : 0;
        putc(digit[a >> 2], out);
        putc(digit[(a & 3) << 4 | b >> 4], out);
        putc(i + 1 < n ? digit[(b & 15) << 2 | c >> 6] : '=', out);
        putc(i + 2 < n ? digit[c & 63] : '=', out);
    }
}

/* A path as Markdown takes it for a link's target. */
static void put_target(FILE *md, const char *path)
{
    for (; *path; path++)
        if (strchr(" %()<>\"'", *path)) fprintf(md, "%%%02X", (unsigned)(unsigned char)*path);
        else putc(*path, md);
}

void page_figure(struct page *p, const char *name, const char *caption)
{
    struct text path = {0}, svg = {0};
    struct err ignored;
    err_clear(&ignored);
    const char *slash = strrchr(p->figures, '/');
    text_add(&path, "%s/%s.svg", p->figures, name);
    if (text_read_file(&svg, path.s, &ignored)) {
        fputs("![", p->md);
        escape_md(p->md, name, false);
        fputs("](", p->md);
        put_target(p->md, slash && slash[1] ? slash + 1 : p->figures);
        putc('/', p->md);
        put_target(p->md, name);
        fputs(".svg)\n\n", p->md);
        fputs("<figure><img alt=\"", p->html);
        escape(p->html, name);
        fputs("\" src=\"data:image/svg+xml;base64,", p->html);
        base64(p->html, (const unsigned char *)svg.s, svg.length);
        fputs("\">\n<figcaption>", p->html);
        escape(p->html, caption);
        fputs("</figcaption></figure>\n", p->html);
        escape_md(p->md, caption, false);
        fputs("\n\n", p->md);
    } else {
        page_paragraph(p, caption);
        page_paragraph(
            p, "This figure was not drawn: gnuplot is missing or no run is stored for it. Its data "
               "are in the CSV file of the same name.");
    }
    text_free(&path);
    text_free(&svg);
}
