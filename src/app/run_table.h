/* run_table.h - what `mimdsim run` answers: one row a run of the plan, one column a key that the scenario sweeps. */
#ifndef APP_RUN_TABLE_H
#define APP_RUN_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "plan/plan.h"
#include "store/store.h"

/* run_table_print: the runs of `p` that `s` holds, in plan order, as a table or (json) as one document. The keys that
 * are swept stand behind P, each by the end of its name that no other column has: link.bandwidth.
 * Returns false with ERR_IO. */
bool run_table_print(struct store *s, const struct plan *p, bool json, FILE *out, struct err *e);

#endif
