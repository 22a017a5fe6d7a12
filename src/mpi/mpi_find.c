/* mpi_find.c - from handles to communicators and groups, and what is wrong with handles that are
 * none. */
#include "mpi/mpi_window.h"

enum { FIRST_HANDLE = 0x400 };

/* By enum mpi_kind; keyvals are integers and no handles, but have their numbers from the
 * same table. */
static const char *const kind_name[] = {"",          "communicator", "group", "datatype",
                                        "operation", "request",      "info",  "error handler",
                                        "window",    "message",      "keyval"};
static const int kind_class[] = {MPI_ERR_ARG, MPI_ERR_COMM,    MPI_ERR_GROUP, MPI_ERR_TYPE,
                                 MPI_ERR_OP,  MPI_ERR_REQUEST, MPI_ERR_INFO,  MPI_ERR_ERRHANDLER,
                                 MPI_ERR_WIN, MPI_ERR_REQUEST, MPI_ERR_KEYVAL};

/* What is wrong with a handle: null, of another kind, or of nothing that is there. The
 * kind in the lower four bits tells a wrong handle from a stale one, which names the
 * mistake: programs pass a group where a communicator belongs. */
void *mpi_bad_handle(struct mpi_rank *r, const void *handle, enum mpi_kind kind)
{
    intptr_t value = (intptr_t)handle - FIRST_HANDLE;
    int other = value < 0 ? 0 : (int)(value & 15);
    if (other && other <= KIND_KEYVAL && other != (int)kind &&
        mpi_object(r, handle, (enum mpi_kind)other))
        r->code = mpi_error(r, NULL, kind_class[kind], "a %s is expected, and the handle is a %s's",
                            kind_name[kind], kind_name[other]);
    else
        r->code = mpi_error(r, NULL, kind_class[kind],
                            "0x%llx is not the handle of a %s (or it was freed)",
                            (unsigned long long)(uintptr_t)handle, kind_name[kind]);
    return NULL;
}

/* The two fixed handles are by far the most frequent, so they come first. */
struct mpi_comm *mpi_comm_of(struct mpi_rank *r, MPI_Comm handle)
{
    if (handle == MPI_COMM_WORLD && r->world_comm) return r->world_comm;
    if (handle == MPI_COMM_SELF && r->self_comm) return r->self_comm;
    struct mpi_comm *c = mpi_object(r, handle, KIND_COMM);
    return c ? c : mpi_bad_handle(r, handle, KIND_COMM);
}

MPI_Comm mpi_comm_handle(struct mpi_rank *r, const struct mpi_comm *c)
{
    return c == r->world_comm ? MPI_COMM_WORLD : c == r->self_comm ? MPI_COMM_SELF : mpi_handle(c);
}

/* A constant: it has no number, so nobody counts or frees it. */
static const struct mpi_group empty = {.o = {KIND_GROUP, -1, 1}, .rank = MPI_UNDEFINED, .step = 1};

struct mpi_group *mpi_group_of(struct mpi_rank *r, MPI_Group handle)
{
    if (handle == MPI_GROUP_EMPTY) return (struct mpi_group *)&empty;
    struct mpi_group *g = mpi_object(r, handle, KIND_GROUP);
    return g ? g : mpi_bad_handle(r, handle, KIND_GROUP);
}

struct mpi_window *mpi_window_of(struct mpi_rank *r, MPI_Win handle)
{
    struct mpi_window *w = mpi_object(r, handle, KIND_WIN);
    return w ? w : mpi_bad_handle(r, handle, KIND_WIN);
}
