/* page.h - one report written twice at once: Markdown for repositories, HTML that is complete in
 * itself. */
#ifndef REPORT_PAGE_H
#define REPORT_PAGE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/err.h"
#include "base/text.h"
#include "store/store.h"

struct page {
    FILE *md, *html;                /* into the texts below */
    const char *figures;            /* folder of the pictures */
    const char *data_dir;           /* holds plots/ */
    int nfigure;                    /* written: each has identifiers of its own */
    struct text script;             /* of the HTML, written at its end */
    int columns;                    /* of the table being written */
    struct text text_md, text_html; /* all but the list of contents */
    bool has_contents;
    size_t list_at_md, list_at_html; /* where the list goes */
    struct text list_md, list_html;
    struct text anchors; /* of all headings so far, a line each: no two are equal */
    struct err trouble; /* a picture that is there and could not be read */
};

/* page_open: begin a report; p->figures and p->data_dir are the caller's, set before and borrowed.
 * The look and the script that sorts tables are data_dir/plots/report.css and report.js; they
 * become a part of the HTML, and no other script runs in it. Returns false with ERR_NO_INPUT where
 * these are missing; page_close is due all the same. */
bool page_open(struct page *p, const char *title, struct err *e);

/* page_close: end it: folder/NAME.md and folder/NAME.html are there, whole, in place of older ones,
 * when `keep`; else nothing is written. Returns false with ERR_CREATE or ERR_IO. */
bool page_close(struct page *p, const char *folder, const char *name, bool keep, struct err *e);

/* page_head: the beginning of an HTML file of ours, up to its title: nothing is fetched from
 * elsewhere, and of scripts only `script` runs. */
void page_head(FILE *html, const struct text *style, const struct text *script);

/* page_contents: put a section "Contents" here, with links to all headings of level 2 that follow.
 * Once a page. */
void page_contents(struct page *p);

/* page_heading, page_paragraph: one heading of that level (1 is the largest), one paragraph; markup
 * is escaped. */
void page_heading(struct page *p, int level, const char *text);
void page_paragraph(struct page *p, const char *text);

/* page_table: the rows of `sql`, or `empty` as a paragraph when there are none. */
bool page_table(struct page *p, struct store *s, const char *sql, int nparam,
                const char *const *param, const char *empty, struct err *e);

/* page_row: one row by hand; `head` begins a table, page_table_end ends it. */
void page_row(struct page *p, bool head, int n, const char *const *cell);
void page_table_end(struct page *p);

/* page_figure: the drawing `name` with its caption, the SVG inside the HTML; one that was not drawn
 * is told as such. */
void page_figure(struct page *p, const char *name, const char *caption);

/* page_figures: all drawings that `name` stands for in the database (report_drawings_find), the
 * caption below the last one. One that has none is told as not drawn. */
void page_figures(struct page *p, struct store *s, const char *name, const char *caption);

#endif
