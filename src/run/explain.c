/* explain.c - what one run will cost, told without making it (run.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "machine/node_use.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/run.h"
#include "vp/world.h"

/* Measured with dynamics on 16 to 16,384 ranks of an x86-64 computer. PROCESS_BYTES: program and
 * libraries, with two large pages of the heap. RANK_BYTES: a rank, its fiber and what is left of
 * its messages, beside its times by stage. STACK_BYTES: what is taken of the stack of a rank of
 * people's own programs. */
enum { PROCESS_BYTES = 11000000, RANK_BYTES = 1000, STACK_BYTES = 2 * 4096 };

/* Before it runs the memory of a built-in program is an estimate. */
static void tell_node(const struct run_spec *spec, const struct program_estimate *k, char *text,
                      int size)
{
    struct node_use use;
    struct err ignored;
    err_clear(&ignored);
    const double own = isfinite(k->rank_bytes) ? k->rank_bytes : 0;
    const int64_t set = spec->kernel.own ? spec->program.working_set : (int64_t)own;
    text[0] = '\0';
    if (node_use_make(&spec->machine, spec->nrank, set, &use, &ignored))
        node_use_tell(&spec->machine.node, &use, text, size);
}

/* What simulating the others takes: their programs run as well. */
static bool add_neighbours(const struct run_spec *spec, int64_t *work, struct run_estimate *out,
                           struct err *e)
{
    const struct job_set *set = spec->jobs;
    /* Whichever of them is looked at, all are simulated on one thread. */
    out->alone = "several jobs share the machine";
    out->threads = 1;
    for (int i = 0; i < set->n; i++) {
        if (i + 1 == spec->job.number || set->idle[i]) continue;
        /* A member of a set has no machine of its own. */
        struct run_spec other = *set->job[i];
        struct run_estimate more;
        other.machine = spec->machine;
        if (!run_explain(&other, work, &more, e)) return false;
        out->host_s += more.host_s;
        out->host_bytes += more.host_bytes - PROCESS_BYTES;
        out->again_bytes += more.again_bytes;
    }
    return true;
}

/* Ranks run ahead of others, and what they have sent stays until it is received: of 64 ranks half
 * of all that they ever sent was there at once, of 16,384 almost nothing of it. */
static double waiting_bytes(const struct program_estimate *k, int nrank)
{
    enum { ALL_WAITS = 32 };
    return k->bytes * fmin(1, (double)ALL_WAITS / nrank);
}

/* What ranks work in more when the program asks for another attempt, as it would of an answer that
 * is no good. */
static double again_bytes(struct program_run *r, double workspaces, struct arena *a)
{
    struct run_result poor = {.status = RUN_OK, .residual = INFINITY};
    struct err ignored;
    double more = 0;
    err_clear(&ignored);
    if (!r->type->again || !r->type->again(r, &poor) || !r->type->prepare(r, a, &ignored)) return 0;
    launch_memory(r, &more);
    return fmax(0, more - workspaces);
}

/* The process, the scene and the ranks' workspaces stay; then comes the machine, and when that is
 * gone again the reference. The last look at r: its settings may be those of another attempt
 * then. */
static void tell_memory(struct program_run *r, const struct program_estimate *k,
                        const struct machine_spec *m, const struct record_spec *record,
                        int64_t *work, struct run_estimate *out)
{
    struct err ignored;
    struct arena *a = arena_create();
    const int nrank = r->spec.nrank;
    double stacks = (double)STACK_BYTES * nrank, workspaces = k->rank_bytes * nrank;
    err_clear(&ignored);
    /* People's own code is not asked before it runs. */
    const bool prepared = !r->spec.kernel.own && r->type->prepare(r, a, &ignored);
    if (prepared) stacks = launch_memory(r, &workspaces);
    const double ranks =
        nrank * (RANK_BYTES + (r->rank->nstage + 1) * (double)sizeof(struct stage_time));
    const double machine = stacks + ranks + waiting_bytes(k, nrank) +
                           world_memory(m, nrank, k->messages, record->links, work);
    const double later = fmax(machine, k->reference_bytes);
    out->host_bytes = PROCESS_BYTES + k->model_bytes + workspaces + later;
    out->again_bytes = prepared ? again_bytes(r, workspaces, a) : 0;
    arena_destroy(a);
}

bool run_explain(const struct run_spec *spec, int64_t *work, struct run_estimate *out,
                 struct err *e)
{
    memset(out, 0, sizeof *out);
    struct arena *own = arena_create();
    struct run_cache *cache = run_cache_create();
    struct program_run r;
    const bool ok = run_open(spec, NULL, cache, own, &r, e);
    if (ok) {
        /* Counts by the program, then host time and memory from measured costs per count. */
        struct program_estimate k = {0};
        r.type->estimate(&r, &k);
        out->nbody = r.nbody;
        out->nu = r.nu;
        out->metre = r.metre, out->kilogram = r.kilogram, out->second = r.second;
        out->messages = k.messages;
        out->bytes = k.bytes;
        out->flops = k.flops;
        out->nomission = omission_listing(&r, out->omission);
        const struct machine_spec machine = omission_machine(spec, r.order.keep);
        const struct record_spec record = omission_record(spec, r.order.keep);
        const int64_t largest = omission_largest_message(&r);
        out->ordered = launch_ordered(&r, &machine, &record, largest);
        out->alone = launch_alone(&r, &machine, &record, largest);
        out->threads = out->alone ? 1
                                  : launch_threads(RUN_THREADS_AUTO, 0, spec->nrank,
                                                   out->ordered != NULL);
        out->nunused = r.type->unused ? r.type->unused(&r, out->unused) : 0;
        /* Measured with bench/bench_messages: host seconds per message and per flop, bytes beside a
         * rank's own. */
        const double per_message = spec->machine.network.level == LEVEL_LOGGP ? 0.4e-6 : 1.5e-6;
        out->host_s = k.messages * per_message + k.flops * 0.6e-9 + spec->nrank * 1.5e-6;
        tell_node(spec, &k, out->node, sizeof out->node);
        tell_memory(&r, &k, &machine, &record, work, out);
    }
    run_close(&r);
    run_cache_destroy(cache);
    arena_destroy(own);
    if (ok && spec->jobs) return add_neighbours(spec, work, out, e);
    return ok;
}
