/* mpi_world.c - MPI programs linked into a test (mpi_world.h). Ranks share mimdsim_host, so that
 * the stubs of these programs set it again after every call. */
#include "mpi_world.h"

#include <mimdsim/host.h>

struct mimdsim_host *mimdsim_host;

struct started {
    struct mpi_world *world;
    mpi_program *program;
    void *context;
    bool whole; /* with Init and Finalize */
};

static void no_time(struct mimdsim_host *host, int64_t ps) { (void)host, (void)ps; }
static void failed(struct mimdsim_host *host, const void *place, const char *text)
{
    (void)host, (void)place;
    fail_msg("%s", text);
}

static void rank_main(struct comm *c, void *context)
{
    static const struct mimdsim_runtime runtime = {.elapse_ps = no_time, .fail = failed};
    struct started *s = context;
    struct mpi_rank *r = mpi_rank_create(s->world, c, c);
    struct mimdsim_host host = {.rank = comm_rank(c), .nrank = comm_size(c), .runtime = &runtime};
    host.mpi = &mpi_functions;
    host.mpi_rank = r;
    mimdsim_host = &host;
    if (s->whole) MPI_Init(NULL, NULL);
    s->program(s->context);
    if (s->whole) MPI_Finalize();
    mpi_rank_end(r);
}

static struct outcome start(const struct machine_spec *m, int n, const struct mpi_setup *setup,
                            struct started s)
{
    struct arena *a = arena_create();
    s.world = mpi_world_create(a, setup);
    struct outcome o = run_load(m, (struct world_load){.nrank = n,
                                                       .program = rank_main,
                                                       .context = &s,
                                                       .stack_bytes = 1 << 18,
                                                       .timed = true,
                                                       .foreign = true,
                                                       .leftovers = true});
    mpi_world_destroy(s.world);
    arena_destroy(a);
    return o;
}

struct outcome mpi_bare(const struct machine_spec *m, int n, const struct mpi_setup *setup,
                        mpi_program *program, void *context)
{
    return start(m, n, setup, (struct started){.program = program, .context = context});
}

struct outcome mpi_go(int n, mpi_program *program, void *context)
{
    static const struct mpi_setup setup;
    struct machine_spec m = crossbar(n);
    return start(&m, n, &setup,
                 (struct started){.program = program, .context = context, .whole = true});
}

void mpi_ok(int n, mpi_program *program, void *context)
{
    struct outcome o = mpi_go(n, program, context);
    expect_ok(&o);
    arena_destroy(o.arena);
}

void mpi_fails(int n, mpi_program *program, void *context, const char *text)
{
    struct outcome o = mpi_go(n, program, context);
    if (o.r.status != RUN_FAILED || !strstr(o.r.text, text))
        fail_msg("status %d, '%s' instead of '%s'", (int)o.r.status, o.r.text, text);
    arena_destroy(o.arena);
}

int own_rank(void)
{
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int all_ranks(void)
{
    int size;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

static int64_t sum_of(const struct outcome *o, bool bytes)
{
    int64_t sum = 0;
    for (int k = 0; k < o->r.nrank * o->r.nstage; k++)
        sum += bytes ? o->r.stage[k].bytes : o->r.stage[k].messages;
    return sum;
}
int64_t messages_of(const struct outcome *o) { return sum_of(o, false); }
int64_t bytes_of(const struct outcome *o) { return sum_of(o, true); }
