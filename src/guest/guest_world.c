/* guest_world.c - images loaded and priced, ranks begun and ended; see guest_world.h. */
#include "guest/guest_world.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/picoseconds.h"
#include "base/progress.h"
#include "base/size.h"
#include "loader/price.h"
#include "machine/node_use.h"
#include "loader/crash.h"
#include "vp/world.h"

/* --- what the loader asks for ----------------------------------------------------------------- */

/* The rank's clock, for time(), clock() and their like. */
static int64_t now_ps(void *context) { return comm_now_ps(((struct guest_rank *)context)->comm); }

/* Counted blocks have their price already. What host time costs is taken whenever blocks are told:
 * it includes what the simulator did meanwhile, so it is an upper bound. */
static void elapse_ps(void *context, int64_t ps)
{
    struct guest_rank *g = context;
    switch (g->world->cost) {
    case PROGRAM_COST_BLOCKS:
        comm_elapse(g->comm, ps);
        return;
    case PROGRAM_COST_HOST: {
        /* What the simulator does in comm_elapse is not counted twice: the next stretch
         * begins after it. */
        const double now = host_seconds();
        comm_elapse(g->comm, ps_rounded((now - g->host_s) * 1e12 * g->world->spec->program.factor));
        g->host_s = host_seconds();
        return;
    }
    default:
        return; /* the program says what it costs */
    }
}

/* Sleeping is computing of a known length: the rank does nothing else meanwhile. */
static void sleep_ps(void *context, int64_t ps)
{
    comm_elapse(((struct guest_rank *)context)->comm, ps);
}

/* 1 and 2 are the streams; everything that is not standard error is output. */
static void output(void *context, int stream, const char *data, size_t n)
{
    struct guest_rank *g = context;
    const int which = stream == 2;
    guest_line_add(&g->line[which], g->comm->rank, which + 1, data, n, g->world->output,
                   g->world->said);
}

void guest_rank_end_lines(struct guest_rank *g)
{
    for (int i = 0; i < 2; i++)
        guest_line_end(&g->line[i], g->comm->rank, i + 1, g->world->output, g->world->said);
}

/* The loader's texts hold call and place already. */
static void fail(void *context, const char *text)
{
    struct guest_rank *g = context;
    guest_rank_end_lines(g);
    g->comm->file = NULL; /* the text says where */
    g->comm->type->end_run(g->comm, text);
}

/* What the program states counts when its author's counts are the cost. Numbers that are none cost
 * nothing. */
static void compute(void *context, double flops, double bytes)
{
    struct guest_rank *g = context;
    const struct node_cost *c = &g->world->node;
    if (g->world->cost != PROGRAM_COST_AUTHOR) return;
    const double ps = node_cost_stated_ps(c, flops, bytes);
    comm_elapse(g->comm, ps_rounded(ps * g->world->spec->program.factor));
}

static const struct loader_hooks hooks = {now_ps, elapse_ps, sleep_ps, output, fail, compute};

/* --- images ----------------------------------------------------------------------------------- */

/* Every block of the code gets its price on this machine before copies are made. Where
 * host time is the cost, blocks only tell that something was computed since the last
 * call. Prices are patched into the code once, since all ranks are on processors of one
 * kind. */
static bool price_blocks(struct guest_world *w, struct err *e)
{
    const struct node_cost told = {.instruction = 1};
    if (w->cost == PROGRAM_COST_AUTHOR || w->cost == PROGRAM_COST_REAL) return true;
    if (w->cost == PROGRAM_COST_HOST) return loader_price_blocks(w->image, &told, 1, e);
    return loader_price_blocks(w->image, &w->node, w->spec->program.factor, e);
}

/* Where its data lie, and with whom it shares the way to them: alone it has what all ranks have. */
static bool find_use(const struct guest_world *w, int nrank, struct node_use *use, struct err *e)
{
    const struct run_spec *s = w->spec;
    const int64_t own = s->program.working_set;
    *use = node_use_alone(size_count(own, s->nrank));
    return w->alone || node_use_make(&s->machine, nrank, own, use, e);
}

bool guest_world_open(struct guest_world *w, const struct node_spec *node, int nrank, struct err *e)
{
    char why[256];
    const struct program_spec *p = &w->spec->program;
    struct node_use use;
    if (!find_use(w, nrank, &use, e)) return false;
    w->node = node_use_cost(node, &use);
    w->image = loader_open(p->image, e);
    /* What was made so far is given back by guest_world_close. */
    if (w->image == NULL || !price_blocks(w, e) || !loader_reserve(w->image, nrank, &hooks, e))
        return false;
    /* From here on a crash, or a loop that calls nothing, is this program's. */
    const char *job = w->spec->job.name;
    crash_watch(w->image, w->stack_bytes, job[0] != '\0' ? job : NULL);
    crash_limit(w->host_limit > 0 ? w->host_limit : PROGRAM_HOST_LIMIT);
    /* Collectives by the rules of the machine's software, unless a rank chooses one by name. */
    if (!collective_rules_parse(w->spec->machine.software.collectives, w->rule, &w->nrule, why,
                                (int)sizeof why))
        return err_set(e, ERR_CONFIG, "machine.software.collectives: %s", why);
    return true;
}

/* Watching ends before the image goes: a crash from here on is the simulator's. */
void guest_world_close(struct guest_world *w)
{
    crash_forget(w->image);
    loader_close(w->image);
    w->image = NULL;
}

/* --- ranks ------------------------------------------------------------------------------------ */

/* Functions in this rank's own copy, whose variables they use. */
static void *function_of(const struct mimdsim_program *p, int part)
{
    if (part == GUEST_RUN) return (void *)p->run;
    if (part == GUEST_CHECK) return (void *)p->check;
    return (void *)p->serial[part - GUEST_SERIAL].run;
}

/* A kernel that calls exit has not reached its end. */
static void refuse_exit(struct guest_rank *g, int status)
{
    char text[80];
    snprintf(text, sizeof text, "called exit(%d) before its end", status);
    g->comm->type->end_run(g->comm, text);
}

void guest_rank_begin(struct guest_rank *g, struct comm *c, struct guest_world *w)
{
    struct err e;
    err_clear(&e);
    g->comm = c;
    g->world = w;
    /* This runs on the rank's fiber, so a failure is told as the rank's. */
    g->instance = loader_instantiate(w->image, comm_rank(c), g, &e);
    if (g->instance == NULL) c->type->end_run(c, e.text);
    struct mimdsim_host *host = loader_host(g->instance);
    host->comm = w->calls;
    host->comm_rank = (struct comm *)g;
    g->host_s = host_seconds();
}

void guest_rank_run(struct comm *c, const void *job, void *workspace)
{
    struct guest_rank *g = workspace;
    struct guest_world *w = *(struct guest_world *const *)job;
    char name[] = "program";
    char *argv[] = {name, NULL};
    guest_rank_begin(g, c, w);
    /* Its parameters are written before anything of it runs, constructors included. */
    g->declared = guest_declared(g->instance, w->memory);
    guest_parameters_set(g->declared, w->spec->program.parameters, w->memory);
    /* Constructors, the part, destructors, as in a process and all on the simulated
     * clock. */
    struct loader_outcome end = loader_start(g->instance, 1, argv);
    const int64_t argument[4] = {(int64_t)(intptr_t)g};
    if (c->type->mark != NULL) c->type->mark(c, 1);
    if (!end.exited) end = loader_call(g->instance, function_of(g->declared, w->part), argument);
    if (c->type->mark != NULL) c->type->mark(c, 0);
    if (end.exited) refuse_exit(g, end.status);
    loader_exit(g->instance, 0);
    guest_rank_end_lines(g);
}

/* --- one processor ---------------------------------------------------------------------------- */

/* The run's machine with one processor of one node: no network, no noise. Copied and
 * changed where a network or a second processor would matter. */
static struct machine_spec one_processor(const struct machine_spec *m)
{
    struct machine_spec one = *m;
    one.topology.family = TOPOLOGY_CROSSBAR;
    one.topology.ndim = 1;
    one.topology.dims[0] = 1;
    one.topology.nodes_per_router = 1;
    one.placement.kind = PLACEMENT_LINEAR;
    one.placement.nlist = 0;
    one.network.level = LEVEL_LOGGP;
    one.noise.compute_cv = 0;
    one.noise.background_load = 0;
    /* Serial codes may have a rate of their own. */
    one.node = node_spec_serial(&one.node);
    return one;
}

/* A rank's state lies in memory that outlasts its fiber. */
static void one_rank(struct comm *c, void *context)
{
    struct guest_world *w = context;
    struct guest_rank *g = arena_take(w->memory, sizeof *g);
    guest_rank_run(c, &w, g);
}

bool guest_alone(struct guest_world *w, int part, int64_t stack_bytes, struct arena *a,
                 struct run_result *out, struct err *e)
{
    static const char *const stage[] = {"serial"};
    const struct machine_spec one = one_processor(&w->spec->machine);
    const struct record_spec nothing = {0};
    w->part = part;
    w->stack_bytes = stack_bytes;
    w->alone = true;
    /* A run of its own beside the run that it belongs to; nothing of it is recorded but
     * time and work. */
    const struct world_load load = {.nrank = 1,
                                    .program = one_rank,
                                    .context = w,
                                    .nstage = 1,
                                    .stage_name = stage,
                                    .largest_message = -1,
                                    .foreign = true,
                                    .working_set = size_count(w->spec->program.working_set,
                                                              w->spec->nrank),
                                    .stack_bytes = stack_bytes};
    const bool made =
        guest_world_open(w, &one.node, 1, e) && world_run(&one, &load, &nothing, 0, a, out, e);
    guest_world_close(w);
    return made;
}
