/* rank_sums.h - what is known of all ranks of a run together: sums and extremes of their times by
 * stage, without the ranks' own. */
#ifndef MEASURE_RANK_SUMS_H
#define MEASURE_RANK_SUMS_H

#include "measure/run_result.h"

/* Least and largest of something over the ranks, and the sum, while it fits into 64 bits. */
struct spread {
    int64_t sum, min, max;
    bool fits;
};

/* One stage over all ranks. */
struct stage_row {
    const char *name; /* borrowed */
    struct spread compute, send, recv, wait, contention, total;
    struct stage_time all; /* messages, bytes and work of all ranks; no times */
};

/* What is known of all ranks together [ps]. */
struct rank_summary {
    bool has_stages, has_finish;
    int64_t accounting_error; /* largest |sum of all parts - makespan| */
    int64_t compute_min, compute_max;
    int64_t finish_min, finish_max;
};

/* Both, of some ranks. */
struct rank_sums {
    struct stage_row stage[RUN_MAX_STAGES]; /* of them nstage, without names */
    struct rank_summary ranks;
};

/* stage_time_total: where the time of a rank went in a stage, all of it [ps]. */
int64_t stage_time_total(const struct stage_time *t);

/* rank_sums_make: of ranks first .. end - 1, from r->stage and r->finish_ps. rank_sums_add: of
 * those of *s and those of *more together, in any order with the same result. */
void rank_sums_make(const struct run_result *r, int first, int end, struct rank_sums *s);
void rank_sums_add(struct rank_sums *s, const struct rank_sums *more);

/* stage_row_make: stage number `stage` of the result over all its ranks; rank_summary_make: all of
 * its stages. Both from r->sums, where the ranks' own times are not kept. */
struct stage_row stage_row_make(const struct run_result *r, int stage);
struct rank_summary rank_summary_make(const struct run_result *r);

#endif
