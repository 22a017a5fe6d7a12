/* mpi_exchange.c - messages between some ranks of a communicator, all under way at once. */
#include "mpi/mpi_collective.h"

/* start_part: the message of one part; packed bytes are its staging. */
static void start_part(struct mpi_rank *r, struct mpi_comm *c, int64_t tag,
                       const struct mpi_part *p, struct comm_request *q, void **staging, bool out)
{
    /* Ranks of an intercommunicator are those of the other side. A dense type goes
     * straight between buffers, any other through packed bytes. */
    int64_t bytes = p->count * p->type->size;
    int world = mpi_group_world(c->remote ? c->remote : c->group, p->peer);
    void *data = p->buffer;
    *staging = NULL;
    if (!p->type->dense && bytes) data = *staging = mpi_take(r->world, bytes);
    if (*staging && out) {
        mpi_pack_bytes(data, p->buffer, p->count, p->type);
        mpi_charge_copy(r, bytes);
    }
    if (out) comm_isend(r->comm, world, tag, data, bytes, q);
    else comm_irecv(r->comm, world, tag, data, bytes, q);
}

/* Receives come first, so that what others send while this rank still packs finds its
 * buffer. One tag is enough: between two ranks messages do not overtake, so the k-th sent
 * meets the k-th posted. */
void mpi_exchange(struct mpi_rank *r, struct mpi_comm *c, unsigned sequence, int nin,
                  const struct mpi_part *in, int nout, const struct mpi_part *out)
{
    int n = nin + nout;
    int64_t tag = mpi_tag(c->context, PLANE_COLLECTIVE, mpi_collective_tag(sequence));
    struct comm_request *q = mpi_take_zero(r->world, (n + 1) * (int64_t)sizeof *q);
    void **staging = mpi_take_zero(r->world, (n + 1) * (int64_t)sizeof *staging);
    for (int i = 0; i < nin; i++)
        if (in[i].peer != MPI_PROC_NULL) start_part(r, c, tag, &in[i], &q[i], &staging[i], false);
    for (int i = 0; i < nout; i++)
        if (out[i].peer != MPI_PROC_NULL)
            start_part(r, c, tag, &out[i], &q[nin + i], &staging[nin + i], true);
    /* The order of waiting does not matter: all have to be complete, and the clock ends
     * at the latest. */
    for (int i = 0; i < n; i++) mpi_wait_request(r, &q[i]);
    for (int i = 0; i < nin; i++) {
        if (!staging[i]) continue;
        /* Only types with gaps have bytes to unpack. */
        int64_t bytes = in[i].count * in[i].type->size;
        mpi_unpack_bytes(in[i].buffer, staging[i], bytes, in[i].count, in[i].type);
        mpi_charge_copy(r, bytes);
    }
    for (int i = 0; i < n; i++) mpi_give(r->world, staging[i]);
    mpi_give(r->world, staging);
    mpi_give(r->world, q);
}
