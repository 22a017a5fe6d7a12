/* levels.h - level 'auto-tolerance' settled from the ladders in the database, or from one measured
 * first. */
#ifndef APP_LEVELS_H
#define APP_LEVELS_H

#include <stdbool.h>

#include "base/err.h"
#include "store/store.h"
#include "study/accuracy.h"

/* ladder_store: the rungs of a report into table ladder, inside the caller's transaction. */
bool ladder_store(struct store *s, const struct accuracy_report *r, struct err *e);

/* levels_settle: every run (nrun) that asks for level 'auto-tolerance' becomes the run at the
 * cheapest level whose stored error is within its tolerance; where no ladder of its family is
 * stored, one is climbed and stored first. What was taken is said on stderr, unless `quiet` or
 * unless the runs are stored.
 *
 *   run    in, out  (nrun) copies of the plan's runs, which stay as they are; new identities have
 * their texts in `a` order  in, out  (nrun) level_choice is filled where a level was taken
 *
 *   Returns false with ERR_CONFIG when no level is good enough, or as accuracy_measure and
 * store_insert. */
bool levels_settle(struct store *s, struct run_spec *run, struct run_order *order, int nrun,
                   bool quiet, struct arena *a, struct err *e);

#endif
