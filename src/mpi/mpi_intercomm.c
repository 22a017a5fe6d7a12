/* mpi_intercomm.c - communicators between two groups, made through a leader on either side.
 *
 * Both sides share one context for the messages between them; each has a communicator of its own
 * beneath for what it does among itself. Collective operations move data directly between the sides
 * where every rank's differ, and through the first rank of each side where one message tells all.
 *
 * Section 7.6 of MPI 5.0; collective operations as in chapter 6's paragraphs on
 * intercommunicators. */
#include <stdlib.h>

#include "mpi/mpi_collective.h"

/* Plain bytes as a part of an exchange. */
static struct mpi_part words(int peer, void *buffer, int64_t bytes)
{
    return (struct mpi_part){peer, buffer, bytes, mpi_type_basic(MPI_BYTE)};
}

/* swap: the leaders of both sides exchange bytes over `c`, whose rank `peer` is the other
 * leader. Both directions are under way at once: neither side can wait for the other to
 * begin. Tags are in the plane of making, which the program's messages never reach. */
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

/* What only a leader knows goes to all of its side, by the machine's broadcast. */
static void tell(struct mpi_rank *r, struct mpi_comm *local, int root, void *data, int64_t bytes)
{
    struct mpi_collective x = {
        .what = WHAT_BCAST, .comm = local, .recv = data, .recv_count = bytes, .root = root};
    x.recv_type = mpi_type_basic(MPI_BYTE);
    mpi_collective_now(r, &x);
}

/* What a leader tells the other: its side's size, largest context and a number of the call's. */
struct side_word {
    int size, context, word;
};

/* Contexts of an intercommunicator: one for both sides, one for the own side. */
struct contexts {
    int both, own;
};

/* meet: the other side's word on every rank, and contexts; the larger that a side gives is for
 * both. */
static struct side_word meet(struct mpi_rank *r, struct mpi_comm *local, int leader,
                             struct mpi_comm *peers, int peer, int64_t tag, int word,
                             struct contexts *context)
{
    /* Two numbers from each side: the first may serve both sides, the second stays the
     * own one's. Both are unique in the run, so the larger of the first two is, too, and
     * no third message is needed to agree. */
    int given = mpi_context_agree(r, &local->channel, local->sequence++);
    struct side_word out = {local->size, given, word}, in = {0};
    context->own = mpi_context_agree(r, &local->channel, local->sequence++);
    /* Only leaders reach the other side: the rest hear from them. */
    if (local->rank == leader) swap(r, peers, peer, tag, &out, sizeof out, &in, sizeof in);
    tell(r, local, leader, &in, sizeof in);
    context->both = given > in.context ? given : in.context;
    return in;
}

/* make: takes over the caller's uses of both groups. */
static struct mpi_comm *make(struct mpi_rank *r, struct mpi_group *local, struct mpi_group *remote,
                             struct contexts context, struct mpi_comm *like)
{
    /* Two communicators beneath one handle: that between the sides, whose ranks are the
     * remote group's for messages, and that of the own side for collective steps. */
    local->o.uses++;
    struct mpi_comm *c = mpi_comm_make(r, local, context.both, like);
    c->remote = remote;
    /* A barrier between two sides is never the machine's own. */
    c->whole = false;
    c->local = mpi_comm_make(r, local, context.own, like);
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
    /* The peer communicator and the other leader are significant at the leader alone
     * (section 7.6.2). */
    bool leads = local->rank == local_leader;
    if (leads) peers = mpi_comm_of(self, peer_comm);
    if (leads && !peers) return self->code;
    int npeer = !leads ? 0 : peers->remote ? peers->remote->size : peers->size;
    struct contexts context;
    /* An error at the leader under MPI_ERRORS_RETURN leaves the other ranks waiting:
     * nothing was agreed on. */
    if (leads && (remote_leader < 0 || remote_leader >= npeer))
        return mpi_error(self, local, MPI_ERR_RANK, "remote leader %d of %d ranks", remote_leader,
                         npeer);
    struct side_word far =
        meet(self, local, local_leader, peers, remote_leader, 2 * (int64_t)tag, 0, &context);
    /* the lists of ranks of the world go the same way */
    int *own = mpi_take(self->world, (local->size + far.size) * (int64_t)sizeof *own),
        *list = own + local->size;
    for (int i = 0; i < local->size; i++) own[i] = mpi_group_world(local->group, i);
    /* The tag is doubled, because one call needs two. */
    int64_t nown = local->size * (int64_t)sizeof *own, nfar = far.size * (int64_t)sizeof *own;
    if (leads) swap(self, peers, remote_leader, 2 * (int64_t)tag + 1, own, nown, list, nfar);
    tell(self, local, local_leader, list, nfar);
    struct mpi_group *remote = mpi_group_make(self, list, far.size);
    mpi_give(self->world, own);
    /* make takes over one use of each group, and the local communicator keeps its own. */
    local->group->o.uses++;
    *newintercomm = mpi_handle(make(self, local->group, remote, context, local));
    return MPI_SUCCESS;
}

/* The first rank of each side leads: any would do, and everybody knows this one. */
int mpi_intercomm_dup(struct mpi_rank *r, struct mpi_comm *c, MPI_Comm *newcomm)
{
    struct contexts context;
    meet(r, c->local, 0, c, 0, 0, 0, &context);
    c->remote->o.uses++;
    c->group->o.uses++;
    struct mpi_comm *made = make(r, c->group, c->remote, context, c);
    *newcomm = mpi_handle(made);
    return mpi_attributes_copy(r, KIND_COMM, c, made);
}

/* parts: an intercommunicator out of those ranks of both sides that go together; NULL where there
 * is none on either side or the own rank is not among them. */
static MPI_Comm parts(struct mpi_rank *r, struct mpi_comm *c, const int *near, int nnear,
                      const int *far, int nfar, struct contexts context)
{
    if (nnear == 0 || nfar == 0) return MPI_COMM_NULL;
    struct mpi_group *local = mpi_group_make(r, near, nnear);
    if (local->rank == MPI_UNDEFINED) {
        mpi_group_drop(r, local);
        return MPI_COMM_NULL;
    }
    return mpi_handle(make(r, local, mpi_group_make(r, far, nfar), context, c));
}

/* Section 7.4.2: each side's ranks pass the group of their own side; the new communicator
 * joins the two. Sizes travel as the word of the meeting, so that lists have room. */
int mpi_intercomm_part(struct mpi_rank *r, struct mpi_comm *c, struct mpi_group *g,
                       MPI_Comm *newcomm)
{
    struct contexts context;
    struct side_word other = meet(r, c->local, 0, c, 0, 0, g->size, &context);
    int *near = mpi_take(r->world, (g->size + other.word + 1) * (int64_t)sizeof *near);
    int *far = near + g->size;
    for (int i = 0; i < g->size; i++) near[i] = mpi_group_world(g, i);
    int64_t nnear = g->size * (int64_t)sizeof *near, nfar = other.word * (int64_t)sizeof *near;
    /* Ranks of the world are valid in the whole run, so they need no translation on the
     * other side. */
    if (c->local->rank == 0) swap(r, c, 0, 1, near, nnear, far, nfar);
    tell(r, c->local, 0, far, nfar);
    *newcomm = parts(r, c, near, g->size, far, other.word, context);
    mpi_give(r->world, near);
    return MPI_SUCCESS;
}

/* What a rank tells of itself in a split; ordered by key, then by place in the communicator. */
struct choice {
    int color, key, place, world;
};

static int by_key(const void *a, const void *b)
{
    const struct choice *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->place - y->place;
}

/* Sorts what it chooses from; the order on both sides is that of section 7.4.2. */
static int chosen(struct choice *of, int n, int color, int *list)
{
    int m = 0;
    qsort(of, (size_t)n, sizeof *of, by_key);
    for (int i = 0; i < n; i++)
        if (color != MPI_UNDEFINED && of[i].color == color) list[m++] = of[i].world;
    return m;
}

/* Both sides split by the same colors; those with ranks on one side only give
 * MPI_COMM_NULL. */
int mpi_intercomm_split(struct mpi_rank *r, struct mpi_comm *c, int color, int key,
                        MPI_Comm *newcomm)
{
    struct contexts context;
    int size = c->size, other = c->remote->size;
    struct choice own = {color, key, c->rank, r->rank};
    struct choice *near = mpi_take(r->world, (size + other) * (int64_t)sizeof *near);
    struct choice *far = near + size;
    int *list = mpi_take(r->world, (size + other) * (int64_t)sizeof *list);
    /* One context serves all parts: they have no rank in common. */
    meet(r, c->local, 0, c, 0, 0, 0, &context);
    mpi_collective_allgather(r, &c->local->channel, c->local->sequence++, &own, near, sizeof own);
    int64_t nnear = size * (int64_t)sizeof own, nfar = other * (int64_t)sizeof own;
    if (c->local->rank == 0) swap(r, c, 0, 1, near, nnear, far, nfar);
    tell(r, c->local, 0, far, nfar);
    int n = chosen(near, size, color, list), m = chosen(far, other, color, list + n);
    *newcomm = parts(r, c, list, n, list + n, m, context);
    mpi_give(r->world, list);
    mpi_give(r->world, near);
    return MPI_SUCCESS;
}

/* The low side comes first; of equals the one whose first rank of the world is the
 * smaller. Section 7.6.2. */
int mpi_intercomm_merge(struct mpi_rank *self, MPI_Comm intercomm, int high, MPI_Comm *newintracomm)
{
    struct mpi_comm *c = mpi_comm_of(self, intercomm);
    struct contexts context;
    if (!c) return self->code;
    if (!c->remote)
        return mpi_error(self, c, MPI_ERR_COMM, "the communicator is not an intercommunicator");
    struct side_word far = meet(self, c->local, 0, c, 0, 0, high != 0, &context);
    /* `high` of each side travels as the word of the meeting; the world's order decides
     * where both say the same, so that both sides come to one result. */
    bool first = (high != 0) != far.word
                     ? !high
                     : mpi_group_world(c->group, 0) < mpi_group_world(c->remote, 0);
    struct mpi_group *half[2] = {first ? c->group : c->remote, first ? c->remote : c->group};
    int n = 0,
        *list = mpi_take(self->world, (c->group->size + c->remote->size) * (int64_t)sizeof *list);
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < half[h]->size; i++) list[n++] = mpi_group_world(half[h], i);
    struct mpi_comm *made = mpi_comm_make(self, mpi_group_make(self, list, n), context.both, c);
    mpi_give(self->world, list);
    *newintracomm = mpi_handle(made);
    return MPI_SUCCESS;
}

/* An intracommunicator has no other side, so asking is an error (section 7.6.1). */
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

/* What one side does among itself for a call; tags apart from those of making
 * communicators. Both communicators count operations from 0, and the local one is used by
 * making, too. The added 2^24 takes the upper half of the tags' cycle, so that the two do
 * not meet before 16 million operations. */
static void among_own(struct mpi_rank *r, const struct mpi_collective *x, enum mpi_what what,
                      void *recv)
{
    struct mpi_collective local = *x;
    local.what = what;
    local.comm = x->comm->local;
    local.root = 0;
    local.recv = recv;
    local.sequence = x->sequence + (1u << 24);
    mpi_collective_run(r, &local);
}

/* Own side complete, first ranks tell each other, own side released: whoever leaves knows
 * that all have come. */
static void barrier(struct mpi_rank *r, const struct mpi_collective *x)
{
    char out = 0, in = 0;
    struct mpi_part to = words(0, &out, 1), from = words(0, &in, 1);
    among_own(r, x, WHAT_BARRIER, NULL);
    if (x->comm->rank == 0) mpi_exchange(r, x->comm, x->sequence, 1, &from, 1, &to);
    among_own(r, x, WHAT_BARRIER, NULL);
}

/* One message to the other side's first rank, which tells its own. */
static void broadcast(struct mpi_rank *r, const struct mpi_collective *x)
{
    struct mpi_part part = {0, x->recv, x->recv_count, x->recv_type};
    if (x->root == MPI_ROOT) mpi_exchange(r, x->comm, x->sequence, 0, NULL, 1, &part);
    /* On the root's side: MPI_ROOT has sent, MPI_PROC_NULL has nothing to do. */
    if (x->root < 0) return;
    part.peer = x->root;
    if (x->comm->rank == 0) mpi_exchange(r, x->comm, x->sequence, 1, &part, 0, NULL);
    among_own(r, x, WHAT_BCAST, x->recv);
}

/* Room for n elements as a buffer of the program's has it: from the first byte of all to the last,
 * wherever the type's elements begin. `at`: where the buffer begins. */
static char *vector_room(struct mpi_rank *r, const struct mpi_type *t, int64_t n, char **at)
{
    int64_t far = n > 0 ? (n - 1) * t->extent : 0, low = far < 0 ? far : 0;
    int64_t bytes = (far < 0 ? -far : far) + t->true_extent, whole = n * t->extent;
    char *room = mpi_take_zero(r->world, (whole > bytes ? whole : bytes) + 1);
    *at = room - low - t->true_lb;
    return room;
}

/* Each side's result goes to the other: to its root, or to its first rank and from there to all. */
static void reduce(struct mpi_rank *r, const struct mpi_collective *x)
{
    struct mpi_comm *c = x->comm;
    /* The side with data reduces to its first rank, which sends the result on. The answer
     * of an MPI_Allreduce is the other side's sum, not one's own (section 6.9.6). */
    bool all = x->what == WHAT_ALLREDUCE, contributes = all || x->root >= 0;
    struct mpi_part in = {0, x->recv, x->recv_count, x->recv_type}, out = in;
    char *room = NULL, *at = NULL;
    if (c->rank == 0 && contributes) room = vector_room(r, x->recv_type, x->recv_count, &at);
    out.buffer = at;
    if (contributes) among_own(r, x, WHAT_REDUCE, out.buffer);
    if (!all) out.peer = x->root;
    bool sends = room != NULL, takes = all ? c->rank == 0 : x->root == MPI_ROOT;
    mpi_exchange(r, c, x->sequence, takes, &in, sends, &out);
    mpi_give(r->world, room);
    /* Only now is the receive buffer complete on the first rank, from where the rest of
     * the side gets it. */
    if (all) among_own(r, x, WHAT_BCAST, x->recv);
}

/* The whole vectors are reduced on either side and exchanged; each side deals out what it got. */
static void reduce_scatter(struct mpi_rank *r, const struct mpi_collective *x)
{
    struct mpi_comm *c = x->comm;
    /* Counts are those of the own side; both sides' sums must be equal (section 6.10),
     * which nobody checks. */
    int64_t total = x->recv_count * c->size, place = 0;
    int *places = mpi_take(r->world, (c->size + 1) * (int64_t)sizeof *places);
    for (int i = 0; i < c->size && x->recv_counts.at; i++) {
        places[i] = (int)place;
        place += mpi_count_at(x->recv_counts, i);
    }
    if (x->recv_counts.at) total = place;
    struct mpi_part out = {0, NULL, total, x->recv_type}, in = out;
    struct mpi_collective part = *x;
    /* The own result and the other's. Only first ranks need them. */
    char *room[2] = {NULL}, *at[2] = {NULL};
    for (int i = 0; i < 2 && c->rank == 0; i++)
        room[i] = vector_room(r, x->recv_type, total, &at[i]);
    out.buffer = at[0];
    in.buffer = at[1];
    part.recv_count = total;
    part.recv_counts = (struct mpi_counts){0};
    among_own(r, &part, WHAT_REDUCE, out.buffer);
    mpi_exchange(r, c, x->sequence, c->rank == 0, &in, c->rank == 0, &out);
    /* The second half is a scatter by the same counts. */
    part = *x;
    part.send = in.buffer;
    part.send_type = x->recv_type;
    part.send_count = x->recv_count;
    part.send_counts = x->recv_counts;
    if (x->recv_counts.at) {
        part.send_places = (struct mpi_counts){places, 0};
        part.recv_count = mpi_count_at(x->recv_counts, c->rank);
    }
    part.recv_counts = (struct mpi_counts){0};
    among_own(r, &part, WHAT_SCATTER, x->recv);
    mpi_give(r->world, room[0]);
    mpi_give(r->world, room[1]);
    mpi_give(r->world, places);
}

/* part_of: block i of a side of the call. */
static struct mpi_part part_of(struct mpi_rank *r, const struct mpi_collective *x, bool out, int i)
{
    struct mpi_counts counts = out ? x->send_counts : x->recv_counts,
                      places = out ? x->send_places : x->recv_places;
    int64_t each = out ? x->send_count : x->recv_count;
    struct mpi_type *t = out ? x->send_type : x->recv_type;
    char *memory = out ? (char *)(uintptr_t)x->send : x->recv;
    /* Displacements count extents, but bytes in the one call whose blocks have types of
     * their own. */
    int64_t place = counts.at ? mpi_count_at(places, i) : i * each, scale = 1;
    int64_t count = counts.at ? mpi_count_at(counts, i) : each;
    if (x->what == WHAT_ALLTOALLW)
        t = mpi_block_type(r, out ? x->send_types[i] : x->recv_types[i], count);
    else scale = t->extent;
    return (struct mpi_part){i, memory + place * scale, count, t};
}

/* Every rank has something for every rank of the other side, or a root for all, or all for a root.
 */
static void direct(struct mpi_rank *r, const struct mpi_collective *x)
{
    /* All in one exchange: blocks in and out under way together. The cost is that of a
     * linear algorithm; the machine's rules for collectives speak of one group and have
     * no entry for two. */
    int far = x->comm->remote->size, nin = 0, nout = 0;
    bool rooted = x->what == WHAT_GATHER || x->what == WHAT_SCATTER, root = x->root == MPI_ROOT;
    bool blocks_in = x->what != WHAT_SCATTER,
         blocks_out = x->what != WHAT_GATHER && x->what != WHAT_ALLGATHER;
    struct mpi_part *in = mpi_take(r->world, 2 * far * (int64_t)sizeof *in), *out = in + far;
    /* The root, or everybody where there is none, has a block for each rank of the other
     * side. Gathering sends one block, the same for all. */
    for (int i = 0; i < far && (!rooted || root); i++) {
        if (!rooted || x->what == WHAT_GATHER) in[nin++] = part_of(r, x, false, i);
        if (!rooted || x->what == WHAT_SCATTER) {
            out[nout] = blocks_out ? part_of(r, x, true, i) : part_of(r, x, true, 0);
            out[nout++].peer = i;
        }
    }
    /* A rank of the side without the root: one message, to the root or from it. */
    if (rooted && x->root >= 0) {
        struct mpi_part part = blocks_in ? part_of(r, x, true, 0) : part_of(r, x, false, 0);
        part.peer = x->root;
        if (blocks_in) out[nout++] = part;
        else in[nin++] = part;
    }
    mpi_exchange(r, x->comm, x->sequence, nin, in, nout, out);
    mpi_give(r->world, in);
}

void mpi_intercomm_run(struct mpi_rank *r, const struct mpi_collective *x)
{
    switch (x->what) {
    case WHAT_BARRIER:
        barrier(r, x);
        break;
    case WHAT_BCAST:
        broadcast(r, x);
        break;
    case WHAT_REDUCE:
    case WHAT_ALLREDUCE:
        reduce(r, x);
        break;
    case WHAT_REDUCE_SCATTER:
        reduce_scatter(r, x);
        break;
    case WHAT_GATHER:
    case WHAT_SCATTER:
    case WHAT_ALLGATHER:
    case WHAT_ALLTOALL:
    case WHAT_ALLTOALLW:
        direct(r, x);
        break;
    default:
        mpi_fail(r, "not supported on intercommunicators");
    }
}
