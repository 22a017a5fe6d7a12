/* measured_run.h - measured runs as the database has them: the latest of a task, with its stages
 * and the condition of the computer. */
#ifndef APP_MEASURED_RUN_H
#define APP_MEASURED_RUN_H

#include "measure/real_row.h"
#include "reality/condition.h"
#include "store/store.h"

/* Where and when, and what a comparison needs of it. */
struct measured_run {
    bool found;
    char id[32], host[64], utc[32];
    struct real_result real; /* times, load, stages; no samples */
    struct condition condition;
};

/* measured_run_find: the latest measurement of `task` (config_hash) that went well, from whichever
 * computer it is; out->found: there is one. False as store_query. */
bool measured_run_find(struct store *s, const char *task, struct measured_run *out, struct err *e);

/* measured_run_left_out: why a run counts for no error, "": it does. */
const char *measured_run_left_out(const struct measured_run *m);

#endif
