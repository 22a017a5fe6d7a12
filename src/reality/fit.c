/* fit.c - see fit.h. Least squares by GSL; what may not be negative is left out until nothing is.
 *
 * Leaving out the most negative unknown and fitting again is the outer loop of Lawson and Hanson's
 * active-set method (Solving Least Squares Problems, 1974, chapter 23) without its way back in,
 * which some tens of well-spread equations with seven unknowns do not need. */
#include "reality/fit.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>

#include "base/check.h"
#include "base/sorted.h"

/* Residual of equation i under prices x, relative to its y. */
static double relative_residual(const double *row, double y, const double *x, int k)
{
    double sum = 0;
    for (int j = 0; j < k; j++) sum += row[j] * x[j];
    return fabs(sum - y) / y;
}

static double largest_residual(const double *count, const double *y, int n, int k, const double *x)
{
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, relative_residual(count + i * k, y[i], x, k));
    return most;
}

static bool column_is_zero(const double *count, int n, int k, int j)
{
    for (int i = 0; i < n; i++)
        if (count[i * k + j] != 0) return false;
    return true;
}

/* One least squares fit of the unknowns in `used`; those that are not are 0 in x. Each equation is
 * divided by its y, and each column by its largest entry, so that the solver's notion of rank does
 * not depend on units. */
static void solve(const double *count, const double *y, int n, int k, const bool *used, double *x)
{
    int place[FIT_MOST_UNKNOWNS], m = 0;
    for (int j = 0; j < k; j++) {
        x[j] = 0;
        if (used[j]) place[m++] = j;
    }
    if (m == 0) return;
    gsl_matrix *a = gsl_matrix_alloc((size_t)n, (size_t)m),
               *covariance = gsl_matrix_alloc((size_t)m, (size_t)m);
    gsl_vector *one = gsl_vector_alloc((size_t)n), *c = gsl_vector_alloc((size_t)m);
    gsl_multifit_linear_workspace *w = gsl_multifit_linear_alloc((size_t)n, (size_t)m);
    double scale[FIT_MOST_UNKNOWNS], chi;
    for (int j = 0; j < m; j++) {
        scale[j] = 0;
        for (int i = 0; i < n; i++) scale[j] = fmax(scale[j], count[i * k + place[j]] / y[i]);
    }
    for (int i = 0; i < n; i++) {
        gsl_vector_set(one, (size_t)i, 1);
        for (int j = 0; j < m; j++)
            gsl_matrix_set(a, (size_t)i, (size_t)j, count[i * k + place[j]] / y[i] / scale[j]);
    }
    CHECK(gsl_multifit_linear(a, one, c, covariance, &chi, w) == GSL_SUCCESS);
    for (int j = 0; j < m; j++) x[place[j]] = gsl_vector_get(c, (size_t)j) / scale[j];
    gsl_multifit_linear_free(w);
    gsl_vector_free(c);
    gsl_vector_free(one);
    gsl_matrix_free(covariance);
    gsl_matrix_free(a);
}

/* The unknown whose share of the equations is most negative, -1: none is. */
static int most_negative(const double *count, const double *y, int n, int k, const double *x)
{
    int worst = -1;
    double least = 0;
    for (int j = 0; j < k; j++) {
        double share = 0;
        for (int i = 0; i < n; i++) share += count[i * k + j] * x[j] / y[i];
        if (x[j] >= 0 || share >= least) continue;
        least = share;
        worst = j;
    }
    return worst;
}

bool fit_prices(const double *count, const double *y, int n, int k, double *x, double *residual)
{
    bool used[FIT_MOST_UNKNOWNS];
    int left = 0;
    CHECK(k <= FIT_MOST_UNKNOWNS);
    for (int j = 0; j < k; j++) {
        used[j] = !column_is_zero(count, n, k, j);
        left += used[j];
    }
    if (left == 0 || n < left) return false;
    /* At most one unknown goes at a time: another one may come out positive without it. */
    for (int worst;;) {
        solve(count, y, n, k, used, x);
        worst = most_negative(count, y, n, k, x);
        if (worst < 0) break;
        used[worst] = false;
    }
    *residual = largest_residual(count, y, n, k, x);
    return true;
}

/* The same with two unknowns: the constant and the slope. */
struct fit_line fit_line_of(const double *x, const double *y, int n)
{
    double count[2 * 64], price[2], safe[64], least = INFINITY;
    struct fit_line l = {0};
    CHECK(n >= 1 && n <= 64);
    for (int i = 0; i < n; i++)
        if (y[i] > 0) least = fmin(least, y[i]);
    if (isinf(least)) return l;
    bool alike = true;
    for (int i = 0; i < n; i++) {
        count[2 * i] = 1;
        count[2 * i + 1] = x[i];
        safe[i] = y[i] > 0 ? y[i] : least;
        alike = alike && x[i] == x[0];
    }
    /* A slope cannot be told from one size. */
    for (int i = 0; alike && i < n; i++) count[2 * i + 1] = 0;
    if (n == 1) return (struct fit_line){safe[0], 0, 0};
    if (fit_prices(count, safe, n, 2, price, &l.residual)) {
        l.at_zero = price[0];
        l.slope = price[1];
    }
    return l;
}

void fit_residuals(double *off, int n, double *median, double *largest)
{
    *median = *largest = 0;
    if (n == 0) return;
    sort_numbers(off, (size_t)n);
    *median = off[n / 2];
    *largest = off[n - 1];
}
