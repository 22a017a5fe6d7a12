/* why.h - what limits a run: its critical path by cause, stage and rank, what each parameter of the
 * machine contributes, how far it may move, and what idealised machines would gain.
 *
 * All of it follows from one run that records what binds (measure/path.h), and a few more to
 * confirm. At levels loggp and link the path names the resource behind every wait; at the others
 * contention is one lump a message. */
#ifndef STUDY_WHY_H
#define STUDY_WHY_H

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "spec/run_spec.h"
#include "study/roofline.h"

enum { WHY_RANKS = 10, WHY_MOST_PARAMETERS = 40, WHY_MOST_LIMITS = 12 };

/* Time of the path with one cause in one stage. */
struct why_share {
    enum path_cause cause;
    int stage;
    int64_t time_ps;
    int64_t steps;
};

struct why_rank {
    int rank;
    int64_t time_ps; /* of the path on that rank or with its message */
};

/* A link or port that messages of the path pass or wait for. */
struct why_resource {
    int resource;    /* number in run.link, which says between which routers it is */
    int64_t time_ps; /* of the path: hops to it, bytes and gaps at it */
};

/* One parameter of the machine. Its contribution is the part of the path that is proportional to it
 * (times, cycles) or to its inverse (rates), so d ln T / d ln value is the share, negative for
 * rates. */
struct why_parameter {
    const char *key; /* in full: machine.network.hop_latency */
    bool rate;       /* larger is faster */
    double value;    /* of the machine [SI]; 0: by segments of message size */
    int64_t time_ps; /* contribution */
    double
        count; /* contribution over value: latencies on the path, bytes, operations; 0: value 0 */
    double
        tolerance;  /* factor on the time that it stands for with which the run takes 5 % longer,
                       confirmed by  simulation; 0: not within a factor of 1000, or not asked for */
    bool same_path; /* up to there the path pays it as often: nothing else takes over */
    double range;   /* factor at which another path takes over, simulated; 0: not before
                       `tolerance`, or not found */
};

/* An idealised machine. */
struct why_limit {
    const char *name;    /* "zero latency" */
    const char *what;    /* which settings that is */
    int64_t makespan_ps; /* 0: it cannot be run */
};

struct why {
    struct run_result run; /* with its path; arrays in the caller's arena */
    int nshare;
    struct why_share *share; /* (nshare) the longest first */
    int nrank;
    struct why_rank rank[WHY_RANKS]; /* the longest first */
    int ranks;                       /* on the path, all of them */
    int nresource;
    struct why_resource resource[WHY_RANKS]; /* the longest first; none at levels without them */
    int nroof;
    struct roofline_row *roof; /* (nroof) computing against communication */
    int64_t messages;                /* that the path follows from one rank to another one */
    int nparameter;
    struct why_parameter
        parameter[WHY_MOST_PARAMETERS]; /* with a contribution; the largest first */
    int nlimit;
    struct why_limit limit[WHY_MOST_LIMITS];
};

enum { WHY_TOLERANCES = 1, WHY_LIMITS = 2, WHY_SLACK = 4, WHY_ALL = 7 };

/* why_study: run `spec` with its path, then find what `ask` (WHY_*) says.
 *
 *   workers, quiet  in  as run_campaign
 *   a               in  memory of the arrays
 *
 *   Returns false as run_one, or with ERR_DEADLOCK or ERR_CHECK when the run did not end. */
bool why_study(const struct run_spec *spec, unsigned ask, int workers, bool quiet, struct arena *a,
               struct why *out, struct err *e);

/* why_contributions: the parameters of `out` from the path of out->run, which ran on machine `m`.
 */
void why_contributions(const struct machine_spec *m, struct why *out);

/* why_contribution: the part of the path of `r`, a run of `spec`, that is proportional to parameter
 * `key` [ps]; 0: none. */
int64_t why_contribution(const struct run_spec *spec, const struct run_result *r, const char *key);

/* why_scale: the time that parameter `key` (machine....) stands for becomes `factor` times as long;
 * false when there is no such parameter. */
bool why_scale(struct machine_spec *m, const char *key, double factor);

#endif
