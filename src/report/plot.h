/* plot.h - figures that a user asks for by columns: any against any, as curves, bars or a heat
 * map. */
#ifndef REPORT_PLOT_H
#define REPORT_PLOT_H

#include "base/text.h"
#include "base/units.h"
#include "report/plot_where.h"
#include "store/store.h"

enum plot_kind { PLOT_AUTO, PLOT_LINES, PLOT_BARS, PLOT_HEAT };
enum plot_scale { PLOT_SCALE_AUTO, PLOT_SCALE_LINEAR, PLOT_SCALE_LOG };

/* What an axis is called where its column's name cannot say it: letters, digits and _ alone. */
struct plot_axis_name {
    const char *title; /* NULL: as the column is called */
    enum unit unit;    /* UNIT_NONE: as the column says */
};

/* What is asked for. Columns are named as in plot_sheet.h; NULL: chosen. */
struct plot_request {
    const char *x, *y;   /* the axes; of a query the first and second column by default */
    const char *z;       /* of a heat map: the value that is drawn over x and y */
    /* columns that tell curves apart, divided by commas; NULL: as many as it takes */
    const char *by;
    const char *query;   /* SQL of a user, NULL: stored runs */
    enum plot_kind kind;
    enum plot_scale x_scale, y_scale; /* y_scale also of z */
    const char *title;   /* NULL: what is drawn over what */
    struct plot_axis_name x_name, value_name;
    const char *as;      /* name of the files */
    int nwhere;
    struct plot_condition where[MOST_CONDITIONS];
};

/* plot_draw: draw it into folder `dir` as report_figure does. *told gets, appended, which rows were
 * drawn, which were left out and why, and what a point stands for where it is several rows. Returns
 * false as plot_sheet.h, plot_where.h, plot_points.h and report_figure. */
bool plot_draw(struct store *s, const char *data_dir, const struct plot_request *r, const char *dir,
               struct text *told, struct err *e);

/* plot_only: the database as if it held only the runs that fulfil the conditions, for every figure
 * drawn from `s` from now on. *told gets how many these are. Returns false as plot_where_keep. */
bool plot_only(struct store *s, int n, const struct plot_condition *where, struct text *told,
               struct err *e);

/* plot_columns: print what --x, --y, --by and --where can name in this database: a line each, with
 * its unit. */
bool plot_columns(struct store *s, FILE *out, struct err *e);

#endif
