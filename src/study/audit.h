/* audit.h - a database held against itself: what its rows must say of each other, and stored runs
 * made again.
 *
 * Rows of one run repeat each other on purpose: ranks add up to stages, stages to the makespan,
 * settings are lines of the configuration, whose hash is the identity. A row that was changed, lost
 * or mixed up contradicts others. What repeats nothing, such as the digest of the messages, is
 * compared with the same run made again, bit by bit. */
#ifndef STUDY_AUDIT_H
#define STUDY_AUDIT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "store/store.h"

enum { AUDIT_ALL = -1, AUDIT_KEPT = 1000 };

struct audit_options {
    int again;     /* how many runs are made again, chosen at random; AUDIT_ALL: all */
    uint64_t seed; /* of that choice */
    int jobs;      /* worker processes, 0: one a processor */
    bool quiet;
};

/* One contradiction. Texts lie in the report's arena. */
struct audit_finding {
    int64_t run;      /* its row in table run, 0: none */
    const char *rule; /* short name: "stages", "identity", "again" */
    const char *text;
};

struct audit_report {
    struct arena *arena; /* borrowed */
    int64_t nrun;
    int nrule;
    int nagain; /* runs made again */
    int nleft;  /* chosen, but not made again: failed ones, and those whose model is a file */
    int64_t nfinding;
    struct audit_finding finding[AUDIT_KEPT]; /* the first of them */
};

/* audit_database: all rules on all rows of `s`, then the runs made again.
 *
 *   a  in   memory of *r
 *
 *   Returns true whatever is found; false when the database cannot be read: ERR_DATA, ERR_BUSY,
 * ERR_IO. */
bool audit_database(struct store *s, const struct audit_options *o, struct arena *a,
                    struct audit_report *r, struct err *e);

#endif
