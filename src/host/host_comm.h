/* host_comm.h - comm.h on the system's MPI: a program's ranks are the processes of a job, and time
 * is this computer's.
 *
 * The same program text that runs on virtual processors runs here, with the same algorithms of
 * collectives and so the same order of arithmetic. Three things differ. Counted work is not looked
 * at, because the processor does it. A barrier is made of messages, as on a machine without
 * hardware for it. A message without content (data NULL) arrives as zeros.
 *
 * What a program publishes is kept in this process, in the order given, and handed over when the
 * clock has stopped (host_comm_published): publishing stops the clock meanwhile. Sends copy their
 * data, as comm.h says; the copy is part of what a message costs. */
#ifndef HOST_HOST_COMM_H
#define HOST_HOST_COMM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "comm/comm.h"
#include "hosts/hosts.h"
#include "measure/run_result.h"

/* One rank of a program on a real processor; opaque. */
struct host_comm;

/* host_comm_create: rank `hosts->rank` of `hosts->size`, on a lane of its own; called by all
 * processes of the job together. They exchange messages, so that MPI's memory for messages is there
 * before any is measured, unless a computer has more of them than processors. hosts NULL: the only
 * rank, without MPI. Owned by the caller. NULL with ERR_INTERNAL when MPI refuses.
 * host_comm_destroy: by all together; accepts NULL. */
struct host_comm *host_comm_create(const struct hosts *hosts, struct err *e);
void host_comm_destroy(struct host_comm *h);

/* host_comm_run_begin: the next run of a program begins, with outputs `output` (n, borrowed; for
 * comm_wanted alone) and stages 0 .. nstage - 1. timed: it uses wildcards, tests or probes
 * (comm_match.h); its messages are then matched here and not by MPI. Returns what the program is to
 * be given. Its clock does not run before its mark: comm_type.mark. */
struct comm *host_comm_run_begin(struct host_comm *h, bool timed, int nstage,
                                 const struct comm_output *output, int n);

/* What a run of one rank took. */
struct host_times {
    int64_t begin_ns, end_ns;         /* on this host's clock */
    int64_t stage_ns[RUN_MAX_STAGES]; /* they add up to the time from begin to end */
    int64_t published_ns;             /* time that the clock stood: not in stages */
    int64_t preempted;                /* involuntary switches of this thread meanwhile */
    int64_t faults;                   /* page faults of this thread meanwhile */
    int64_t late_ns;                  /* how late this rank began, where all begin at one time */
    int64_t messages, bytes;          /* sent */
};

/* host_comm_run_end: the program has returned. Waits for sends that nobody waited for, then for all
 * ranks. *left: a message that nobody received was thrown away. False: MPI reports an error. */
bool host_comm_run_end(struct host_comm *h, struct host_times *out, bool *left);

/* Numbers that one rank published, as they were published. */
struct host_published {
    int64_t output, first, n;
    const double *x; /* (n) until the next host_comm_run_begin */
};

/* host_comm_published: publication number i of the last run, false: there are fewer.
 * host_comm_digest: of all of them. */
bool host_comm_published(const struct host_comm *h, int i, struct host_published *out);
uint64_t host_comm_digest(const struct host_comm *h);

/* host_comm_one_clock: whether all processes of the job run on one host and read one clock. */
bool host_comm_one_clock(const struct host_comm *h);

/* host_comm_barrier: MPI's own barrier, for measurements. False: MPI reports an error. */
bool host_comm_barrier(struct host_comm *h);

/* host_clock_ns: this host's monotonic clock [ns]. host_switches, host_faults: involuntary switches
 * of this thread so far; its page faults. host_interruptions: both together, for what touches no
 * memory of its own for the first time. */
int64_t host_clock_ns(void);
int64_t host_switches(void);
int64_t host_faults(void);
int64_t host_interruptions(void);

#endif
