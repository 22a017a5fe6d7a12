/* sorted.c - see sorted.h. */
#include "base/sorted.h"

#include <stdlib.h>

/* A difference would lose its sign where it is rounded to an int. */
static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void sort_numbers(double *x, size_t n)
{
    /* Also where there is no array of none. */
    if (n > 1) qsort(x, n, sizeof *x, by_value);
}

double sorted_quantile(const double *sorted, int n, double share)
{
    const double place = share * (n - 1);
    const int below = (int)place;
    if (below + 1 >= n) return sorted[n - 1];
    return sorted[below] + (place - below) * (sorted[below + 1] - sorted[below]);
}
