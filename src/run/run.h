/* run.h - one run_spec in, one run_result out; campaigns of many on worker processes. */
#ifndef RUN_RUN_H
#define RUN_RUN_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "measure/run_result.h"
#include "program/program.h"
#include "spec/run_spec.h"

/* run_one: build the model, run the kernel on the machine, compare with the serial references, fill
 * the baselines.
 *
 *   spec  in   resolved
 *   a     in   memory of the result's arrays; scratch is released
 *   out   out  always filled when true is returned; a wrong number gives status RUN_INVALID with
 * its text
 *
 *   Returns false with ERR_CONFIG, ERR_DATA, ERR_NO_INPUT or ERR_INTERNAL when the run cannot be
 * made. */
bool run_one(const struct run_spec *spec, struct arena *a, struct run_result *out, struct err *e);

/* What the runs of a campaign share: scenes and their serial answers. The caller owns it; destroy
 * accepts NULL. */
struct run_cache;
struct run_cache *run_cache_create(void);
void run_cache_destroy(struct run_cache *cache);

/* run_cache_repeat: from now on runs of one task on many machines repeat what its ranks did
 * (tape.h), from their second run on or, `at_once`, from the first: the same results in less time,
 * which is no longer that of the program. Once a cache. */
void run_cache_repeat(struct run_cache *cache, bool at_once);

/* run_sharing: run_one with what earlier runs left in `cache`; sharing changes no result. `order`:
 * how the run is executed, NULL: as usual. */
bool run_sharing(const struct run_spec *spec, const struct run_order *order,
                 struct run_cache *cache, struct arena *a, struct run_result *out, struct err *e);

/* run_program: the program of `spec`, built in or a person's own; NULL: there is none. */
const struct program_type *run_program(const struct run_spec *spec);

/* run_open: the program of `spec`, opened (program.h) but not prepared; memory from `a`, which must
 * live as long as *r, as must `cache`. Returns false as run_one. */
bool run_open(const struct run_spec *spec, const struct run_order *order, struct run_cache *cache,
              struct arena *a, struct program_run *r, struct err *e);

/* run_attempts: the ranks of an opened program on virtual processors, again while the program asks
 * for it; answers stay in *r, results in `a`, memory of the ranks in `cache`. Returns false as
 * run_one. */
bool run_attempts(struct program_run *r, struct run_cache *cache, struct arena *a,
                  struct run_result *out, struct err *e);

/* run_close: give back what an opened program took beside its arenas; also after run_open
 * failed. */
void run_close(struct program_run *r);

/* run_fits: whether a run would begin (world_fits), for plan_options.fits. */
bool run_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs, int64_t *work,
              struct err *e);

/* What `mimdsim explain` shows of one run before it runs. */
struct run_estimate {
    int64_t nbody, nu; /* bodies, degrees of freedom */
    double metre, kilogram, second; /* the model's units in SI; 0: no model */
    double messages, bytes, flops;
    char node[320];    /* what its computing costs by (node_use_tell); "": nothing to be told */
    double host_s;     /* estimated wall time */
    double host_bytes; /* estimated memory */
    double again_bytes; /* and more, where its answer asks for another attempt */
    int threads;       /* of the host, on all of its processors */
    const char *alone; /* why one, whatever is asked for; NULL: several may run it (world_alone) */
    const char *ordered; /* why by windows of simulated time; NULL: in any order (world_ordered) */
    int nomission;     /* what the run leaves out */
    struct omission omission[RUN_MAX_OMISSIONS];
    int nunused;       /* settings that the model's file makes idle: "key: reason" */
    const char *unused[2];
};

/* run_explain: estimate one run without making it. `work`: as of world_fits, at first
 * RUN_EXPLAIN_WORK for a plan, or a run alone; networks beyond it are left out of the memory.
 * Returns false as run_one. */
enum { RUN_EXPLAIN_WORK = 1 << 25 };
bool run_explain(const struct run_spec *spec, int64_t *work, struct run_estimate *out,
                 struct err *e);

/* run_done_fn: called in plan order with each result; return false to stop the campaign. */
typedef bool run_done_fn(void *context, const struct run_spec *spec,
                         const struct run_result *result);

/* A run that is refused, or whose worker process dies, is handed over as a result, too: RUN_FAILED
 * with its reason.
 *
 * run_campaign: every spec whose `skip` flag is not set, on `workers` processes (0: as many as
 * processors online; 1: in this process), executed as `order` (nspec; NULL: as usual) says but for
 * its heartbeat, which is the campaign's own. Code of people's own programs runs in worker
 * processes only, each run in a new one, and a crash is told by rank and line. Results are handed
 * over in plan order, so the outcome does not depend on `workers`. */
bool run_campaign(const struct run_spec *spec, const struct run_order *order, int nspec,
                  const bool *skip, int workers, bool quiet, run_done_fn *done, void *context,
                  struct err *e);

/* run_loads_code: whether a run executes code of people's own, or one beside which it runs. */
bool run_loads_code(const struct run_spec *spec);

/* run_campaign_again: a quiet run_campaign of all specs that begins, in every worker, with what
 * `cache` has: for one campaign after the other of the same tasks. */
bool run_campaign_again(const struct run_spec *spec, int nspec, int workers,
                        struct run_cache *cache, run_done_fn *done, void *context, struct err *e);

/* run_refused: what a run that could not be made leaves: its status, and why. */
struct run_result run_refused(const struct err *why);

/* Somebody who deals out runs, one at a time. */
enum { RUN_LATER = -1, RUN_NO_MORE = -2 };
struct run_dealer {
    /* the number of the next run; RUN_LATER: none now; RUN_NO_MORE: none any more */
    int (*next)(void *context);
    /* attend: called again and again while runs are made; *active when there was something to do.
     * False with the error set stops all. */
    bool (*attend)(void *context, bool *active, struct err *e);
    run_done_fn *done; /* called when a result is there, in any order */
    void *context;
};

/* run_stream: as run_campaign, of the runs that `dealer` names, each once and each in a worker
 * process. */
bool run_stream(const struct run_spec *spec, const struct run_order *order, int nspec, int workers,
                const struct run_dealer *dealer, struct err *e);

#endif
