/* real.h - one run of a program on this computer, for real: simulated first, then repeated on MPI.
 *
 * The simulation comes first for two reasons. A program that deadlocks or fails there is not let
 * loose on processes that would hang. And its answer is what the real one is compared with: the
 * same bits where the order of arithmetic is the same, else within the tolerance of the program's
 * own check, which judges the real answer as it does a simulated one. */
#ifndef RUN_REAL_H
#define RUN_REAL_H

#include "base/arena.h"
#include "base/err.h"
#include "host/host_comm.h"
#include "measure/real_row.h"
#include "run/run.h"
#include "spec/run_spec.h"

/* How often, and how long at most. */
struct real_order {
    int samples;    /* undisturbed repetitions that are wanted; 0: 30 */
    double seconds; /* no further repetition after this time; 0: 5 */
    /* parts, of at least 3 wanted repetitions each, before and after which the computer's speed is
     * measured, with a pause of 20 ms between them; at most REAL_BURSTS. 0: one, without that */
    int bursts;
};

/* run_real: make `spec` with its ranks on the processes of the job. Called by all of them with
 * equal arguments.
 *
 *   hosts   in   the job, as many processes as the run has ranks; NULL: one rank in this process
 *   comm    in   made by host_comm_create for that job
 *   cache   in   as run_sharing
 *   a       in   memory of the samples
 *   out     out  on process 0; on others its status alone
 *
 *   Returns false with ERR_CONFIG (a program that cannot run for real, another number of ranks) or
 * as run_one; on processes other than the first without a text where that one tells it. */
bool run_real(const struct run_spec *spec, const struct hosts *hosts, struct host_comm *comm,
              const struct real_order *order, struct run_cache *cache, struct arena *a,
              struct real_result *out, struct err *e);

#endif
