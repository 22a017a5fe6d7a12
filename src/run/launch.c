/* launch.c - workspaces for all ranks, and the function that hands each its own; see launch.h. */
#include "run/launch.h"

#include <sched.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/size.h"
#include "base/text.h"
#include "run/rank_stack.h"
#include "sim/fiber.h"
#include "spec/collective_spec.h"
#include "vp/world.h"

/* Fewer ranks on each thread than this, and messages between threads cost more than a thread saves
 * (bench/bench_threads). */
enum { LEAST_RANKS = 1024, LEAST_ORDERED = 2048, MOST_ORDERED = 4 };

/* What all ranks share, and each rank's own memory. */
struct launch {
    const struct rank_program *rank; /* its functions */
    const void *job; /* what all ranks read, and none writes */
    struct tape *tape; /* NULL: none */
    char **workspace; /* (nrank); NULL: on the ranks' stacks */
};

/* A page of a stack is touched anyway, and what a rank works in may be the rest of it. Not inlined:
 * what it takes lies above the frames of the program and below nothing but the rank's first. */
static __attribute__((noinline)) void run_on_stack(const struct launch *l, struct comm *c)
{
    const size_t bytes = l->rank->workspace_bytes(l->job, comm_rank(c)); /* at most a page */
    char *workspace = __builtin_alloca(bytes);
    memset(workspace, 0, bytes);
    l->rank->run(c, l->job, workspace);
}

/* What each virtual processor executes: the program's run function, with its own workspace. */
static void program(struct comm *c, void *context)
{
    struct launch *l = context;
    if (!l->workspace) {
        run_on_stack(l, c);
        return;
    }
    char *workspace = l->workspace[comm_rank(c)];
    if (l->tape) tape_rank(l->tape, c, l->rank, l->job, workspace);
    else l->rank->run(c, l->job, workspace);
}

enum { PAGE = 4096 };

/* Whether `depth` bytes and the workspace of every rank fit a page. */
static bool fits_page(const struct program_run *r, const struct world_load *load, size_t depth)
{
    int first, end;
    world_part(load, &first, &end);
    for (int i = first; i < end; i++)
        if (r->rank->workspace_bytes(r->job, i) + depth > PAGE) return false;
    return true;
}

/* Whether stack and workspace of every rank share a page: what fiber.c saves above the first frame,
 * and frames of this file, are part of the depth. A stack that somebody wants smaller than usual is
 * left to the program. */
static bool shares_page(const struct program_run *r, const struct world_load *load)
{
    enum { LEAST_STACK = 2 * PAGE };
    if (r->rank->depth == 0 || (load->stack_bytes > 0 && load->stack_bytes < LEAST_STACK))
        return false;
    return fits_page(r, load, (size_t)r->rank->depth);
}

/* Whether a page is all the stack that a rank needs, with something to spare. A message enters the
 * network from its sender's stack: where that asks for more than a fixed way to its receiver, there
 * is no bound. What goes wrong without guards may not end the job of several processes, and a size
 * that somebody asks for is given. */
static bool packs(const struct program_run *r, const struct machine_spec *m,
                  const struct record_spec *record, const struct world_load *load)
{
    enum { SPARE = 2 * FIBER_PACKED_SPARE };
    const enum network_level level = m->network.level;
    const bool fixed = m->network.routing == ROUTING_DETERMINISTIC &&
                       m->topology.nfailed_link == 0 && m->topology.nfailed_router == 0;
    const bool formula = level == LEVEL_LOGGP && m->topology.family == TOPOLOGY_TORUS;
    const size_t deepest = r->rank->deepest ? (size_t)r->rank->deepest(r->job) : 0,
                 depth = deepest + (formula ? 0 : LAUNCH_WAY_DEPTH) +
                         (load->threads > 1 ? LAUNCH_THREADS_DEPTH : 0) + SPARE;
    if (level != LEVEL_LOGGP && !(level == LEVEL_LINK && fixed)) return false;
    if (record->path || record->balance) return false; /* a log that grows on the rank's stack */
    if (deepest == 0 || load->hosts || load->stack_bytes > 0 || !r->packs) return false;
    return load->fills ? fits_page(r, load, depth) : depth <= PAGE;
}

/* The bytes that rank `i` works in, or those of what `tape` keeps of it where there is one. */
static size_t workspace_of(const struct program_run *r, const struct tape *tape, int i)
{
    return tape ? tape_workspace(tape, i) : r->rank->workspace_bytes(r->job, i);
}

/* What the ranks of this process work in, all together. */
static size_t workspaces_sum(const struct program_run *r, const struct world_load *load,
                             const struct tape *tape)
{
    size_t sum = 0;
    int first, end;
    world_part(load, &first, &end);
    for (int i = first; i < end; i++) sum = size_sum(sum, workspace_of(r, tape, i));
    return sum;
}

/* Taken one by one: all of it will be touched, so the arena may use large pages. Nothing is taken
 * before the sum is known to be there. NULL: with the error set. */
static char **make_workspaces(const struct program_run *r, const struct world_load *load,
                              const struct tape *tape, struct arena *a, struct err *e)
{
    const struct tape *taped = tape && tape_whole(tape) ? tape : NULL;
    const size_t sum = workspaces_sum(r, load, taped);
    int first, end;
    char what[64];
    world_part(load, &first, &end);
    snprintf(what, sizeof what, "what %d ranks of '%s' work in", end - first, r->type->name);
    if (!size_in_memory(sum, "", 0, what, e)) return NULL;
    char **w = TAKE(a, r->spec.nrank, char *);
    for (int i = first; i < end; i++) w[i] = arena_take(a, workspace_of(r, taped, i));
    return w;
}

/* -1: the program does not promise any bound. */
int64_t launch_largest_message(const struct program_run *r)
{
    return r->rank->largest_message ? r->rank->largest_message(r->job) : -1;
}

/* The program as the room of virtual processors knows it: functions and promises, no names. */
static struct world_load load_of(const struct program_run *r, int64_t largest)
{
    return (struct world_load){.nrank = r->spec.nrank,
                               .program = program,
                               .nstage = r->rank->nstage,
                               .stage_name = r->rank->stage_name,
                               .largest_message = largest,
                               .output = r->output,
                               .noutput = PROGRAM_OUTPUTS,
                               .heartbeat = r->order.heartbeat,
                               .name = r->type->name,
                               .stack_bytes = r->rank->stack_bytes,
                               .timed = r->rank->timed,
                               /* The vectors of all ranks are combined in one memory, so that such
                                * a run stays on one thread. */
                               .meets = collective_meets(&r->spec),
                               .foreign = r->rank->foreign,
                               .no_synchronous = r->rank->no_synchronous,
                               .leftovers = r->rank->leftovers};
}

/* What a rank passes over: the memory that a built-in program works in, the largest of any rank;
 * of people's own programs what the scenario says. Rates do not ask. */
static int64_t working_set(const struct program_run *r)
{
    size_t most = 0;
    if (r->spec.machine.node.model != NODE_ROOFLINE) return 0;
    if (r->spec.kernel.own) return r->spec.program.working_set;
    for (int i = 0; i < r->spec.nrank; i++) {
        const size_t own = r->rank->workspace_bytes(r->job, i);
        if (own > most) most = own;
    }
    return (int64_t)most;
}

/* Calls of built-in programs hardly go deeper than a page (docs/scale.md). */
double launch_memory(const struct program_run *r, double *workspaces)
{
    const struct world_load load = load_of(r, -1);
    *workspaces = shares_page(r, &load) ? 0 : (double)workspaces_sum(r, &load, NULL);
    return (double)PAGE * r->spec.nrank;
}

const char *launch_ordered(const struct program_run *r, const struct machine_spec *m,
                           const struct record_spec *record, int64_t largest)
{
    const struct world_load load = load_of(r, largest);
    return world_ordered(m, &load, record);
}

const char *launch_alone(const struct program_run *r, const struct machine_spec *m,
                         const struct record_spec *record, int64_t largest)
{
    const struct world_load load = load_of(r, largest);
    return world_alone(m, &load, record);
}

int launch_threads(int asked, int cores, int nrank, bool ordered)
{
    if (asked != RUN_THREADS_AUTO) return asked > 0 ? asked : 1;
    /* Those that this process may use: a batch system, or taskset, leaves fewer than there are. */
    cpu_set_t set;
    const int mine = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    int threads = cores > 0 && cores < mine ? cores : mine;
    const int least = ordered ? LEAST_ORDERED : LEAST_RANKS;
    if (nrank / least < threads) threads = nrank / least;
    if (ordered && threads > MOST_ORDERED) threads = MOST_ORDERED;
    return threads > 0 ? threads : 1;
}

bool launch_run(const struct program_run *r, const struct machine_spec *m,
                const struct record_spec *record, uint64_t seed, int64_t largest,
                struct tape *tape, struct arena *scratch, struct arena *world, struct arena *a,
                struct run_result *out, struct err *e)
{
    const struct arena_mark work = arena_mark(scratch), results = arena_mark(a);
    struct world_load load = load_of(r, largest);
    load.scratch = world;
    load.working_set = working_set(r);
    if (!load.foreign && !rank_stack_set(&load, e)) return false;
    const char *ordered = world_ordered(m, &load, record);
    const char *alone = world_alone(m, &load, record);
    load.threads =
        alone ? 1 : launch_threads(r->order.threads, r->order.cores, load.nrank, ordered != NULL);
    out->threads = load.threads;
    /* Processes share what may happen in any order, threads more. */
    const char *why = r->order.hosts ? ordered : r->order.threads > 1 ? alone : NULL;
    if (why) text_copy(out->alone, sizeof out->alone, why);
    /* What processes cannot share, the first one does. */
    if (ordered && r->order.hosts && r->order.hosts->rank > 0) return true;
    if (!ordered) load.hosts = r->order.hosts, load.job_run = r->order.job_run;
    load.keeps_outputs = r->divided;
    load.sums = r->order.sums;
    load.fills = !tape && shares_page(r, &load);
    load.packed = !tape && packs(r, m, record, &load);
    struct launch l = {.rank = r->rank, .job = r->job, .tape = tape};
    if (!load.fills && !(l.workspace = make_workspaces(r, &load, tape, scratch, e))) return false;
    load.context = &l;
    if (tape && load.threads <= 1 && !load.hosts) load.stacks = tape_stacks(tape);
    if (!world_run(m, &load, record, seed, a, out, e)) return false;
    const bool one = load.threads <= 1 && !load.hosts;
    if (out->status != RUN_FAILED || out->job_broken || (one && !load.packed)) return true;
    /* A part of the scene is not enough to make all of it again. */
    if (load.hosts && (load.hosts->rank > 0 || r->divided)) return true;
    /* Of several ranks that fail, one is told: the first on one thread. Which one is first on
     * several depends on the host, so such a run is made again on one. It has room below its
     * stacks then, which may be all that was missing. */
    arena_release(a, results);
    arena_release(scratch, work);
    memset(out, 0, sizeof *out);
    out->threads = 1;
    load.hosts = NULL;
    load.sums = false;
    load.threads = 1;
    load.packed = false;
    l.tape = NULL;
    load.fills = shares_page(r, &load);
    l.workspace = load.fills ? NULL : make_workspaces(r, &load, NULL, scratch, e);
    return (load.fills || l.workspace) && world_run(m, &load, record, seed, a, out, e);
}

bool launch_jobs(const struct launch_job *job, int n, const struct machine_spec *m, uint64_t seed,
                 struct run_heartbeat *heartbeat, struct arena *world, struct err *e)
{
    struct world_job own[JOB_MOST];
    struct world_load load[JOB_MOST];
    struct launch l[JOB_MOST];
    CHECK(n <= JOB_MOST);
    for (int i = 0; i < n; i++) {
        const struct launch_job *j = &job[i];
        own[i] = (struct world_job){j->name, NULL,      j->nrank, j->placement, j->start_ps,
                                    j->seed, j->record, j->arena, j->out};
        /* An idle job has no ranks, and so no load. */
        if (!j->r) continue;
        load[i] = load_of(j->r, j->largest);
        load[i].working_set = working_set(j->r);
        if (!load[i].foreign && !rank_stack_set(&load[i], e)) return false;
        l[i] = (struct launch){j->r->rank, j->r->job, NULL,
                               make_workspaces(j->r, &load[i], NULL, j->scratch, e)};
        if (!l[i].workspace) return false;
        load[i].context = &l[i];
        own[i].load = &load[i];
        j->out->threads = 1;
    }
    return world_run_jobs(m, own, n, seed, heartbeat, world, e);
}
