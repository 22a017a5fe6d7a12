/* schedule_run.h - a rank that executes its part of a schedule. */
#ifndef SCHEDULE_SCHEDULE_RUN_H
#define SCHEDULE_SCHEDULE_RUN_H

#include "comm/comm.h"
#include "schedule/schedule.h"

struct schedule_job {
    const struct schedule *schedule;
    const char *path;    /* of the file, for reports */
    int64_t unit_ps;     /* of computing times */
    struct arena *arena; /* memory of operations under way; lives longer than the ranks */
};

/* schedule_workspace: memory of rank `rank` [B]. */
size_t schedule_workspace(const void *job, int rank);

/* schedule_rank: the program of one rank; job is a struct schedule_job.
 *
 * An operation that may start waits for its processor (cpu) behind those that could start earlier.
 * A message that is there is received in the same order, by when it came. A computing time occupies
 * its processor, a message the rank's software for as long as the machine says; several processors
 * of a rank compute at the same time and share the software. A send has finished when the machine's
 * software says so: at once when it is eager, when it has been answered otherwise. */
void schedule_rank(struct comm *c, const void *job, void *workspace);

#endif
