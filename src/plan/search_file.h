/* search_file.h - `optimise:` of a scenario: which settings may change, for which goal, within
 * which limit.
 *
 *     optimise:
 *       least: makespan                  # or greatest: speedup; a formula of settings and results
 *       within: makespan <= 2 ms         # optional: a condition on settings and results
 *       over:
 *         kernel.solver: [cr, pcr]                                        # every one is tried
 *         machine.network.link.bandwidth: {from: 100 MB/s, to: 1 GB/s}    # searched by a minimiser
 *       runs: 100                        # the most for each combination of listed values
 *
 * Lists become axes like those of a sweep, but for each point of the other axes the best is wanted.
 */
#ifndef PLAN_SEARCH_FILE_H
#define PLAN_SEARCH_FILE_H

#include "plan/scenario_file.h"

/* Adds the axis called `name` with the points of `list` to the scenario. */
typedef bool search_axis_fn(struct scenario *s, const char *name, const struct node *list,
                            struct arena *a, struct err *e);

/* search_file_read: s->search from the mapping `n`, and by `add_axis` the axes of its lists.
 * Returns false with ERR_DATA. */
bool search_file_read(struct scenario *s, const struct node *n, search_axis_fn *add_axis,
                      struct arena *a, struct err *e);

/* search_file_drop: --set gives `key` (in full) a value: it is searched no more. */
void search_file_drop(struct scenario *s, const char *key);

/* search_file_check: what has to hold once all of the file has been read: a key is not both
 * searched and set. */
bool search_file_check(const struct scenario *s, struct err *e);

#endif
