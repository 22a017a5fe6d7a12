/* variance.h - how much of a result's variance each input explains: Sobol' indices by Saltelli's
 * design.
 *
 * For y = f(x) with independent x_i, uniform in [0, 1):
 *
 *     first_i = V(E(y | x_i)) / V(y)             what x_i explains alone
 *     total_i = E(V(y | all but x_i)) / V(y)     with all its interactions
 *
 * Two independent samples A and B of n points, and for each i the sample A with column i of B, give
 * both with n (k + 2) evaluations (Saltelli et al. 2010, Computer Physics Communications 181, table
 * 2: (b) for first, Jansen's (f) for total). */
#ifndef STUDY_VARIANCE_H
#define STUDY_VARIANCE_H

#include <stdbool.h>
#include <stdint.h>

/* variance_rows: n (k + 2): how many points the design has; n k-vectors each of A, B, then of input
 * 0, 1, ... */
int64_t variance_rows(int n, int k);

/* variance_design: the points of the design, out of a Sobol' sequence in 2k dimensions, of a Latin
 * hypercube beyond its 40.
 *
 *   u  out  (variance_rows x k) in [0, 1) */
void variance_design(uint64_t seed, int n, int k, double *u);

/* Shares of one input with their standard errors (bootstrap over the n points). They can leave [0,
 * 1] by as much: they are estimates. */
struct variance_share {
    double first, first_error, total, total_error;
};

/* variance_shares: out of the results at the points of the design.
 *
 *   y      in   (variance_rows), finite
 *   share  out  (k); NaN when nothing varies
 *   Returns the variance of A and B together. */
double variance_shares(int n, int k, const double *y, struct variance_share *share);

/* What is told of many results. */
struct variance_band {
    double mean, deviation, low, median,
        high; /* low and high: 5 % and 95 % of the results lie below */
    int n;
};

/* variance_band: of the finite ones among n results; y is sorted by it. n of 0: all NaN. */
struct variance_band variance_band(int n, double *y);

#endif
