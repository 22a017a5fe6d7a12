/* run_result.h - everything that one run tells us, as plain data: how it ended, times, counts,
 * errors.
 *
 * For every rank the times of all its stages add up exactly, in integer picoseconds, to the
 * makespan. */
#ifndef MEASURE_RUN_RESULT_H
#define MEASURE_RUN_RESULT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/work.h"
#include "measure/path.h"
#include "measure/slack.h"

enum run_status { RUN_OK, RUN_INVALID, RUN_DEADLOCK, RUN_FAILED };

enum { RUN_MAX_STAGES = 16, RUN_MAX_BASELINES = 16, RUN_MAX_ERRORS = 16, RUN_MAX_OMISSIONS = 20 };

/* Where the time of one rank went in one stage [ps], and what it sent. */
struct stage_time {
    int64_t compute_ps;
    int64_t send_ps;        /* send overhead, copies, back-pressure of the sender's software */
    int64_t recv_ps;        /* receive overhead and copies */
    /* waiting that an uncontended network would also have caused, and idling at the end */
    int64_t wait_ps;
    int64_t contention_ps;  /* further waiting: links, ports, servers shared with other messages */
    int64_t messages;       /* sent */
    int64_t bytes;          /* sent */
    struct work work;
};

/* A slice of one rank's timeline, when spans are recorded. */
enum span_kind { SPAN_COMPUTE, SPAN_SEND, SPAN_RECV, SPAN_WAIT, SPAN_BARRIER };
struct span {
    int rank, stage;
    enum span_kind kind;
    int64_t begin_ps, end_ps;
    int peer;               /* the other rank, -1: none */
    int64_t bytes;
    int64_t message;        /* number that pairs a send with its receive, -1: none */
};

struct link_load {
    int from, to;           /* routers; -1 marks a node's injection or ejection */
    int node;               /* of an injection or ejection resource, else -1 */
    int64_t messages, bytes;
    int64_t busy_ps;        /* time in use */
    int64_t queue_ps;       /* sum over messages of the time spent waiting for it */
};

/* A serial code whose predicted time on one node the speedup is measured against. */
struct baseline {
    char name[40];          /* "rnea+aba", "parallel work on one processor", ... */
    int64_t time_ps;
    struct work work;
};

/* One number checked against an independent reference. */
struct error_check {
    char quantity[24];      /* "tau", "qdd" */
    char reference[24];     /* "rnea", "aba" */
    double relative;        /* max |x - ref| / max |ref| */
    double tolerance;       /* above: the run is RUN_INVALID */
};

/* Something that was not computed because the scene does not need it. */
struct omission {
    char what[48], why[96];
    double bound;           /* largest relative change of a result; 0: exact, the same numbers */
    unsigned keep;          /* KEEP_* of run_spec.h that puts it back; 0: nothing does */
};

struct rank_sums;

struct run_result {
    enum run_status status;
    char text[2048];        /* why a run is not RUN_OK: the wait-for cycle, the wrong number */
    /* err_kind of a run that could not be made, which is RUN_FAILED; 0 (ERR_NONE): it was */
    int refusal;

    bool job_broken;        /* it was shared by processes, and one of them does not answer */

    /* bodies and degrees of freedom of the model that was built; 0: no model */
    int nbody, nu;
    int64_t makespan_ps;
    int64_t working_set; /* of a rank [B], as the node's roofline model took it; else 0 */
    int nrank, nstage;
    char stage_name[RUN_MAX_STAGES][24];
    struct stage_time *stage;  /* (nrank x nstage), in the run's arena */
    int64_t *finish_ps;        /* (nrank) when each rank ended, in the run's arena */
    /* of both, instead of them, where single ranks are not asked for (run_order.sums); in the run's
     * arena */
    struct rank_sums *sums;

    int nbaseline;
    struct baseline baseline[RUN_MAX_BASELINES];
    int nerror;
    struct error_check error[RUN_MAX_ERRORS];

    int nomission;
    struct omission omission[RUN_MAX_OMISSIONS];

    /* largest constraint residual that a rank saw, relative; NaN: no forward dynamics */
    double residual;
    /* lower bound of the block-scaled system's condition, from its pivots; 0: not known */
    double condition;
    int inner_added, outer_added; /* refinements that the run switched on by itself */
    bool twice_added;          /* with residuals in twice the digits */
    double residual_before;    /* of the answer that needed them; with none added without meaning */
    /* what a micro-benchmark's kernel measured, largest over ranks; NaN: no such kernel */
    double measured_s;
    /* constraints of closed chains; the independent ones among them, -1: not asked for */
    int loop_rows, loop_rank;
    /* largest violation of a loop at the end [model's units]; of loops only */
    double drift_position, drift_velocity;
    int64_t messages, bytes;   /* sent, all ranks */
    int64_t events;            /* dispatched by the simulator */
    int64_t ties;              /* events that shared their time with the one before */
    int64_t switches;          /* of fibers */
    int threads;               /* of the host that ran the ranks */
    char alone[96];            /* why it was one, although more were asked for; "": not so */
    uint64_t digest;           /* of all matched messages and clocks: same input, same digest */

    int exit_status;           /* of a person's own program: the first of a rank that is not 0 */
    int64_t nsaid;
    char *said; /* (nsaid, with the NUL) lines that ranks of a person's own program wrote, in
                   that order: "RANK STREAM TEXT"; in the run's arena, NULL: nothing */
    int64_t nspan;
    struct span *span;         /* in the run's arena, NULL unless recorded */
    int64_t npath;
    /* the critical path in the order of time, in the run's arena, NULL unless recorded */
    struct path_step *path;
    int64_t path_nodes, path_bytes; /* of the graph that it was found in, and its memory [B] */
    int nslack;
    struct slack_row *slack; /* (nslack) in the run's arena, NULL unless recorded */
    int64_t *rank_slack;     /* (nrank x nstage) likewise: slack_ranks */
    int nlink;
    struct link_load *link;    /* in the run's arena, NULL unless recorded */

    int64_t stack_peak_bytes;  /* deepest fiber stack */
    /* wall time of the simulation proper; the only host-dependent numbers here */
    double host_s;
    double host_total_s;       /* with model, references and checks */
    int64_t host_peak_bytes;
};

/* run_result_refined: whether the run switched on refinements by itself. */
static inline bool run_result_refined(const struct run_result *r)
{
    return r->inner_added + r->outer_added > 0 || r->twice_added;
}

#endif
