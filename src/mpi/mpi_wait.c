/* mpi_wait.c - completing requests: one, any, some, all; waiting or testing.
 *
 * Section 3.7.5 of MPI 5.0. Blocking calls stop the rank until something is there and
 * take no polls; a test that finds nothing costs a poll (vp/poll.c). Requests that are
 * known to be complete are taken in the order of the array, else the one that is complete
 * first in simulated time: a simulator should not choose at random where the standard
 * lets it. */
#include "mpi/mpi_internal.h"

/* The requests of one call: few of them need no memory. */
enum { FEW = 32 };
struct set {
    int n, nactive;
    struct mpi_request **q; /* (n) NULL: null or inactive */
    struct mpi_request *few[FEW];
};

/* Handles are looked up once, and inactive persistent requests count as null (section
 * 3.7.5). */
static bool collect(struct mpi_rank *r, struct set *s, int n, const MPI_Request *handle)
{
    s->n = n;
    s->nactive = 0;
    s->q = s->few;
    if (n < 0) {
        r->code = mpi_error(r, NULL, MPI_ERR_COUNT, "count %d is negative", n);
        return false;
    }
    if (n > FEW) s->q = mpi_take(r->world, n * (int64_t)sizeof *s->q);
    for (int i = 0; i < n; i++) {
        s->q[i] = NULL;
        if (handle[i] == MPI_REQUEST_NULL) continue;
        struct mpi_request *q = mpi_request_of(r, handle[i]);
        if (!q) {
            if (s->q != s->few) mpi_give(r->world, s->q);
            return false;
        }
        if (!q->active) continue;
        s->q[i] = q;
        s->nactive++;
    }
    return true;
}

static void release(struct mpi_rank *r, struct set *s)
{
    if (s->q != s->few) mpi_give(r->world, s->q);
}

/* No time passes: this asks what has been completed before. */
static int first_ready(int n, struct mpi_request *const *q)
{
    for (int i = 0; i < n; i++)
        if (q[i] && mpi_request_ready(q[i])) return i;
    return -1;
}

/* look: one round over what the requests and the rank's operations wait for; whether anything
 * moved. */
static bool look(struct mpi_rank *r, int n, struct mpi_request *const *q, bool block)
{
    struct comm_request *few[FEW], **wanted = few;
    int nwanted = 0;
    /* Operations in progress are added by mpi_progress; general requests wait for nothing
     * that comm.h knows. */
    few[0] = NULL;
    if (n > FEW) wanted = mpi_take(r->world, n * (int64_t)sizeof *wanted);
    for (int i = 0; i < n; i++)
        if (q[i] && (q[i]->what == REQUEST_SEND || q[i]->what == REQUEST_RECEIVE) && q[i]->q.active)
            wanted[nwanted++] = &q[i]->q;
    /* A rank has one thread, so nobody else could complete a generalized request: the
     * wait would last for ever. */
    if (block && nwanted == 0 && !r->tasks)
        mpi_fail(r, "waits for a request that only the program can complete");
    bool moved = mpi_progress(r, nwanted, wanted, block) != PROGRESS_NONE;
    if (wanted != few) mpi_give(r->world, wanted);
    return moved;
}

/* Each round may let an operation in progress go on instead of completing a request; it
 * is repeated as long as something moves. */
int mpi_poll(struct mpi_rank *r, int n, struct mpi_request *const *q)
{
    int found = first_ready(n, q);
    while (found < 0 && look(r, n, q, false)) found = first_ready(n, q);
    return found;
}

static int wait_any(struct mpi_rank *r, int n, struct mpi_request *const *q)
{
    int found;
    while ((found = first_ready(n, q)) < 0) look(r, n, q, true);
    return found;
}

/* A message needs no search among others, unless operations are in progress
 * (mpi_wait_request). */
static void wait_one(struct mpi_rank *r, struct mpi_request *q)
{
    if (q->what == REQUEST_SEND || q->what == REQUEST_RECEIVE) mpi_wait_request(r, &q->q);
    else wait_any(r, 1, &q);
}

/* --- one --- */

/* The request, where there is something to wait for. Else NULL, and *code is what the call returns:
 * a null or inactive request is complete at once, with an empty status. */
static struct mpi_request *awaited(struct mpi_rank *r, MPI_Request request, MPI_Status *status,
                                   int *code)
{
    *code = MPI_SUCCESS;
    struct mpi_request *q = request != MPI_REQUEST_NULL ? mpi_request_of(r, request) : NULL;
    if (q && q->active) return q;
    if (request != MPI_REQUEST_NULL && !q) *code = r->code;
    else mpi_status_empty(status);
    return NULL;
}

int mpi_wait(struct mpi_rank *self, MPI_Request *request, MPI_Status *status)
{
    int code;
    struct mpi_request *q = awaited(self, *request, status, &code);
    if (!q) return code;
    wait_one(self, q);
    return mpi_request_finish(self, q, request, status);
}

/* The flag is what the program loops on; time passes when it stays 0, so such loops end. */
int mpi_test(struct mpi_rank *self, MPI_Request *request, int *flag, MPI_Status *status)
{
    int code;
    *flag = 1;
    struct mpi_request *q = awaited(self, *request, status, &code);
    if (!q) return code;
    *flag = mpi_poll(self, 1, &q) >= 0;
    return *flag ? mpi_request_finish(self, q, request, status) : MPI_SUCCESS;
}

/* --- all --- */

/* finish_all: complete every request in the order given; the statuses say which failed, if any did.
 */
static int finish_all(struct mpi_rank *r, struct set *s, MPI_Request *handle, MPI_Status *status)
{
    int code = MPI_SUCCESS;
    /* Every request is completed, also behind one that failed: none may be left half-way
     * (section 3.7.5). The error field of statuses is set here and in the calls for some
     * alone. */
    for (int i = 0; i < s->n; i++) {
        MPI_Status *own = status ? &status[i] : MPI_STATUS_IGNORE;
        int one = MPI_SUCCESS;
        if (s->q[i]) one = mpi_request_finish(r, s->q[i], &handle[i], own);
        else mpi_status_empty(own);
        if (own) own->MPI_ERROR = one;
        if (one != MPI_SUCCESS) code = MPI_ERR_IN_STATUS;
    }
    return code;
}

/* One after the other: the clock ends at the latest of all, whatever the order. */
int mpi_waitall(struct mpi_rank *self, int count, MPI_Request array_of_requests[],
                MPI_Status *array_of_statuses)
{
    struct set s;
    if (!collect(self, &s, count, array_of_requests)) return self->code;
    for (int i = 0; i < s.n; i++)
        if (s.q[i]) wait_one(self, s.q[i]);
    int code = finish_all(self, &s, array_of_requests, array_of_statuses);
    release(self, &s);
    return code;
}

static bool all_ready(const struct set *s)
{
    for (int i = 0; i < s->n; i++)
        if (s->q[i] && !mpi_request_ready(s->q[i])) return false;
    return true;
}

/* Each request that is not ready is looked at once; the first that stays so ends the test. */
static bool poll_all(struct mpi_rank *r, const struct set *s)
{
    for (int i = 0; i < s->n; i++)
        if (s->q[i] && mpi_poll(r, 1, &s->q[i]) < 0) return false;
    return all_ready(s);
}

/* Nothing is completed unless all are ready. */
int mpi_testall(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *flag,
                MPI_Status *array_of_statuses)
{
    struct set s;
    int code = MPI_SUCCESS;
    if (!collect(self, &s, count, array_of_requests)) return self->code;
    *flag = poll_all(self, &s);
    if (*flag) code = finish_all(self, &s, array_of_requests, array_of_statuses);
    release(self, &s);
    return code;
}

/* --- any --- */

/* No active request: the index is MPI_UNDEFINED, and the status is empty. */
static int finish_any(struct mpi_rank *r, struct set *s, int found, MPI_Request *handle, int *index,
                      MPI_Status *status)
{
    *index = found < 0 ? MPI_UNDEFINED : found;
    if (found >= 0) return mpi_request_finish(r, s->q[found], &handle[found], status);
    mpi_status_empty(status);
    return MPI_SUCCESS;
}

/* Waits for whichever is complete first in simulated time. */
int mpi_waitany(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx,
                MPI_Status *status)
{
    struct set s;
    if (!collect(self, &s, count, array_of_requests)) return self->code;
    int found = s.nactive ? wait_any(self, s.n, s.q) : -1;
    int code = finish_any(self, &s, found, array_of_requests, indx, status);
    release(self, &s);
    return code;
}

int mpi_testany(struct mpi_rank *self, int count, MPI_Request array_of_requests[], int *indx,
                int *flag, MPI_Status *status)
{
    struct set s;
    if (!collect(self, &s, count, array_of_requests)) return self->code;
    int found = s.nactive ? mpi_poll(self, s.n, s.q) : -1, code = MPI_SUCCESS;
    *flag = found >= 0 || s.nactive == 0;
    *indx = MPI_UNDEFINED;
    if (*flag) code = finish_any(self, &s, found, array_of_requests, indx, status);
    release(self, &s);
    return code;
}

/* --- some --- */

/* finish_some: those that are ready, after one of them was found or none. */
static int finish_some(struct mpi_rank *r, struct set *s, MPI_Request *handle, int *outcount,
                       int *indices, MPI_Status *status)
{
    int code = MPI_SUCCESS;
    /* Indices and statuses are packed at the front of the arrays. */
    *outcount = s->nactive ? 0 : MPI_UNDEFINED;
    for (int i = 0; i < s->n; i++) {
        if (!s->q[i] || !mpi_request_ready(s->q[i])) continue;
        MPI_Status *own = status ? &status[*outcount] : MPI_STATUS_IGNORE;
        int one = mpi_request_finish(r, s->q[i], &handle[i], own);
        if (own) own->MPI_ERROR = one;
        if (one != MPI_SUCCESS) code = MPI_ERR_IN_STATUS;
        indices[(*outcount)++] = i;
    }
    return code;
}

/* Everything else that is there by now is found too: a look costs time only where nothing is. */
static void poll_rest(struct mpi_rank *r, struct set *s)
{
    bool waiting = true;
    while (waiting && !all_ready(s)) waiting = look(r, s->n, s->q, false);
}

/* Waits until one is there, then takes all that are: a server that uses this lets nobody
 * starve. */
int mpi_waitsome(struct mpi_rank *self, int incount, MPI_Request array_of_requests[], int *outcount,
                 int array_of_indices[], MPI_Status *array_of_statuses)
{
    struct set s;
    if (!collect(self, &s, incount, array_of_requests)) return self->code;
    if (s.nactive) wait_any(self, s.n, s.q);
    if (s.nactive) poll_rest(self, &s);
    int code =
        finish_some(self, &s, array_of_requests, outcount, array_of_indices, array_of_statuses);
    release(self, &s);
    return code;
}

int mpi_testsome(struct mpi_rank *self, int incount, MPI_Request array_of_requests[], int *outcount,
                 int array_of_indices[], MPI_Status *array_of_statuses)
{
    struct set s;
    if (!collect(self, &s, incount, array_of_requests)) return self->code;
    if (s.nactive) poll_rest(self, &s);
    int code =
        finish_some(self, &s, array_of_requests, outcount, array_of_indices, array_of_statuses);
    release(self, &s);
    return code;
}

/* --- without completing --- */

int mpi_request_get_status(struct mpi_rank *self, MPI_Request request, int *flag,
                           MPI_Status *status)
{
    *flag = 1;
    mpi_status_empty(status);
    if (request == MPI_REQUEST_NULL) return MPI_SUCCESS;
    struct mpi_request *q = mpi_request_of(self, request);
    if (!q) return self->code;
    if (!q->active) return MPI_SUCCESS;
    *flag = mpi_poll(self, 1, &q) >= 0;
    /* What its completion will tell, without completing it. */
    if (*flag && (q->what == REQUEST_SEND || q->what == REQUEST_RECEIVE))
        mpi_message_status(self, q, status);
    if (*flag && q->what == REQUEST_TASK && q->status_at >= 0 && status)
        *status = *(MPI_Status *)((char *)q->argument + q->status_at);
    if (*flag && q->what == REQUEST_GENERAL && status) {
        void *const *f = q->argument;
        return (int)mpi_call_program(self, f[0], (intptr_t[6]){(intptr_t)f[3], (intptr_t)status});
    }
    return MPI_SUCCESS;
}

/* MPI 4.1 added the forms for several requests; they stop at the first that is not
 * complete. */
int mpi_request_get_status_all(struct mpi_rank *self, int count,
                               const MPI_Request array_of_requests[], int *flag,
                               MPI_Status *array_of_statuses)
{
    int code = MPI_SUCCESS;
    *flag = 1;
    for (int i = 0; i < count && code == MPI_SUCCESS && *flag; i++)
        code =
            mpi_request_get_status(self, array_of_requests[i], flag,
                                   array_of_statuses ? &array_of_statuses[i] : MPI_STATUS_IGNORE);
    return code;
}

/* Null and inactive requests; a wrong handle is left to the look at it. */
static bool passed_over(struct mpi_rank *r, MPI_Request handle)
{
    if (handle == MPI_REQUEST_NULL) return true;
    const struct mpi_request *q = mpi_object(r, handle, KIND_REQUEST);
    return q && !q->active;
}

int mpi_request_get_status_any(struct mpi_rank *self, int count,
                               const MPI_Request array_of_requests[], int *indx, int *flag,
                               MPI_Status *status)
{
    int code = MPI_SUCCESS, active = 0;
    *indx = MPI_UNDEFINED;
    *flag = 0;
    for (int i = 0; i < count && code == MPI_SUCCESS; i++) {
        if (passed_over(self, array_of_requests[i])) continue;
        active++;
        code = mpi_request_get_status(self, array_of_requests[i], flag, status);
        if (!*flag) continue;
        *indx = i;
        return code;
    }
    if (active == 0) *flag = 1;
    return code;
}

int mpi_request_get_status_some(struct mpi_rank *self, int incount,
                                const MPI_Request array_of_requests[], int *outcount,
                                int array_of_indices[], MPI_Status *array_of_statuses)
{
    int code = MPI_SUCCESS, active = 0;
    *outcount = 0;
    for (int i = 0; i < incount && code == MPI_SUCCESS; i++) {
        int flag;
        if (passed_over(self, array_of_requests[i])) continue;
        active++;
        code = mpi_request_get_status(self, array_of_requests[i], &flag,
                                      array_of_statuses ? &array_of_statuses[*outcount]
                                                        : MPI_STATUS_IGNORE);
        if (flag) array_of_indices[(*outcount)++] = i;
    }
    if (active == 0) *outcount = MPI_UNDEFINED;
    return code;
}
