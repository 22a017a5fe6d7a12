/* mpi_message.c - sending and receiving: from the program's arguments to messages of comm.h and
 * back. */
#include "mpi/mpi_internal.h"

/* The rank of the world behind a rank of the communicator; an intercommunicator's are those of the
 * other side. */
static int world_rank(const struct mpi_comm *c, int rank)
{
    return mpi_group_world(c->remote ? c->remote : c->group, rank);
}

/* A rank is checked against the side that it belongs to. */
static int peers(const struct mpi_comm *c) { return c->remote ? c->remote->size : c->size; }

/* mpi_message_check: the arguments that all calls share, into *q. */
int mpi_message_check(struct mpi_rank *r, struct mpi_request *q, struct mpi_message m)
{
    *q = (struct mpi_request){.what = m.receive ? REQUEST_RECEIVE : REQUEST_SEND, .mode = m.mode};
    q->comm = mpi_comm_of(r, m.comm);
    /* Nothing is said of what goes to nobody. Section 3.11: a message to or from
     * MPI_PROC_NULL has no effect, and its type may be anything. */
    if (m.peer == MPI_PROC_NULL) m.type = MPI_BYTE;
    q->type = q->comm ? mpi_type_of(r, m.type) : NULL;
    if (!q->type) return r->code;
    struct mpi_comm *c = q->comm;
    if (m.count < 0)
        return mpi_error(r, c, MPI_ERR_COUNT, "count %lld is negative", (long long)m.count);
    if (!q->type->committed) return mpi_error(r, c, MPI_ERR_TYPE, "the datatype was not committed");
    bool wild = m.receive && m.peer == MPI_ANY_SOURCE;
    if (!wild && m.peer != MPI_PROC_NULL && (m.peer < 0 || m.peer >= peers(c)))
        return mpi_error(r, c, MPI_ERR_RANK, "rank %d is not in the communicator of %d ranks",
                         m.peer, peers(c));
    if (m.tag < 0 && !(m.receive && m.tag == MPI_ANY_TAG) && m.peer != MPI_PROC_NULL)
        return mpi_error(r, c, MPI_ERR_TAG, "tag %d is negative", m.tag);
    /* A type with gaps may hold absolute addresses and begin at MPI_BOTTOM, which is NULL
     * (section 5.1.5): then NULL is right. */
    if (!m.buffer && q->type->dense && m.count * q->type->size > 0 && m.peer != MPI_PROC_NULL)
        return mpi_error(r, c, MPI_ERR_BUFFER, "the buffer is NULL");
    q->buffer = m.buffer;
    q->count = m.count;
    q->peer = m.peer;
    q->tag = m.tag;
    return MPI_SUCCESS;
}

/* send: comm.h copies the data, so that packed ones are not needed any more when it returns. */
static int send(struct mpi_rank *r, struct mpi_request *q)
{
    struct mpi_comm *c = q->comm;
    int64_t bytes = q->count * q->type->size;
    /* A dense type's bytes lie in the program's memory already; comm.h copies them into
     * the message. */
    const void *data = q->buffer;
    void *packed = NULL;
    struct comm_request *buffered = NULL;
    if (q->mode == MODE_BUFFERED && !(buffered = mpi_buffer_room(r, c, bytes)))
        return MPI_ERR_BUFFER;
    if (!q->type->dense && bytes) {
        data = packed = mpi_take(r->world, bytes);
        mpi_pack_bytes(packed, q->buffer, q->count, q->type);
        mpi_charge_copy(r, bytes);
    }
    /* Modes of section 3.4. Synchronous sends wait until they are matched. Those of
     * buffered ones are the buffer's, so that the call is local whatever the size. Ready sends go
     * as standard ones: that the receive is posted is the program's promise. */
    int to = world_rank(c, q->peer);
    int64_t tag = mpi_tag(c->context, PLANE_PROGRAM, q->tag);
    if (q->mode == MODE_SYNCHRONOUS) comm_isend_synchronous(r->comm, to, tag, data, bytes, &q->q);
    else if (q->mode == MODE_BUFFERED) comm_isend(r->comm, to, tag, data, bytes, buffered);
    else comm_isend(r->comm, to, tag, data, bytes, &q->q);
    mpi_give(r->world, packed);
    return MPI_SUCCESS;
}

/* The tag of another context cannot match, because the mask always covers the upper bits. */
static void receive(struct mpi_rank *r, struct mpi_request *q)
{
    struct mpi_comm *c = q->comm;
    bool any_tag = q->tag == MPI_ANY_TAG;
    void *room = mpi_receive_room(r, q);
    int from = q->peer == MPI_ANY_SOURCE ? COMM_ANY_SOURCE : world_rank(c, q->peer);
    int64_t tag = mpi_tag(c->context, PLANE_PROGRAM, any_tag ? 0 : q->tag);
    /* MPI_ANY_TAG leaves the lower 32 bits open and keeps context and plane. */
    int64_t mask = any_tag ? ~(INT64_C(0xffffffff)) & COMM_WHOLE_TAG : COMM_WHOLE_TAG;
    comm_irecv_matching(r->comm, from, tag, mask, room, q->room, &q->q);
}

/* mpi_receive_room: where the bytes come in: the program's buffer, or packed bytes where its type
 * has gaps. */
void *mpi_receive_room(struct mpi_rank *r, struct mpi_request *q)
{
    q->room = q->count * q->type->size;
    q->staging = NULL;
    if (q->type->dense) return (void *)(uintptr_t)q->buffer;
    return q->staging = mpi_take(r->world, q->room ? q->room : 1);
}

/* Persistent requests come here once for each start, so what the last one left is
 * cleared. */
int mpi_message_begin(struct mpi_rank *r, struct mpi_request *q)
{
    q->q = (struct comm_request){0};
    q->error = MPI_SUCCESS;
    q->cancelled = false;
    q->staging = NULL;
    q->room = 0;
    if (q->peer == MPI_PROC_NULL) return MPI_SUCCESS;
    if (q->what == REQUEST_SEND) return send(r, q);
    receive(r, q);
    return MPI_SUCCESS;
}

/* Ranks of the world become ranks of the communicator only where the program does not
 * know them. */
static int source_of(struct mpi_rank *r, const struct mpi_request *q)
{
    if (q->peer != MPI_ANY_SOURCE) return q->peer;
    return mpi_group_find(r, q->comm->remote ? q->comm->remote : q->comm->group, q->q.peer);
}

/* mpi_message_status: what a complete message tells, also when it is only looked at. */
void mpi_message_status(struct mpi_rank *r, const struct mpi_request *q, MPI_Status *status)
{
    /* A send has nothing to tell, and a message from nobody comes from there. */
    if (q->cancelled || q->what == REQUEST_SEND)
        mpi_status_set(status, MPI_ANY_SOURCE, MPI_ANY_TAG, 0);
    else if (q->peer == MPI_PROC_NULL) mpi_status_set(status, MPI_PROC_NULL, MPI_ANY_TAG, 0);
    else
        mpi_status_set(status, source_of(r, q), (int)(q->q.tag & 0xffffffff),
                       q->q.truncated ? q->room : q->q.bytes);
    /* The third internal word is what MPI_Test_cancelled reads (mpi_status.c). */
    if (q->cancelled && status) status->MPI_internal[2] = 1;
}

/* mpi_message_finish: the message is there: unpack it, tell its status, or that it was too long. */
int mpi_message_finish(struct mpi_rank *r, struct mpi_request *q, MPI_Status *status)
{
    mpi_message_status(r, q, status);
    if (q->cancelled) mpi_give(r->world, q->staging);
    if (q->cancelled || q->what == REQUEST_SEND || q->peer == MPI_PROC_NULL) return MPI_SUCCESS;
    /* A message may be shorter than the type has room for: unpacking stops where the
     * bytes end. What does not fit is cut: bytes that are there are delivered, and the
     * error says the rest. */
    if (q->staging) {
        int64_t bytes = q->q.truncated ? q->room : q->q.bytes;
        mpi_unpack_bytes((void *)(uintptr_t)q->buffer, q->staging, bytes, q->count, q->type);
        mpi_charge_copy(r, bytes);
        mpi_give(r->world, q->staging);
        q->staging = NULL;
    }
    if (!q->q.truncated) return MPI_SUCCESS;
    return mpi_error(r, q->comm, MPI_ERR_TRUNCATE,
                     "the message of %lld bytes from rank %d with tag %d is longer "
                     "than the buffer of %lld",
                     (long long)q->q.bytes, source_of(r, q), (int)(q->q.tag & 0xffffffff),
                     (long long)q->room);
}
