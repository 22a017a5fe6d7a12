/* mpi_collective_calls.c - the collective functions: their arguments checked and put into one form.
 *
 * The same struct describes every call; what a call does not have is zero. Checks come
 * before anything is sent, so that a wrong argument leaves the communicator as it was.
 * Sections are those of chapter 6 of MPI 5.0. */
#include "mpi/mpi_collective.h"

/* What a started operation holds on to until it is completed for good. The communicator
 * is held by the request itself. */
static void hold(struct mpi_collective *x)
{
    if (x->send_type) mpi_type_use(x->send_type);
    if (x->recv_type) mpi_type_use(x->recv_type);
    if (x->op) mpi_op_use(x->op);
}

static void release(struct mpi_rank *r, void *argument)
{
    struct mpi_collective *x = argument;
    mpi_type_drop(r, x->send_type);
    mpi_type_drop(r, x->recv_type);
    mpi_op_drop(r, x->op);
}

/* run: on the side of the communicator that the call is for. */
static void run(struct mpi_rank *r, void *call)
{
    const struct mpi_collective *x = call;
    /* An intercommunicator has no topology, so the two cannot meet. */
    if (x->comm->remote) mpi_intercomm_run(r, x);
    else if (x->what >= WHAT_NEIGHBOR_ALLGATHER) mpi_neighbor_run(r, x);
    else mpi_collective_run(r, x);
}

static int count_error(struct mpi_rank *r, struct mpi_comm *c, int64_t n)
{
    return mpi_error(r, c, MPI_ERR_COUNT, "count %lld is negative", (long long)n);
}

/* Displacements are not checked: any place that the program can reach is legal. */
static int check_counts(struct mpi_rank *r, struct mpi_comm *c, struct mpi_counts counts, int n)
{
    for (int i = 0; counts.at && i < n; i++)
        if (mpi_count_at(counts, i) < 0) return count_error(r, c, mpi_count_at(counts, i));
    return MPI_SUCCESS;
}

/* A root of an intercommunicator is MPI_ROOT, MPI_PROC_NULL or a rank of the other side. */
static int check_root(struct mpi_rank *r, const struct mpi_collective *x)
{
    struct mpi_comm *c = x->comm;
    int n = c->remote ? c->remote->size : c->size;
    if (c->remote && (x->root == MPI_ROOT || x->root == MPI_PROC_NULL)) return MPI_SUCCESS;
    if (x->root >= 0 && x->root < n) return MPI_SUCCESS;
    return mpi_error(r, c, MPI_ERR_ROOT, "root %d is not in the communicator of %d ranks", x->root,
                     n);
}

/* Only committed types may be used in communication (section 5.1.9). */
static bool type_of(struct mpi_rank *r, MPI_Datatype handle, struct mpi_type **t,
                    const struct mpi_collective *x)
{
    *t = mpi_type_of(r, handle);
    if (!*t) return false;
    if ((*t)->committed) return true;
    r->code = mpi_error(r, x->comm, MPI_ERR_TYPE, "the datatype was not committed");
    return false;
}

/* Of operations with a type for each block; where a block is empty nobody looks at its
 * type. */
static int check_types(struct mpi_rank *r, const struct mpi_collective *x, struct mpi_counts counts,
                       const MPI_Datatype *types, int n)
{
    struct mpi_type *t;
    for (int i = 0; types && counts.at && i < n; i++)
        if (mpi_count_at(counts, i) > 0 && !type_of(r, types[i], &t, x)) return r->code;
    return MPI_SUCCESS;
}

/* Blocks are as many as there are ranks, on the other side of an intercommunicator, or edges of a
 * topology. What is reduced there is scattered over the own side (section 6.10). */
static int check_blocks(struct mpi_rank *r, const struct mpi_collective *x)
{
    const bool across = x->comm->remote && x->what != WHAT_REDUCE_SCATTER;
    int nin = across ? x->comm->remote->size : x->comm->size, nout = nin;
    if (x->what >= WHAT_NEIGHBOR_ALLGATHER) {
        if (!x->comm->topology)
            return mpi_error(r, x->comm, MPI_ERR_TOPOLOGY, "the communicator has no topology");
        mpi_neighbor_edges(x->comm, &nin, &nout);
    }
    int code = check_counts(r, x->comm, x->send_counts, nout);
    if (code == MPI_SUCCESS) code = check_counts(r, x->comm, x->recv_counts, nin);
    if (code == MPI_SUCCESS) code = check_types(r, x, x->send_counts, x->send_types, nout);
    if (code == MPI_SUCCESS) code = check_types(r, x, x->recv_counts, x->recv_types, nin);
    return code;
}

/* operate: check what all have in common, then run or start. */
static int operate(struct mpi_rank *r, struct mpi_start start, struct mpi_collective *x)
{
    int code = check_root(r, x);
    if (code != MPI_SUCCESS) return code;
    if (x->comm->remote && (x->what == WHAT_SCAN || x->what == WHAT_EXSCAN))
        return mpi_error(r, x->comm, MPI_ERR_COMM, "an intercommunicator has no order of ranks");
    if (x->send_count < 0 || x->recv_count < 0)
        return count_error(r, x->comm, x->send_count < 0 ? x->send_count : x->recv_count);
    code = check_blocks(r, x);
    if (code != MPI_SUCCESS) return code;
    /* The sequence is taken by the call and not when the operation runs: ranks may start
     * several, and these may go on in another order on each rank. */
    x->sequence = x->comm->sequence++;
    /* A blocking call runs on the rank's own stack and needs no request. */
    if (start.mode == MPI_BLOCKING) {
        run(r, x);
        return MPI_SUCCESS;
    }
    /* The program may free types and operations while it goes on (sections 5.1.9, 6.9.5):
     * the request keeps them. */
    hold(x);
    code = mpi_request_task(r, x->comm, run, x, sizeof *x, -1, start);
    mpi_request_release(r, *start.request, release);
    return code;
}

/* comm_of, type_of: the handles that a call gives; false: an error was reported. */
static bool comm_of(struct mpi_rank *r, MPI_Comm comm, struct mpi_collective *x)
{
    return (x->comm = mpi_comm_of(r, comm)) != NULL;
}

/* What the root alone must give. */
static bool is_root(const struct mpi_collective *x)
{
    return x->comm->remote ? x->root == MPI_ROOT : x->comm->rank == x->root;
}
/* Of an intercommunicator the root's side only receives or only sends, and of it only the
 * root acts. */
static bool is_leaf(const struct mpi_collective *x) { return !x->comm->remote || x->root >= 0; }

int mpi_barrier(struct mpi_rank *self, struct mpi_start start, MPI_Comm comm)
{
    struct mpi_collective x = {.what = WHAT_BARRIER};
    if (!comm_of(self, comm, &x)) return self->code;
    return operate(self, start, &x);
}

/* The buffer is `recv` on every rank: the root's holds what the others receive. */
int mpi_bcast(struct mpi_rank *self, struct mpi_start start, void *buffer, MPI_Count count,
              MPI_Datatype datatype, int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_BCAST, .recv = buffer, .recv_count = count, .root = root};
    if (!comm_of(self, comm, &x) || !type_of(self, datatype, &x.recv_type, &x)) return self->code;
    return operate(self, start, &x);
}

/* --- gather and scatter --- */

/* Arguments that are significant at the root alone are not looked at elsewhere: programs
 * pass anything there, often uninitialized variables (section 6.5). */
static int gather(struct mpi_rank *r, struct mpi_start start, struct mpi_collective *x,
                  MPI_Datatype sendtype, MPI_Datatype recvtype, MPI_Comm comm)
{
    if (!comm_of(r, comm, x)) return r->code;
    bool place = x->send == MPI_IN_PLACE;
    if (!is_leaf(x) || place) x->send_count = 0;
    else if (!type_of(r, sendtype, &x->send_type, x)) return r->code;
    if (!is_root(x)) {
        x->recv_count = 0;
        x->recv_counts.at = NULL;
    } else if (!type_of(r, recvtype, &x->recv_type, x)) return r->code;
    return operate(r, start, x);
}

/* Whether a call is of the kind with counts must be known where they are not read too.
 * All ranks must choose one algorithm, also those to which the counts mean nothing. */
static const int none_here;
static struct mpi_counts places_of(const int *places)
{
    return (struct mpi_counts){places ? places : &none_here, 0};
}

int mpi_gather(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
               MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
               MPI_Datatype recvtype, int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_GATHER, .send = sendbuf, .send_count = sendcount, .recv = recvbuf};
    x.recv_count = recvcount;
    x.root = root;
    return gather(self, start, &x, sendtype, recvtype, comm);
}

/* Counts and displacements are read at the root alone. */
int mpi_gatherv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
                MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf,
                struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype,
                int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_GATHER, .send = sendbuf, .send_count = sendcount, .recv = recvbuf};
    x.recv_counts = recvcounts;
    x.recv_places = displs.at ? displs : places_of(NULL);
    x.root = root;
    return gather(self, start, &x, sendtype, recvtype, comm);
}

/* As gather, with the sides changed over. */
static int scatter(struct mpi_rank *r, struct mpi_start start, struct mpi_collective *x,
                   MPI_Datatype sendtype, MPI_Datatype recvtype, MPI_Comm comm)
{
    if (!comm_of(r, comm, x)) return r->code;
    if (!is_leaf(x) || x->recv == MPI_IN_PLACE) x->recv_count = 0;
    else if (!type_of(r, recvtype, &x->recv_type, x)) return r->code;
    if (!is_root(x)) {
        x->send_count = 0;
        x->send_counts.at = NULL;
    } else if (!type_of(r, sendtype, &x->send_type, x)) return r->code;
    return operate(r, start, x);
}

int mpi_scatter(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
                MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,
                MPI_Datatype recvtype, int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_SCATTER, .send = sendbuf, .send_count = sendcount, .recv = recvbuf};
    x.recv_count = recvcount;
    x.root = root;
    return scatter(self, start, &x, sendtype, recvtype, comm);
}

/* As MPI_Gatherv: `sendcounts` and `displs` mean something at the root alone. */
int mpi_scatterv(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
                 struct mpi_counts sendcounts, struct mpi_counts displs, MPI_Datatype sendtype,
                 void *recvbuf, MPI_Count recvcount, MPI_Datatype recvtype, int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_SCATTER, .send = sendbuf, .recv = recvbuf, .recv_count = recvcount};
    x.send_counts = sendcounts;
    x.send_places = displs.at ? displs : places_of(NULL);
    x.root = root;
    return scatter(self, start, &x, sendtype, recvtype, comm);
}

/* --- everybody to everybody --- */

/* MPI_IN_PLACE takes data and counts from the receiving side; what is given for the
 * sending side is not looked at. On an intercommunicator MPI_IN_PLACE has no meaning
 * (section 6.2.3); programs do not use it there. */
static int everybody(struct mpi_rank *r, struct mpi_start start, struct mpi_collective *x,
                     MPI_Datatype sendtype, MPI_Datatype recvtype, MPI_Comm comm)
{
    if (!comm_of(r, comm, x)) return r->code;
    if (x->send == MPI_IN_PLACE) {
        x->send_count = 0;
        x->send_counts.at = NULL;
    } else if (!type_of(r, sendtype, &x->send_type, x)) return r->code;
    if (!type_of(r, recvtype, &x->recv_type, x)) return r->code;
    return operate(r, start, x);
}

/* One size for all blocks. */
#define REGULAR(name, what_)                                                                       \
    int name(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,                   \
             MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf, MPI_Count recvcount,       \
             MPI_Datatype recvtype, MPI_Comm comm)                                                 \
    {                                                                                              \
        struct mpi_collective x = {                                                                \
            .what = what_, .send = sendbuf, .send_count = sendcount, .recv = recvbuf};             \
        x.recv_count = recvcount;                                                                  \
        return everybody(self, start, &x, sendtype, recvtype, comm);                               \
    }
REGULAR(mpi_allgather, WHAT_ALLGATHER)
REGULAR(mpi_alltoall, WHAT_ALLTOALL)
REGULAR(mpi_neighbor_allgather, WHAT_NEIGHBOR_ALLGATHER)
REGULAR(mpi_neighbor_alltoall, WHAT_NEIGHBOR_ALLTOALL)

/* One block sent to everybody, of another size from each rank. */
#define GATHER_V(name, what_)                                                                      \
    int name(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,                   \
             MPI_Count sendcount, MPI_Datatype sendtype, void *recvbuf,                            \
             struct mpi_counts recvcounts, struct mpi_counts displs, MPI_Datatype recvtype,        \
             MPI_Comm comm)                                                                        \
    {                                                                                              \
        struct mpi_collective x = {                                                                \
            .what = what_, .send = sendbuf, .send_count = sendcount, .recv = recvbuf};             \
        x.recv_counts = recvcounts;                                                                \
        x.recv_places = displs;                                                                    \
        return everybody(self, start, &x, sendtype, recvtype, comm);                               \
    }
GATHER_V(mpi_allgatherv, WHAT_ALLGATHER)
GATHER_V(mpi_neighbor_allgatherv, WHAT_NEIGHBOR_ALLGATHER)

/* Blocks of any size both ways. */
#define ALL_V(name, what_)                                                                         \
    int name(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,                   \
             struct mpi_counts sendcounts, struct mpi_counts sdispls, MPI_Datatype sendtype,       \
             void *recvbuf, struct mpi_counts recvcounts, struct mpi_counts rdispls,               \
             MPI_Datatype recvtype, MPI_Comm comm)                                                 \
    {                                                                                              \
        struct mpi_collective x = {                                                                \
            .what = what_, .send = sendbuf, .send_counts = sendcounts, .recv = recvbuf};           \
        x.send_places = sdispls;                                                                   \
        x.recv_counts = recvcounts;                                                                \
        x.recv_places = rdispls;                                                                   \
        return everybody(self, start, &x, sendtype, recvtype, comm);                               \
    }
ALL_V(mpi_alltoallv, WHAT_ALLTOALL)
ALL_V(mpi_neighbor_alltoallv, WHAT_NEIGHBOR_ALLTOALL)

/* Types come as arrays and are looked up again when the exchange begins: the arrays must last
 * until then, which the standard asks for (section 6.12). */
int mpi_alltoallw(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
                  struct mpi_counts sendcounts, struct mpi_counts sdispls,
                  const MPI_Datatype sendtypes[], void *recvbuf, struct mpi_counts recvcounts,
                  struct mpi_counts rdispls, const MPI_Datatype recvtypes[], MPI_Comm comm)
{
    struct mpi_collective x = {.what = WHAT_ALLTOALLW, .send = sendbuf, .recv = recvbuf};
    if (!comm_of(self, comm, &x)) return self->code;
    x.send_counts = sendbuf == MPI_IN_PLACE ? (struct mpi_counts){0} : sendcounts;
    x.send_places = sdispls;
    x.send_types = sendtypes;
    x.recv_counts = recvcounts;
    x.recv_places = rdispls;
    x.recv_types = recvtypes;
    return operate(self, start, &x);
}

/* Displacements are addresses [B] in every form of this call, counts are not: hence the
 * two widths (section 8.6). */
int mpi_neighbor_alltoallw(struct mpi_rank *self, struct mpi_start start, const void *sendbuf,
                           struct mpi_counts sendcounts, const MPI_Aint sdispls[],
                           const MPI_Datatype sendtypes[], void *recvbuf,
                           struct mpi_counts recvcounts, const MPI_Aint rdispls[],
                           const MPI_Datatype recvtypes[], MPI_Comm comm)
{
    struct mpi_collective x = {.what = WHAT_NEIGHBOR_ALLTOALLW, .send = sendbuf, .recv = recvbuf};
    if (!comm_of(self, comm, &x)) return self->code;
    x.send_counts = sendcounts;
    x.send_places = (struct mpi_counts){sdispls, 1};
    x.send_types = sendtypes;
    x.recv_counts = recvcounts;
    x.recv_places = (struct mpi_counts){rdispls, 1};
    x.recv_types = recvtypes;
    return operate(self, start, &x);
}

/* --- combining --- */

/* Whether the operation is defined on the type is asked before anything is sent: an error
 * half-way would leave other ranks waiting. */
static int combine(struct mpi_rank *r, struct mpi_start start, struct mpi_collective *x,
                   MPI_Datatype datatype, MPI_Op op, MPI_Comm comm)
{
    /* Only the check of it is wanted here: the operation is made again where it runs. */
    struct mpi_reduction check;
    if (!comm_of(r, comm, x) || !type_of(r, datatype, &x->recv_type, x)) return r->code;
    x->op = mpi_op_of(r, op);
    if (!x->op) return r->code;
    int code = mpi_reduction_make(r, &check, x->op, x->recv_type, x->comm);
    return code == MPI_SUCCESS ? operate(r, start, x) : code;
}

int mpi_reduce(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf,
               MPI_Count count, MPI_Datatype datatype, MPI_Op op, int root, MPI_Comm comm)
{
    struct mpi_collective x = {
        .what = WHAT_REDUCE, .send = sendbuf, .recv = recvbuf, .recv_count = count};
    x.root = root;
    return combine(self, start, &x, datatype, op, comm);
}

/* These have no root; they differ in whether counts come as a number or as an array. */
#define ALL_COMBINE(name, what_, argument, counts, member)                                         \
    int name(struct mpi_rank *self, struct mpi_start start, const void *sendbuf, void *recvbuf,    \
             counts argument, MPI_Datatype datatype, MPI_Op op, MPI_Comm comm)                     \
    {                                                                                              \
        struct mpi_collective x = {                                                                \
            .what = what_, .send = sendbuf, .recv = recvbuf, .member = argument};                  \
        return combine(self, start, &x, datatype, op, comm);                                       \
    }
ALL_COMBINE(mpi_allreduce, WHAT_ALLREDUCE, count, MPI_Count, recv_count)
/* Ranks of two groups have no order in common (section 6.11). */
ALL_COMBINE(mpi_scan, WHAT_SCAN, count, MPI_Count, recv_count)
ALL_COMBINE(mpi_exscan, WHAT_EXSCAN, count, MPI_Count, recv_count)
ALL_COMBINE(mpi_reduce_scatter_block, WHAT_REDUCE_SCATTER, recvcount, MPI_Count, recv_count)
ALL_COMBINE(mpi_reduce_scatter, WHAT_REDUCE_SCATTER, recvcounts, struct mpi_counts, recv_counts)
