/* rates.h - what counted operations cost on one processor of this computer: fitted to measured
 * times of our own kernels. */
#ifndef REALITY_RATES_H
#define REALITY_RATES_H

#include "base/err.h"
#include "base/work.h"
#include "plan/plan.h"

enum { RATES_MOST = 64 };

/* One kernel at one size on one processor. */
struct rate_sample {
    char what[64];       /* "dynamics, thomas, n = 64" */
    struct work work;    /* counted */
    double instructions; /* of compiled blocks; 0: a built-in kernel */
    double seconds;      /* median of the undisturbed repetitions */
    int samples, disturbed;
};

/* Prices [s], and how well they explain the samples. */
struct rates {
    double flop, div, sqrt, trig, call, byte, fixed;
    double residual, median_residual; /* relative: the largest, the median */
    double instruction;               /* of compiled programs [s] */
    double copy; /* of a byte that is copied in memory, measured on its own [s/B] */
    int n;
    struct rate_sample sample[RATES_MOST]; /* (n) */
};

/* rates_measure: run the points of plan `p` on one rank in this process, each for at most `seconds`
 * after at least a few repetitions, and fit prices to them. ERR_BUSY when the host disturbs too
 * many of the repetitions; else as run_real. */
bool rates_measure(const struct plan *p, int samples, double seconds, bool quiet, struct rates *out,
                   struct err *e);

/* rates_fit: the prices of samples that are there. False when they are too few. */
bool rates_fit(struct rates *r);

#endif
