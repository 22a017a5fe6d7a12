/* mpi_channel.c - comm.h for the ranks of a communicator, so that the algorithms of
 * comm/collectives.h run on it.
 *
 * A channel counts ranks as its group does and keeps its tags apart from those of all others.
 * Everything else is the rank's own comm. */
#include "mpi/mpi_internal.h"

/* The comm is the channel's first member, so that its address is the channel's. */
static struct mpi_channel *channel_of(struct comm *c) { return (struct mpi_channel *)c; }
static struct comm *world_of(struct comm *c) { return channel_of(c)->self->comm; }

/* The rank's own comm charges the software's time and launches the message: a message of
 * a collective costs what any other costs. */
static void channel_isend(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                          struct comm_request *r)
{
    struct mpi_channel *k = channel_of(c);
    comm_isend(k->self->comm, mpi_group_world(k->group, dst), k->base + tag, data, bytes, r);
}

static void channel_irecv(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                          struct comm_request *r)
{
    struct mpi_channel *k = channel_of(c);
    comm_irecv(k->self->comm, mpi_group_world(k->group, src), k->base + tag, buffer, bytes, r);
}

/* A rank that waits lets its other operations go on. */
static void channel_wait(struct comm *c, struct comm_request *r)
{
    mpi_wait_request(channel_of(c)->self, r);
}

static void channel_barrier(struct comm *c) { comm_barrier(world_of(c)); }
static void channel_meet(struct comm *c, const struct comm_meeting *m)
{
    comm_meet(world_of(c), m);
}
static void channel_work(struct comm *c, const struct work *w) { comm_work(world_of(c), w); }
static void channel_stage(struct comm *c, int stage) { comm_stage(world_of(c), stage); }
static int64_t channel_now(struct comm *c) { return comm_now_ps(world_of(c)); }
static void channel_elapse(struct comm *c, int64_t ps) { comm_elapse(world_of(c), ps); }
static void channel_fail(struct comm *c, const char *text) { comm_fail(world_of(c), text); }

/* Without wildcards, probes and tests: algorithms do not use them. */
static const struct comm_type channel_type = {
    .name = "communicator",
    .isend = channel_isend,
    .irecv = channel_irecv,
    .wait = channel_wait,
    .barrier = channel_barrier,
    .meet = channel_meet,
    .work = channel_work,
    .stage = channel_stage,
    .now_ps = channel_now,
    .elapse = channel_elapse,
    .end_run = channel_fail,
};

/* One number of comm.h carries three: context in the highest bits, then the plane (two
 * bits), then the tag in 32 bits. MPI_ANY_TAG becomes a mask that leaves the lower 32
 * bits open, and no receive of one communicator can take a message of another (section
 * 7.4: safe communication space). LAST_CONTEXT keeps the sum within 63 bits. */
int64_t mpi_tag(int context, enum mpi_plane plane, int64_t tag)
{
    return ((int64_t)context * 4 + (int)plane) * (INT64_C(1) << 32) + tag;
}

void mpi_channel_make(struct mpi_channel *k, struct mpi_rank *r, struct mpi_group *g, int context,
                      enum mpi_plane plane)
{
    *k = (struct mpi_channel){.self = r, .group = g, .base = mpi_tag(context, plane, 0)};
    k->comm = (struct comm){.type = &channel_type, .rank = g->rank, .size = g->size};
    k->comm.file = r->comm->file;
    k->comm.keep_site = 1; /* the world's comm says where the program is */
}
