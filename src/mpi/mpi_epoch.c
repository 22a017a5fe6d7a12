/* mpi_epoch.c - when one-sided operations are complete: fences, groups that expose and access,
 * locks.
 *
 * An operation is complete at both ends when its answer is there, so that every epoch ends with
 * waiting for answers; what else is sent tells others so. */
#include "mpi/mpi_window.h"

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

/* tell: a message without data to each rank of a group; hear: one from each. */
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

int mpi_win_post(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    struct mpi_group *g = w ? mpi_group_of(self, group) : NULL;
    (void)assert;
    if (!g) return self->code;
    if (w->exposed)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "the window is exposed already");
    w->exposed = g;
    g->o.uses += g->o.number >= 0;
    w->completed = mpi_take_zero(self->world, (g->size + 1) * (int64_t)sizeof *w->completed);
    post(self, w, g, TAG_COMPLETE, w->completed);
    tell(self, w, g, TAG_POST);
    return MPI_SUCCESS;
}

int mpi_win_start(struct mpi_rank *self, MPI_Group group, int assert, MPI_Win win)
{
    struct mpi_window *w = mpi_window_of(self, win);
    struct mpi_group *g = w ? mpi_group_of(self, group) : NULL;
    (void)assert;
    if (!g) return self->code;
    if (w->access)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "MPI_Win_start was called before");
    w->access = g;
    g->o.uses += g->o.number >= 0;
    struct comm_request *q = mpi_take_zero(self->world, (g->size + 1) * (int64_t)sizeof *q);
    post(self, w, g, TAG_POST, q);
    for (int i = 0; i < g->size; i++) mpi_wait_request(self, &q[i]);
    mpi_give(self->world, q);
    return MPI_SUCCESS;
}

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

static void exposure_ends(struct mpi_rank *r, struct mpi_window *w)
{
    mpi_give(r->world, w->completed);
    w->completed = NULL;
    mpi_group_drop(r, w->exposed);
    w->exposed = NULL;
}

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

static struct mpi_window *on_rank(struct mpi_rank *r, MPI_Win win, int rank)
{
    struct mpi_window *w = mpi_window_of(r, win);
    if (!w || rank == MPI_PROC_NULL || (rank >= 0 && rank < w->comm->size)) return w;
    r->code = mpi_error(r, w->comm, MPI_ERR_RANK, "rank %d is not in the window's group of %d",
                        rank, w->comm->size);
    return NULL;
}

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
    mpi_window_flush(self, w, rank);
    mpi_window_ask(self, w, RMA_UNLOCK, rank, held_type(w->locked[rank]));
    w->locked[rank] = 0;
    return MPI_SUCCESS;
}

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
