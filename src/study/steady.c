/* steady.c - see steady.h. */
#include "study/steady.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <math.h>

#include "base/check.h"

enum { FIVE = 5, SPARED = 5 }; /* observations in a batch of MSER-5; batches it must leave */

static double mean_of(const double *x, int64_t n)
{
    double sum = 0;
    for (int64_t i = 0; i < n; i++) sum += x[i];
    return sum / (double)n;
}

int64_t steady_mser(const double *x, int64_t n, bool *settled)
{
    int64_t m = n / FIVE, best = 0;
    double sum = 0, square = 0, least = INFINITY;
    CHECK(n >= 2 * FIVE);
    /* Deviations from the mean of all: sums of squares then lose no digits. */
    const double centre = mean_of(x, n);
    /* From the end, so that each step adds one batch to the sums. The last few batches alone are
     * no state: their variance is small by chance. */
    for (int64_t d = m - 1; d >= 0; d--) {
        double z = mean_of(x + d * FIVE, FIVE) - centre, left = (double)(m - d);
        sum += z;
        square += z * z;
        double error = (square - sum * sum / left) / (left * left);
        /* of equal errors the shorter warm-up */
        if (m - d >= SPARED && error <= least) least = error, best = d;
    }
    *settled = best <= m / 2;
    return FIVE * (*settled ? best : m / 2);
}

/* Mean, interval, autocorrelation and trend of the batch means y (STEADY_BATCHES). */
static void judge(struct steady *s, const double *y)
{
    enum { K = STEADY_BATCHES };
    double x[K], c0, c1, cov00, cov01, cov11, squares = 0, variance = 0, product = 0;
    const double mean = mean_of(y, K);
    for (int i = 0; i < K; i++) {
        x[i] = i;
        variance += (y[i] - mean) * (y[i] - mean) / (K - 1);
        if (i > 0) product += (y[i] - mean) * (y[i - 1] - mean) / (K - 1);
    }
    s->half = gsl_cdf_tdist_Pinv(0.975, K - 1) * sqrt(variance / K);
    s->lag = variance > 0 ? product / variance : 0;
    /* Least squares; cov11 is the variance of the slope c1. */
    gsl_fit_linear(x, 1, y, 1, K, &c0, &c1, &cov00, &cov01, &cov11, &squares);
    s->trend = cov11 > 0 ? c1 / sqrt(cov11) : 0;
    s->trend_99 = gsl_cdf_tdist_Pinv(0.995, K - 2);
}

struct steady steady_state(const double *x, int64_t n)
{
    struct steady s = {0};
    double y[STEADY_BATCHES];
    CHECK(n >= STEADY_LEAST);
    s.warmup = steady_mser(x, n, &s.settled);
    /* Batches of equal length; what does not fit is left out at the beginning, with the warm-up. */
    const int64_t each = (n - s.warmup) / STEADY_BATCHES;
    const double *from = x + n - each * STEADY_BATCHES;
    s.warmup = n - each * STEADY_BATCHES;
    for (int i = 0; i < STEADY_BATCHES; i++) y[i] = mean_of(from + i * each, each);
    s.mean = mean_of(y, STEADY_BATCHES);
    judge(&s, y);
    return s;
}

double steady_quantile(const double *sorted, int64_t n, double q)
{
    int64_t rank = (int64_t)ceil(q * (double)n);
    CHECK(n >= 1);
    /* ranks are counted from 1 */
    rank = rank < 1 ? 1 : rank > n ? n : rank;
    return sorted[rank - 1];
}
