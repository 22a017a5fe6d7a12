/* mpi_intercomm.c - communicators between two groups, made through a leader on either side.
 *
 * Both sides share one context for the messages between them; each has a communicator of its own
 * beneath for what it does among itself. Collective operations move data directly between the sides
 * where every rank's differ, and through the first rank of each side where one message tells all.
 */
#include "mpi/mpi_collective.h"

static struct mpi_part words(int peer, void *buffer, int64_t bytes)
{
    return (struct mpi_part){peer, buffer, bytes, mpi_type_basic(MPI_BYTE)};
}

/* swap: the leaders of both sides exchange bytes over `c`, whose rank `peer` is the other leader.
 */
static void swap(struct mpi_rank *r, struct mpi_comm *c, int peer, int64_t tag, void *out,
                 int64_t nout, void *in, int64_t nin)
{
    struct comm_request q[2] = {{0}};
    int world = mpi_group_world(c->remote ? c->remote : c->group, peer);
    int64_t whole = mpi_tag(c->context, PLANE_MAKING, tag);
    comm_irecv(r->comm, world, whole, in, nin, &q[0]);
    comm_isend(r->comm, world, whole, out, nout, &q[1]);
    mpi_wait_request(r, &q[0]);
    mpi_wait_request(r, &q[1]);
}

static void tell(struct mpi_rank *r, struct mpi_comm *local, int root, void *data, int64_t bytes)
{
    struct mpi_collective x = {
        .what = WHAT_BCAST, .comm = local, .recv = data, .recv_count = bytes, .root = root};
    x.recv_type = mpi_type_basic(MPI_BYTE);
    mpi_collective_run(r, &x);
}

/* What a leader tells the other: its side's size, largest context and a number of the call's. */
struct side_word {
    int size, context, word;
};

/* meet: the other side's word on every rank; contexts of both sides in *context. */
static struct side_word meet(struct mpi_rank *r, struct mpi_comm *local, int leader,
                             struct mpi_comm *peers, int peer, int64_t tag, int word, int *context)
{
    int own = mpi_collective_max(r, &local->channel, local->sequence++, r->next_context);
    struct side_word out = {local->size, own, word}, in = {0};
    if (local->rank == leader) swap(r, peers, peer, tag, &out, sizeof out, &in, sizeof in);
    tell(r, local, leader, &in, sizeof in);
    *context = own > in.context ? own : in.context;
    return in;
}

static struct mpi_comm *make(struct mpi_rank *r, struct mpi_comm *local, struct mpi_group *remote,
                             int context)
{
    local->group->o.uses += 2;
    struct mpi_comm *c = mpi_comm_make(r, local->group, context, local);
    c->remote = remote;
    c->whole = false;
    c->local = mpi_comm_make(r, local->group, context + 1, local);
    mpi_context_new(r, context + 1);
    return c;
}

int mpi_intercomm_create(struct mpi_rank *self, MPI_Comm local_comm, int local_leader,
                         MPI_Comm peer_comm, int remote_leader, int tag, MPI_Comm *newintercomm)
{
    struct mpi_comm *local = mpi_comm_of(self, local_comm), *peers = NULL;
    if (!local) return self->code;
    if (local->remote)
        return mpi_error(self, local, MPI_ERR_COMM,
                         "the local communicator is an intercommunicator");
    if (local_leader < 0 || local_leader >= local->size)
        return mpi_error(self, local, MPI_ERR_RANK, "leader %d of %d ranks", local_leader,
                         local->size);
    bool leads = local->rank == local_leader;
    if (leads) peers = mpi_comm_of(self, peer_comm);
    if (leads && !peers) return self->code;
    int npeer = !leads ? 0 : peers->remote ? peers->remote->size : peers->size, context;
    if (leads && (remote_leader < 0 || remote_leader >= npeer))
        return mpi_error(self, local, MPI_ERR_RANK, "remote leader %d of %d ranks", remote_leader,
                         npeer);
    struct side_word far =
        meet(self, local, local_leader, peers, remote_leader, 2 * (int64_t)tag, 0, &context);
    /* the lists of ranks of the world go the same way */
    int *own = mpi_take(self->world, (local->size + far.size) * (int64_t)sizeof *own),
        *list = own + local->size;
    for (int i = 0; i < local->size; i++) own[i] = mpi_group_world(local->group, i);
    int64_t nown = local->size * (int64_t)sizeof *own, nfar = far.size * (int64_t)sizeof *own;
    if (leads) swap(self, peers, remote_leader, 2 * (int64_t)tag + 1, own, nown, list, nfar);
    tell(self, local, local_leader, list, nfar);
    struct mpi_group *remote = mpi_group_make(self, list, far.size);
    mpi_give(self->world, own);
    *newintercomm = mpi_handle(make(self, local, remote, context));
    return MPI_SUCCESS;
}

int mpi_intercomm_dup(struct mpi_rank *r, struct mpi_comm *c, MPI_Comm *newcomm)
{
    int context;
    meet(r, c->local, 0, c, 0, 0, 0, &context);
    c->remote->o.uses++;
    struct mpi_comm *made = make(r, c->local, c->remote, context);
    *newcomm = mpi_handle(made);
    return mpi_attributes_copy(r, KIND_COMM, c, made);
}

/* The low side comes first; of equals the one whose first rank of the world is the smaller. */
int mpi_intercomm_merge(struct mpi_rank *self, MPI_Comm intercomm, int high, MPI_Comm *newintracomm)
{
    struct mpi_comm *c = mpi_comm_of(self, intercomm);
    int context;
    if (!c) return self->code;
    if (!c->remote)
        return mpi_error(self, c, MPI_ERR_COMM, "the communicator is not an intercommunicator");
    struct side_word far = meet(self, c->local, 0, c, 0, 0, high != 0, &context);
    bool first = (high != 0) != far.word
                     ? !high
                     : mpi_group_world(c->group, 0) < mpi_group_world(c->remote, 0);
    struct mpi_group *half[2] = {first ? c->group : c->remote, first ? c->remote : c->group};
    int n = 0,
        *list = mpi_take(self->world, (c->group->size + c->remote->size) * (int64_t)sizeof *list);
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < half[h]->size; i++) list[n++] = mpi_group_world(half[h], i);
    struct mpi_comm *made =
        mpi_comm_make(self, mpi_group_make(self, list, n), mpi_context_new(self, context), c);
    mpi_give(self->world, list);
    *newintracomm = mpi_handle(made);
    return MPI_SUCCESS;
}

int mpi_comm_remote_size(struct mpi_rank *self, MPI_Comm comm, int *size)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    if (!c->remote)
        return mpi_error(self, c, MPI_ERR_COMM, "the communicator is not an intercommunicator");
    *size = c->remote->size;
    return MPI_SUCCESS;
}

int mpi_comm_remote_group(struct mpi_rank *self, MPI_Comm comm, MPI_Group *group)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    if (!c) return self->code;
    if (!c->remote)
        return mpi_error(self, c, MPI_ERR_COMM, "the communicator is not an intercommunicator");
    *group = mpi_group_handle(c->remote);
    return MPI_SUCCESS;
}

/* --- collective operations --- */

static void barrier(struct mpi_rank *r, struct mpi_comm *c, unsigned sequence)
{
    char out = 0, in = 0;
    mpi_collective_barrier(r, c->local);
    struct mpi_part to = words(0, &out, 1), from = words(0, &in, 1);
    if (c->rank == 0) mpi_exchange(r, c, sequence, 1, &from, 1, &to);
    mpi_collective_barrier(r, c->local);
}

/* One message to the other side's first rank, which tells its own. */
static void broadcast(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct mpi_part part = {0, x->recv, x->recv_count, x->recv_type};
    if (x->root == MPI_ROOT) mpi_exchange(r, x->comm, sequence, 0, NULL, 1, &part);
    if (x->root < 0) return;
    part.peer = x->root;
    if (x->comm->rank == 0) mpi_exchange(r, x->comm, sequence, 1, &part, 0, NULL);
    struct mpi_collective local = *x;
    local.comm = x->comm->local;
    local.root = 0;
    mpi_collective_run(r, &local);
}

/* Each side's result goes to the other: to its root, or to its first rank and from there to all. */
static void reduce(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct mpi_comm *c = x->comm;
    bool all = x->what == WHAT_ALLREDUCE, contributes = all || x->root >= 0;
    int64_t bytes = x->recv_count * x->recv_type->extent;
    struct mpi_part in = {0, x->recv, x->recv_count, x->recv_type}, out = in;
    out.buffer = c->rank == 0 && contributes ? mpi_take_zero(r->world, bytes + 1) : NULL;
    if (contributes) {
        struct mpi_collective local = *x;
        local.what = WHAT_REDUCE;
        local.comm = c->local;
        local.root = 0;
        local.recv = out.buffer;
        mpi_collective_run(r, &local);
    }
    if (!all) out.peer = x->root;
    bool sends = out.buffer != NULL, takes = all ? c->rank == 0 : x->root == MPI_ROOT;
    mpi_exchange(r, c, sequence, takes, &in, sends, &out);
    mpi_give(r->world, out.buffer);
    if (!all) return;
    struct mpi_collective local = *x;
    local.what = WHAT_BCAST;
    local.comm = c->local;
    local.root = 0;
    mpi_collective_run(r, &local);
}

/* part_of: block i of a side of the call. */
static struct mpi_part part_of(struct mpi_rank *r, const struct mpi_collective *x, bool out, int i)
{
    struct mpi_counts counts = out ? x->send_counts : x->recv_counts,
                      places = out ? x->send_places : x->recv_places;
    int64_t each = out ? x->send_count : x->recv_count;
    struct mpi_type *t = out ? x->send_type : x->recv_type;
    char *memory = out ? (char *)(uintptr_t)x->send : x->recv;
    int64_t place = counts.at ? mpi_count_at(places, i) : i * each, scale = 1;
    if (x->what == WHAT_ALLTOALLW) t = mpi_type_of(r, out ? x->send_types[i] : x->recv_types[i]);
    else scale = t->extent;
    return (struct mpi_part){i, memory + place * scale, counts.at ? mpi_count_at(counts, i) : each,
                             t};
}

/* Every rank has something for every rank of the other side, or a root for all, or all for a root.
 */
static void direct(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    int far = x->comm->remote->size, nin = 0, nout = 0;
    bool rooted = x->what == WHAT_GATHER || x->what == WHAT_SCATTER, root = x->root == MPI_ROOT;
    bool blocks_in = x->what != WHAT_SCATTER,
         blocks_out = x->what != WHAT_GATHER && x->what != WHAT_ALLGATHER;
    struct mpi_part *in = mpi_take(r->world, 2 * far * (int64_t)sizeof *in), *out = in + far;
    for (int i = 0; i < far && (!rooted || root); i++) {
        if (!rooted || x->what == WHAT_GATHER) in[nin++] = part_of(r, x, false, i);
        if (!rooted || x->what == WHAT_SCATTER) {
            out[nout] = blocks_out ? part_of(r, x, true, i) : part_of(r, x, true, 0);
            out[nout++].peer = i;
        }
    }
    if (rooted && x->root >= 0) {
        struct mpi_part part = blocks_in ? part_of(r, x, true, 0) : part_of(r, x, false, 0);
        part.peer = x->root;
        if (blocks_in) out[nout++] = part;
        else in[nin++] = part;
    }
    mpi_exchange(r, x->comm, sequence, nin, in, nout, out);
    mpi_give(r->world, in);
}

void mpi_intercomm_run(struct mpi_rank *r, const struct mpi_collective *x)
{
    unsigned sequence = x->comm->sequence++;
    switch (x->what) {
    case WHAT_BARRIER:
        barrier(r, x->comm, sequence);
        break;
    case WHAT_BCAST:
        broadcast(r, x, sequence);
        break;
    case WHAT_REDUCE:
    case WHAT_ALLREDUCE:
        reduce(r, x, sequence);
        break;
    case WHAT_GATHER:
    case WHAT_SCATTER:
    case WHAT_ALLGATHER:
    case WHAT_ALLTOALL:
    case WHAT_ALLTOALLW:
        direct(r, x, sequence);
        break;
    default:
        mpi_fail(r, "not supported on intercommunicators");
    }
}
