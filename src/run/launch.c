/* launch.c - workspaces for all ranks, and the program that hands each its own; see launch.h. */
#include "run/launch.h"

#include "vp/world.h"

struct launch {
    const struct kernel_type *kernel;
    const struct kernel_job *job;
    char **workspace; /* (nrank) */
};

static void program(struct comm *c, void *context)
{
    struct launch *l = context;
    l->kernel->run(c, l->job, l->workspace[comm_rank(c)]);
}

/* Taken one by one: all of it will be touched, so the arena may use large pages. */
static char **make_workspaces(const struct kernel_job *job, const struct kernel_type *kernel, struct arena *a)
{
    char **w = TAKE(a, job->nrank, char *);
    for (int i = 0; i < job->nrank; i++) w[i] = arena_take(a, kernel->workspace_bytes(job, i));
    return w;
}

int64_t launch_largest_message(const struct kernel_type *kernel, const struct kernel_job *job)
{
    return kernel->largest_message ? kernel->largest_message(job) : -1;
}

bool launch_job(const struct kernel_type *kernel, const struct kernel_job *job, const struct machine_spec *m,
                const struct record_spec *record, uint64_t seed, int64_t largest, struct arena *scratch,
                struct arena *a, struct run_result *out, struct err *e)
{
    struct launch l = {kernel, job, make_workspaces(job, kernel, scratch)};
    const struct world_load load = {.nrank = job->nrank, .program = program, .context = &l, .nstage = kernel->nstage,
                                    .stage_name = kernel->stage_name, .largest_message = largest,
                                    .output = job->output, .noutput = KERNEL_OUTPUTS, .pulse = job->spec->pulse};
    return world_run(m, &load, record, seed, a, out, e);
}
