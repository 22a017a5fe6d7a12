/* gnuplot.h - running the one optional program that draws. */
#ifndef REPORT_GNUPLOT_H
#define REPORT_GNUPLOT_H

#include <stdbool.h>

#include "base/err.h"

/* gnuplot_run: run script `file` in folder `work` with gnuplot from $MIMDSIM_GNUPLOT or PATH,
 * without start-up files. Messages tell `dir`, where its files are to be.
 *
 *   Returns false with ERR_UNAVAILABLE when the program is missing, fails (its first complaint in
 * the text), or takes longer than 120 s or $MIMDSIM_GNUPLOT_SECONDS, after which it is ended. */
bool gnuplot_run(const char *work, const char *dir, const char *file, struct err *e);

#endif
