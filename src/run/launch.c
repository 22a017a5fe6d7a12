/* launch.c - workspaces for all ranks, and the function that hands each its own; see launch.h. */
#include "run/launch.h"

#include "vp/world.h"

/* What all ranks share, and each rank's own memory. */
struct launch {
    const struct rank_program *rank; /* its functions */
    const void *job; /* what all ranks read, and none writes */
    char **workspace; /* (nrank) */
};

/* What each virtual processor executes: the program's run function, with its own workspace. */
static void program(struct comm *c, void *context)
{
    struct launch *l = context;
    l->rank->run(c, l->job, l->workspace[comm_rank(c)]);
}

/* Taken one by one: all of it will be touched, so the arena may use large pages. */
static char **make_workspaces(const struct program_run *r, struct arena *a)
{
    char **w = TAKE(a, r->spec.nrank, char *);
    for (int i = 0; i < r->spec.nrank; i++) w[i] = arena_take(a, r->rank->workspace_bytes(r->job, i));
    return w;
}

/* -1: the program does not promise any bound. */
int64_t launch_largest_message(const struct program_run *r)
{
    return r->rank->largest_message ? r->rank->largest_message(r->job) : -1;
}

bool launch_run(const struct program_run *r, const struct machine_spec *m, const struct record_spec *record,
                uint64_t seed, int64_t largest, struct arena *scratch, struct arena *a, struct run_result *out,
                struct err *e)
{
    struct launch l = {r->rank, r->job, make_workspaces(r, scratch)};
    /* The program as the room of virtual processors knows it: functions and promises, no names. */
    const struct world_load load = {.nrank = r->spec.nrank, .program = program, .context = &l,
                                    .nstage = r->rank->nstage, .stage_name = r->rank->stage_name,
                                    .largest_message = largest, .output = r->output, .noutput = PROGRAM_OUTPUTS,
                                    .heartbeat = r->heartbeat, .stack_bytes = r->rank->stack_bytes,
                                    .timed = r->rank->timed, .foreign = r->rank->foreign,
                                    .no_synchronous = r->rank->no_synchronous,
                                    .leftovers = r->rank->leftovers};
    return world_run(m, &load, record, seed, a, out, e);
}
