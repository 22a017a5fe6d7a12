/* mpi_rma.c - the origin's side of one-sided communication.
 *
 * Chapter 12 of MPI 5.0. Every operation goes the same way: a message with its data to
 * the target, an answer with data or without back. So a put costs a trip more than on
 * hardware that writes into remote memory by itself; the program sees that in the time of
 * its synchronizing call only. */
#include "mpi/mpi_window.h"

/* What a message holds before its data: the address, displacement, count and type of an operation.
 */
enum { HEAD = 40 };

/* The message is as long as header and data together, so that the network charges the
 * right size; its content is the address of the operation, which the target reads and
 * fills in place (one process simulates all ranks). */
void mpi_rma_send(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x, int64_t bytes)
{
    int world = mpi_group_world(w->comm->group, x->target);
    char *message = mpi_take_zero(r->world, HEAD + bytes);
    memcpy(message, &x, sizeof x);
    /* Each answer has a tag of its own: operations on several targets are answered in any
     * order. */
    x->origin = w->comm->rank;
    x->answer_tag = TAG_ANSWERS + (int)((unsigned)w->answers++ % (1u << 30));
    /* The receive stands before the operation leaves, so an answer never comes
     * unexpected. It has no room: the data are in x->back, the message only takes its
     * time. */
    comm_irecv_matching(r->comm, world, mpi_tag(w->comm->context, PLANE_WINDOW, x->answer_tag),
                        COMM_WHOLE_TAG, NULL, 0, &x->answer);
    x->next = w->pending;
    w->pending = x;
    comm_isend(r->comm, world, mpi_tag(w->comm->context, PLANE_WINDOW, TAG_OPERATION), message,
               HEAD + bytes, NULL);
    mpi_give(r->world, message);
}

/* finish: data that came back go where the program wants them. */
static void finish(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x)
{
    /* A dense result's copy is not charged: the network would have delivered it into
     * place. */
    if (x->result_type) {
        int64_t bytes = x->nback;
        mpi_unpack_bytes(x->result, x->back, bytes, x->result_count, x->result_type);
        if (!x->result_type->dense) mpi_charge_copy(r, bytes);
    }
    /* The list is short: it holds what was started since the last synchronization, of
     * which the oldest are waited for first, at its end. */
    for (struct mpi_rma **at = &w->pending; *at; at = &(*at)->next)
        if (*at == x) {
            *at = x->next;
            break;
        }
    mpi_type_drop(r, x->type);
    mpi_type_drop(r, x->result_type);
    mpi_op_drop(r, x->op);
    mpi_give(r->world, x->data);
    mpi_give(r->world, x->back);
    mpi_give(r->world, x);
}

/* An operation with a request has a task that waits for the answer and finishes it; two
 * may not wait for one request. */
void mpi_rma_wait(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x)
{
    if (x->task) {
        mpi_wait_task(r, x->task);
        return;
    }
    mpi_wait_request(r, &x->answer);
    finish(r, w, x);
}

/* The oldest first; each wait takes its operation off the list. */
void mpi_window_flush(struct mpi_rank *r, struct mpi_window *w, int target)
{
    for (;;) {
        struct mpi_rma *oldest = NULL;
        for (struct mpi_rma *x = w->pending; x; x = x->next)
            if (target == MPI_ANY_SOURCE || x->target == target) oldest = x;
        if (!oldest) return;
        mpi_rma_wait(r, w, oldest);
    }
}

/* --- locks --- */

/* A lock is an operation without data, and its answer is the grant. */
void mpi_window_ask(struct mpi_rank *r, struct mpi_window *w, enum rma_kind kind, int target,
                    int type)
{
    struct mpi_rma *x = mpi_take_zero(r->world, sizeof *x);
    x->kind = kind;
    x->target = target;
    x->lock_type = type;
    x->type = mpi_type_basic(MPI_BYTE);
    mpi_rma_send(r, w, x, 0);
    mpi_rma_wait(r, w, x);
}

/* P bytes for each window on each rank only where a program uses locks. */
char *mpi_window_locks(struct mpi_rank *r, struct mpi_window *w)
{
    if (!w->locked) w->locked = mpi_take_zero(r->world, w->comm->size);
    return w->locked;
}

/* A lock on all ranks is taken on each when it is first used. MPI_Win_lock_all is a
 * shared lock by definition (section 12.5.3). */
void mpi_window_take(struct mpi_rank *r, struct mpi_window *w, int target)
{
    if (mpi_window_locks(r, w)[target]) return;
    mpi_window_ask(r, w, RMA_LOCK, target, MPI_LOCK_SHARED);
    w->locked[target] = HELD_SHARED;
}

/* --- operations --- */

/* What all operations are called with; unused parts are zero. */
struct call {
    enum rma_kind kind;
    const void *out;
    MPI_Count nout;
    MPI_Datatype tout;
    const void *compare;
    void *in;
    MPI_Count nin;
    MPI_Datatype tin;
    int target;
    MPI_Aint displacement;
    MPI_Count count;
    MPI_Datatype type;
    MPI_Op op;
    MPI_Win win;
};

/* A request's operation: who waits for it. */
struct asked {
    struct mpi_window *window;
    struct mpi_rma *rma;
};

static void run_asked(struct mpi_rank *r, void *argument)
{
    const struct asked *a = argument;
    /* The task runs at once when it is made, so whoever waits for the operation finds it
     * here. */
    a->rma->task = r->running;
    mpi_wait_request(r, &a->rma->answer);
    a->rma->task = NULL;
    finish(r, a->window, a->rma);
}

/* Origin's data are packed now: the program may not change them until the epoch ends, but
 * packed bytes need no type at the target. */
static struct mpi_rma *make(struct mpi_rank *r, const struct call *c, struct mpi_type *type,
                            struct mpi_type *tout, struct mpi_type *tin, struct mpi_op *op)
{
    struct mpi_rma *x = mpi_take_zero(r->world, sizeof *x);
    int64_t bytes = c->count * type->size, nout = tout ? c->nout * tout->size : 0;
    *x = (struct mpi_rma){.kind = c->kind, .target = c->target, .count = c->count, .type = type};
    x->displacement = c->displacement;
    x->op = op;
    mpi_type_use(type);
    if (op) mpi_op_use(op);
    if (tout) {
        /* Room for the target's bytes, even if the program sends fewer than it says;
         * behind them the value to compare with. */
        x->data = mpi_take_zero(r->world, 2 * bytes + nout + 1);
        mpi_pack_bytes(x->data, c->out, c->nout, tout);
        if (!tout->dense) mpi_charge_copy(r, nout);
        if (c->compare) mpi_pack_bytes(x->data + bytes, c->compare, 1, tout);
    }
    if (!tin) return x;
    mpi_type_use(tin);
    x->result = c->in;
    x->result_count = c->nin;
    x->result_type = tin;
    /* The target packs what is there into `back`, which the origin owns. */
    x->nback = bytes;
    x->back = mpi_take(r->world, bytes + 1);
    return x;
}

static int operate(struct mpi_rank *r, const struct call *c, MPI_Request *request)
{
    struct mpi_window *w = mpi_window_of(r, c->win);
    struct mpi_type *type = w ? mpi_type_of(r, c->type) : NULL, *tout = NULL, *tin = NULL;
    struct mpi_op *op = NULL;
    if (!type) return r->code;
    if (c->tout && !(tout = mpi_type_of(r, c->tout))) return r->code;
    if (c->tin && !(tin = mpi_type_of(r, c->tin))) return r->code;
    if (c->op && !(op = mpi_op_of(r, c->op))) return r->code;
    if (c->count < 0 || c->nout < 0 || c->nin < 0)
        return mpi_error(r, w->comm, MPI_ERR_COUNT, "a count is negative");
    /* Handles and counts were checked all the same (section 12.3). */
    if (c->target == MPI_PROC_NULL) {
        if (request) *request = mpi_request_nothing(r);
        return MPI_SUCCESS;
    }
    if (c->target < 0 || c->target >= w->comm->size)
        return mpi_error(r, w->comm, MPI_ERR_RANK, "rank %d is not in the window's group of %d",
                         c->target, w->comm->size);
    /* The lock that MPI_Win_lock_all has put off. */
    if (w->lock_all) mpi_window_take(r, w, c->target);
    struct mpi_rma *x = make(r, c, type, tout, tin, op);
    /* Bytes that go out: the operation's data, and the value to compare with, where there
     * is one. */
    int64_t out = tout ? c->nout * tout->size + (c->compare ? tout->size : 0) : 0;
    mpi_rma_send(r, w, x, out);
    /* Without a request the operation is complete when its epoch ends or a flush says so
     * (section 12.3.5 has those with one). */
    if (!request) return MPI_SUCCESS;
    const struct asked a = {w, x};
    return mpi_request_task(r, w->comm, run_asked, &a, sizeof a, -1,
                            (struct mpi_start){MPI_NON_BLOCKING, request});
}

/* Section 12.3.1. All functions below differ in what they fill in; those without a request are
 * the others without one. */
int mpi_put(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
            MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
            MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win)
{
    return mpi_rput(self, origin_addr, origin_count, origin_datatype, target_rank, target_disp,
                    target_count, target_datatype, win, NULL);
}

int mpi_rput(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
             MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
             MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win,
             MPI_Request *request)
{
    struct call c = {.kind = RMA_PUT,
                     .out = origin_addr,
                     .nout = origin_count,
                     .tout = origin_datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = target_count,
                     .type = target_datatype,
                     .win = win};
    return operate(self, &c, request);
}

/* Section 12.3.2: nothing goes out but the header. */
int mpi_get(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count,
            MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
            MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win)
{
    return mpi_rget(self, origin_addr, origin_count, origin_datatype, target_rank, target_disp,
                    target_count, target_datatype, win, NULL);
}

int mpi_rget(struct mpi_rank *self, void *origin_addr, MPI_Count origin_count,
             MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
             MPI_Count target_count, MPI_Datatype target_datatype, MPI_Win win,
             MPI_Request *request)
{
    struct call c = {.kind = RMA_GET,
                     .in = origin_addr,
                     .nin = origin_count,
                     .tin = origin_datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = target_count,
                     .type = target_datatype,
                     .win = win};
    return operate(self, &c, request);
}

/* Section 12.3.4: applied at the target one at a time, so elements are never
 * half-written. */
int mpi_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
                   MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
                   MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win)
{
    return mpi_raccumulate(self, origin_addr, origin_count, origin_datatype, target_rank,
                           target_disp, target_count, target_datatype, op, win, NULL);
}

int mpi_raccumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
                    MPI_Datatype origin_datatype, int target_rank, MPI_Aint target_disp,
                    MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win,
                    MPI_Request *request)
{
    struct call c = {.kind = RMA_ACCUMULATE,
                     .out = origin_addr,
                     .nout = origin_count,
                     .tout = origin_datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = target_count,
                     .type = target_datatype,
                     .op = op,
                     .win = win};
    return operate(self, &c, request);
}

/* With MPI_NO_OP nothing goes out and only the answer counts. Then it is a get that keeps
 * the order of accumulates. */
static int get_accumulate(struct mpi_rank *r, struct call c, MPI_Request *request)
{
    c.kind = RMA_GET_ACCUMULATE;
    if (c.op == MPI_NO_OP) c.tout = NULL;
    return operate(r, &c, request);
}

int mpi_get_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
                       MPI_Datatype origin_datatype, void *result_addr, MPI_Count result_count,
                       MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp,
                       MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op, MPI_Win win)
{
    return mpi_rget_accumulate(self, origin_addr, origin_count, origin_datatype, result_addr,
                               result_count, result_datatype, target_rank, target_disp,
                               target_count, target_datatype, op, win, NULL);
}

int mpi_rget_accumulate(struct mpi_rank *self, const void *origin_addr, MPI_Count origin_count,
                        MPI_Datatype origin_datatype, void *result_addr, MPI_Count result_count,
                        MPI_Datatype result_datatype, int target_rank, MPI_Aint target_disp,
                        MPI_Count target_count, MPI_Datatype target_datatype, MPI_Op op,
                        MPI_Win win, MPI_Request *request)
{
    struct call c = {.out = origin_addr,
                     .nout = origin_count,
                     .tout = origin_datatype,
                     .in = result_addr,
                     .nin = result_count,
                     .tin = result_datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = target_count,
                     .type = target_datatype,
                     .op = op,
                     .win = win};
    return get_accumulate(self, c, request);
}

/* One element: MPI_Get_accumulate in a form that hardware often has. */
int mpi_fetch_and_op(struct mpi_rank *self, const void *origin_addr, void *result_addr,
                     MPI_Datatype datatype, int target_rank, MPI_Aint target_disp, MPI_Op op,
                     MPI_Win win)
{
    struct call c = {.out = origin_addr,
                     .nout = 1,
                     .tout = datatype,
                     .in = result_addr,
                     .nin = 1,
                     .tin = datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = 1,
                     .type = datatype,
                     .op = op,
                     .win = win};
    return get_accumulate(self, c, NULL);
}

/* The answer is the old value, whether it was replaced or not. */
int mpi_compare_and_swap(struct mpi_rank *self, const void *origin_addr, const void *compare_addr,
                         void *result_addr, MPI_Datatype datatype, int target_rank,
                         MPI_Aint target_disp, MPI_Win win)
{
    struct call c = {.kind = RMA_COMPARE_AND_SWAP,
                     .out = origin_addr,
                     .nout = 1,
                     .tout = datatype,
                     .compare = compare_addr,
                     .in = result_addr,
                     .nin = 1,
                     .tin = datatype,
                     .target = target_rank,
                     .displacement = target_disp,
                     .count = 1,
                     .type = datatype,
                     .win = win};
    return operate(self, &c, NULL);
}
