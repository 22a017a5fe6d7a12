/* mpi_buffer.c - buffers attached for MPI_Bsend. comm.h copies what is sent, so only their sizes
 * matter: a message that a real library could not have buffered is an error here too. */
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

/* A real library waits here until all buffered messages have left. comm.h has taken its
 * copies when a send returns, so nothing is pending. */
static int detach(void **at, int64_t *bytes, void *buffer_addr, MPI_Count *size)
{
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
    return detach(&self->buffer, &self->buffer_bytes, buffer_addr, size);
}

/* For the same reason a flush has nothing to wait for. */
int mpi_buffer_flush(struct mpi_rank *self)
{
    (void)self;
    return MPI_SUCCESS;
}

int mpi_buffer_iflush(struct mpi_rank *self, MPI_Request *request)
{
    *request = mpi_request_nothing(self);
    return MPI_SUCCESS;
}

/* A communicator's own buffer takes precedence over the rank's (buffered_room in
 * mpi_message.c). */
int mpi_comm_attach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer, MPI_Count size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    return c ? attach(self, c, &c->buffer, &c->buffer_bytes, buffer, size) : self->code;
}

int mpi_comm_detach_buffer(struct mpi_rank *self, MPI_Comm comm, void *buffer_addr, MPI_Count *size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    return c ? detach(&c->buffer, &c->buffer_bytes, buffer_addr, size) : self->code;
}

int mpi_comm_flush_buffer(struct mpi_rank *self, MPI_Comm comm)
{
    return mpi_comm_of(self, comm) ? MPI_SUCCESS : self->code;
}

/* The request is complete from the start: the program still has to wait or test for it. */
int mpi_comm_iflush_buffer(struct mpi_rank *self, MPI_Comm comm, MPI_Request *request)
{
    if (!mpi_comm_of(self, comm)) return self->code;
    *request = mpi_request_nothing(self);
    return MPI_SUCCESS;
}
