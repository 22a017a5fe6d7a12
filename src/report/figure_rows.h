/* figure_rows.h - which runs a figure shows and which it leaves out, by what they are called. */
#ifndef REPORT_FIGURE_ROWS_H
#define REPORT_FIGURE_ROWS_H

#include "base/text.h"
#include "store/store.h"

/* figure_rows: a clause about a figure that shows the runs of the JSON array `run_ids`, appended:
 * "t3e-300; left out: 14 runs on t3e-300, hop_latency 60 us". Left out are runs of the same
 * programs on machines that are not shown; where there are none and all machines are as shipped,
 * nothing is appended. Returns false as store_select. */
bool figure_rows(struct store *s, const char *run_ids, struct text *out, struct err *e);

#endif
