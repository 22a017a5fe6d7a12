/* netcheck.h - the network levels against a reference's answers: every case of a file at every
 * level wanted.
 *
 * Files are JSON lists of cases in the forms of netcheck_form.h. Times are cycles. A file of
 * message lists without reference answers is played: its rows hold times and nothing is judged. */
#ifndef STUDY_NETCHECK_H
#define STUDY_NETCHECK_H

#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/json.h"
#include "spec/machine_spec.h"

enum { NETCHECK_MOST_IGNORED = 64 };

/* What a case asks for. */
enum netcheck_form {
    NETCHECK_STEP,       /* every node sends one message at 0 */
    NETCHECK_LIST,       /* messages with dependencies (collectives), `trace` */
    NETCHECK_HAND,       /* a few messages with times derived by hand, `messages` */
    NETCHECK_LOAD,       /* mean latency under a random load, `points` */
    NETCHECK_SATURATION, /* the load at which the mean latency is three times that of the empty
                            network */
    NETCHECK_FORMS
};

/* What one level answered to one case. */
struct netcheck_answer {
    bool ran;             /* false: the level cannot run this case, see why */
    bool deadlock;        /* the network was stuck */
    /* makespan or mean latency [cycles], or load at saturation [flits/node/cycle] */
    double found;
    /* (found - reference) / reference; against a band: to its nearer end, 0 inside */
    double error;
    int differing;        /* messages whose arrival differs from the reference's */
    double message_error; /* mean over messages of |arrival - reference| / reference */
    double message_worst; /* the largest of them */
    int64_t events;
    double *arrival; /* played: (nmessage) arrivals [cycles]; else NULL */
    char why[160];
};

struct netcheck_row {
    char name[112]; /* topology, pattern, size, channels, buffer */
    char group[56]; /* what it is counted with: family, channels, buffer */
    int line;       /* of the case in the file */
    enum netcheck_form form;
    enum topology_family family;
    int channels;     /* virtual channels per link */
    bool cuts;        /* a message is cut into several packets */
    bool routed;      /* by a routing rule of the reference (netcheck_series.c) */
    bool worms;       /* a packet is longer than a buffer */
    double crowding;  /* load: reference latency over that of the empty network */
    int nmessage;
    bool played;   /* there is no reference answer */
    bool compared; /* messages have reference arrivals */
    bool expect_deadlock;
    /* false: nothing to be compared with (the reference was unstable); shown, not counted */
    bool counted;
    double low, high;       /* reference [cycles], equal but for a band */
    char flaw[160]; /* the reference contradicts itself, "" when not: the row fails whatever the
                       levels say */
    int *src, *dst, *flits; /* played: (nmessage) */
    struct netcheck_answer answer[LEVELS];
};

struct netcheck {
    const char *path;            /* borrowed */
    bool level[LEVELS]; /* asked for */
    int nrow;
    struct netcheck_row *row; /* (nrow) in the arena */
    int nignored;
    const char *ignored[NETCHECK_MOST_IGNORED]; /* keys of the file that nothing is compared with */
};

/* netcheck_run: run the cases of file `path` at the levels wanted (level[l]; NULL: all) into *n,
 * memory from a.
 *
 *   filter  only cases whose name contains it; NULL: all
 *   quiet   no progress line
 *
 *   Returns false with ERR_NO_INPUT, ERR_IO or ERR_DATA (file, line, key, value and what was
 * expected), also when none of the cases can be answered. A case that a level cannot run is not an
 * error. */
bool netcheck_run(struct netcheck *n, const char *path, const bool *level, const char *filter,
                  bool quiet, struct arena *a, struct err *e);

/* Statistics of the answers of one level over the rows of one group. */
struct netcheck_total {
    int cases, skipped;      /* answered; not answerable at this level */
    int exact_cases;         /* with the reference's makespan, to a thousandth of a cycle */
    int64_t messages, exact; /* compared; with the reference's arrival */
    double mean, worst;      /* of |error|; the largest error with its sign */
    double message_error;    /* mean over cases */
};

/* netcheck_total: over the rows whose group is `group` (NULL: all) at `level`. */
struct netcheck_total netcheck_total(const struct netcheck *n, const char *group,
                                     enum network_level level);

/* netcheck_in_group: whether a row is counted in `group` (NULL: all). */
bool netcheck_in_group(const struct netcheck_row *row, const char *group);

/* netcheck_level_name: "loggp", "link", "packet", "flit", "auto". */
const char *netcheck_level_name(enum network_level level);

/* netcheck_print: a table of cases (unless brief), of totals and verdicts per group and level, and
 * what was not compared; netcheck_json_object: the same as the next value of a document. within: as
 * of netcheck_verdict. */
void netcheck_print(const struct netcheck *n, double within, bool brief, FILE *out);
void netcheck_json_object(const struct netcheck *n, double within, struct json *j);

/* netcheck_print_stated: the table of stated accuracies, as Markdown; netcheck_json_stated: as a
 * JSON list. */
void netcheck_print_stated(FILE *out);
void netcheck_json_stated(FILE *out);

#endif
