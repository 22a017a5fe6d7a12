/* jobs.c - several jobs on one machine: a world for each, and one for what they share; jobs.h.
 *
 * Ranks of all jobs lie in one array, a slice for each job, and go on in one ring: to the loop of
 * world.c they are the ranks of one run. A job's world has the slice, so that what a rank sees of
 * its world (its size, its peers, its stages, its barrier) is its job's alone. */
#include "vp/jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/progress.h"
#include "machine/node_use.h"
#include "measure/run_heartbeat.h"
#include "sim/stack_fault.h"
#include "vp/arrivals.h"
#include "vp/explain.h"
#include "vp/ground.h"
#include "vp/meeting.h"
#include "vp/team.h"
#include "vp/world_parts.h"

struct jobs {
    int n;
    const struct world_job *job;  /* (n) */
    struct placement *placement;  /* (n) */
    struct world *world;          /* (n) of those that run */
    struct world whole;
    struct world_load load;       /* of the whole */
    struct run_result result;     /* of the whole: nobody reads it */
    bool links;
};

/* What holds for all ranks together: the largest stack, and the weakest promise. */
static void make_load(struct jobs *j, struct run_heartbeat *heartbeat, struct arena *scratch)
{
    j->load = (struct world_load){.heartbeat = heartbeat, .scratch = scratch};
    for (int i = 0; i < j->n; i++) {
        const struct world_load *l = j->job[i].load;
        if (!l) continue;
        j->load.nrank += l->nrank;
        j->links = j->links || j->job[i].record->links;
        const int64_t stack = l->stack_bytes > 0 ? l->stack_bytes : WORLD_STACK_BYTES;
        if (stack > j->load.stack_bytes) j->load.stack_bytes = stack;
    }
}

/* The ranks of job i, and those of others on its nodes: they share caches and memories. */
static struct placement on_its_nodes(const struct jobs *j, int i)
{
    struct arena *a = j->whole.scratch;
    /* Room for all ranks that run, which is never too little. */
    const int most = j->load.nrank;
    struct placement all = {0, TAKE(a, most, int), TAKE(a, most, int)};
    bool *its = TAKE(a, j->whole.topology->nnode, bool);
    for (int r = 0; r < j->placement[i].nrank; r++) its[j->placement[i].node[r]] = true;
    for (int k = 0; k < j->n; k++) {
        const struct placement *p = &j->placement[k];
        /* Who is idle computes nothing. */
        for (int r = 0; j->job[k].load && r < p->nrank; r++) {
            if (!its[p->node[r]]) continue;
            all.node[all.nrank] = p->node[r];
            all.processor[all.nrank++] = p->processor[r];
        }
    }
    return all;
}

/* What computing and copies cost where all of these ranks do it at once (docs/nodes.md). */
static void make_costs(const struct jobs *j, int i, struct world *w)
{
    const struct machine_spec *m = w->machine;
    const int64_t set = w->load->working_set;
    struct node_use use = node_use_alone(set);
    /* By rates nobody shares anything, and nothing needs to be counted. */
    if (m->node.model == NODE_ROOFLINE) {
        const struct placement all = on_its_nodes(j, i);
        use = node_use_placed(m, &all, set);
    }
    w->node_cost = node_use_cost(&m->node, &use);
    w->software = software_cost_used(m, &use);
    w->result->working_set = set;
}

/* A job's world is the whole but for its own ranks, program and result. */
static void make_world(struct jobs *j, int i, int first)
{
    const struct world_job *b = &j->job[i];
    struct world *w = &j->world[i];
    *w = j->whole;
    w->record = b->record;
    w->result = b->out;
    w->arena = b->arena;
    w->load = b->load;
    w->placement = j->placement[i];
    w->vp = j->whole.vp + first;
    w->nrank = w->nown = b->load->nrank;
    w->nstage = b->load->nstage;
    w->eager_only = world_all_eager(w->machine, b->load);
    /* Its messages carry its number, and its times count from its start. */
    w->job = i;
    w->start = b->start_ps;
    b->out->nrank = w->nrank;
    world_name_stages(b->out, w->nstage, b->load->stage_name);
    world_make_tables(w);
    make_costs(j, i, w);
    /* The network does the collectives of each job by itself. */
    meeting_create(w);
}

/* From the outside in, as for one job. */
static bool build(struct jobs *j, struct err *e)
{
    struct world *w = &j->whole;
    /* Jobs that are idle have places, too. */
    struct placement_job place[JOB_MOST];
    for (int i = 0; i < j->n; i++)
        place[i] =
            (struct placement_job){j->job[i].name, j->job[i].placement, j->job[i].nrank};
    j->placement = TAKE(w->scratch, j->n, struct placement);
    if (!ground_make(w, j->placement, j->n, place, e) || !world_make_network(w, j->links, e))
        return false;
    /* Before anything is sent: each job has an account of its own. */
    net_count_jobs(w->net, j->n);
    arrivals_foresee(w);
    w->fibers = fiber_pool_create(w->nrank, j->load.stack_bytes, e);
    return w->fibers != NULL;
}

/* All ranks are made before any goes on: who begins later has a later clock. */
static void make_ranks(struct jobs *j)
{
    struct world *w = &j->whole;
    w->vp = TAKE(w->scratch, w->nrank, struct vp);
    w->ready = TAKE(w->scratch, w->nrank, struct vp *);
    j->world = TAKE(w->scratch, j->n, struct world);
    int first = 0;
    /* Worlds before ranks: a rank points into its own world, which must not move any more. */
    for (int i = 0; i < j->n; i++) {
        if (!j->job[i].load) continue;
        make_world(j, i, first);
        first += j->job[i].load->nrank;
    }
    for (int i = 0; i < j->n; i++)
        if (j->job[i].load) world_make_ranks(&j->world[i], j->job[i].seed);
}

/* The world whose rank has stack `fiber`, and that rank: stacks are numbered over all jobs, ranks
 * within their own. -1: of none. */
static int owner_of(const struct jobs *j, int fiber, int *rank)
{
    for (int i = 0; i < j->n; i++) {
        if (!j->job[i].load) continue;
        *rank = fiber - (int)(j->world[i].vp - j->whole.vp);
        if (*rank >= 0 && *rank < j->world[i].nrank) return i;
    }
    return -1;
}

/* In a signal handler: the rank's stack is at its end, nothing is known of the rest. Programs of
 * users are told of by whoever loads them. */
static void tell_overflow(void *context, int fiber)
{
    const struct jobs *j = context;
    char text[480];
    int rank, at = owner_of(j, fiber, &rank);
    if (at < 0 || !j->world[at].load->overflowed || j->world[at].load->foreign) return;
    const int n = snprintf(text, sizeof text, "job '%.31s', ", j->job[at].name);
    world_stack_text(&j->world[at], rank, text + n, sizeof text - (size_t)n);
    j->world[at].load->overflowed(j->world[at].load->overflow_context, text);
}

/* A rank whose stack was too small, or a message that nobody took, spoils what all have found. */
static void look_for_damage(struct jobs *j)
{
    int fiber, rank = -1;
    const int64_t peak = fiber_pool_stack_peak(j->whole.fibers, &fiber);
    const int beyond = fiber >= 0 ? owner_of(j, fiber, &rank) : -1;
    for (int i = 0; i < j->n; i++) {
        struct world *w = &j->world[i];
        if (!j->job[i].load) continue;
        w->result->stack_peak_bytes = peak;
        if (!j->whole.failed && w->load->foreign && !w->load->leftovers) find_leftovers(w);
        if (j->whole.failed || i != beyond) continue;
        j->whole.failed = w->failed = true;
        world_stack_text(w, rank, w->result->text, sizeof w->result->text);
    }
}

/* The job whose fault it is that the run did not end well: who failed, passed the end of time, or
 * waits for ever. The first of several. */
static int culprit(const struct jobs *j)
{
    for (int i = 0; i < j->n; i++) {
        const struct world *w = &j->world[i];
        if (!j->job[i].load) continue;
        const bool mine = j->whole.failed ? w->failed
                          : j->whole.late ? j->whole.late->world == w
                                          : w->nfinished < w->nrank;
        if (mine) return i;
    }
    return 0;
}

/* What is told of the culprit is what is told of a job alone. */
static void explain(struct jobs *j, int at)
{
    struct world *w = &j->world[at];
    const bool late = j->whole.late || sim_beyond(w->sim), deadlock = !j->whole.failed && !late;
    /* The whole knows who was late; the sentence is about a rank of this job. */
    w->late = j->whole.late;
    if (deadlock) {
        deadlock_explain(w);
        deadlock_time(w, deadlock_reached(w, 0, w->nrank));
    } else {
        if (!j->whole.failed) late_explain(w);
        forget_parts(w);
    }
    w->result->status = deadlock ? RUN_DEADLOCK : RUN_FAILED;
}

/* The others' times would be those beside a job that did not do what it was to do. */
static void fail_others(struct jobs *j, int at)
{
    for (int i = 0; i < j->n; i++) {
        struct world *w = &j->world[i];
        if (!j->job[i].load || i == at) continue;
        /* No times: they would look like results in tables. */
        forget_parts(w);
        w->result->status = RUN_FAILED;
        snprintf(w->result->text, sizeof w->result->text, "job '%s' beside it: %.1900s",
                 j->job[at].name, j->job[at].out->text);
    }
}

static void run(struct jobs *j, uint64_t seed)
{
    struct world *w = &j->whole;
    const double begin = host_seconds();
    world_begin_heartbeat(w, begin);
    make_ranks(j);
    w->fault = stack_fault_begin(w->fibers, tell_overflow, j);
    background_start(w, seed);
    world_loop(w);
    stack_fault_end(w->fault);
    /* Every job's row has the time of all: they were simulated together. */
    const double taken = host_seconds() - begin;
    for (int i = 0; i < j->n; i++)
        if (j->job[i].load) j->job[i].out->host_s = taken;
    if (w->nfinished == w->nrank && !w->failed) look_for_damage(j);
    /* Three causes, as of a run of one job: failure, the end of time, nobody can go on. */
    if (w->nfinished < w->nrank || w->failed) {
        const int at = culprit(j);
        explain(j, at);
        fail_others(j, at);
        return;
    }
    /* Times and links of each job alone: what they have in common is nobody's result. */
    for (int i = 0; i < j->n; i++) {
        if (!j->job[i].load) continue;
        world_collect(&j->world[i]);
        if (j->job[i].record->links) world_copy_links(&j->world[i]);
    }
}

bool world_run_jobs(const struct machine_spec *m, const struct world_job *job, int n,
                    uint64_t seed, struct run_heartbeat *heartbeat, struct arena *scratch,
                    struct err *e)
{
    static const struct record_spec nothing;
    struct message_pool pool = {0};
    struct jobs j = {.n = n, .job = job};
    const struct arena_mark begin = scratch ? arena_mark(scratch) : (struct arena_mark){0};
    CHECK(n >= 1 && n <= JOB_MOST);
    make_load(&j, heartbeat, scratch);
    CHECK(j.load.nrank > 0);
    j.whole = (struct world){
        .machine = m,
        .record = &nothing,
        .result = &j.result,
        .scratch = scratch ? scratch : arena_create(),
        .arrived = world_arrived,
        .sim = sim_create(),
        .nrank = j.load.nrank,
        .nown = j.load.nrank,
        .pool = &pool,
        .load = &j.load,
        .software = software_cost_make(&m->software),
        .shared_channel = m->software.shared_bandwidth > 0,
        .eager_only = true,
        .noisy = m->noise.compute_cv > 0,
        /* Who stops, or waits for the machine's one server, does so among all jobs. */
        .whole = &j.whole,
    };
    pool.arena = j.whole.scratch;
    /* The network may promise order only if all jobs do. */
    for (int i = 0; i < n; i++)
        if (job[i].load && !world_all_eager(m, job[i].load)) j.whole.eager_only = false;
    const bool ok = build(&j, e);
    if (ok) run(&j, seed);
    fiber_pool_destroy(j.whole.fibers);
    sim_destroy(j.whole.sim);
    if (scratch) arena_release(scratch, begin);
    else arena_destroy(j.whole.scratch);
    return ok;
}
