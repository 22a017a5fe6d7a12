/* steady.h - the steady state of a simulated series: where the warm-up ends, the mean with its
 * confidence interval, and whether there is a steady state at all.
 *
 * Warm-up: MSER-5 (K. P. White, M. J. Cobb, S. C. Spratt, "A comparison of five steady-state
 * truncation heuristics for simulation", Winter Simulation Conference 2000). With the means z_j of
 * m batches of five observations, the first d batches are left out, where d minimises the squared
 * standard error
 *
 *     MSER(d) = sum_{j >= d} (z_j - mean_{j >= d} z)^2 / (m - d)^2
 *
 * A minimum in the second half means that the series is too short or has no steady state.
 *
 * Mean: what is left is cut into k = 20 batches of equal length (B. Schmeiser, "Batch size effects
 * in the analysis of simulation output", Operations Research 30, 1982: 10 to 30). With the standard
 * deviation s of their means, the 95 % interval is mean +- t_{0.975, k-1} s / sqrt(k). It presumes
 * that batch means are uncorrelated: their lag-1 autocorrelation is told.
 *
 * Trend: the t statistic of the slope of a straight line through the batch means; of a series
 * without trend it has Student's distribution with k - 2 degrees of freedom. */
#ifndef STUDY_STEADY_H
#define STUDY_STEADY_H

#include <stdbool.h>
#include <stdint.h>

enum { STEADY_BATCHES = 20, STEADY_LEAST = 200 }; /* fewer observations tell nothing */

struct steady {
    int64_t warmup;  /* observations left out at the beginning */
    bool settled;    /* MSER-5 found the warm-up in the first half */
    double mean;     /* of the rest */
    double half;     /* half the width of its 95 % confidence interval */
    double lag;      /* lag-1 autocorrelation of the batch means */
    double trend;    /* t statistic of their slope; 0 where nothing varies */
    double trend_99; /* what it exceeds by chance in one of 200 series without trend */
};

/* steady_state: of n >= STEADY_LEAST observations x in the order of time. */
struct steady steady_state(const double *x, int64_t n);

/* steady_mser: the number of observations, a multiple of 5, that MSER-5 leaves out of n >= 10; at
 * most half of them. *settled: the minimum is in the first half. */
int64_t steady_mser(const double *x, int64_t n, bool *settled);

/* steady_quantile: the least of n >= 1 sorted values that at least the share q of them does not
 * exceed (nearest rank). */
double steady_quantile(const double *sorted, int64_t n, double q);

#endif
