/* plot_points.h - rows of a plot as points of curves: which rows make one point, how far they
 * spread. */
#ifndef REPORT_PLOT_POINTS_H
#define REPORT_PLOT_POINTS_H

#include "base/text.h"
#include "report/plot_sheet.h"

enum { MOST_BY = 8, MOST_SERIES = 6, MOST_PANELS = 12 };

/* Which columns are what. */
struct plot_axes {
    int x, y; /* y: of a heat map, -1 of all others */
    int value;
    int nby, by[MOST_BY];
    bool by_given; /* else the columns that tell the rows of one point apart are added */
};

struct plot_point {
    int panel, series, xi, yi; /* from 0; xi and yi in the order of the axis */
    double value, low, high;   /* mean; low and high are NAN where there is one row */
    int rows, row;             /* how many rows it stands for, and the first of them */
};

struct plot_points {
    int n, nx, ny, npanel, nseries;
    struct plot_point *at;      /* (n) by panel, series, x; in the sheet's arena, as all below */
    const char **panel, **series; /* what they are called */
    int *x, *y;                 /* (nx), (ny) a row that has each value of the axis */
    bool band;                  /* some point has low and high */
    int repeated, mixed;        /* points of repetitions of one run; of runs that differ in more */
    struct text differ;         /* owned: in what those differ */
    int unknown;                /* rows without a value or a place on the axes */
};

/* plot_points_make: the points of the sheet's rows. Of several rows in one place the mean;
 * repetitions of one run with the 95 % confidence interval of the mean (Student's t), others with
 * the range. *axes gets the columns that were added. Returns false with ERR_NO_INPUT (nothing to
 * draw) or ERR_USAGE (more curves than can be told apart). */
bool plot_points_make(struct plot_points *p, const struct plot_sheet *sheet, struct plot_axes *axes,
                      struct err *e);

#endif
