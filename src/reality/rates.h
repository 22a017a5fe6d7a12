/* rates.h - what counted operations cost on one processor of this computer: fitted to measured
 * times of our own kernels. */
#ifndef REALITY_RATES_H
#define REALITY_RATES_H

#include "base/err.h"
#include "base/work.h"
#include "host/host_comm.h"
#include "measure/real_row.h"
#include "plan/plan.h"
#include "run/run.h"

enum { RATES_MOST = 64 };

/* One kernel at one size on one processor. */
struct rate_sample {
    char what[64];       /* "dynamics, thomas, n = 64" */
    struct work work;    /* counted */
    double seconds;      /* median of the undisturbed repetitions */
    int samples, disturbed;
    struct host_speed before, after; /* how fast this computer was */
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

/* rate_sample_take: one point, `spec`, on one rank in this process: `samples` undisturbed
 * repetitions, fewer after `seconds`. ERR_BUSY when fewer than 3 are undisturbed; else as run_real.
 */
bool rate_sample_take(const struct run_spec *spec, struct host_comm *comm, int samples,
                      double seconds, struct run_cache *cache, struct rate_sample *s,
                      struct err *e);

/* rates_node: a processor with these prices, of `clock` [Hz]. */
struct node_spec rates_node(const struct rates *r, double clock);

/* rates_loops: what has loops of its own (copies, flops, roots, angles, instructions): their least
 * times, or those of `r` where these are less; 0 there: none yet. */
void rates_loops(struct rates *r);

/* rates_fit: the prices of samples that are there. False when they are too few. */
bool rates_fit(struct rates *r);

#endif
