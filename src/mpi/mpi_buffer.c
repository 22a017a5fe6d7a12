/* mpi_buffer.c - buffers attached for MPI_Bsend. comm.h copies what is sent, so only their sizes
 * matter: a message that a real library could not have buffered is an error here too. What
 * is in them is kept in mpi_buffered.c. */
#include "mpi/mpi_internal.h"

/* One buffer at a time for the rank, and one for each communicator (MPI 4.1 added those),
 * so a second is an error (section 3.6). The memory stays the program's and is never
 * written. */
static int attach(struct mpi_rank *r, struct mpi_comm *c, void **at, int64_t *bytes, void *buffer,
                  int64_t size)
{
    if (*at)
        return mpi_error(r, c, MPI_ERR_BUFFER, "a buffer of %lld bytes is attached already",
                         (long long)*bytes);
    if (size < 0) return mpi_error(r, c, MPI_ERR_ARG, "size %lld is negative", (long long)size);
    *at = buffer;
    *bytes = size;
    return MPI_SUCCESS;
}

/* Section 3.6: this waits until all messages in the buffer have left. */
static int detach(struct mpi_rank *r, struct mpi_buffered **list, void **at, int64_t *bytes,
                  void *buffer_addr, MPI_Count *size)
{
    mpi_buffer_drain(r, list);
    *(void **)buffer_addr = *at;
    *size = *bytes;
    *at = NULL;
    *bytes = 0;
    return MPI_SUCCESS;
}

int mpi_buffer_attach(struct mpi_rank *self, void *buffer, MPI_Count size)
{
    return attach(self, NULL, &self->buffer, &self->buffer_bytes, buffer, size);
}

int mpi_buffer_detach(struct mpi_rank *self, void *buffer_addr, MPI_Count *size)
{
    return detach(self, &self->buffered, &self->buffer, &self->buffer_bytes, buffer_addr, size);
}

int mpi_buffer_flush(struct mpi_rank *self)
{
    mpi_buffer_drain(self, &self->buffered);
    return MPI_SUCCESS;
}

/* The program may use its memory at once, as comm.h has copies: so this request is complete. */
int mpi_buffer_iflush(struct mpi_rank *self, MPI_Request *request)
{
    *request = mpi_request_nothing(self);
    return MPI_SUCCESS;
}

/* A communicator's own buffer takes precedence over the rank's (mpi_buffer_room). */
int mpi_comm_attach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer, MPI_Count size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    return c ? attach(self, c, &c->buffer, &c->buffer_bytes, buffer, size) : self->code;
}

int mpi_comm_detach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer_addr, MPI_Count *size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    return detach(self, &c->buffered, &c->buffer, &c->buffer_bytes, buffer_addr, size);
}

int mpi_comm_flush_buffer(struct mpi_rank *self, MPI_Comm comm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    mpi_buffer_drain(self, &c->buffered);
    return MPI_SUCCESS;
}

/* The request is complete from the start: the program still has to wait or test for it. */
int mpi_comm_iflush_buffer(struct mpi_rank *self, MPI_Comm comm, MPI_Request *request)
{
    if (!mpi_comm_of(self, comm)) return self->code;
    *request = mpi_request_nothing(self);
    return MPI_SUCCESS;
}
