/* known_error.h - how far predicted times are known: what the view v_known_error needs besides the
 * runs. */
#ifndef APP_KNOWN_ERROR_H
#define APP_KNOWN_ERROR_H

#include "base/err.h"
#include "spec/identity.h"
#include "spec/run_spec.h"
#include "store/store.h"

/* known_error_note: the family of each of n runs that are stored, by which ladders know the errors
 * of their levels (study/level_choice.h).
 *
 *   by  in  what the runs were identified by (plan_options), which knows most of their texts; NULL:
 *           they are printed again
 *
 *   Returns false as store_insert. */
bool known_error_note(struct store *s, struct identity *by, const struct run_spec *run, int n,
                      struct err *e);

#endif
