/* world.c - build a machine for one run, let its ranks go, collect what they did.
 *
 * Two memories: the result's arena, which the caller keeps, and the run's scratch, which
 * ends with the run and with it every message and table. Stacks, event
 * queue and path log are freed one by one. Everything is built anew for each run, so that
 * no run can leave anything to the next one. */
#include "vp/world.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/progress.h"
#include "base/text.h"
#include "hosts/hosts_copy.h"
#include "machine/node_use.h"
#include "sim/stack_fault.h"
#include "vp/arrivals.h"
#include "vp/explain.h"
#include "vp/ground.h"
#include "vp/shared.h"
#include "vp/matching.h"
#include "vp/offload.h"
#include "vp/meeting.h"
#include "vp/path.h"
#include "vp/team.h"
#include "vp/windows.h"
#include "vp/vp.h"
#include "vp/world_parts.h"

/* The last step of a trip. A hand-shake goes its own way, all else to whoever matches. */
void world_arrived(struct message *m)
{
    switch ((enum message_kind)m->kind) {
    /* Timed programs match by simulated time, all others by order alone. */
    case MESSAGE_EAGER:
        offload_receive(m);
        /* fall through */
    case MESSAGE_REQUEST_TO_SEND:
        if (m->to->matching) matching_deliver(m->to, m);
        else mailbox_deliver(m->to, m);
        break;
    case MESSAGE_CLEAR_TO_SEND:
    case MESSAGE_DATA:
        rendezvous_deliver(m);
        break;
    }
}

/* The network knows its own part of a message, which is the first member of ours. */
void world_deliver(void *context, struct net_message *m)
{
    struct world *w = context;
    struct message *own = (struct message *)m;
    if (w->windows) windows_deliver(w, own);
    else if (w->arrivals) arrivals_add(w, own);
    else if (w->team && team_elsewhere(w, own)) team_post(w, own);
    else world_arrived(own);
}

/* Arrays of all ranks; fresh memory costs nothing until it is used. Threads that make their ranks
 * take nothing from the memory that they share. */
void world_make_tables(struct world *w)
{
    const struct software_spec *s = &w->machine->software;
    const bool more = w->noisy || s->kernel_server || s->offload != OFFLOAD_HANDSHAKES;
    w->extra = more ? TAKE(w->scratch, w->nrank, struct vp_extra) : NULL;
    /* One row more than stages: "end" takes the idle time until the last rank is done. */
    const int row = w->nstage + 1;
    /* Of processes that share the run each writes its own part. */
    w->result->stage =
        TAKE_FULL(w->arena, size_product(w->nrank, row), struct stage_time, !w->load->hosts);
    w->result->finish_ps = TAKE(w->arena, w->nrank, int64_t);
}

/* Often enough for a display, and too seldom to cost anything. */
enum { PULSE_EVENTS = 1 << 14 }; /* 5 to 30 ms of the host */

/* Ranks run ahead until they wait; only then is it safe to let simulated time pass. So no
 * event is taken while a rank could still do something earlier: conservative simulation
 * with one clock for events and one for each rank. */
void world_loop(struct world *w)
{
    int quiet_events = PULSE_EVENTS;
    do {
        /* More events first, as long as they come before all that has arrived; then all
         * that can run without a further event runs, and one event is taken, which may wake
         * others. */
        if (w->arrivals) {
            while (arrivals_step(w)) quiet_events--;
            arrivals_give(w);
        }
        if (w->ready_count) world_resume(w, INT64_MAX);
        if (--quiet_events <= 0) {
            world_tell_heartbeat(w);
            quiet_events = PULSE_EVENTS;
        }
    } while (!w->stopped && sim_step(w->sim));
}

static int64_t stack_bytes(const struct world *w)
{
    return w->load->stack_bytes > 0 ? w->load->stack_bytes : WORLD_STACK_BYTES;
}

/* What to do depends on whose program it is. Several jobs have stacks of one size. */
void world_stack_text(const struct world *w, int rank, char *text, size_t size)
{
    char named[64] = "";
    if (w->load->name && !w->load->foreign)
        snprintf(named, sizeof named, "kernel %.40s, ", w->load->name);
    snprintf(text, size,
             "%srank %d of %d: stack overflow: it has used more than its stack of %lld KiB; %s",
             named, rank, w->nrank, (long long)stack_bytes(w->whole) / 1024,
             w->load->foreign ? ".stack_bytes in the program's declaration gives every rank more"
                              : "the environment variable MIMDSIM_STACK (such as '256 KiB') gives "
                                "every rank more, and with fewer bodies for each rank, thus more "
                                "ranks, less is needed");
}

/* In a signal handler: the rank's stack is at its end, nothing is known of the rest. */
static void tell_overflow(void *context, int rank)
{
    const struct world *w = context;
    char text[400];
    world_stack_text(w, rank, text, sizeof text);
    w->load->overflowed(w->load->overflow_context, text);
}

/* The digest covers events, what ranks received and when, and when they ended. */
void world_collect(struct world *w)
{
    struct run_result *r = w->result;
    uint64_t digest = digest_mix(DIGEST_START, sim_digest(w->sim));
    /* Idle time at the end makes every rank's parts add up to the makespan. The end of
     * the run is the clock of the last rank, not the time of the last event. */
    for (int i = 0; i < w->nrank; i++) {
        const struct vp *v = &w->vp[i];
        r->finish_ps[i] = v->finish;
        if (v->finish > r->makespan_ps) r->makespan_ps = v->finish;
        digest = digest_mix(digest_mix(digest, v->digest), (uint64_t)v->finish);
    }
    for (int i = 0; i < w->nrank; i++) {
        struct stage_time *row = w->vp[i].stages;
        row[w->nstage].wait_ps += r->makespan_ps - r->finish_ps[i];
        for (int k = 0; k < w->nstage; k++) {
            r->messages += row[k].messages;
            r->bytes += row[k].bytes;
        }
    }
    r->digest = digest;
    r->events = sim_events(w->sim);
    r->ties = sim_ties(w->sim);
    r->switches = fiber_pool_switches(w->fibers);
}

/* How deep stacks have become. Of very many ranks not every one has a guard page below its stack:
 * one that went beyond has written over its neighbour's, and what the run has found is not worth
 * much. */
static void measure_stacks(struct world *w)
{
    struct run_result *r = w->result;
    int rank;
    r->stack_peak_bytes = fiber_pool_stack_peak(w->fibers, &rank);
    if (rank < 0) return;
    w->failed = true;
    world_stack_text(w, rank, r->text, sizeof r->text);
}

/* How much later everything else may be: from the ends of all ranks back. */
static void trace_slack(struct world *w)
{
    struct run_result *r = w->result;
    uint32_t *end = TAKE(w->scratch, w->nrank, uint32_t);
    for (int i = 0; i < w->nrank; i++) {
        w->vp[i].clock = w->vp[i].finish;
        end[i] = vp_path_until(&w->vp[i], w->vp[i].finish);
    }
    int64_t *slack = slack_of(w->path, w->nrank, end);
    r->slack = slack_rows(w->path, slack, r->makespan_ps, &r->nslack, w->arena);
    r->rank_slack = slack_ranks(w->path, slack, w->nrank, r->nstage, w->arena);
    free(slack);
}

/* The critical path ends with the rank that ends last, the first of several. Any of
 * several that end together would do; the first makes it the same in each run. */
static void trace_path(struct world *w)
{
    struct run_result *r = w->result;
    int last = 0;
    for (int i = 1; i < w->nrank; i++)
        if (w->vp[i].finish > w->vp[last].finish) last = i;
    struct vp *v = &w->vp[last];
    v->clock = v->finish;
    vp_path(v, PATH_POLL, v->finish, 0);
    r->path = path_trace(w->path, v->path, &r->npath, w->arena);
    if (w->record->slack) trace_slack(w);
    r->path_nodes = path_nodes(w->path);
    r->path_bytes = path_bytes(w->path);
}

/* Links belong to the network, which ends with the run. */
void world_copy_links(struct world *w)
{
    int n;
    w->result->link = net_links(w->net, w->job, w->arena, &n);
    w->result->nlink = n;
}

void world_name_stages(struct run_result *r, int nstage, const char *const *name)
{
    CHECK(nstage >= 1 && nstage < RUN_MAX_STAGES);
    for (int k = 0; k < nstage; k++) text_copy(r->stage_name[k], sizeof r->stage_name[k], name[k]);
    text_copy(r->stage_name[nstage], sizeof r->stage_name[nstage], "end");
    r->nstage = nstage + 1;
}

bool world_all_eager(const struct machine_spec *m, const struct world_load *load)
{
    /* A synchronous send shakes hands whatever its size, and only timed programs have one. */
    return (!load->timed || load->no_synchronous) &&
           software_all_eager(&m->software, load->largest_message);
}

bool world_make_network(struct world *w, bool links, struct err *e)
{
    w->net = net_create(w->machine, w->topology, w->sim, w->scratch, world_deliver, w, links, e);
    if (!w->net) return false;
    /* Before the first message: it may not change while one is under way. */
    net_set_in_order(w->net, w->eager_only);
    return true;
}

/* Several threads, and the order of time matters. */
static bool by_windows(const struct world *w)
{
    return w->load->threads > 1 && !w->load->hosts &&
           world_ordered(w->machine, w->load, w->record) &&
           !world_alone(w->machine, w->load, w->record);
}

/* Stacks that an earlier run has left, if they fit. */
static struct fiber_pool *stacks_take(const struct world *w, struct err *e)
{
    struct fiber_pool **kept = w->load->stacks, *p = kept ? *kept : NULL;
    if (w->load->packed) return fiber_pool_create_packed(w->nrank, e);
    if (!p || !fiber_pool_again(p, w->nrank, stack_bytes(w)))
        return fiber_pool_create(w->nrank, stack_bytes(w), e);
    *kept = NULL;
    return p;
}

/* For the next run, as long as their touched pages are few. Ranks that have not ended are left in
 * the middle of their stacks. */
static void stacks_leave(struct world *w)
{
    enum { MOST_KEPT = 1024 };
    struct fiber_pool **kept = w->load->stacks, *p = w->fibers;
    if (kept && p && w->nfinished == w->nrank && !w->failed && w->nrank <= MOST_KEPT) {
        p = *kept;
        *kept = w->fibers;
    }
    fiber_pool_destroy(p);
}

/* From the outside in: topology, places of ranks, network, stacks. Whatever fails has set
 * the error; world_run gives everything back. */
static bool build(struct world *w, struct err *e)
{
    const struct machine_spec *m = w->machine;
    if (!ground_make(w, &w->placement, 1, NULL, e)) return false;
    const struct node_use use = node_use_placed(m, &w->placement, w->load->working_set);
    w->node_cost = node_use_cost(&m->node, &use);
    w->software = software_cost_used(m, &use);
    w->result->working_set = w->load->working_set;
    if (!world_make_network(w, w->record->links, e)) return false;
    /* Threads ask for memory window by window. */
    if (!by_windows(w) && !arrivals_make(w)) arrivals_foresee(w);
    meeting_create(w);
    /* A log of its own, which only runs that ask for it pay for. */
    if (w->record->path) net_set_path(w->net, w->path = path_log_create());
    if (w->record->path && w->record->slack) path_keep_losers(w->path);
    if (w->record->balance)
        w->balanced = TAKE(w->scratch, size_product(w->nrank, w->nstage + 1), int64_t);
    w->fibers = stacks_take(w, e);
    if (w->fibers && w->load->fills) fiber_pool_fill(w->fibers);
    return w->fibers != NULL;
}

/* A run that processes share: process 0 gets what a run on one has. */
static void end_shared(struct world *w)
{
    struct run_result *r = w->result;
    enum shared_end end = shared_end(w);
    const bool chief = w->load->hosts->rank == 0;
    /* Whatever the processes are asked for, one that does not answer breaks the job. */
    if (end == SHARED_FINISHED && !shared_collect(w)) end = SHARED_BROKEN;
    if (end == SHARED_FINISHED && chief) world_copy_links(w);
    if (end == SHARED_DEADLOCK && !shared_gather_waiting(w)) end = SHARED_BROKEN;
    if (end == SHARED_DEADLOCK && chief) {
        deadlock_explain(w);
        deadlock_time(w, w->result->makespan_ps);
    }
    if (end == SHARED_FINISHED) return;
    /* As on one process: times of a deadlock are kept, those of a failure are not. */
    if (end != SHARED_DEADLOCK) forget_parts(w);
    r->status = end == SHARED_DEADLOCK ? RUN_DEADLOCK : RUN_FAILED;
    r->job_broken = end == SHARED_BROKEN;
    if (r->job_broken) text_copy(r->text, sizeof r->text, HOSTS_SILENT);
}

/* Host time covers ranks and events, not building. */
static void run(struct world *w, uint64_t seed)
{
    struct run_result *r = w->result;
    double begin = host_seconds();
    world_begin_heartbeat(w, begin);
    w->vp = TAKE_FULL(w->scratch, w->nrank, struct vp, !w->load->hosts);
    w->ready = TAKE(w->scratch, w->nrank, struct vp *);
    world_make_tables(w);
    /* Programs of users are watched by whoever loads them. */
    if (w->load->overflowed && !w->load->foreign)
        w->fault = stack_fault_begin(w->fibers, tell_overflow, w);
    if (by_windows(w)) {
        windows_run(w, seed);
    } else if ((w->load->threads > 1 || w->load->hosts) &&
               !world_ordered(w->machine, w->load, w->record)) {
        team_run(w, seed);
    } else {
        world_make_ranks(w, seed);
        background_start(w, seed);
        world_loop(w);
    }
    stack_fault_end(w->fault);
    r->host_s = host_seconds() - begin;
    if (w->load->hosts) {
        end_shared(w);
        return;
    }
    if (w->nfinished == w->nrank && !w->failed && w->load->foreign && !w->load->leftovers)
        find_leftovers(w);
    if (w->nfinished == w->nrank && !w->failed) measure_stacks(w);
    if (w->nfinished == w->nrank && !w->failed) {
        world_collect(w);
        world_copy_links(w);
        if (w->path) trace_path(w);
        return;
    }
    /* One of three causes: the program failed, simulated time ended, or nobody can go on.
     * A deadlock's times are kept, since they show who waited where. What an event or a
     * rank would do beyond the end of time cannot be simulated, so such a run has failed. */
    const bool late = w->late || sim_beyond(w->sim), deadlock = !w->failed && !late;
    if (deadlock) {
        deadlock_explain(w);
        deadlock_time(w, deadlock_reached(w, 0, w->nrank));
    } else if (!w->failed) late_explain(w);
    if (!deadlock) forget_parts(w);
    r->status = deadlock ? RUN_DEADLOCK : RUN_FAILED;
}

bool world_run(const struct machine_spec *m, const struct world_load *load,
               const struct record_spec *record, uint64_t seed, struct arena *a,
               struct run_result *out, struct err *e)
{
    struct message_pool pool = {0};
    const struct arena_mark begin =
        load->scratch ? arena_mark(load->scratch) : (struct arena_mark){0};
    struct world w = {
        .machine = m,
        .record = record,
        .result = out,
        .arena = a,
        .scratch = load->scratch ? load->scratch : arena_create(),
        .arrived = world_arrived,
        .sim = sim_create(),
        .nrank = load->nrank,
        .nown = load->nrank,
        .pool = &pool,
        .nstage = load->nstage,
        .load = load,
        .shared_channel = m->software.shared_bandwidth > 0,
        .eager_only = world_all_eager(m, load),
        .noisy = m->noise.compute_cv > 0,
    };
    struct published published = {.lock = PTHREAD_MUTEX_INITIALIZER};
    pool.arena = w.scratch;
    w.whole = &w;
    if (load->hosts) {
        int end;
        CHECK(!world_ordered(m, load, record));
        team_part(load, load->hosts->rank, &w.first, &end);
        w.nown = end - w.first;
        if (load->hosts->rank > 0 && !load->keeps_outputs) w.published = &published;
    }
    out->nrank = load->nrank;
    world_name_stages(out, load->nstage, load->stage_name);
    bool ok = build(&w, e);
    if (load->hosts) ok = shared_built(&w, ok, e);
    if (ok) run(&w, seed);
    path_log_destroy(w.path);
    stacks_leave(&w);
    sim_destroy(w.sim);
    /* Somebody who has many runs keeps the memory for the next one. */
    if (load->scratch) arena_release(load->scratch, begin);
    else arena_destroy(w.scratch);
    free(published.interval);
    return ok;
}

void world_part(const struct world_load *load, int *first, int *end)
{
    team_part(load, load->hosts ? load->hosts->rank : 0, first, end);
}
