/* run_row.h - a run as rows of tables: what is known of all ranks together, and the columns of
 * every result struct. */
#ifndef MEASURE_RUN_ROW_H
#define MEASURE_RUN_ROW_H

#include "measure/column.h"
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

/* One run: what it was asked and what came of it. */
struct run_row {
    const struct run_spec *spec;     /* borrowed; its columns stand where the struct is known */
    const struct run_order *order;   /* borrowed, NULL: executed as usual */
    const struct run_result *result; /* borrowed */
    struct rank_summary ranks;
    struct text left_out; /* owned: the omissions as one text */
};

/* stage_time_total: where the time of a rank went in a stage, all of it [ps]. */
int64_t stage_time_total(const struct stage_time *t);

/* omission_class: "exact" or "bounded". */
const char *omission_class(const struct omission *o);

/* stage_time_idle: a rank that did nothing in a stage has no row of its own. */
bool stage_time_idle(const struct stage_time *t);

/* stage_row_make: stage number `stage` of the result over all its ranks. */
struct stage_row stage_row_make(const struct run_result *r, int stage);

/* run_row_make: the row of a run; ended by run_row_free. */
struct run_row run_row_make(const struct run_spec *spec, const struct run_order *order,
                            const struct run_result *r);
void run_row_free(struct run_row *row);

/* The columns: of struct run_row, how it ended, and which refinements it added; then of the structs
 * named. */
extern const struct column_table run_outcome_columns, run_refinement_columns, stage_row_columns,
    stage_time_columns, baseline_columns, error_check_columns, omission_columns, link_load_columns,
    span_columns;

#endif
