/* mpi_start.c - the beginning and end of MPI in a rank, and what may be asked at any time.
 *
 * Chapters 9 and 11 of MPI 5.0. A run is one world of ranks that all begin together; none
 * joins later. */
#include <stdio.h>
#include <stdlib.h>

#include "mpi/mpi_internal.h"

/* Everything that ranks share is of one run and of one thread, so nothing is locked. */
struct mpi_world *mpi_world_create(struct arena *a, const struct mpi_setup *setup)
{
    struct mpi_world *w = arena_take(a, sizeof *w);
    *w = (struct mpi_world){.setup = setup, .arena = a};
    return w;
}

/* Ranks may have ended anywhere: their stacks and large blocks are found through the
 * world. */
void mpi_world_destroy(struct mpi_world *w)
{
    if (!w) return;
    mpi_tasks_end(w);
    mpi_memory_end(w);
}

struct mpi_rank *mpi_rank_create(struct mpi_world *w, struct comm *c, void *host)
{
    struct mpi_rank *r = arena_take(w->arena, sizeof *r);
    *r = (struct mpi_rank){
        .comm = c, .world = w, .host = host, .rank = comm_rank(c), .size = comm_size(c)};
    /* The table of handles is made by the first that is needed. */
    r->free_object = -1;
    r->call = "before MPI_Init";
    /* comm.h reports where a rank waits by file and line of its call: here that is the
     * MPI function (mpi_enter). */
    c->keep_site = 1;
    return r;
}

void mpi_rank_end(struct mpi_rank *r)
{
    /* Section 11.2: a program that has begun MPI must end it, or the others may wait for
     * it for ever. One that never began is fine. */
    if (r->initialized && !r->finalized) {
        r->address = NULL;
        r->call = "the end of the program";
        mpi_fail(r, "the program ends without MPI_Finalize");
    }
}

/* Every stub calls this first. The return address costs nothing to keep, and is looked up
 * only when something is wrong. */
void mpi_enter(struct mpi_rank *self, const char *call, const void *address, int anytime)
{
    self->call = call;
    self->address = address;
    self->comm->file = call;
    self->comm->line = 0;
    if (anytime || (self->initialized && !self->finalized)) return;
    mpi_fail(self, self->finalized ? "called after MPI_Finalize" : "called before MPI_Init");
}

/* Functions without an implementation are in the table, too, so that programs link; a
 * call ends the run by name. */
void mpi_refuse(struct mpi_rank *self, const char *call, const char *reason)
{
    char text[512];
    self->call = call;
    snprintf(text, sizeof text,
             "this function is not supported: %s (docs/mpi.md lists those that are)", reason);
    mpi_fail(self, text);
}

/* --- begin --- */

/* Groups of the world and of a rank alone are regular: no list of P ranks on each of P
 * ranks. */
static struct mpi_comm *first_comm(struct mpi_rank *r, int first, int n, int context)
{
    struct mpi_group *g = mpi_take_zero(r->world, sizeof *g);
    mpi_handle_make(r, g, KIND_GROUP);
    g->size = n;
    g->first = first;
    g->step = 1;
    g->rank = r->rank - first;
    struct mpi_comm *c = mpi_comm_make(r, g, context, NULL);
    /* Section 9.3: errors are fatal unless the program says otherwise. */
    c->handler = mpi_errhandler_of(r, MPI_ERRORS_ARE_FATAL);
    return c;
}

int mpi_init_thread(struct mpi_rank *self, int *argc, char ***argv, int required, int *provided)
{
    /* Arguments are the program's alone; nothing of the library's is among them. */
    (void)argc, (void)argv;
    if (self->initialized) mpi_fail(self, "called a second time");
    if (self->finalized) mpi_fail(self, "called after MPI_Finalize");
    self->initialized = 1;
    self->world_comm = first_comm(self, 0, self->size, WORLD_CONTEXT);
    self->self_comm = first_comm(self, self->rank, 1, SELF_CONTEXT);
    /* a rank is one thread: more than serialized calls cannot happen */
    self->thread_level = required < MPI_THREAD_SERIALIZED ? required : MPI_THREAD_SERIALIZED;
    *provided = self->thread_level;
    return MPI_SUCCESS;
}

int mpi_init(struct mpi_rank *self, int *argc, char ***argv)
{
    int provided;
    return mpi_init_thread(self, argc, argv, MPI_THREAD_SINGLE, &provided);
}

int mpi_initialized(struct mpi_rank *self, int *flag)
{
    *flag = self->initialized;
    return MPI_SUCCESS;
}

int mpi_finalized(struct mpi_rank *self, int *flag)
{
    *flag = self->finalized;
    return MPI_SUCCESS;
}

int mpi_query_thread(struct mpi_rank *self, int *provided)
{
    *provided = self->thread_level;
    return MPI_SUCCESS;
}

int mpi_is_thread_main(struct mpi_rank *self, int *flag)
{
    (void)self;
    *flag = 1;
    return MPI_SUCCESS;
}

/* --- end --- */

/* Attributes of MPI_COMM_SELF are deleted first, which is the program's hook at the end. */
int mpi_finalize(struct mpi_rank *self)
{
    char text[160];
    /* Chapter 11 gives this order; the functions may still communicate. */
    mpi_attributes_end(self, KIND_COMM, self->self_comm);
    mpi_attributes_end(self, KIND_COMM, self->world_comm);
    if (self->windows) mpi_fail(self, "a window was not freed");
    /* A request left behind is a mistake (section 11.2), which real libraries often pass
     * over. */
    if (self->pending > 0) {
        snprintf(text, sizeof text, "%d request%s started and neither completed nor freed",
                 self->pending, self->pending == 1 ? " was" : "s were");
        mpi_fail(self, text);
    }
    /* All ranks are here before one leaves; then operations that were freed while in
     * progress come to their end. */
    mpi_collective_barrier(self, self->world_comm, self->world_comm->sequence++);
    while (self->tasks) mpi_progress(self, 0, NULL, true);
    self->finalized = 1;
    return MPI_SUCCESS;
}

/* All ranks end, whatever the communicator, which the standard allows. */
int mpi_abort(struct mpi_rank *self, MPI_Comm comm, int errorcode)
{
    const struct mpi_setup *s = self->world->setup;
    char text[64];
    (void)comm;
    if (s->abort) s->abort(self->host, errorcode);
    snprintf(text, sizeof text, "the program ends the run with code %d", errorcode);
    mpi_fail(self, text);
}

/* --- at any time --- */

/* Ranks on one node have one name, by which programs find out who shares memory. */
int mpi_get_processor_name(struct mpi_rank *self, char *name, int *resultlen)
{
    const struct mpi_setup *s = self->world->setup;
    int node = s->node ? s->node[self->rank] : self->rank;
    *resultlen = snprintf(name, MPI_MAX_PROCESSOR_NAME, "%s%d",
                          s->processor_name ? s->processor_name : "node", node);
    return MPI_SUCCESS;
}

int mpi_get_version(struct mpi_rank *self, int *version, int *subversion)
{
    (void)self;
    *version = MPI_VERSION;
    *subversion = MPI_SUBVERSION;
    return MPI_SUCCESS;
}

int mpi_abi_get_version(struct mpi_rank *self, int *abi_major, int *abi_minor)
{
    (void)self;
    *abi_major = MPI_ABI_VERSION;
    *abi_minor = MPI_ABI_SUBVERSION;
    return MPI_SUCCESS;
}

int mpi_get_library_version(struct mpi_rank *self, char *version, int *resultlen)
{
    (void)self;
    *resultlen =
        snprintf(version, MPI_MAX_LIBRARY_VERSION_STRING, "mimdsim: MPI on simulated machines");
    return MPI_SUCCESS;
}

/* There is no profiler to be told. */
int mpi_pcontrol(struct mpi_rank *self, const int level)
{
    (void)self, (void)level;
    return MPI_SUCCESS;
}

/* Simulated time: the same clock for all ranks. Looking at it takes 20 ns, so that a
 * program that waits by looking goes on. Of the order of reading a clock on a current
 * processor; not a setting of the machine. */
enum { LOOK = 20000 /* [ps] */ };
/* Seconds since the run began. 1e-12 is one tick, of which a double tells neighbours
 * apart for about two and a half hours. */
double mpi_wtime(struct mpi_rank *self)
{
    comm_elapse(self->comm, LOOK);
    return (double)comm_now_ps(self->comm) * 1e-12;
}
double mpi_wtick(struct mpi_rank *self)
{
    (void)self;
    return 1e-12;
}

/* Addresses are the host's: MPI_BOTTOM is 0. */
int mpi_get_address(struct mpi_rank *self, const void *location, MPI_Aint *address)
{
    (void)self;
    *address = (MPI_Aint)location;
    return MPI_SUCCESS;
}

int mpi_address(struct mpi_rank *self, void *location, MPI_Aint *address)
{
    return mpi_get_address(self, location, address);
}

/* Zeroed, so that a program that forgets to set it behaves the same in every run. */
int mpi_alloc_mem(struct mpi_rank *self, MPI_Aint size, MPI_Info info, void *baseptr)
{
    (void)info;
    if (size < 0)
        return mpi_error(self, NULL, MPI_ERR_ARG, "size %lld is negative", (long long)size);
    *(void **)baseptr = mpi_take_zero(self->world, size ? size : 1);
    return MPI_SUCCESS;
}

int mpi_free_mem(struct mpi_rank *self, void *base)
{
    mpi_give(self->world, base);
    return MPI_SUCCESS;
}
