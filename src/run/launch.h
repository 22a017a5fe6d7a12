/* launch.h - a prepared run of a program on the virtual processors of a machine: workspaces and
 * every rank's text. */
#ifndef RUN_LAUNCH_H
#define RUN_LAUNCH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "program/program.h"
#include "run/tape.h"
#include "spec/run_spec.h"
#include "vp/jobs.h"

/* launch_largest_message: what the program promises of its messages [B], -1: nothing. After
 * open. */
int64_t launch_largest_message(const struct program_run *r);

/* launch_ordered: why things must happen in the order of simulated time in such a run, NULL: they
 * need not (world_ordered). launch_alone: why it takes one host thread whatever was asked for,
 * NULL: it may take several (world_alone). Both after open. launch_threads: how many it takes
 * otherwise, of those `asked` for on `cores` processors (run_order), by windows if `ordered`. */
const char *launch_ordered(const struct program_run *r, const struct machine_spec *m,
                           const struct record_spec *record, int64_t largest);
const char *launch_alone(const struct program_run *r, const struct machine_spec *m,
                         const struct record_spec *record, int64_t largest);
int launch_threads(int asked, int cores, int nrank, bool ordered);

/* How much deeper than what a rank_program calls deepest the calls of a rank go, at most [B]: where
 * a message looks for its way, which is all but level loggp on a torus; on several threads. */
enum { LAUNCH_WAY_DEPTH = 256, LAUNCH_THREADS_DEPTH = 192 };

/* launch_memory: host memory of the ranks' stacks [B], and in *workspaces of what they work in
 * beside them, of a built-in program that has been prepared: all of it will be touched. */
double launch_memory(const struct program_run *r, double *workspaces);

/* launch_run: run the ranks of `r`, which has been prepared, to the end on virtual processors of
 * machine `m`.
 *
 *   record, seed  in   see world_run
 *   largest       in   the promise that world_run may rely on, see world_load
 *   scratch       in   memory of the ranks' workspaces
 *   world         in   memory of the machine (world_load), empty again at the end; NULL: fresh
 *   tape          in   on which the ranks' doing is written, or from which it is repeated; NULL
 *   a, out        out  the result, with its arrays in `a`
 *
 *   Returns false as world_run. */
bool launch_run(const struct program_run *r, const struct machine_spec *m,
                const struct record_spec *record, uint64_t seed, int64_t largest,
                struct tape *tape, struct arena *scratch, struct arena *world, struct arena *a,
                struct run_result *out, struct err *e);

/* One of several jobs. */
struct launch_job {
    const char *name;
    const struct program_run *r; /* prepared; NULL: it only keeps its processors */
    int nrank;
    const struct placement_spec *placement;
    int64_t start_ps;
    uint64_t seed;
    int64_t largest; /* as of launch_run */
    const struct record_spec *record;
    struct arena *scratch; /* of its ranks' workspaces */
    struct arena *arena;   /* of its result's arrays */
    struct run_result *out;
};

/* launch_jobs: n jobs at once on machine `m`, by world_run_jobs; `seed` of the background, `world`
 * as above. */
bool launch_jobs(const struct launch_job *job, int n, const struct machine_spec *m, uint64_t seed,
                 struct run_heartbeat *heartbeat, struct arena *world, struct err *e);

#endif
