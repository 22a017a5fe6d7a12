/* report.h - tables and figures out of the database; gnuplot's language lives in plots/ alone. */
#ifndef REPORT_REPORT_H
#define REPORT_REPORT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/err.h"
#include "base/json.h"
#include "base/text.h"
#include "store/store.h"

/* report_figure: draw figure `name` (plots/NAME.sql + plots/NAME.gp) from `s` into folder `dir`
 * (made if missing): NAME.csv, NAME.gp, NAME.png, NAME.svg; all its drawings when it has several.
 * `data_dir` holds plots/.
 *
 *   Returns false with ERR_NO_INPUT (no such figure: nearest name; no rows for it: what to run
 * first), ERR_CREATE, or ERR_UNAVAILABLE (gnuplot missing; the CSV and the script are there all the
 * same). */
bool report_figure(struct store *s, const char *data_dir, const char *name, const char *dir,
                   struct err *e);

/* What a figure's name stands for: itself, or one drawing for each scenario of the database. */
struct report_drawings {
    char figure[64];   /* whose description draws them */
    int n;
    char **which, **as; /* (n) the row that is shown, "" for all; the name of the files. Owned */
    char **of;          /* (n) the name of all drawings that belong together, or `as`. Owned */
};

/* report_drawings_find: the drawings of `name`: a figure ("accuracy": all of them), some that
 * belong together
 * ("accuracy-four-bar"), or a single one ("accuracy-four-bar-network"). Returns false with
 * ERR_NO_INPUT as report_figure does, then with nothing to free. */
bool report_drawings_find(struct store *s, const char *data_dir, const char *name,
                          struct report_drawings *d, struct err *e);

/* report_drawings_free: what report_drawings_find allocated. */
void report_drawings_free(struct report_drawings *d);

/* report_figure_run: the same of the one run `run_id`: NAME.sql finds it bound to ?1; the files are
 * called `as`. */
bool report_figure_run(struct store *s, const char *data_dir, const char *name, int64_t run_id,
                       const char *as, const char *dir, struct err *e);

/* report_folder: make folder `dir` and those above it, where they are missing. Returns false with
 * ERR_CREATE. */
bool report_folder(const char *dir, struct err *e);

/* report_folder_check: whether report_folder could make `dir`, or files could be made in it, for a
 * verb that computes first: nothing is made. Returns false with ERR_CREATE. */
bool report_folder_check(const char *dir, struct err *e);

/* report_figures: the names of all figures in data_dir/plots, sorted; returns how many; names owned
 * by the caller (free each and the array). */
int report_figures(const char *data_dir, char ***name);

/* report_figure_about: what figure `name` shows, as much of the first sentence of its description
 * as a line holds
 * (*title), and the command that fills a database for it (*needs); "" when it does not say. The
 * caller frees both. */
void report_figure_about(const char *data_dir, const char *name, struct text *title,
                         struct text *needs);

/* report_value_json: one value of a row as the next value of a document. */
void report_value_json(struct json *j, const struct store_value *v);

/* How a table is shown. */
struct report_look {
    bool compact; /* columns without any value are left out */
    int width;    /* characters that a line may have, 0: any number */
};

/* report_table: print the rows of `sql` as an aligned table on `out`. */
bool report_table(struct store *s, const char *sql, int nparam, const char *const *param,
                  const struct report_look *look, FILE *out, struct err *e);

/* report_query: print the rows of `sql` as an aligned table (or as JSON, one document with
 * sorted keys) on `out`. */
bool report_query(struct store *s, const char *sql, int nparam, const char *const *param, bool json,
                  FILE *out, struct err *e);

#endif
