/* code_rates.h - what the code of programs in one file costs on one processor of this computer:
 * prices of instructions, loads, stores and chains, fitted to measured times of loops. */
#ifndef REALITY_CODE_RATES_H
#define REALITY_CODE_RATES_H

#include "base/err.h"
#include "plan/plan.h"
#include "reality/passes.h"

enum { CODE_RATES_MOST = 24, CODE_PRICES = 13, CODE_WINDOW = CODE_PRICES - 1 };

/* One loop. */
struct code_sample {
    char what[64];
    double seconds, fitted; /* median of the undisturbed repetitions; by the prices */
    int samples, disturbed;
};

/* Prices in cycles of the processor's clock, in the order of names: node.code.issue, div, root,
 * chain, step, load, whole, add, multiply, fetch, add_latency, multiply_latency; and at CODE_WINDOW
 * 1 / node.code.window, so that time grows with it as with the others. */
struct code_rates {
    double price[CODE_PRICES];        /* [cycles] */
    double residual, median_residual; /* relative: the largest, the median */
    int n;
    struct code_sample sample[CODE_RATES_MOST]; /* (n) */
};

/* code_price_name: the key of price `i` behind "node.code.". */
const char *code_price_name(int i);

/* code_price_window: node.code.window [instructions] of such prices. */
double code_price_window(const double *price);

/* A time that depends on prices: seconds of sample `i` at `price` (CODE_PRICES, cycles). False with
 * an error when it cannot be told. */
typedef bool code_time_fn(void *context, int i, const double *price, double *seconds,
                          struct err *e);

/* code_rates_fit: prices with which the times of `r->n` samples come nearest to those measured, by
 * repeated linear least squares of relative residuals (Gauss and Newton), none negative. Fills
 * price, fitted and residuals. Returns false with the error of `time`, or ERR_DATA: too few
 * samples. */
bool code_rates_fit(struct code_rates *r, code_time_fn *time, void *context, struct err *e);

/* code_rates_take: fit prices to the times that the points of plan `p` took (passes.h), in their
 * order; what divisions, roots and elementary functions cost is that of `node`. Errors as
 * code_rates_fit and run_one. */
bool code_rates_take(const struct plan *p, const struct passes *measured,
                     const struct node_spec *node, struct code_rates *out, struct err *e);

#endif
