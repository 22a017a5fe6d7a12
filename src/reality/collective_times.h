/* collective_times.h - barrier and collectives between the processes of this job, by algorithm and
 * size: measured, beside what a machine predicts of them, and which algorithm is the fastest. */
#ifndef REALITY_COLLECTIVE_TIMES_H
#define REALITY_COLLECTIVE_TIMES_H

#include "base/err.h"
#include "comm/collectives.h"
#include "host/host_comm.h"
#include "plan/plan.h"

enum { COLLECTIVE_TIMES_MOST = 192 };

/* One collective by one algorithm at one size; times are the mean over ranks. */
struct collective_sample {
    enum collective_kind kind;
    const struct collective_algorithm *algorithm;
    int64_t bytes; /* of the vector, or of a block */
    double measured, predicted; /* of one call [s] */
    int samples, disturbed;
};

struct collective_times {
    int nrank, n, left_out; /* left_out: of which too few repetitions were undisturbed */
    struct collective_sample sample[COLLECTIVE_TIMES_MOST]; /* (n) by kind, size, algorithm */
    char rules[512]; /* as software.collectives: where another than MPICH's choice is faster */
    double residual, median_residual; /* of the predicted times of all: relative */
};

/* collective_times_measure: every algorithm that can do a call, on all processes of the job, called
 * by all with equal arguments.
 *
 *   p        in   plan "calibrate-collectives" for as many ranks as the job has processes
 *   machine  in   predicts; NULL on processes but the first
 *   large    in   whether 1 MiB is measured as well
 *
 * What is too disturbed is left out and counted. Returns false as run_real. */
bool collective_times_measure(struct plan *p, const struct hosts *hosts, struct host_comm *comm,
                              const struct machine_spec *machine, int samples, double seconds,
                              bool large, struct collective_times *out, struct err *e);

/* collective_times_judge: rules and residuals of samples that are there. A rule is made where an
 * algorithm takes at least a tenth less time than the one that would be chosen without it. */
void collective_times_judge(struct collective_times *t);

#endif
