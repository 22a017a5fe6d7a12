/* plot_where.h - conditions on the rows of a plot: "level=link", "n>=64", "hop_latency<=1 us". */
#ifndef REPORT_PLOT_WHERE_H
#define REPORT_PLOT_WHERE_H

#include "report/plot_sheet.h"

enum { MOST_CONDITIONS = 32 };

enum plot_operator {
    PLOT_EQUAL,
    PLOT_NOT_EQUAL,
    PLOT_LESS,
    PLOT_AT_MOST,
    PLOT_MORE,
    PLOT_AT_LEAST,
    PLOT_LIKE
};

/* One condition, as written; it is no SQL and never becomes a part of any. */
struct plot_condition {
    const char *key;          /* in the arena of plot_where_parse */
    enum plot_operator operator;
    const char *value;        /* several after = and !=, divided by | */
};

/* plot_where_parse: `text` as a condition, in `a`. Operators: = != < <= > >= and ~ (shell pattern).
 * Returns false with ERR_USAGE. */
bool plot_where_parse(struct plot_condition *c, const char *text, struct arena *a, struct err *e);

/* plot_where_keep: drop the rows of the sheet that do not fulfil all (n) conditions. Numbers are
 * compared as numbers, with units where the column has one; a row without a value fulfils only !=
 * and "KEY=". Returns false with ERR_USAGE (unknown key, wrong unit) or ERR_NO_INPUT (no row is
 * left: which values there are). */
bool plot_where_keep(struct plot_sheet *sheet, int n, const struct plot_condition *c,
                     struct err *e);

#endif
