/* mpi_request.c - requests: made, started, completed one at a time, taken back. mpi_wait.c
 * completes many. */
#include <stdio.h>

#include "mpi/mpi_internal.h"

struct mpi_request *mpi_request_make(struct mpi_rank *r, enum mpi_request_kind what)
{
    /* Programs start and complete requests in every step: they come from a list of spare
     * ones, and handles from the table's free slots, so both take constant time. */
    struct mpi_request *q = r->spare_request;
    if (q) r->spare_request = q->next;
    else q = mpi_take(r->world, sizeof *q);
    *q = (struct mpi_request){.what = what};
    mpi_handle_make(r, q, KIND_REQUEST);
    return q;
}

static void spare(struct mpi_rank *r, struct mpi_request *q)
{
    q->next = r->spare_request;
    r->spare_request = q;
}

/* end: the request is no more; what it held on to is let go. A persistent request ends by
 * MPI_Request_free alone, any other when it is completed. */
static void end(struct mpi_rank *r, struct mpi_request *q)
{
    mpi_handle_end(r, q);
    mpi_type_drop(r, q->type);
    mpi_comm_drop(r, q->comm);
    if (q->release) q->release(r, q->argument);
    mpi_give(r->world, q->argument);
    mpi_give(r->world, q->task);
    spare(r, q);
}

struct mpi_request *mpi_request_of(struct mpi_rank *r, MPI_Request handle)
{
    struct mpi_request *q = mpi_object(r, handle, KIND_REQUEST);
    return q ? q : mpi_bad_handle(r, handle, KIND_REQUEST);
}

/* The program may free communicator and type while the operation goes on (sections 5.1.9,
 * 7.4.3). */
static void hold(struct mpi_request *q)
{
    if (q->comm) q->comm->o.uses++;
    if (q->type) mpi_type_use(q->type);
}

/* An operation in progress runs at once, as far as it comes without waiting: its first
 * messages leave now. */
static int begin(struct mpi_rank *r, struct mpi_request *q)
{
    q->active = true;
    r->pending++;
    if (q->what != REQUEST_TASK) {
        int code = mpi_message_begin(r, q);
        /* What did not begin will not complete, so nobody may wait for it. */
        if (code == MPI_SUCCESS) return code;
        q->active = false;
        r->pending--;
        return code;
    }
    mpi_give(r->world, q->task);
    q->task = mpi_task_start(r, q->run, q->argument);
    return MPI_SUCCESS;
}

int mpi_request_start(struct mpi_rank *r, const struct mpi_request *checked, struct mpi_start start)
{
    struct mpi_request *q = mpi_request_make(r, checked->what);
    /* The checked request was filled before there was a handle: all but its first member
     * is taken over. */
    struct mpi_object o = q->o;
    *q = *checked;
    q->o = o;
    q->persistent = start.mode == MPI_PERSISTENT;
    hold(q);
    int code = q->persistent ? MPI_SUCCESS : begin(r, q);
    *start.request = code == MPI_SUCCESS ? mpi_handle(q) : MPI_REQUEST_NULL;
    if (code != MPI_SUCCESS) end(r, q);
    return code;
}

/* The argument is copied, as the caller's lies on its stack; in the copy the operation
 * may leave a status. */
int mpi_request_task(struct mpi_rank *r, struct mpi_comm *c, mpi_task_fn *run, const void *argument,
                     int64_t bytes, int64_t status_at, struct mpi_start start)
{
    struct mpi_request *q = mpi_request_make(r, REQUEST_TASK);
    q->comm = c;
    q->run = run;
    q->argument = memcpy(mpi_take(r->world, bytes), argument, (size_t)bytes);
    q->status_at = status_at;
    q->persistent = start.mode == MPI_PERSISTENT;
    hold(q);
    *start.request = mpi_handle(q);
    return q->persistent ? MPI_SUCCESS : begin(r, q);
}

/* Called when the request ends: what it must let go of is known to who started it. */
void mpi_request_release(struct mpi_rank *r, MPI_Request request,
                         void (*release)(struct mpi_rank *r, void *argument))
{
    mpi_request_of(r, request)->release = release;
}

/* A request of something that was over before it began. */
MPI_Request mpi_request_nothing(struct mpi_rank *r)
{
    struct mpi_request *q = mpi_request_make(r, REQUEST_NOTHING);
    q->active = true;
    r->pending++;
    return mpi_handle(q);
}

/* Without a look at time: what comm.h has completed by now. Looking itself is
 * mpi_progress's. */
bool mpi_request_ready(const struct mpi_request *q)
{
    switch (q->what) {
    case REQUEST_SEND:
    case REQUEST_RECEIVE:
        return !q->q.active;
    case REQUEST_TASK:
        return q->task->done;
    case REQUEST_GENERAL:
        return q->matched;
    case REQUEST_NOTHING:
        break;
    }
    return true;
}

/* Section 13.2: the query function fills the status, the free function ends the state;
 * both run when the program completes the request. The four words are those of
 * mpi_grequest_start. */
static int finish_general(struct mpi_rank *r, struct mpi_request *q, MPI_Status *status)
{
    void *const *f = q->argument;
    MPI_Status own = {.MPI_ERROR = MPI_SUCCESS};
    mpi_status_set(&own, MPI_ANY_SOURCE, MPI_ANY_TAG, 0);
    int code = (int)mpi_call_program(r, f[0], (intptr_t[6]){(intptr_t)f[3], (intptr_t)&own});
    if (status) *status = own;
    mpi_call_program(r, f[1], (intptr_t[6]){(intptr_t)f[3]});
    return code;
}

/* The caller has seen that it is ready. A persistent request becomes inactive and keeps
 * its handle. */
int mpi_request_finish(struct mpi_rank *r, struct mpi_request *q, MPI_Request *request,
                       MPI_Status *status)
{
    int code = MPI_SUCCESS;
    r->pending--;
    q->active = false;
    if (q->what == REQUEST_TASK) code = q->task->code;
    if (q->what == REQUEST_SEND || q->what == REQUEST_RECEIVE)
        code = mpi_message_finish(r, q, status);
    else if (q->what == REQUEST_GENERAL) code = finish_general(r, q, status);
    /* The status of MPI_Isendrecv is what its receiving half told; collectives have none. */
    else if (q->what == REQUEST_TASK && q->status_at >= 0) {
        if (status) *status = *(MPI_Status *)((char *)q->argument + q->status_at);
    } else mpi_status_set(status, MPI_ANY_SOURCE, MPI_ANY_TAG, 0);
    if (q->persistent) return code;
    end(r, q);
    if (request) *request = MPI_REQUEST_NULL;
    return code;
}

/* --- starting persistent ones --- */

/* Section 3.9. Starting an active request again is an error, as its buffer is in use. */
int mpi_start(struct mpi_rank *self, MPI_Request *request)
{
    struct mpi_request *q = mpi_request_of(self, *request);
    if (!q) return self->code;
    if (!q->persistent || q->active)
        return mpi_error(self, q->comm, MPI_ERR_REQUEST,
                         q->active ? "the request is active already"
                                   : "the request is not a persistent one");
    return begin(self, q);
}

/* In the order of the array, one after the other; an error leaves the rest inactive. */
int mpi_startall(struct mpi_rank *self, int count, MPI_Request array_of_requests[])
{
    int code = MPI_SUCCESS;
    for (int i = 0; i < count && code == MPI_SUCCESS; i++)
        code = mpi_start(self, &array_of_requests[i]);
    return code;
}

/* --- letting go --- */

/* A message under way goes on: its request stays where it is, and nobody will ask for it. */
int mpi_request_free(struct mpi_rank *self, MPI_Request *request)
{
    struct mpi_request *q = mpi_request_of(self, *request);
    if (!q) return self->code;
    *request = MPI_REQUEST_NULL;
    /* Neither memory nor uses come back: comm.h writes into this request when the message
     * is done. */
    if (q->active && !mpi_request_ready(q)) {
        self->pending--;
        mpi_handle_end(self, q);
        return MPI_SUCCESS;
    }
    /* It is complete already, so freeing it completes it. */
    if (q->active) {
        q->persistent = false;
        return mpi_request_finish(self, q, NULL, MPI_STATUS_IGNORE);
    }
    end(self, q);
    return MPI_SUCCESS;
}

/* Sends are under way at once and are never taken back. */
int mpi_cancel(struct mpi_rank *self, MPI_Request *request)
{
    struct mpi_request *q = mpi_request_of(self, *request);
    if (!q) return self->code;
    /* The program's own function decides; it is told whether the request is complete. */
    if (q->what == REQUEST_GENERAL) {
        void *const *f = q->argument;
        return (int)mpi_call_program(self, f[2], (intptr_t[6]){(intptr_t)f[3], q->matched});
    }
    /* Section 3.8.4: a receive either is taken back or has its message, and the status of
     * the completing call says which. Cancelling a send is deprecated. */
    if (q->what == REQUEST_RECEIVE && q->active && q->q.active && comm_cancel(self->comm, &q->q))
        q->cancelled = true;
    return MPI_SUCCESS;
}

/* --- requests of the program's own --- */

/* Section 13.2. The program completes such a request itself; until then it is pending
 * like any other. */
int mpi_grequest_start(struct mpi_rank *self, MPI_Grequest_query_function *query_fn,
                       MPI_Grequest_free_function *free_fn, MPI_Grequest_cancel_function *cancel_fn,
                       void *extra_state, MPI_Request *request)
{
    struct mpi_request *q = mpi_request_make(self, REQUEST_GENERAL);
    void *const f[4] = {(void *)(intptr_t)query_fn, (void *)(intptr_t)free_fn,
                        (void *)(intptr_t)cancel_fn, extra_state};
    q->argument = memcpy(mpi_take(self->world, sizeof f), f, sizeof f);
    q->active = true;
    self->pending++;
    *request = mpi_handle(q);
    return MPI_SUCCESS;
}

int mpi_grequest_complete(struct mpi_rank *self, MPI_Request request)
{
    struct mpi_request *q = mpi_request_of(self, request);
    if (!q) return self->code;
    if (q->what != REQUEST_GENERAL)
        return mpi_error(self, NULL, MPI_ERR_REQUEST, "the request is not a generalized one");
    /* `matched` serves as the mark of completion, as no message belongs to such a
     * request. */
    q->matched = true;
    return MPI_SUCCESS;
}
