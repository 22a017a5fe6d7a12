/* run_row.h - a run as rows of tables: what is known of all ranks together, and the columns of
 * every result struct. */
#ifndef MEASURE_RUN_ROW_H
#define MEASURE_RUN_ROW_H

#include "measure/column.h"
#include "measure/rank_sums.h"

/* One run: what it was asked and what came of it. */
struct run_row {
    const struct run_spec *spec;     /* borrowed; its columns stand where the struct is known */
    const struct run_order *order;   /* borrowed, NULL: executed as usual */
    const struct run_result *result; /* borrowed */
    struct rank_summary ranks;
    struct text left_out; /* owned: the omissions as one text */
};

/* omission_class: "exact" or "bounded". */
const char *omission_class(const struct omission *o);

/* stage_time_idle: a rank that did nothing in a stage has no row of its own. */
bool stage_time_idle(const struct stage_time *t);

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
