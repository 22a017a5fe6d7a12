/* mpi_epoch.c - when one-sided operations are complete: fences, groups that expose and access,
 * locks.
 *
 * An operation is complete at both ends when its answer is there, so that every epoch ends with
 * waiting for answers; what else is sent tells others so.
 *
 * Sections 12.5.1 to 12.5.5 of MPI 5.0. Assertions are promises that allow a library to
 * leave out messages; here they are accepted and nothing is left out, which is always
 * right. */
#include "mpi/mpi_window.h"

/* All operations of this rank are answered, so all of its targets have applied them;
 * after the barrier that holds for every rank. A real library may count messages instead,
 * and saves the answers. */
int mpi_win_fence(struct mpi_rank *self, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    (void)assert;
    if (!w) return self->code;
    mpi_window_flush(self, w, MPI_ANY_SOURCE);
    mpi_collective_barrier(self, w->comm, w->comm->sequence++);
    return MPI_SUCCESS;
}

/* --- groups --- */

/* tell: a message without data to each rank of a group; hear: one from each. No request:
 * nobody waits for a message of zero bytes to leave. */
static void tell(struct mpi_rank *r, const struct mpi_window *w, const struct mpi_group *g, int tag)
{
    for (int i = 0; i < g->size; i++)
        comm_isend(r->comm, mpi_group_world(g, i), mpi_tag(w->comm->context, PLANE_WINDOW, tag),
                   NULL, 0, NULL);
}

static void post(struct mpi_rank *r, const struct mpi_window *w, const struct mpi_group *g, int tag,
                 struct comm_request *q)
{
    for (int i = 0; i < g->size; i++)
        comm_irecv(r->comm, mpi_group_world(g, i), mpi_tag(w->comm->context, PLANE_WINDOW, tag),
                   NULL, 0, &q[i]);
}

/* The window keeps the group; the empty group is a constant without a handle, which is never
 * written. */
static void keep(struct mpi_group *g)
{
    if (g->o.number >= 0) g->o.uses++;
}

int mpi_win_post(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    struct mpi_group *g = w ? mpi_group_of(self, group) : NULL;
    (void)assert;
    if (!g) return self->code;
    /* Exposure to a group: ranks that call MPI_Win_start wait for TAG_POST, and this one
     * later for TAG_COMPLETE from each. Receives are posted before the others are let in,
     * so that none comes unexpected. */
    if (w->exposed)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "the window is exposed already");
    w->exposed = g;
    keep(g);
    w->completed = mpi_take_zero(self->world, (g->size + 1) * (int64_t)sizeof *w->completed);
    post(self, w, g, TAG_COMPLETE, w->completed);
    tell(self, w, g, TAG_POST);
    return MPI_SUCCESS;
}

/* The standard allows this call to wait or to return at once (section 12.5.2). It waits:
 * operations of the epoch then never meet a window that is not exposed. */
int mpi_win_start(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    struct mpi_group *g = w ? mpi_group_of(self, group) : NULL;
    (void)assert;
    if (!g) return self->code;
    if (w->access)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_start was called before");
    w->access = g;
    keep(g);
    struct comm_request *q = mpi_take_zero(self->world, (g->size + 1) * (int64_t)sizeof *q);
    post(self, w, g, TAG_POST, q);
    for (int i = 0; i < g->size; i++) mpi_wait_request(self, &q[i]);
    mpi_give(self->world, q);
    return MPI_SUCCESS;
}

/* Answers first: what the target hears after them is that everything was applied. */
int mpi_win_complete(struct mpi_rank *self, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->access)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_start was not called before");
    mpi_window_flush(self, w, MPI_ANY_SOURCE);
    tell(self, w, w->access, TAG_COMPLETE);
    mpi_group_drop(self, w->access);
    w->access = NULL;
    return MPI_SUCCESS;
}

/* The window lets go of the group and of the requests, which are all complete. */
static void exposure_ends(struct mpi_rank *r, struct mpi_window *w)
{
    mpi_give(r->world, w->completed);
    w->completed = NULL;
    mpi_group_drop(r, w->exposed);
    w->exposed = NULL;
}

/* Operations were applied by the serving task as they came; what is left is to hear that
 * no more will come. */
int mpi_win_wait(struct mpi_rank *self, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->exposed)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_post was not called before");
    for (int i = 0; i < w->exposed->size; i++) mpi_wait_request(self, &w->completed[i]);
    exposure_ends(self, w);
    return MPI_SUCCESS;
}

int mpi_win_test(struct mpi_rank *self, MPI_Win win, int *flag)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->exposed)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_post was not called before");
    *flag = 1;
    /* Requests that are complete stay so: a later test begins where this one ends. One
     * look may move an operation in progress instead of the request, so it is repeated
     * until nothing moves. */
    for (int i = 0; i < w->exposed->size && *flag; i++) {
        struct comm_request *q = &w->completed[i];
        int found = PROGRESS_TASK;
        while (q->active && found == PROGRESS_TASK) found = mpi_progress(self, 1, &q, false);
        *flag = !q->active;
    }
    if (*flag) exposure_ends(self, w);
    return MPI_SUCCESS;
}

/* --- locks --- */

static int held_type(char held)
{
    return held == HELD_SHARED ? MPI_LOCK_SHARED : MPI_LOCK_EXCLUSIVE;
}

/* MPI_PROC_NULL is legal, and then nothing is done (section 12.3). */
static struct mpi_window *on_rank(struct mpi_rank *r, MPI_Win win, int rank)
{
    struct mpi_window *w = mpi_window_of(r, win);
    if (!w || rank == MPI_PROC_NULL || (rank >= 0 && rank < w->comm->size)) return w;
    r->code = mpi_error(r, w->comm, MPI_ERR_RANK, "rank %d is not in the window's group of %d",
                        rank, w->comm->size);
    return NULL;
}

/* The call waits until the lock is granted. Real libraries often put the lock off until
 * the first operation; the number of messages is the same. */
int mpi_win_lock(struct mpi_rank *self, int lock_type, int rank, int assert, MPI_Win win)
{
    struct mpi_window *w = on_rank(self, win, rank);
    (void)assert;
    if (!w) return self->code;
    if (lock_type != MPI_LOCK_SHARED && lock_type != MPI_LOCK_EXCLUSIVE)
        return mpi_error(self, w->comm, MPI_ERR_LOCKTYPE, "lock type %d", lock_type);
    if (rank == MPI_PROC_NULL) return MPI_SUCCESS;
    if (mpi_window_locks(self, w)[rank])
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "rank %d is locked already", rank);
    mpi_window_ask(self, w, RMA_LOCK, rank, lock_type);
    w->locked[rank] = lock_type == MPI_LOCK_SHARED ? HELD_SHARED : HELD_EXCLUSIVE;
    return MPI_SUCCESS;
}

int mpi_win_unlock(struct mpi_rank *self, int rank, MPI_Win win)
{
    struct mpi_window *w = on_rank(self, win, rank);
    if (!w) return self->code;
    if (rank == MPI_PROC_NULL) return MPI_SUCCESS;
    if (!mpi_window_locks(self, w)[rank])
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "rank %d is not locked", rank);
    /* The lock goes when its operations are answered, so whoever gets it next sees their
     * effect (section 12.5.3). */
    mpi_window_flush(self, w, rank);
    mpi_window_ask(self, w, RMA_UNLOCK, rank, held_type(w->locked[rank]));
    w->locked[rank] = 0;
    return MPI_SUCCESS;
}

/* No message yet: P locks for a program that reaches a few neighbours would be dear. Each
 * is taken by the first operation on its rank (mpi_window_take). */
int mpi_win_lock_all(struct mpi_rank *self, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    (void)assert;
    if (!w) return self->code;
    if (w->lock_all)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "all ranks are locked already");
    w->lock_all = true;
    return MPI_SUCCESS;
}

int mpi_win_unlock_all(struct mpi_rank *self, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->lock_all)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_lock_all was not called before");
    mpi_window_flush(self, w, MPI_ANY_SOURCE);
    for (int i = 0; w->locked && i < w->comm->size; i++)
        if (w->locked[i]) {
            mpi_window_ask(self, w, RMA_UNLOCK, i, held_type(w->locked[i]));
            w->locked[i] = 0;
        }
    w->lock_all = false;
    return MPI_SUCCESS;
}

/* --- in between --- */

/* An answered operation is complete at both ends, so a flush and a local flush are the
 * same here (section 12.5.4). */
int mpi_win_flush(struct mpi_rank *self, int rank, MPI_Win win)
{
    struct mpi_window *w = on_rank(self, win, rank);
    if (!w) return self->code;
    if (rank != MPI_PROC_NULL) mpi_window_flush(self, w, rank);
    return MPI_SUCCESS;
}

int mpi_win_flush_all(struct mpi_rank *self, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    mpi_window_flush(self, w, MPI_ANY_SOURCE);
    return MPI_SUCCESS;
}

int mpi_win_flush_local(struct mpi_rank *self, int rank, MPI_Win win)
{
    return mpi_win_flush(self, rank, win);
}
int mpi_win_flush_local_all(struct mpi_rank *self, MPI_Win win)
{
    return mpi_win_flush_all(self, win);
}

/* Whoever looks at memory until it changes lets the changes come in. */
int mpi_win_sync(struct mpi_rank *self, MPI_Win win)
{
    if (!mpi_window_of(self, win)) return self->code;
    mpi_poll_tasks(self);
    return MPI_SUCCESS;
}
