/* upgrade_runs.h - the identities of an older database's runs, computed anew. */
#ifndef STORE_UPGRADE_RUNS_H
#define STORE_UPGRADE_RUNS_H

#include "store/connection.h"

/* upgrade_runs: config_hash of every run anew from its config_text, within the caller's
 * transaction, in tables that have this version's schema already. *kept runs could not be
 * described: they keep their hash and get a row in run_older. */
bool upgrade_runs(struct store *s, int version, int64_t *kept, struct err *e);

#endif
