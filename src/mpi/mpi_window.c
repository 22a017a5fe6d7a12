/* mpi_window.c - windows: made, told of, ended.
 *
 * Section 12.2 of MPI 5.0. A window's messages have a communicator and so a context of
 * their own: nothing that the program sends can meet them. */
#include <stdio.h>

#include "mpi/mpi_window.h"

/* --- making --- */

/* open_window: a communicator of its own, then the task that serves it; all ranks leave together,
 * so that nobody asks before everybody serves. */
static int open_window(struct mpi_rank *r, struct mpi_comm *c, struct mpi_window given,
                       MPI_Win *win)
{
    if (c->remote) return mpi_error(r, c, MPI_ERR_COMM, "an intercommunicator has no windows");
    if (given.size < 0) return mpi_error(r, c, MPI_ERR_SIZE, "size %lld", (long long)given.size);
    if (given.unit <= 0) return mpi_error(r, c, MPI_ERR_DISP, "displacement unit %d", given.unit);
    int context = mpi_context_agree(r, &c->channel, c->sequence++);
    /* Windows do not take over the communicator's error handler: theirs begins as fatal
     * (section 12.6). */
    struct mpi_window *w = mpi_take(r->world, sizeof *w);
    *w = given;
    mpi_handle_make(r, w, KIND_WIN);
    c->group->o.uses++;
    w->comm = mpi_comm_make(r, c->group, context, NULL);
    w->comm->handler = mpi_errhandler_of(r, MPI_ERRORS_ARE_FATAL);
    /* Ranks read and write their memory directly, so there is one copy of it (section
     * 12.4). */
    w->model = MPI_WIN_UNIFIED;
    w->waiting_end = &w->waiting;
    w->next = r->windows;
    r->windows = w;
    /* From here to MPI_Win_free a task waits for operations, so this rank has always one
     * in progress. */
    w->server = mpi_task_start(r, mpi_window_serve, w);
    mpi_collective_barrier(r, w->comm, w->comm->sequence++);
    *win = mpi_handle(w);
    return MPI_SUCCESS;
}

int mpi_win_create(struct mpi_rank *self, void *base, MPI_Aint size, MPI_Count disp_unit,
                   MPI_Info info, MPI_Comm comm, MPI_Win *win)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_window w = {
        .base = base, .size = size, .unit = (int)disp_unit, .flavor = MPI_WIN_FLAVOR_CREATE};
    (void)info;
    return c ? open_window(self, c, w, win) : self->code;
}

/* Zeroed; one byte more, so that a window of no bytes has an address as well. */
int mpi_win_allocate(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit, MPI_Info info,
                     MPI_Comm comm, void *baseptr, MPI_Win *win)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_window w = {.size = size, .unit = (int)disp_unit, .flavor = MPI_WIN_FLAVOR_ALLOCATE};
    (void)info;
    if (!c) return self->code;
    if (size >= 0) w.base = mpi_take_zero(self->world, size + 1);
    *(void **)baseptr = w.base;
    return open_window(self, c, w, win);
}

/* Displacements are addresses, so the unit is 1 (section 12.2.4). */
int mpi_win_create_dynamic(struct mpi_rank *self, MPI_Info info, MPI_Comm comm, MPI_Win *win)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_window w = {.unit = 1, .flavor = MPI_WIN_FLAVOR_DYNAMIC};
    (void)info;
    return c ? open_window(self, c, w, win) : self->code;
}

/* What a rank tells the others of its part of shared memory. */
struct share {
    int64_t size;
    char *place;
};

/* The first rank takes the memory of all, one part behind the other. All ranks are in one
 * process, so memory of one is memory of all; that they are on one node is not checked,
 * as MPI_Comm_split_type is how programs get such a communicator. */
int mpi_win_allocate_shared(struct mpi_rank *self, MPI_Aint size, MPI_Count disp_unit,
                            MPI_Info info, MPI_Comm comm, void *baseptr, MPI_Win *win)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_window w = {.size = size, .unit = (int)disp_unit, .flavor = MPI_WIN_FLAVOR_SHARED};
    (void)info;
    if (!c) return self->code;
    struct share own = {.size = size > 0 ? size : 0},
                 *all = mpi_take(self->world, c->size * (int64_t)sizeof *all);
    mpi_collective_allgather(self, &c->channel, c->sequence++, &own, all, sizeof own);
    /* Contiguous over the ranks, which the standard asks for by default (section 12.2.3). */
    int64_t total = 0;
    for (int i = 0; i < c->size; i++) total += all[i].size;
    if (c->rank == 0) own.place = mpi_take_zero(self->world, total + 1);
    struct share first[1] = {own};
    mpi_collective_allgather(self, &c->channel, c->sequence++, first, all, sizeof own);
    w.sizes = mpi_take(self->world, c->size * (int64_t)sizeof *w.sizes);
    w.places = mpi_take(self->world, c->size * (int64_t)sizeof *w.places);
    char *place = all[0].place;
    for (int i = 0; i < c->size; i++) {
        w.sizes[i] = all[i].size;
        w.places[i] = place;
        place += all[i].size;
    }
    mpi_give(self->world, all);
    *(void **)baseptr = w.base = w.places[c->rank];
    return open_window(self, c, w, win);
}

/* MPI_PROC_NULL: the first rank that has any. Units are taken to be the same on all ranks. */
int mpi_win_shared_query(struct mpi_rank *self, MPI_Win win, int rank, MPI_Aint *size,
                         MPI_Count *disp_unit, void *baseptr)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->places)
        return mpi_error(self, w->comm, MPI_ERR_RMA_FLAVOR, "the window's memory is not shared");
    for (int i = 0; rank == MPI_PROC_NULL && i < w->comm->size; i++)
        if (w->sizes[i] > 0) rank = i;
    *size = 0;
    *disp_unit = 1;
    *(void **)baseptr = NULL;
    if (rank == MPI_PROC_NULL) return MPI_SUCCESS;
    if (rank < 0 || rank >= w->comm->size)
        return mpi_error(self, w->comm, MPI_ERR_RANK, "rank %d of %d", rank, w->comm->size);
    *size = w->sizes[rank];
    *disp_unit = w->unit;
    *(void **)baseptr = w->places[rank];
    return MPI_SUCCESS;
}

/* Memory of a dynamic window is named by its address, wherever it is. An address is not
 * checked against what was attached. */
int mpi_win_attach(struct mpi_rank *self, MPI_Win win, void *base, MPI_Aint size)
{
    (void)base, (void)size;
    return mpi_window_of(self, win) ? MPI_SUCCESS : self->code;
}

int mpi_win_detach(struct mpi_rank *self, MPI_Win win, const void *base)
{
    (void)base;
    return mpi_window_of(self, win) ? MPI_SUCCESS : self->code;
}

/* When all ranks are here nobody asks any more: the server's receive is taken back and it ends. */
int mpi_win_free(struct mpi_rank *self, MPI_Win *win)
{
    struct mpi_window *w = mpi_window_of(self, *win);
    if (!w) return self->code;
    bool held = false;
    for (int i = 0; w->locked && i < w->comm->size; i++) held = held || w->locked[i];
    if (w->exposed || w->access || w->lock_all || held)
        return mpi_error(self, w->comm, MPI_ERR_RMA_SYNC, "an epoch of the window is still open");
    int code = mpi_attributes_end(self, KIND_WIN, w);
    if (code != MPI_SUCCESS) return code;
    /* Own operations first; after the barrier everybody's are done. The rest is taken
     * apart in the order in which it was made. */
    mpi_window_flush(self, w, MPI_ANY_SOURCE);
    mpi_collective_barrier(self, w->comm, w->comm->sequence++);
    w->closing = true;
    comm_cancel(self->comm, &w->served);
    mpi_task_go_on(self, w->server);
    struct mpi_window **at = &self->windows;
    while (*at != w) at = &(*at)->next;
    *at = w->next;
    /* Memory that MPI took is MPI's to give back; of shared memory the first rank took
     * all. */
    if (w->flavor == MPI_WIN_FLAVOR_ALLOCATE) mpi_give(self->world, w->base);
    if (w->flavor == MPI_WIN_FLAVOR_SHARED && w->comm->rank == 0)
        mpi_give(self->world, w->places[0]);
    mpi_give(self->world, w->sizes);
    mpi_give(self->world, w->places);
    mpi_give(self->world, w->locked);
    mpi_give(self->world, w->server);
    mpi_comm_drop(self, w->comm);
    mpi_handle_end(self, w);
    mpi_give(self->world, w);
    *win = MPI_WIN_NULL;
    return MPI_SUCCESS;
}

/* --- what they are --- */

int mpi_win_get_group(struct mpi_rank *self, MPI_Win win, MPI_Group *group)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    *group = mpi_group_handle(w->comm->group);
    return MPI_SUCCESS;
}

/* Section 12.2.6: pointers to the values, but for the base, which is the address itself
 * and may be NULL. */
bool mpi_window_attribute(struct mpi_window *w, int keyval, void *value)
{
    void *p = NULL;
    if (keyval == MPI_WIN_SIZE) p = &w->size;
    if (keyval == MPI_WIN_DISP_UNIT) p = &w->unit;
    if (keyval == MPI_WIN_CREATE_FLAVOR) p = &w->flavor;
    if (keyval == MPI_WIN_MODEL) p = &w->model;
    if (keyval == MPI_WIN_BASE) p = w->base;
    /* `value` stays as it is where the keyval is none of these. */
    if (p == NULL && keyval != MPI_WIN_BASE) return false;
    *(void **)value = p;
    return true;
}

/* As for communicators and types (section 7.8). */
int mpi_win_get_name(struct mpi_rank *self, MPI_Win win, char *win_name, int *resultlen)
{
    struct mpi_window *w = win == MPI_WIN_NULL ? NULL : mpi_window_of(self, win);
    if (!w && win != MPI_WIN_NULL) return self->code;
    const char *name = w ? mpi_name_given(self, KIND_WIN, w, "") : "MPI_WIN_NULL";
    return mpi_text_out(win_name, MPI_MAX_OBJECT_NAME, name, resultlen);
}

int mpi_win_set_name(struct mpi_rank *self, MPI_Win win, const char *win_name)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    mpi_name_give(self, KIND_WIN, w, win_name);
    return MPI_SUCCESS;
}

int mpi_win_set_info(struct mpi_rank *self, MPI_Win win, MPI_Info info)
{
    (void)info;
    return mpi_window_of(self, win) ? MPI_SUCCESS : self->code;
}

int mpi_win_get_info(struct mpi_rank *self, MPI_Win win, MPI_Info *info_used)
{
    return mpi_window_of(self, win) ? mpi_info_create(self, info_used) : self->code;
}

/* Errors are those of the window's own communicator. */
int mpi_win_set_errhandler(struct mpi_rank *self, MPI_Win win, MPI_Errhandler errhandler)
{
    struct mpi_window *w = mpi_window_of(self, win);
    return w ? mpi_comm_set_errhandler(self, mpi_handle(w->comm), errhandler) : self->code;
}

int mpi_win_get_errhandler(struct mpi_rank *self, MPI_Win win, MPI_Errhandler *errhandler)
{
    struct mpi_window *w = mpi_window_of(self, win);
    return w ? mpi_comm_get_errhandler(self, mpi_handle(w->comm), errhandler) : self->code;
}

/* A function of the program gets the window and not the communicator within. */
int mpi_win_call_errhandler(struct mpi_rank *self, MPI_Win win, int errorcode)
{
    struct mpi_window *w = mpi_window_of(self, win);
    if (!w) return self->code;
    if (!w->comm->handler || !w->comm->handler->function)
        return mpi_comm_call_errhandler(self, mpi_handle(w->comm), errorcode);
    mpi_error_handled(self, w, w->comm->handler, errorcode);
    return MPI_SUCCESS;
}
