/* mpi_probe.c - looking for messages before they are received, and receiving what was found.
 *
 * Section 3.8 of MPI 5.0. A matched probe takes the message away from all other receives,
 * so that the one that follows it gets the very message that was seen. */
#include "mpi/mpi_internal.h"

/* probe: whether a message fits; `take` keeps it from all others. */
static int probe(struct mpi_rank *r, MPI_Comm comm, int source, int tag, int block, int *flag,
                 MPI_Status *status, struct mpi_request *take)
{
    struct mpi_request q;
    struct comm_envelope e;
    /* A receive of nothing has all the arguments that a probe has, so their check is the
     * same. */
    struct mpi_message m = {MODE_STANDARD, true, NULL, 0, MPI_BYTE, source, tag, comm};
    int code = mpi_message_check(r, &q, m);
    *flag = 1;
    if (code != MPI_SUCCESS) return code;
    if (take) take->comm = q.comm;
    /* A program that only probes must not keep its collectives from going on (progress
     * rule, section 3.7.4). */
    mpi_poll_tasks(r);
    mpi_status_set(status, MPI_PROC_NULL, MPI_ANY_TAG, 0);
    if (source == MPI_PROC_NULL) return code;
    /* From here as a receive would do (mpi_message.c): the same tag and mask, so that it
     * finds the same message. */
    struct mpi_group *peers = q.comm->remote ? q.comm->remote : q.comm->group;
    int from = source == MPI_ANY_SOURCE ? COMM_ANY_SOURCE : mpi_group_world(peers, source);
    int64_t wanted = mpi_tag(q.comm->context, PLANE_PROGRAM, tag == MPI_ANY_TAG ? 0 : tag);
    int64_t mask = tag == MPI_ANY_TAG ? ~(INT64_C(0xffffffff)) & COMM_WHOLE_TAG : COMM_WHOLE_TAG;
    if (take) *flag = comm_probe_take(r->comm, from, wanted, mask, block, &e, &take->q);
    else *flag = comm_probe(r->comm, from, wanted, mask, block, &e);
    /* The size is in the envelope before the data are here: programs take memory for it. */
    if (*flag)
        mpi_status_set(status, mpi_group_find(r, peers, e.source), (int)(e.tag & 0xffffffff),
                       e.bytes);
    return code;
}

int mpi_probe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, MPI_Status *status)
{
    int flag;
    /* while operations are in progress, waiting must not keep them from going on */
    while (self->tasks) {
        int code = probe(self, comm, source, tag, 0, &flag, status, NULL);
        if (flag || code != MPI_SUCCESS) return code;
    }
    /* Without operations in progress waiting needs no polls: the rank stops until a
     * message comes. */
    return probe(self, comm, source, tag, 1, &flag, status, NULL);
}

int mpi_iprobe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag,
               MPI_Status *status)
{
    return probe(self, comm, source, tag, 0, flag, status, NULL);
}

/* The message waits inside a request; its handle is first that of a request, then of a
 * message. */
static int matched_probe(struct mpi_rank *r, int source, int tag, MPI_Comm comm, int block,
                         int *flag, MPI_Message *message, MPI_Status *status)
{
    struct mpi_request *m = mpi_request_make(r, REQUEST_RECEIVE);
    int code = probe(r, comm, source, tag, block, flag, status, m);
    *message = MPI_MESSAGE_NULL;
    mpi_handle_end(r, m);
    if (*flag && source == MPI_PROC_NULL) *message = MPI_MESSAGE_NO_PROC;
    /* Nothing was taken: the request goes back to the spare ones. */
    if (!*flag || code != MPI_SUCCESS || source == MPI_PROC_NULL) {
        m->next = r->spare_request;
        r->spare_request = m;
        return code;
    }
    m->peer = MPI_ANY_SOURCE; /* the message says who */
    *message = mpi_handle_make(r, m, KIND_MESSAGE);
    return code;
}

int mpi_mprobe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, MPI_Message *message,
               MPI_Status *status)
{
    int flag;
    /* as MPI_Probe: operations in progress go on meanwhile */
    while (self->tasks) {
        int code = matched_probe(self, source, tag, comm, 0, &flag, message, status);
        if (flag || code != MPI_SUCCESS) return code;
    }
    return matched_probe(self, source, tag, comm, 1, &flag, message, status);
}

int mpi_improbe(struct mpi_rank *self, int source, int tag, MPI_Comm comm, int *flag,
                MPI_Message *message, MPI_Status *status)
{
    return matched_probe(self, source, tag, comm, 0, flag, message, status);
}

/* receive_matched: the message of a matched probe becomes a request, its handle ends. */
static int receive_matched(struct mpi_rank *r, void *buf, MPI_Count count, MPI_Datatype datatype,
                           MPI_Message *message, MPI_Request *request)
{
    struct mpi_type *t = mpi_type_of(r, datatype);
    if (!t) return r->code;
    /* Section 3.8.3: a message from nobody gives a receive from nobody. */
    if (*message == MPI_MESSAGE_NO_PROC) {
        struct mpi_message none = {MODE_STANDARD, true,          buf, count,
                                   datatype,      MPI_PROC_NULL, 0,   MPI_COMM_SELF};
        struct mpi_request q;
        int code = mpi_message_check(r, &q, none);
        if (code == MPI_SUCCESS)
            code = mpi_request_start(r, &q, (struct mpi_start){MPI_NON_BLOCKING, request});
        return code;
    }
    struct mpi_request *q = mpi_object(r, *message, KIND_MESSAGE);
    if (!q) {
        mpi_bad_handle(r, *message, KIND_MESSAGE);
        return r->code;
    }
    if (count < 0)
        return mpi_error(r, q->comm, MPI_ERR_COUNT, "count %lld is negative", (long long)count);
    /* From here on the request is like one of MPI_Irecv that has been matched: it holds
     * communicator and type, and counts as pending. */
    mpi_handle_end(r, q);
    *message = MPI_MESSAGE_NULL;
    q->type = t;
    q->buffer = buf;
    q->count = count;
    mpi_type_use(t);
    q->comm->o.uses++;
    *request = mpi_handle_make(r, q, KIND_REQUEST);
    q->active = true;
    r->pending++;
    void *room = mpi_receive_room(r, q);
    comm_receive_into(r->comm, &q->q, room, q->room);
    return MPI_SUCCESS;
}

int mpi_imrecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
               MPI_Message *message, MPI_Request *request)
{
    bool none = *message == MPI_MESSAGE_NO_PROC;
    int code = receive_matched(self, buf, count, datatype, message, request);
    if (none) *message = MPI_MESSAGE_NULL;
    return code;
}

/* Waiting for a request is all that a blocking receive adds. */
int mpi_mrecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
              MPI_Message *message, MPI_Status *status)
{
    MPI_Request request;
    int code = mpi_imrecv(self, buf, count, datatype, message, &request);
    return code == MPI_SUCCESS ? mpi_wait(self, &request, status) : code;
}
