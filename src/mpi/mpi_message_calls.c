/* mpi_message_calls.c - the functions that send and receive, in every mode and way to start.
 *
 * The stubs give blocking, non-blocking and persistent forms of a send to one function
 * with `start`, so that a mode is written once. Section 3.4 of MPI 5.0 has the modes, 3.7
 * and 3.9 the ways to start. */
#include "mpi/mpi_internal.h"

/* --- sends --- */

static int start_send(struct mpi_rank *r, struct mpi_start start, struct mpi_message m)
{
    /* A blocking send needs no handle: its request lives on the stack. */
    struct mpi_request own;
    int code = mpi_message_check(r, &own, m);
    if (code != MPI_SUCCESS) return code;
    if (start.mode != MPI_BLOCKING) return mpi_request_start(r, &own, start);
    code = mpi_message_begin(r, &own);
    if (code == MPI_SUCCESS) mpi_wait_request(r, &own.q);
    return code;
}

/* A standard send may wait for its receive or not: the machine's protocol for the size
 * decides (eager or rendezvous, docs/network.md). */
int mpi_send(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
             MPI_Datatype datatype, int dest, int tag, MPI_Comm comm)
{
    return start_send(
        self, start,
        (struct mpi_message){MODE_STANDARD, false, buf, count, datatype, dest, tag, comm});
}

/* Local: it completes without a receive, as the buffer takes the message. */
int mpi_bsend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
              MPI_Datatype datatype, int dest, int tag, MPI_Comm comm)
{
    return start_send(
        self, start,
        (struct mpi_message){MODE_BUFFERED, false, buf, count, datatype, dest, tag, comm});
}

/* Complete when the receive has begun, which programs use to find hidden dependences on
 * buffering. */
int mpi_ssend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
              MPI_Datatype datatype, int dest, int tag, MPI_Comm comm)
{
    return start_send(
        self, start,
        (struct mpi_message){MODE_SYNCHRONOUS, false, buf, count, datatype, dest, tag, comm});
}

/* Costs what a standard send costs: the machines know no faster path. */
int mpi_rsend(struct mpi_rank *self, struct mpi_start start, const void *buf, MPI_Count count,
              MPI_Datatype datatype, int dest, int tag, MPI_Comm comm)
{
    return start_send(
        self, start,
        (struct mpi_message){MODE_READY, false, buf, count, datatype, dest, tag, comm});
}

/* --- receives --- */

int mpi_recv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int source,
             int tag, MPI_Comm comm, MPI_Status *status)
{
    /* No reference is taken on communicator and type: the call ends before the program
     * can free them. */
    struct mpi_request own;
    int code = mpi_message_check(
        self, &own,
        (struct mpi_message){MODE_STANDARD, true, buf, count, datatype, source, tag, comm});
    if (code != MPI_SUCCESS) return code;
    mpi_message_begin(self, &own);
    mpi_wait_request(self, &own.q);
    return mpi_message_finish(self, &own, status);
}

/* The checked request is copied into one with a handle. */
static int start_receive(struct mpi_rank *r, enum mpi_start_mode mode, struct mpi_message m,
                         MPI_Request *request)
{
    struct mpi_request own;
    int code = mpi_message_check(r, &own, m);
    if (code != MPI_SUCCESS) return code;
    return mpi_request_start(r, &own, (struct mpi_start){mode, request});
}

int mpi_irecv(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype, int source,
              int tag, MPI_Comm comm, MPI_Request *request)
{
    struct mpi_message m = {MODE_STANDARD, true, buf, count, datatype, source, tag, comm};
    return start_receive(self, MPI_NON_BLOCKING, m, request);
}

int mpi_recv_init(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
                  int source, int tag, MPI_Comm comm, MPI_Request *request)
{
    struct mpi_message m = {MODE_STANDARD, true, buf, count, datatype, source, tag, comm};
    return start_receive(self, MPI_PERSISTENT, m, request);
}

/* --- both at once --- */

/* Both directions under way together; the data to send are copied before the buffer is received
 * into. */
static int exchange(struct mpi_rank *r, struct mpi_message out, struct mpi_message in,
                    MPI_Status *status)
{
    struct mpi_request to, from;
    int code = mpi_message_check(r, &to, out);
    if (code == MPI_SUCCESS) code = mpi_message_check(r, &from, in);
    if (code != MPI_SUCCESS) return code;
    /* MPI_Sendrecv_replace: comm.h takes its copy when the send begins, so the receive
     * may come after it. Elsewhere the receive goes first, as in any exchange. */
    if (out.buffer == in.buffer) {
        mpi_message_begin(r, &to);
        mpi_message_begin(r, &from);
    } else {
        mpi_message_begin(r, &from);
        mpi_message_begin(r, &to);
    }
    /* Section 3.10: neither half waits for the other, so rings of such calls do not lock
     * up. */
    mpi_wait_request(r, &from.q);
    mpi_wait_request(r, &to.q);
    return mpi_message_finish(r, &from, status);
}

int mpi_sendrecv(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount,
                 MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount,
                 MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm, MPI_Status *status)
{
    return exchange(self,
                    (struct mpi_message){MODE_STANDARD, false, sendbuf, sendcount, sendtype, dest,
                                         sendtag, comm},
                    (struct mpi_message){MODE_STANDARD, true, recvbuf, recvcount, recvtype, source,
                                         recvtag, comm},
                    status);
}

int mpi_sendrecv_replace(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
                         int dest, int sendtag, int source, int recvtag, MPI_Comm comm,
                         MPI_Status *status)
{
    return exchange(
        self, (struct mpi_message){MODE_STANDARD, false, buf, count, datatype, dest, sendtag, comm},
        (struct mpi_message){MODE_STANDARD, true, buf, count, datatype, source, recvtag, comm},
        status);
}

/* The two halves of a non-blocking exchange, and its status. */
struct pair {
    struct mpi_message out, in;
    MPI_Status status;
};

/* The operation in progress checks its arguments again, which costs nothing in simulated
 * time. */
static void run_pair(struct mpi_rank *r, void *argument)
{
    struct pair *p = argument;
    int code = exchange(r, p->out, p->in, &p->status);
    r->running->code = code;
}

/* Checked here, so that errors are the call's and not those of a later wait. The status
 * is found behind its offset when the request is completed. */
static int start_pair(struct mpi_rank *r, struct pair p, MPI_Request *request)
{
    struct mpi_request check;
    int code = mpi_message_check(r, &check, p.out);
    if (code == MPI_SUCCESS) code = mpi_message_check(r, &check, p.in);
    if (code != MPI_SUCCESS) return code;
    return mpi_request_task(r, check.comm, run_pair, &p, sizeof p, offsetof(struct pair, status),
                            (struct mpi_start){MPI_NON_BLOCKING, request});
}

int mpi_isendrecv(struct mpi_rank *self, const void *sendbuf, MPI_Count sendcount,
                  MPI_Datatype sendtype, int dest, int sendtag, void *recvbuf, MPI_Count recvcount,
                  MPI_Datatype recvtype, int source, int recvtag, MPI_Comm comm,
                  MPI_Request *request)
{
    struct pair p = {{MODE_STANDARD, false, sendbuf, sendcount, sendtype, dest, sendtag, comm},
                     {MODE_STANDARD, true, recvbuf, recvcount, recvtype, source, recvtag, comm},
                     {0}};
    return start_pair(self, p, request);
}

int mpi_isendrecv_replace(struct mpi_rank *self, void *buf, MPI_Count count, MPI_Datatype datatype,
                          int dest, int sendtag, int source, int recvtag, MPI_Comm comm,
                          MPI_Request *request)
{
    struct pair p = {{MODE_STANDARD, false, buf, count, datatype, dest, sendtag, comm},
                     {MODE_STANDARD, true, buf, count, datatype, source, recvtag, comm},
                     {0}};
    return start_pair(self, p, request);
}
