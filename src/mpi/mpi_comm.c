/* mpi_comm.c - communicators: a group, and a context that keeps their messages apart. */
#include "mpi/mpi_internal.h"

struct mpi_comm *mpi_comm_make(struct mpi_rank *r, struct mpi_group *g, int context,
                               struct mpi_comm *like)
{
    struct mpi_comm *c = mpi_take_zero(r->world, sizeof *c);
    mpi_handle_make(r, c, KIND_COMM);
    /* One group serves all communicators made of the same ranks, and the program's
     * handles of it: whoever lets go last frees it. */
    c->group = g; /* the caller's use of it */
    c->rank = g->rank;
    c->size = g->size;
    c->context = context;
    /* Known once, because a hardware barrier is asked for at each barrier
     * (mpi_algorithm.c). */
    c->whole = !g->list && g->first == 0 && g->step == 1 && g->size == r->size;
    /* Section 9.3: a new communicator has the error handler of the one it was made from. */
    c->handler = like ? like->handler : NULL;
    mpi_errhandler_use(c->handler);
    mpi_channel_make(&c->channel, r, g, context, PLANE_COLLECTIVE);
    /* The network's own collectives are of all ranks. */
    if (c->whole) c->channel.comm.hardware = r->comm->hardware;
    return c;
}

/* Uses are the program's handle and each request that is not complete (section 7.4.3): a
 * communicator that the program has freed lives until these are done. Drops of parts
 * accept NULL. */
void mpi_comm_drop(struct mpi_rank *r, struct mpi_comm *c)
{
    if (!c || --c->o.uses > 0) return;
    mpi_handle_end(r, c);
    mpi_group_drop(r, c->group);
    mpi_group_drop(r, c->remote);
    mpi_comm_drop(r, c->local);
    mpi_errhandler_drop(r, c->handler);
    mpi_topology_end(r, c);
    mpi_give(r->world, c->name);
    mpi_give(r->world, c);
}
