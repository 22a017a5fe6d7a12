/* plot_sheet.h - the rows that a plot is made of, in memory: stored runs with their settings, or a
 * user's own query. */
#ifndef REPORT_PLOT_SHEET_H
#define REPORT_PLOT_SHEET_H

#include "base/arena.h"
#include "base/units.h"
#include "store/store.h"

/* One value: a text always, a number where it is one (SI base units where the column is a
 * quantity). */
struct plot_cell {
    const char *text; /* "" for NULL */
    double number;    /* NAN: none */
};

struct plot_column {
    const char *key;   /* as it was found: speedup, machine.network.hop_latency */
    const char *title; /* for an axis, without the unit */
    enum unit unit;    /* UNIT_NONE: a bare number, or a text */
    bool number;       /* every value of it that is known is a number */
    bool trait;        /* says what a run is, as opposed to what came of it */
};

struct plot_sheet {
    struct arena *arena; /* owned */
    bool runs;           /* rows are runs; else those of a query */
    int ncolumn, nrow;
    struct plot_column *column; /* (ncolumn) */
    struct plot_cell *cell;     /* (nrow x ncolumn) */
    int64_t *run_id;            /* (nrow) 0: not known */
    int nleft;                  /* settings that differ between runs and had no room, .. */
    const char *left;           /* .. the first of them */
};

/* plot_sheet_runs: every run that ended well, with the columns that `key` (n) names and with those
 * that runs may differ in. A key is a column of table run or view v_run, a setting, or the end of
 * one that is unique. Returns false with ERR_USAGE (an unknown key, with the nearest one), or as
 * store_query; nothing is then to be freed. */
bool plot_sheet_runs(struct plot_sheet *sheet, struct store *s, int n, const char *const *key,
                     struct err *e);

/* plot_sheet_query: the rows of the query `sql`, which may only read. Returns false as
 * store_query. */
bool plot_sheet_query(struct plot_sheet *sheet, struct store *s, const char *sql, struct err *e);

/* plot_sheet_find: the column that `key` names, after plot_sheet_runs or of a query; -1 with
 * ERR_USAGE. */
int plot_sheet_find(const struct plot_sheet *sheet, const char *key, struct err *e);

/* plot_sheet_at: the value of a row in a column. */
const struct plot_cell *plot_sheet_at(const struct plot_sheet *sheet, int row, int column);

/* plot_sheet_free: accepts an empty one. */
void plot_sheet_free(struct plot_sheet *sheet);

#endif
