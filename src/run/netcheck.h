/* netcheck.h - the network levels against a reference's answers: every case of a file at every level wanted.
 *
 * Files are JSON lists of cases in one of five forms, told apart by their keys: one-step makespans (`completion`),
 * collectives (`trace`), latency against load (`points`), hand-derived cases (`messages`, expected times) and bands
 * of makespans over router variants (`makespan_by_variant`). Times are cycles. */
#ifndef RUN_NETCHECK_H
#define RUN_NETCHECK_H

#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/json.h"
#include "spec/machine_spec.h"

enum { NETCHECK_LEVELS = LEVEL_AUTO + 1 };

/* What one level answered to one case. */
struct netcheck_answer {
    bool ran;             /* false: the level cannot run this case, see why */
    bool deadlock;        /* the network was stuck */
    double found;         /* makespan or mean latency [cycles] */
    double error;         /* (found - reference) / reference; against a band: to its nearer end, 0 inside */
    int differing;        /* messages whose arrival differs from the reference's */
    double message_error; /* mean over messages of |arrival - reference| / reference */
    int64_t events;
    char why[160];
};

struct netcheck_row {
    char name[112]; /* topology, pattern, size, channels, buffer */
    char group[56]; /* what it is counted with: family, channels, buffer */
    int nmessage;
    bool compared; /* messages have reference arrivals */
    bool expect_deadlock;
    bool counted;     /* false: the reference itself was unstable here; shown, not counted */
    double low, high; /* reference [cycles], equal but for a band */
    struct netcheck_answer answer[NETCHECK_LEVELS];
};

struct netcheck {
    const char *path;            /* borrowed */
    bool level[NETCHECK_LEVELS]; /* asked for */
    int nrow;
    struct netcheck_row *row; /* (nrow) in the arena */
};

/* netcheck_run: run the cases of file `path` at the levels wanted (level[l]; NULL: all) into *n, memory from a.
 *
 *   filter  only cases whose name contains it; NULL: all
 *   quiet   no progress line
 *
 *   Returns false with ERR_NO_INPUT, ERR_IO or ERR_DATA. A case that a level cannot run is not an error. */
bool netcheck_run(struct netcheck *n, const char *path, const bool *level, const char *filter, bool quiet,
                  struct arena *a, struct err *e);

/* Statistics of the answers of one level over the rows of one group. */
struct netcheck_total {
    int cases, skipped;      /* answered; not answerable at this level */
    int exact_cases;         /* with the reference's makespan, to a thousandth of a cycle */
    int64_t messages, exact; /* compared; with the reference's arrival */
    double mean, worst;      /* of |error|; the largest error with its sign */
    double message_error;    /* mean over cases */
};

/* netcheck_total: over the rows whose group is `group` (NULL: all) at `level`. */
struct netcheck_total netcheck_total(const struct netcheck *n, const char *group, enum network_level level);

/* netcheck_level_name: "loggp", "link", "packet", "flit", "auto". */
const char *netcheck_level_name(enum network_level level);

/* netcheck_print: a table of cases (unless brief) and of totals per group and level; netcheck_json: the same. */
void netcheck_print(const struct netcheck *n, bool brief, FILE *out);
void netcheck_json(const struct netcheck *n, FILE *out);

/* netcheck_json_object: the same as the next value of a larger document. */
void netcheck_json_object(const struct netcheck *n, struct json *j);

/* netcheck_file: netcheck_run and print or JSON on `out`: the verb `netcheck FILE [--level L]`. level NULL: all. */
bool netcheck_file(const char *path, const enum network_level *level, bool json, bool brief, bool quiet, FILE *out,
                   struct err *e);

#endif
