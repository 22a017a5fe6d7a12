/* compare.h - sets of stored runs held against each other: settings, results, where the time
 * goes. */
#ifndef REPORT_COMPARE_H
#define REPORT_COMPARE_H

#include <stdio.h>

#include "base/arena.h"
#include "store/store.h"

enum { MOST_SIDES = 6, COMPARE_PARTS = 4 };

/* One set of runs: of a machine, a database, a scenario, or a single run. */
struct compare_side {
    const char *name;      /* what the user calls it */
    struct store *store;   /* borrowed, open for reading or writing */
    const char *run_ids;   /* JSON array */
    int nrun;              /* that ended well */
    bool machines;         /* its runs are on several machines */
};

/* A setting that has one value on each side, but not the same. */
struct compare_difference {
    const char *key;
    const char *value[MOST_SIDES];
};

/* What one side has at one point. */
struct compare_cell {
    int runs;          /* 0: no such run */
    int64_t run;       /* the first of them */
    double makespan;   /* mean [s] */
    double half;       /* of the 95 % confidence interval [s], 0: one run */
    /* computing, overhead, waiting, contention [s], mean over the ranks */
    double part[COMPARE_PARTS];
};

/* Runs of several sides that agree in everything but what the sides differ in. */
struct compare_point {
    const char *name;  /* "n 16, link" */
    double x;          /* the first number of it, NAN: none */
    struct compare_cell cell[MOST_SIDES];
};

struct compare {
    struct arena *arena; /* owned */
    int nside, ndifference, npoint, ncommon; /* points that all sides have come first */
    struct compare_side side[MOST_SIDES];
    struct compare_difference *difference;
    struct compare_point *point;
    bool x_only;         /* the points differ in x alone */
    const char *x_name;  /* what x is */
};

extern const char *const compare_part[COMPARE_PARTS]; /* what the parts are called */

/* compare_make: pair the runs of `n` sides (2 .. MOST_SIDES). Settings of the machine make no
 * point: a machine is what is compared; where a side has several, its name does. Returns false with
 * ERR_NO_INPUT (a side without runs, or no point that two sides have), or as store_query.
 * compare_free ends it either way. */
bool compare_make(struct compare *c, int n, const struct compare_side *side, struct err *e);

/* compare_free: accepts what compare_make left. */
void compare_free(struct compare *c);

/* compare_ratio: time of side `side` over that of the first at a point; *error gets the relative
 * half width of its 95 % confidence interval, 0: both are single runs. NAN when one is missing. */
double compare_ratio(const struct compare_point *p, int side, double *error);

/* compare_print: differences, results with ratios, where the time goes at the largest common point;
 * as text or as one JSON document with sorted keys. */
void compare_print(const struct compare *c, bool json, FILE *out);

/* compare_draw: all sides in one figure, `as` its files in folder `dir`. Returns false as
 * report_figure. */
bool compare_draw(const struct compare *c, const char *data_dir, const char *dir, const char *as,
                  struct err *e);

#endif
