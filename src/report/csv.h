/* csv.h - tables as comma-separated values after RFC 4180: a header, CRLF, quotes only where they
 * are needed. */
#ifndef REPORT_CSV_H
#define REPORT_CSV_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/err.h"
#include "store/store.h"

/* csv_cell: one cell, quoted when it holds a quote, a comma, a line end or an outer blank; NULL
 * writes nothing. */
void csv_cell(FILE *out, const char *s, bool last);

/* csv_plain: change what gnuplot cannot read in a text: control characters to blanks, double quotes
 * to apostrophes. */
void csv_plain(char *s);

/* csv_write: the rows of `sql` to `out`, texts as csv_plain makes them. SQL NULL is an empty cell.
 *
 *   run_id  called, when not NULL, with each value of a column named run_id
 *   nrow    out, number of rows */
bool csv_write(struct store *s, const char *sql, int nparam, const char *const *param, FILE *out,
               void (*run_id)(void *context, int64_t id), void *context, int64_t *nrow,
               struct err *e);

#endif
