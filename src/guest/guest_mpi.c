/* guest_mpi.c - a program with main, which may call MPI, as a program of runs.
 *
 * Its answer is its exit status: 0 on every rank is right. It has one stage, and its speedup is
 * what a sweep over the number of ranks shows: most such programs do not run on one processor alone
 * as they do on many. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "base/argument_line.h"
#include "guest/guest_program.h"
#include "guest/guest_world.h"
#include "machine/placement.h"
#include "machine/topology.h"
#include "mpi/mpi_rank.h"

/* program_run.own */
struct mpi_run {
    struct rank_program rank;
    struct guest_world ranks;
    struct mpi_run *job; /* = itself: what the ranks are given */
    struct mpi_setup setup;
    struct mpi_world *world; /* owned */
    struct text said;
    int argc;
    char **argv;      /* (argc + 1) the program's name and its arguments */
    int *exit_status; /* where the first one that is not 0 goes; borrowed */
};

static const char *const stage[] = {"program"};

static size_t workspace_bytes(const void *job, int rank)
{
    (void)job, (void)rank;
    return sizeof(struct guest_rank);
}

/* --- what room mpi asks for ------------------------------------------------------------------- */

/* Callbacks of MPI have up to six arguments, all of them words. The loader counts what
 * they compute. */
static intptr_t call_program(void *host, void (*function)(void), const intptr_t argument[6])
{
    const struct guest_rank *g = host;
    int64_t six[6];
    for (int i = 0; i < 6; i++) six[i] = argument[i];
    const struct loader_outcome o = loader_call_six(g->instance, (void *)(uintptr_t)function, six);
    return (intptr_t)o.value;
}

/* The world's owner is the run that made it. */
static struct mpi_run *run_of(const struct guest_rank *g) { return g->world->owner; }

static _Noreturn void end_with(struct guest_rank *g, const char *what, int status)
{
    char text[80];
    struct mpi_run *m = run_of(g);
    /* The first failure on the host is the one that `mimdsim mpirun` returns. */
    if (*m->exit_status == 0) *m->exit_status = status;
    snprintf(text, sizeof text, "%s %d", what, status);
    guest_rank_end_lines(g);
    g->comm->file = NULL; /* its last call has nothing to do with it */
    g->comm->type->end_run(g->comm, text);
    __builtin_unreachable();
}

/* MPI_Abort ends the run as failed, with its code as the exit status. */
static void abort_run(void *host, int code) { end_with(host, "called MPI_Abort with code", code); }

static void tell_place(void *host, const void *address, char *text, int size)
{
    const struct guest_rank *g = host;
    if (!loader_address_text(g->world->image, address, text, size)) text[0] = '\0';
}

/* --- ranks ------------------------------------------------------------------------------------ */

static void rank_run(struct comm *c, const void *job, void *workspace)
{
    struct mpi_run *m = *(struct mpi_run *const *)job;
    struct guest_rank *g = workspace;
    guest_rank_begin(g, c, &m->ranks);
    /* Every copy of the image has a host table of its own: the rank behind it is the
     * copy's. */
    struct mimdsim_host *host = loader_host(g->instance);
    host->mpi = &mpi_functions;
    host->mpi_rank = mpi_rank_create(m->world, c, g);
    /* A program may change its arguments: each rank has its own. Copies lie in the run's
     * memory and end with it. */
    struct arena *a = m->ranks.memory;
    char **argv = TAKE(a, m->argc + 1, char *);
    for (int i = 0; i < m->argc; i++) argv[i] = arena_text(a, m->argv[i]);
    const int status = loader_main(g->instance, m->argc, argv);
    /* A rank that lacks MPI_Finalize has failed, but an exit status says more. */
    if (status != 0) end_with(g, "ended with exit status", status);
    mpi_rank_end(host->mpi_rank);
    guest_rank_end_lines(g);
}

/* --- open, prepare, close --------------------------------------------------------------------- */

static bool mpi_open(struct program_run *r, struct err *e)
{
    struct mpi_run *m = TAKE(r->arena, 1, struct mpi_run);
    r->own = m;
    if (r->spec.program.image == NULL)
        return err_set(e, ERR_CONFIG, "program '%s' of a stored run is not at hand",
                       r->spec.kernel.name);
    char why[160];
    m->argc = argument_line_split(r->spec.program.image, r->spec.program.arguments, &m->argv,
                                  r->arena, why, (int)sizeof why);
    if (m->argc < 0) return err_set(e, ERR_CONFIG, "program.arguments: %s", why);
    m->exit_status = &r->exit_status;
    /* Wildcards, probes and tests may come up anywhere. Messages that nobody receives are the
     * program's business, as they are in most implementations of MPI. */
    m->rank = (struct rank_program){.nstage = 1,
                                    .stage_name = stage,
                                    .workspace_bytes = workspace_bytes,
                                    .run = rank_run,
                                    .foreign = true,
                                    .timed = true,
                                    .leftovers = true,
                                    .stack_bytes = GUEST_STACK_BYTES};
    r->rank = &m->rank;
    return true;
}

/* Which ranks share a node, where nodes have several processors. */
static bool find_nodes(struct mpi_run *m, const struct run_spec *s, struct arena *a, struct err *e)
{
    struct placement p;
    if (s->machine.topology.processors_per_node < 2) return true;
    const struct topology *t = topology_create(&s->machine.topology, a, e);
    if (t == NULL || !placement_create(&p, &s->machine, t, s->nrank, a, e)) return false;
    m->setup.node = p.node;
    return true;
}

/* "t3e-300-", to which the number of the node is added. */
static const char *node_name(const struct run_spec *s, struct arena *a)
{
    struct text t = {0};
    text_add(&t, "%s-", s->machine.name);
    const char *name = arena_text(a, t.s);
    text_free(&t);
    return name;
}

static bool mpi_prepare(struct program_run *r, struct arena *scratch, struct err *e)
{
    struct mpi_run *m = r->own;
    const enum program_cost cost = r->spec.program.cost;
    memset(r->output, 0, sizeof r->output);
    m->ranks =
        (struct guest_world){.spec = &r->spec,
                             .owner = m,
                             .memory = scratch,
                             .calls = &guest_calls,
                             .stack_bytes = GUEST_STACK_BYTES,
                             .said = &m->said,
                             .cost = cost == PROGRAM_COST_DECLARED ? PROGRAM_COST_BLOCKS : cost,
                             .output = r->order.output,
                             .host_limit = r->order.host_limit};
    r->said = &m->said;
    m->job = m;
    r->job = &m->job;
    if (!guest_world_open(&m->ranks, &r->spec.machine.node, r->spec.nrank, e)) return false;
    /* Rules of collectives come from the machine, by way of guest_world_open. */
    m->setup =
        (struct mpi_setup){.processor_name = node_name(&r->spec, scratch),
                           .rule = m->ranks.rule,
                           .nrule = m->ranks.nrule,
                           .hardware_barrier = r->spec.machine.software.barrier == BARRIER_HARDWARE,
                           .call = call_program,
                           .abort = abort_run,
                           .place = tell_place};
    if (!find_nodes(m, &r->spec, scratch, e)) return false;
    m->world = mpi_world_create(scratch, &m->setup);
    return true;
}

static void mpi_close(struct program_run *r)
{
    struct mpi_run *m = r->own;
    if (m == NULL) return;
    if (m->world != NULL) mpi_world_destroy(m->world);
    guest_world_close(&m->ranks);
    text_free(&m->said);
}

/* What it costs is known when it has run. */
static void mpi_estimate(const struct program_run *r, struct program_estimate *out)
{
    (void)r;
    *out = (struct program_estimate){
        .messages = NAN, .bytes = NAN, .flops = NAN, .rank_bytes = NAN};
}

const struct program_type guest_mpi_type = {
    .name = "program",
    .title = "a program of your own with main",
    .open = mpi_open,
    .close = mpi_close,
    .prepare = mpi_prepare,
    .estimate = mpi_estimate,
};
