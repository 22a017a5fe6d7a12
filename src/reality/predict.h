/* predict.h - a simulated run beside a measured one: by stage, and which parameter of the machine
 * would have to be another one. */
#ifndef REALITY_PREDICT_H
#define REALITY_PREDICT_H

#include "base/err.h"
#include "measure/real_row.h"
#include "run/run.h"

/* Groups of parameters that act alike. */
enum price_group {
    PRICE_FLOP,
    PRICE_DIV,
    PRICE_SQRT,
    PRICE_TRIG,
    PRICE_CALL,
    PRICE_COPY,
    PRICE_INSTRUCTION,
    PRICE_CODE,
    PRICE_SEND,
    PRICE_RECV,
    PRICE_LATENCY,
    PRICE_BYTES,
    PRICES
};

/* price_name: "node.flop_rate", ... price_scale: the machine with the times of the group multiplied
 * by `factor`. */
const char *price_name(enum price_group g);
void price_scale(struct machine_spec *m, enum price_group g, double factor);

struct predicted_stage {
    char name[24];
    double predicted, measured; /* mean over the ranks [s]; NaN: the other one has no such stage */
};

struct prediction {
    double predicted, measured; /* [s] */
    double error;               /* (predicted - measured) / measured */
    int nstage;
    struct predicted_stage stage[RUN_MAX_STAGES + 1];
    int worst;                   /* stage with the largest difference in time, -1: no stages */
    double contribution[PRICES]; /* time that grows with the group's prices [s] */
    enum price_group explains;   /* the group that needs the least change; PRICES: none helps */
    double factor;               /* by which its times would have to change */
};

/* predict_simulate: run_sharing, and ERR_CHECK when the simulated run is not RUN_OK. predict_time:
 * its simulated time alone [s], without a check of the answer and without serial codes; false as
 * predict_simulate. */
bool predict_simulate(const struct run_spec *spec, struct run_cache *cache, struct arena *a,
                      struct run_result *out, struct err *e);
bool predict_time(const struct run_spec *spec, struct run_cache *cache, double *seconds,
                  struct err *e);

/* predict_run: simulate `spec` on its machine, and once more for each group of prices.
 *
 *   real  in  the measured times and stages (time.median and stage[].median_s)
 *
 *   Returns false as run_one; ERR_CHECK when the simulated run is not RUN_OK. */
bool predict_run(const struct run_spec *spec, const struct real_result *real,
                 struct run_cache *cache, struct prediction *out, struct err *e);

#endif
