/* mpi_buffered.c - the messages of MPI_Bsend that are in an attached buffer. A message takes room
 * until the sender's software is done with it: an eager one none, any other until its receiver is
 * ready. */
#include "mpi/mpi_internal.h"

struct mpi_buffered {
    struct comm_request q;
    int64_t bytes;
    struct mpi_buffered *next;
};

/* occupied: the bytes of messages that have not left; what has left is taken from the list. */
static int64_t occupied(struct mpi_rank *r, struct mpi_buffered **list)
{
    int64_t sum = 0;
    for (struct mpi_buffered *b; (b = *list);) {
        if (b->q.active) {
            sum += b->bytes;
            list = &b->next;
        } else {
            *list = b->next;
            mpi_give(r->world, b);
        }
    }
    return sum;
}

/* Messages are asked whether they have left only when the room is needed, as a look without success
 * takes time. Section 3.6 says an overhead for each message that programs must allow for; none is
 * needed here. */
struct comm_request *mpi_buffer_room(struct mpi_rank *r, struct mpi_comm *c, int64_t bytes)
{
    struct mpi_buffered **list = c->buffer ? &c->buffered : &r->buffered;
    int64_t room = c->buffer ? c->buffer_bytes : r->buffer_bytes, taken = occupied(r, list);
    bool endless = (c->buffer ? c->buffer : r->buffer) == MPI_BUFFER_AUTOMATIC;
    if (!endless && bytes <= room && bytes > room - taken) {
        for (struct mpi_buffered *b = *list; b; b = b->next) comm_test(r->comm, &b->q);
        taken = occupied(r, list);
    }
    if (!endless && bytes > room - taken) {
        mpi_error(r, c, MPI_ERR_BUFFER,
                  "%lld bytes do not fit in the attached buffer of %lld, of which %lld are taken",
                  (long long)bytes, (long long)room, (long long)taken);
        return NULL;
    }
    struct mpi_buffered *b = mpi_take_zero(r->world, sizeof *b);
    b->bytes = bytes;
    b->next = *list;
    *list = b;
    return &b->q;
}

void mpi_buffer_drain(struct mpi_rank *r, struct mpi_buffered **list)
{
    for (struct mpi_buffered *b = *list; b; b = b->next) mpi_wait_request(r, &b->q);
    occupied(r, list);
}
