/* mpi_errhandler.c - error handlers: what a communicator does with what goes wrong.
 *
 * Section 9.3 of MPI 5.0. What the handlers do is in mpi_error.c; here they are made,
 * counted and attached. */
#include "mpi/mpi_internal.h"

struct mpi_errhandler *mpi_errhandler_of(struct mpi_rank *r, MPI_Errhandler handle)
{
    int value = (int)(intptr_t)handle;
    if (handle != MPI_ERRORS_ARE_FATAL && handle != MPI_ERRORS_ABORT && handle != MPI_ERRORS_RETURN)
        return mpi_object(r, handle, KIND_ERRHANDLER) ?: mpi_bad_handle(r, handle, KIND_ERRHANDLER);
    /* Handles of the standard's three are fixed in the ABI, 0x141 to 0x143, one behind
     * the other: the handle says the place in the table. */
    static const struct mpi_errhandler standard[3] = {
        {.o = {KIND_ERRHANDLER, -1, 1}, .code = 0x141},
        {.o = {KIND_ERRHANDLER, -1, 1}, .code = 0x142},
        {.o = {KIND_ERRHANDLER, -1, 1}, .code = 0x143},
    };
    return (struct mpi_errhandler *)&standard[value - 0x141];
}

/* Standard handlers are constants that nobody counts. */
void mpi_errhandler_use(struct mpi_errhandler *h)
{
    if (h && h->function) h->o.uses++;
}

/* Uses: the program's handle and every communicator or window that has it. */
void mpi_errhandler_drop(struct mpi_rank *r, struct mpi_errhandler *h)
{
    if (!h || !h->function || --h->o.uses > 0) return;
    mpi_handle_end(r, h);
    mpi_give(r->world, h);
}

/* The function is variadic in the standard; it gets the object and the code, and no more. */
static int create_handler(struct mpi_rank *r, MPI_Handler_function *function,
                          MPI_Errhandler *errhandler)
{
    if (!function) return mpi_error(r, NULL, MPI_ERR_ARG, "the function is NULL");
    struct mpi_errhandler *h = mpi_take_zero(r->world, sizeof *h);
    *errhandler = mpi_handle_make(r, h, KIND_ERRHANDLER);
    h->function = function;
    return MPI_SUCCESS;
}

int mpi_comm_create_errhandler(struct mpi_rank *self,
                               MPI_Comm_errhandler_function *comm_errhandler_fn,
                               MPI_Errhandler *errhandler)
{
    return create_handler(self, comm_errhandler_fn, errhandler);
}

int mpi_errhandler_create(struct mpi_rank *self, MPI_Comm_errhandler_function *errhandler_fn,
                          MPI_Errhandler *errhandler)
{
    return create_handler(self, errhandler_fn, errhandler);
}

int mpi_comm_set_errhandler(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_errhandler *h = c ? mpi_errhandler_of(self, errhandler) : NULL;
    if (!h) return self->code;
    /* Use before drop: the new handler may be the old one. */
    mpi_errhandler_use(h);
    mpi_errhandler_drop(self, c->handler);
    c->handler = h;
    return MPI_SUCCESS;
}

MPI_Errhandler mpi_errhandler_handle(struct mpi_errhandler *h)
{
    /* A communicator without a handler has the world's default. */
    if (!h) return MPI_ERRORS_ARE_FATAL;
    if (!h->function) return (MPI_Errhandler)(intptr_t)h->code;
    h->o.uses++; /* the program may free what it gets */
    return mpi_handle(h);
}

int mpi_comm_get_errhandler(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler *errhandler)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    *errhandler = mpi_errhandler_handle(c->handler);
    return MPI_SUCCESS;
}

int mpi_errhandler_set(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler errhandler)
{
    return mpi_comm_set_errhandler(self, comm, errhandler);
}

int mpi_errhandler_get(struct mpi_rank *self, MPI_Comm comm, MPI_Errhandler *errhandler)
{
    return mpi_comm_get_errhandler(self, comm, errhandler);
}

/* The program's own code goes through the same handler as errors that are found here.
 * What the handler returns is not this call's result. */
int mpi_comm_call_errhandler(struct mpi_rank *self, MPI_Comm comm, int errorcode)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    char text[MPI_MAX_ERROR_STRING];
    int length;
    if (!c) return self->code;
    mpi_error_string(self, errorcode, text, &length);
    mpi_error(self, c, errorcode, "the program reports error %d: %s", errorcode, text);
    return MPI_SUCCESS;
}

/* The handler stays while a communicator has it. */
int mpi_errhandler_free(struct mpi_rank *self, MPI_Errhandler *errhandler)
{
    struct mpi_errhandler *h = mpi_errhandler_of(self, *errhandler);
    if (!h) return self->code;
    mpi_errhandler_drop(self, h);
    *errhandler = MPI_ERRHANDLER_NULL;
    return MPI_SUCCESS;
}

/* Handlers of windows differ by the type of their first argument, a pointer to a handle
 * in either case. */
int mpi_win_create_errhandler(struct mpi_rank *self, MPI_Win_errhandler_function *win_errhandler_fn,
                              MPI_Errhandler *errhandler)
{
    return create_handler(self, (MPI_Handler_function *)(intptr_t)win_errhandler_fn, errhandler);
}
