/* world.h - a machine with its network, clock and virtual processors, built for one run.
 *
 * A virtual processor is a fiber with its own clock. Computing and sending advance the clock without an event; only
 * waiting for something not yet known switches fibers. */
#ifndef VP_WORLD_H
#define VP_WORLD_H

#include "base/arena.h"
#include "base/err.h"
#include "comm/comm.h"
#include "measure/run_result.h"
#include "spec/machine_spec.h"
#include "spec/run_spec.h"

typedef void world_program(struct comm *c, void *context);

/* world_run: run `program(comm, context)` on `nrank` virtual processors of machine `m` to the end.
 *
 *   m            in   the machine; level, placement, software, noise as given
 *   record, seed in   what to record; seed of the noise
 *   nstage, stage_name  in  the program's stages; one more, "end", is added for idling until the makespan
 *   a            in   memory of the result's arrays
 *   out          out  makespan, stages, counts, digest, spans, links, host_s, stack peak; `status` RUN_OK or
 *                     RUN_DEADLOCK with the wait-for cycle in `text`
 *
 *   Returns false only for ERR_CONFIG or ERR_INTERNAL (the machine cannot hold the ranks, no memory). */
bool world_run(const struct machine_spec *m, int nrank, const struct record_spec *record, uint64_t seed, int nstage,
               const char *const *stage_name, world_program *program, void *context, struct arena *a,
               struct run_result *out, struct err *e);

#endif
