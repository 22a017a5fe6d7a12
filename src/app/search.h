/* search.h - `optimise:` of a scenario: the setting that is best for a goal, for each point of the
 * other axes.
 *
 * Listed values are all tried: they are runs of the plan. Ranges are searched for each combination
 * of them, by GSL's simplex of Nelder and Mead from the best of a few evenly spread points. Every
 * run that is made is stored, so a search that was interrupted repeats none. */
#ifndef APP_SEARCH_H
#define APP_SEARCH_H

#include "app/run_table.h"
#include "plan/plan.h"
#include "store/store.h"

enum { SEARCH_MOST = 100000 }; /* runs of one search, as of a plan */

/* search_check: before anything is run: names and units of goal and limit, and how many runs it may
 * take. Returns true where nothing is optimised; false with ERR_DATA or ERR_CONFIG at the
 * scenario's line. */
bool search_check(const struct plan *p, struct err *e);

/* search_run: the best of each group of p->run, whose runs are stored, into table `optimum`. */
bool search_run(struct plan *p, struct store *s, struct err *e);

/* search_print: these rows, with the value of each setting that differs between runs. */
bool search_print(struct store *s, const struct plan *p, const struct run_table_look *l, FILE *out,
                  struct err *e);

#endif
