/* fit.h - numbers that explain measured times: lines over sizes, and prices of counted operations,
 * none of them negative.
 *
 * Errors of measured times are relative: a microsecond in a millisecond counts as much as a
 * nanosecond in a microsecond. So all fits minimise relative residuals. */
#ifndef REALITY_FIT_H
#define REALITY_FIT_H

#include <stdbool.h>

enum { FIT_MOST_UNKNOWNS = 16 };

/* y = at_zero + slope x, both >= 0; residual: the largest relative one of the points. */
struct fit_line {
    double at_zero, slope, residual;
};

/* fit_line_of: through n >= 1 points with y > 0 (y = 0 counts with the weight of the least other
 * one). One point, or x all alike: a constant. */
struct fit_line fit_line_of(const double *x, const double *y, int n);

/* fit_prices: x (k <= FIT_MOST_UNKNOWNS), all >= 0, with sum_j count[i][j] x[j] near y[i] > 0 for
 * i < n; rows of `count` are k long. A column that is all zero, and one whose price comes out
 * negative, gets price 0 and the fit is made without it.
 *
 *   residual  out  largest relative residual
 *
 *   Returns false when there are fewer equations than unknowns that are left. */
bool fit_prices(const double *count, const double *y, int n, int k, double *x, double *residual);

/* fit_residuals: the median (the upper one of two) and the largest of n residuals off[i] >= 0, 0
 * where there are none; sorts them. */
void fit_residuals(double *off, int n, double *median, double *largest);

#endif
