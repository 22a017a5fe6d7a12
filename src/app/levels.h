/* levels.h - level 'auto-tolerance' settled from the ladders in the database, or from one measured first. */
#ifndef APP_LEVELS_H
#define APP_LEVELS_H

#include <stdbool.h>

#include "base/err.h"
#include "store/store.h"
#include "study/accuracy.h"

/* ladder_store: the rungs of a report into table ladder, inside the caller's transaction. */
bool ladder_store(struct store *s, const struct accuracy_report *r, struct err *e);

/* levels_settle: every run (nrun) that asks for level 'auto-tolerance' takes the cheapest level whose stored error is
 * within its tolerance; where no ladder of its family is stored, one is climbed and stored first. Runs with `skip` set
 * (may be NULL) are left alone. What was taken is said on stderr unless `quiet`.
 *
 *   Returns false with ERR_CONFIG when no level is good enough, or as accuracy_measure and store_insert. */
bool levels_settle(struct store *s, struct run_spec *run, int nrun, const bool *skip, bool quiet, struct err *e);

#endif
