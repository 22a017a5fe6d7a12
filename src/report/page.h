/* page.h - one report written twice at once: Markdown for repositories, HTML that is complete in itself. */
#ifndef REPORT_PAGE_H
#define REPORT_PAGE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/err.h"
#include "base/text.h"
#include "store/store.h"

struct page {
    FILE *md, *html;     /* owned */
    const char *figures; /* folder of the pictures */
    int columns;         /* of the table being written */
    /* with a list of contents: what follows it waits in memory until all headings are known */
    FILE *front_md, *front_html; /* the files */
    char *rest_md, *rest_html;   /* what waits */
    size_t size_md, size_html;
    struct text list_md, list_html;
};

/* page_open: make folder/NAME.md and folder/NAME.html; `figures` is borrowed. Returns false with ERR_CREATE. */
bool page_open(struct page *p, const char *folder, const char *name, const char *title, const char *figures,
               struct err *e);

/* page_close: end both files; false with ERR_IO when writing failed. Accepts a page that was never opened. */
bool page_close(struct page *p, struct err *e);

/* page_contents: put a section "Contents" here, with links to all headings of level 2 that follow. Once a page. */
void page_contents(struct page *p);

/* page_heading, page_paragraph: one heading of that level (1 is the largest), one paragraph; markup is escaped. */
void page_heading(struct page *p, int level, const char *text);
void page_paragraph(struct page *p, const char *text);

/* page_table: the rows of `sql`, or `empty` as a paragraph when there are none. */
bool page_table(struct page *p, struct store *s, const char *sql, int nparam, const char *const *param,
                const char *empty, struct err *e);

/* page_row: one row by hand; `head` begins a table, page_table_end ends it. */
void page_row(struct page *p, bool head, int n, const char *const *cell);
void page_table_end(struct page *p);

/* page_figure: figure `name` with its caption, the SVG inside the HTML; a figure that was not drawn is told as such. */
void page_figure(struct page *p, const char *name, const char *caption);

#endif
