/* run.c - one run: open its program, let the ranks go, judge, check, collect. */
#include "run/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/picoseconds.h"
#include "base/progress.h"
#include "base/text.h"
#include "hosts/hosts_copy.h"
#include "machine/node_cost.h"
#include "machine/node_use.h"
#include "run/beside.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/run_parts.h"
#include "vp/world.h"

enum { TAG_VERDICT = 400 };

/* KEPT_BYTES: memory of a run that the next one finds with its pages. To fault in and give back
 * those of a small run takes a fifth of its time; a large one must not hold them for small ones. */
enum { KEPT_BYTES = 64 << 20 };

/* Whether this process has the whole result: only one of those that share a run does. */
static bool chief(const struct program_run *r)
{
    return !r->order.hosts || r->order.hosts->rank == 0;
}

/* The ranks once, or what they did on another machine. */
static bool let_go(struct program_run *r, struct run_cache *c, const struct machine_spec *machine,
                   const struct record_spec *record, struct arena *a, struct run_result *out,
                   struct err *e)
{
    const struct arena_mark work = arena_mark(c->scratch), results = arena_mark(a);
    const uint64_t seed = run_spec_seed(&r->spec);
    const int64_t largest = omission_largest_message(r);
    struct tape *tape = tape_for(c->tapes, r);
    const bool ok =
        launch_run(r, machine, record, seed, largest, tape, c->scratch, c->world, a, out, e);
    if (ok && !tape) tape_none(c->tapes, r, out);
    if (!ok || !tape || tape_end(c->tapes, tape, r, out)) return ok;
    arena_release(a, results);
    arena_release(c->scratch, work);
    memset(out, 0, sizeof *out);
    return launch_run(r, machine, record, seed, largest, NULL, c->scratch, c->world, a, out, e);
}

/* The ranks once, with the settings that are in force now. */
static bool attempt(struct program_run *r, struct run_cache *c, struct arena *a,
                    struct run_result *out, struct err *e)
{
    /* What --keep-all and `explain --measure` undo acts here: the spec itself stays as it is. */
    const struct machine_spec machine = omission_machine(&r->spec, r->order.keep);
    const struct record_spec record = omission_record(&r->spec, r->order.keep);
    memset(out, 0, sizeof *out);
    out->residual = out->measured_s = NAN;
    if (!r->type->prepare(r, c->scratch, e)) return false;
    const bool ok = let_go(r, c, &machine, &record, a, out, e);
    arena_empty(c->world, KEPT_BYTES);
    if (!ok) return false;
    out->residual = out->measured_s = NAN;
    if (out->status == RUN_OK && (chief(r) || r->divided) && r->type->judge) r->type->judge(r, out);
    return true;
}

/* Whether the program asks for one more attempt. Processes that share a run learn it from the one
 * that has the answers, with the settings that the program has changed. */
static bool once_more(struct program_run *r, struct run_result *out)
{
    struct {
        bool more;
        struct kernel_spec kernel;
    } verdict = {.more = chief(r) && r->type->again && r->type->again(r, out),
                 .kernel = r->spec.kernel};
    if (!r->order.hosts || out->job_broken) return verdict.more;
    if (!hosts_tell(r->order.hosts, TAG_VERDICT, &verdict, sizeof verdict)) {
        out->job_broken = true;
        return false;
    }
    r->spec.kernel = verdict.kernel;
    r->order.job_run++;
    return verdict.more;
}

/* Attempts until the program asks for no more; only the last leaves anything in the arenas. */
bool run_attempts(struct program_run *r, struct run_cache *c, struct arena *a,
                  struct run_result *out, struct err *e)
{
    /* Beside other jobs they repeat all together. */
    if (r->spec.jobs) {
        const bool made = beside_attempts(r, c->scratch, c->world, a, out, e);
        arena_empty(c->world, KEPT_BYTES);
        return made;
    }
    /* A program asks again when its residual is too large: the next attempt has more refinement. */
    const struct arena_mark work = arena_mark(c->scratch), results = arena_mark(a);
    bool ok = attempt(r, c, a, out, e);
    while (ok && once_more(r, out)) {
        arena_release(c->scratch, work);
        arena_release(a, results);
        ok = attempt(r, c, a, out, e);
    }
    return ok;
}

/* The node's prices as a function, for room program, which does not know machines. */
static int64_t price_ps(const void *context, const struct work *w)
{
    return node_cost_ps(context, w);
}

/* A serial code that takes longer than simulated time is: there is no speedup to tell, so the run
 * has failed. */
static void refuse_long_baselines(struct run_result *out)
{
    const struct baseline *b = NULL;
    for (int i = 0; i < out->nbaseline && !b; i++)
        if (out->baseline[i].time_ps > PS_LAST) b = &out->baseline[i];
    if (!b) return;
    /* Nothing of the run is kept that would need the missing time. */
    snprintf(out->text, sizeof out->text,
             "simulated time ends at %.3g s: the parallel run took %.6g s, and '%s' on one "
             "processor takes longer",
             PS_LAST * 1e-12, (double)out->makespan_ps * 1e-12, b->name);
    out->status = RUN_FAILED;
    out->makespan_ps = 0;
    out->nbaseline = out->nstage = 0;
    out->stage = NULL;
    out->finish_ps = NULL;
    out->sums = NULL;
    out->nspan = 0;
    out->measured_s = NAN;
}

/* What the answer is worth: only programs that ran to their end have one. */
static void verify(struct program_run *r, struct arena *scratch, struct run_result *out)
{
    if (out->status != RUN_OK && out->status != RUN_INVALID) return;
    /* Serial codes may have a rate of their own. */
    const struct node_spec node = node_spec_serial(&r->spec.machine.node);
    /* One processor has the data of all ranks, and its caches and memory for itself. */
    const struct node_use use = node_use_alone(size_count(out->working_set, out->nrank));
    const struct node_cost cost = node_use_cost(&node, &use);
    const struct work_price price = {price_ps, &cost};
    /* Against the reference first, then the serial codes, whose times are the numerators of
     * every speedup. */
    if (r->type->check) r->type->check(r, scratch, out);
    if (r->type->baselines) r->type->baselines(r, &price, scratch, out);
    refuse_long_baselines(out);
}

/* What the ranks wrote, out of memory that is about to go. Also what ranks of a run that failed
 * wrote before: often it says why. */
static void take_lines(const struct text *said, struct arena *a, struct run_result *out)
{
    if (said->length == 0) return;
    out->nsaid = (int64_t)said->length + 1;
    out->said = arena_text(a, said->s);
}

/* For the last words of a CHECK that fails in this run. */
static void describe(void *context, char *buffer, int size)
{
    const struct run_spec *s = context;
    snprintf(buffer, (size_t)size,
             "in a run of scenario '%s': kernel %s, n = %d, %d ranks on %s, seed %llu, repetition "
             "%d",
             s->scenario, s->kernel.name, s->model.nbody, s->nrank, s->machine.name,
             (unsigned long long)s->seed, s->rep);
}

/* Stacks of ranks are memory that is certain to be used, a page each at least. */
enum { STACK_LEAST_BYTES = 4096 };

static bool ranks_fit(const struct run_spec *spec, const struct run_order *order, struct err *e)
{
    char what[64];
    if (order && order->hosts) return true; /* each process has a part of them */
    snprintf(what, sizeof what, "a run on %d ranks", spec->nrank);
    return size_in_memory(size_product((size_t)spec->nrank, STACK_LEAST_BYTES), "", 0, what, e);
}

/* A divided run that processes cannot share, because things must happen in order, is opened again
 * as a whole; all of them come to the same verdict. */
static bool open_divided(const struct run_spec *spec, const struct run_order *order,
                         struct run_cache *cache, struct program_run *r, struct err *e)
{
    if (!run_open(spec, order, cache, cache->own, r, e)) return false;
    if (!r->divided) return true;
    const struct machine_spec machine = omission_machine(spec, order->keep);
    const struct record_spec record = omission_record(spec, order->keep);
    if (!launch_ordered(r, &machine, &record, omission_largest_message(r))) return true;
    struct run_order whole = *order;
    whole.whole = true;
    run_close(r);
    return run_open(spec, &whole, cache, cache->own, r, e);
}

/* What one process cannot open, none begins. */
static bool open_shared(const struct run_spec *spec, const struct run_order *order,
                        struct run_cache *cache, struct program_run *r, struct err *e)
{
    enum { TAG_OPENED = 410 };
    const bool ok = ranks_fit(spec, order, e) && open_divided(spec, order, cache, r, e);
    return order && order->hosts ? hosts_agree(order->hosts, TAG_OPENED, ok, e) : ok;
}

/* Of ranks that fail one is told, the first on one thread. Process 0 makes the run again, alone; it
 * has no more than its part of the scene. */
static bool again_alone(const struct run_spec *spec, struct run_cache *cache,
                        struct program_run *r, struct arena *a, struct run_result *out,
                        struct err *e)
{
    struct run_order alone = r->order;
    if (!r->divided || !chief(r) || out->status != RUN_FAILED || out->job_broken) return true;
    alone.hosts = NULL;
    alone.threads = 0;
    run_close(r);
    arena_empty(cache->scratch, KEPT_BYTES);
    return run_open(spec, &alone, cache, cache->own, r, e) && run_attempts(r, cache, a, out, e);
}

bool run_sharing(const struct run_spec *spec, const struct run_order *order,
                 struct run_cache *cache, struct arena *a, struct run_result *out, struct err *e)
{
    memset(out, 0, sizeof *out);
    const double begin = host_seconds();
    /* The plan keeps points that cannot run, with their reason. */
    if (spec->refused) return err_set(e, (enum err_kind)spec->refused_kind, "%s", spec->refused);
    if (spec->machine.network.level == LEVEL_AUTO_TOLERANCE)
        return err_set(e, ERR_CONFIG,
                       "level 'auto-tolerance' is for 'mimdsim run' and 'mimdsim paper'; choose a "
                       "level");
    struct arena *scratch = cache->scratch;
    struct program_run r = {.spec = *spec};
    check_note_set(describe, &r.spec);
    const bool ok = open_shared(spec, order, cache, &r, e) &&
                    run_attempts(&r, cache, a, out, e) && again_alone(spec, cache, &r, a, out, e);
    if (ok && (chief(&r) || r.divided)) {
        out->nomission = omission_listing(&r, out->omission);
        out->nbody = r.nbody;
        out->nu = r.nu;
        if (!order || !order->times) verify(&r, scratch, out);
    }
    if (ok && r.said) take_lines(r.said, a, out);
    out->exit_status = r.exit_status;
    check_note_set(NULL, NULL);
    run_close(&r);
    arena_empty(scratch, KEPT_BYTES);
    arena_empty(cache->own, KEPT_BYTES);
    out->host_total_s = host_seconds() - begin;
    out->host_peak_bytes = host_peak_bytes();
    return ok;
}

bool run_one(const struct run_spec *spec, struct arena *a, struct run_result *out, struct err *e)
{
    struct run_cache *cache = run_cache_create();
    const bool ok = run_sharing(spec, NULL, cache, a, out, e);
    run_cache_destroy(cache);
    return ok;
}

/* --- before it runs --------------------------------------------------------------------------- */

/* Rooms above know runs, not virtual processors. */
bool run_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs, int64_t *work,
              struct err *e)
{
    return world_fits(m, nrank, jobs, work, e);
}
