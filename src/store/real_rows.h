/* real_rows.h - runs on real computers as rows: tables real_run, real_stage, real_sample. */
#ifndef STORE_REAL_ROWS_H
#define STORE_REAL_ROWS_H

#include "measure/real_row.h"
#include "store/store.h"

/* What was run, whatever it ran on. */
struct real_task {
    const char *hash;     /* SHA-256 of all settings but the machine's: task_identity */
    const char *scenario; /* its name, or the command that was recorded */
    const char *program;
    int n;                /* bodies; 0: it has no scene */
    const char *settings; /* all of them as "key = value" lines, or the command's arguments */
};

/* store_put_real: the run with its stages and samples, in one transaction; nothing is stored on
 * failure. Each call adds a row: what was measured at another time is another row. Returns false as
 * store_insert. */
bool store_put_real(struct store *s, const struct real_task *task, const struct real_result *r,
                    struct err *e);

#endif
