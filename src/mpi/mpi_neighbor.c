/* mpi_neighbor.c - collective operations between neighbours of a topology: one message for each
 * edge.
 *
 * Section 8.6 of MPI 5.0. There is no algorithm to choose: who talks to whom is the
 * program's, and all messages are under way together. */
#include "mpi/mpi_collective.h"
#include "mpi/mpi_topology.h"

/* Sources and destinations in the order that the standard gives them. */
struct neighbours {
    int nin, nout, *in, *out;
};

void mpi_neighbor_edges(const struct mpi_comm *c, int *nin, int *nout)
{
    const struct mpi_topology *t = c->topology;
    if (t->kind == MPI_CART) *nin = *nout = 2 * t->ndim;
    else if (t->kind == MPI_DIST_GRAPH) *nin = t->nin, *nout = t->nout;
    else *nin = *nout = t->index[c->rank] - (c->rank ? t->index[c->rank - 1] : 0);
}

/* Of a grid: in each dimension the one before, then the one behind. Of a graph: both ways
 * the same. MPI_PROC_NULL beyond the edge of a grid keeps its block: the place in the
 * program's buffers stays, and nothing is sent (section 8.6.1). */
static struct neighbours neighbours_of(struct mpi_rank *r, const struct mpi_comm *c)
{
    const struct mpi_topology *t = c->topology;
    struct neighbours n = {0};
    mpi_neighbor_edges(c, &n.nin, &n.nout);
    /* One block for both lists; whoever asked gives it back. */
    n.in = mpi_take(r->world, (n.nin + n.nout + 1) * (int64_t)sizeof *n.in);
    n.out = n.in + n.nin;
    for (int i = 0; i < n.nin; i++) {
        if (t->kind == MPI_CART) n.in[i] = mpi_cart_shifted(t, i / 2, i % 2 ? 1 : -1);
        else if (t->kind == MPI_DIST_GRAPH) n.in[i] = t->in[i];
        else n.in[i] = t->edge[(c->rank ? t->index[c->rank - 1] : 0) + i];
    }
    for (int i = 0; i < n.nout; i++) n.out[i] = t->kind == MPI_DIST_GRAPH ? t->out[i] : n.in[i];
    return n;
}

static struct mpi_part part(int peer, void *buffer, int64_t place, int64_t count,
                            struct mpi_type *t)
{
    return (struct mpi_part){peer, (char *)buffer + place, count, t};
}

/* Displacements count extents, but bytes in MPI_Neighbor_alltoallw. */
static struct mpi_part in_part(struct mpi_rank *r, const struct mpi_collective *x, int peer, int i)
{
    int64_t count = x->recv_counts.at ? mpi_count_at(x->recv_counts, i) : x->recv_count;
    int64_t place = x->recv_places.at ? mpi_count_at(x->recv_places, i) : i * x->recv_count;
    if (x->what == WHAT_NEIGHBOR_ALLTOALLW)
        return part(peer, x->recv, place, count, mpi_block_type(r, x->recv_types[i], count));
    return part(peer, x->recv, place * x->recv_type->extent, count, x->recv_type);
}

static struct mpi_part out_part(struct mpi_rank *r, const struct mpi_collective *x, int peer, int i)
{
    void *send = (void *)(uintptr_t)x->send;
    /* The same block goes to everybody. */
    if (x->what == WHAT_NEIGHBOR_ALLGATHER) return part(peer, send, 0, x->send_count, x->send_type);
    int64_t count = x->send_counts.at ? mpi_count_at(x->send_counts, i) : x->send_count;
    int64_t place = x->send_places.at ? mpi_count_at(x->send_places, i) : i * x->send_count;
    if (x->what == WHAT_NEIGHBOR_ALLTOALLW)
        return part(peer, send, place, count, mpi_block_type(r, x->send_types[i], count));
    return part(peer, send, place * x->send_type->extent, count, x->send_type);
}

/* On a periodic dimension of one or two places both neighbours are one rank: what was sent first
 * arrives first, so the message of the one behind must be taken as that of the one before. The
 * standard pairs them that way: what I send to the one before, it receives from the one behind. */
static void order_grid(int n, struct mpi_part *part)
{
    for (int i = 0; i + 1 < n; i += 2) {
        struct mpi_part kept = part[i];
        part[i] = part[i + 1];
        part[i + 1] = kept;
    }
}

void mpi_neighbor_run(struct mpi_rank *r, const struct mpi_collective *x)
{
    struct neighbours n = neighbours_of(r, x->comm);
    struct mpi_part *in = mpi_take(r->world, (n.nin + n.nout + 1) * (int64_t)sizeof *in),
                    *out = in + n.nin;
    /* Blocks are numbered by edge, not by rank: several edges may lead to one rank. */
    for (int i = 0; i < n.nin; i++) in[i] = in_part(r, x, n.in[i], i);
    for (int i = 0; i < n.nout; i++) out[i] = out_part(r, x, n.out[i], i);
    if (x->comm->topology->kind == MPI_CART) order_grid(n.nout, out);
    mpi_exchange(r, x->comm, x->sequence, n.nin, in, n.nout, out);
    mpi_give(r->world, in);
    mpi_give(r->world, n.in);
}
