/* mpi_algorithm.c - the algorithms of comm/collectives.h on a communicator, and those uses of them
 * that making communicators needs. */
#include "mpi/mpi_collective.h"

/* Every rank works out the same shape and so chooses the same algorithm without a
 * message: the rules see sizes that all ranks know. `irregular` keeps those algorithms
 * out that need the counts of others where only the root has them (MPI_Gatherv,
 * MPI_Scatterv). */
void mpi_collective_call(struct mpi_rank *r, struct collective_call *k, bool irregular)
{
    const struct mpi_setup *setup = r->world->setup;
    struct collective_shape s = collective_shape(k);
    s.irregular = s.irregular || irregular;
    /* An operation in progress must not hold the rank itself, as the network's collectives do; all
     * ranks call alike. */
    if (r->running) s.hardware = NULL;
    const struct collective_algorithm *a = collective_choose(&s, setup->rule, setup->nrule);
    /* The algorithm says what it needs; the memory is taken here, because it must last as
     * long as the operation, which may be in progress on a stack of its own. */
    int64_t bytes = collective_scratch(a, &s, k->comm->rank);
    k->scratch = bytes > 0 ? mpi_take(r->world, bytes) : NULL;
    collective_run(a, k);
    mpi_give(r->world, k->scratch);
}

/* The first rank's integer to all ranks of the channel: how a new context becomes known. */
void mpi_collective_tell(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence, int *value)
{
    struct collective_call call = {.kind = COLLECTIVE_BROADCAST, .comm = &k->comm, .count = 1};
    call.element = sizeof *value;
    call.tag = mpi_collective_tag(sequence);
    call.recv = value;
    mpi_collective_call(r, &call, false);
}

/* Elements of one byte, so that a struct of any kind goes as it lies: all ranks are of
 * one host. */
void mpi_collective_allgather(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence,
                              const void *own, void *all, int64_t bytes)
{
    struct collective_call call = {
        .kind = COLLECTIVE_ALLGATHER, .comm = &k->comm, .count = bytes, .element = 1};
    call.tag = mpi_collective_tag(sequence);
    call.send = own;
    call.recv = all;
    mpi_collective_call(r, &call, false);
}

/* The machine's own barrier where it has one for all ranks. It holds the rank, which a non-blocking
 * one must not. */
void mpi_collective_barrier(struct mpi_rank *r, struct mpi_comm *c, unsigned sequence)
{
    if (c->whole && r->world->setup->hardware_barrier && !r->running) {
        comm_barrier(r->comm);
        return;
    }
    struct collective_call call = {.kind = COLLECTIVE_BARRIER, .comm = &c->channel.comm};
    call.tag = mpi_collective_tag(sequence);
    mpi_collective_call(r, &call, false);
}
