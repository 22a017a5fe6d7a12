/* slack.h - how much later everything beside the critical path may be without lengthening the run.
 *
 * The slack of a node of the graph (path.h) is the largest delay of it that leaves the makespan as
 * it is, with everything else taking the time that it takes and resources serving messages in the
 * order in which they did. It is 0 on the critical path. Where two times meet, the one that came
 * first has slack: that is why a log has to keep losers (path_keep_losers).
 *
 * Source: the total float of the critical path method, J. E. Kelley, "Critical-path planning and
 * scheduling: mathematical basis", Operations Research 9 (1961) 296-320. */
#ifndef MEASURE_SLACK_H
#define MEASURE_SLACK_H

#include "measure/path.h"

/* Whoever is nearer to the path than this part of the makespan is nearly critical. */
enum { SLACK_NEAR = 20 };

/* All steps of one cause in one stage, over all ranks and messages. */
struct slack_row {
    enum path_cause cause;
    int stage;
    int64_t steps, time_ps;
    int64_t critical_ps; /* of that the part without slack */
    int64_t near_ps;     /* with a slack of at most makespan / SLACK_NEAR, the former too */
    int64_t least_ps;    /* the least slack above 0; INT64_MAX: there is none */
};

/* slack_of: the slack of every node of `p` [ps] when rank i ends with node end[i] (n of them) and
 * the run with the last; INT64_MAX: no end follows from it. The caller frees it. */
int64_t *slack_of(const struct path_log *p, int n, const uint32_t *end);

/* slack_rows: what slack_of found, by stage and cause, in `a`; *n rows that have steps, the longest
 * time first. `makespan` [ps] as in slack_row. */
struct slack_row *slack_rows(const struct path_log *p, const int64_t *slack, int64_t makespan,
                             int *n, struct arena *a);

/* slack_ranks: (nrank x nstage) the least slack of what each rank computes, sends and receives in
 * each stage [ps], in `a`; INT64_MAX: it does nothing there that an end follows from. */
int64_t *slack_ranks(const struct path_log *p, const int64_t *slack, int nrank, int nstage,
                     struct arena *a);

#endif
