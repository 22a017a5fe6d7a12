/* sorted.h - numbers in rising order, and what lies between them. */
#ifndef BASE_SORTED_H
#define BASE_SORTED_H

#include <stddef.h>

/* sort_numbers: the n numbers of x, none of them a NaN, from the least to the largest. */
void sort_numbers(double *x, size_t n);

/* sorted_quantile: the number below which the part `share` (0 .. 1) of n >= 1 sorted ones lies:
 * between the two neighbours of place (n - 1) share in proportion, as most programs of statistics
 * have it (type 7 of Hyndman and Fan, "Sample quantiles in statistical packages", 1996). */
double sorted_quantile(const double *sorted, int n, double share);

#endif
