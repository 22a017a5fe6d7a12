/* world.h - a machine with its network, clock and virtual processors, built for one run.
 *
 * A virtual processor is a fiber with its own clock. Computing and sending advance the clock
 * without an event; only waiting for something not yet known switches fibers. */
#ifndef VP_WORLD_H
#define VP_WORLD_H

#include "base/arena.h"
#include "base/err.h"
#include "comm/comm.h"
#include "hosts/hosts.h"
#include "measure/run_result.h"
#include "spec/machine_spec.h"
#include "spec/run_spec.h"

typedef void world_program(struct comm *c, void *context);

struct fiber_pool;

/* What the virtual processors are to do. */
struct world_load {
    int nrank;
    world_program *program; /* of every rank */
    void *context;          /* handed to it; borrowed */
    int nstage;
    const char *const
        *stage_name;         /* (nstage); one more, "end", is added for idling until the makespan */
    int64_t largest_message; /* bytes; a promise (CHECK), -1: none. When every message is eager,
                                sends of a node come in order and some levels need fewer events,
                                with the same times */
    int64_t working_set; /* what a rank passes over again and again [B], the largest of any */
    const struct comm_output *output; /* (noutput) where outputs gather; borrowed */
    int noutput;
    struct run_heartbeat *heartbeat;       /* where to tell how far the run is, NULL: nowhere */
    const char *name;              /* of the program, for messages; NULL: none */
    int64_t stack_bytes;           /* of each rank, 0: what built-in programs need */
    bool fills; /* ranks fill the first page of their stacks (fiber_pool_fill) */
    bool packed; /* a page is all the stack that each has (fiber_pool_create_packed) */
    /* of programs that are not foreign: called in a signal handler when a rank has gone beyond its
     * stack, with a sentence; ends the process. NULL: the fault ends it */
    void (*overflowed)(void *context, const char *text);
    void *overflow_context;
    /* the program may use wildcards, tests, cancel, probes and synchronous sends (comm_match.h) */
    bool timed;
    /* none of its sends is synchronous: as largest_message, a promise that saves events */
    bool no_synchronous;
    bool meets;     /* a built-in program that may call collectives of the network (comm_meet) */
    bool foreign;   /* what the program does wrong ends the run RUN_FAILED and is no CHECK */
    /* of a foreign program: messages that nobody has received at its end are no failure */
    bool leftovers;
    /* host threads; 0: one. More act where world_alone lets them, and on no result */
    int threads;
    /* processes that share the run, each with a part of the ranks; NULL: only this one */
    const struct hosts *hosts;
    int job_run;               /* number of the run among those of these processes */
    /* of a run that processes share: each keeps the outputs that its ranks published; process 0
     * gets sums over the ranks, not their own times */
    bool keeps_outputs, sums;
    /* memory of the machine, of which nothing is left taken at the end; NULL: fresh */
    struct arena *scratch;
    /* of a run on one thread: stacks of an earlier one, NULL at first, and where those of this one
     * stay when it ends well, owned by the caller. How deep its own were is not told then. NULL:
     * fresh ones, which do not stay */
    struct fiber_pool **stacks;
    /* for tests: threads stop for a while at random, by this seed; 0: they do not */
    uint64_t delays;
    /* (nrank) in which order ranks first go on the host, NULL: by number; acts on no result */
    const int *order;
};

/* world_run: run a load on machine `m` to the end.
 *
 *   m            in   the machine; level, placement, software, noise as given
 *   record, seed in   what to record; seed of the noise
 *   a            in   memory of the result's arrays
 *   out          out  makespan, stages, counts, digest, spans, links, host_s, stack peak; `status`
 * RUN_OK or RUN_DEADLOCK with the wait-for cycle in `text`, or RUN_FAILED with what failed
 *
 *   Returns false only for ERR_CONFIG or ERR_INTERNAL (the machine cannot hold the ranks, no
 * memory). */
bool world_run(const struct machine_spec *m, const struct world_load *load,
               const struct record_spec *record, uint64_t seed, struct arena *a,
               struct run_result *out, struct err *e);

/* world_fits: whether world_run would begin with `nrank` ranks on machine m, or world_run_jobs with
 * the jobs of a set (NULL: there is none): what they build before the ranks go. `work`: how many
 * ranks, nodes, routers and links may still be built; this machine's are taken off, and what goes
 * beyond is not built, and said to fit. False as world_run. */
bool world_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs, int64_t *work,
                struct err *e);

/* world_memory: host memory that a run takes beside its ranks (topology, places, network),
 * estimated for `messages` in all [B]. `links`: their loads are recorded. `work` as of world_fits:
 * what goes beyond is not built, and 0 is told, as of a machine that cannot hold the ranks. */
double world_memory(const struct machine_spec *m, int nrank, double messages, bool links,
                    int64_t *work);

/* world_part: the ranks *first .. *end - 1 that this process runs: all, unless load->hosts. Only
 * process 0 then gets the whole result; the others' has the status and their own ranks' part. */
void world_part(const struct world_load *load, int *first, int *end);

/* world_ordered: why things must happen in the order of simulated time in such a run; NULL: its
 * ranks may go on in any order (vp/team.h), in threads and in processes. A constant text.
 * world_alone: why world_run would use one host thread for it, whatever load->threads says; NULL:
 * it may use several, by windows of simulated time (vp/windows.h) where the order matters. */
const char *world_ordered(const struct machine_spec *m, const struct world_load *load,
                          const struct record_spec *record);
const char *world_alone(const struct machine_spec *m, const struct world_load *load,
                        const struct record_spec *record);

#endif
