/* mpi_graph.c - graph topologies: one that all ranks know whole, and distributed ones of which each
 * knows its own.
 *
 * Sections 8.5.3 to 8.5.5 of MPI 5.0. Ranks are never reordered, for the reason in
 * mpi_cart.c. A graph that all know takes memory for the whole of it on every rank; of a
 * distributed one each rank keeps its own edges. */
#include <stdlib.h>

#include "mpi/mpi_collective.h"
#include "mpi/mpi_topology.h"

/* --- known to all --- */

int mpi_graph_create(struct mpi_rank *self, MPI_Comm comm_old, int nnodes, const int indx[],
                     const int edges[], int reorder, MPI_Comm *comm_graph)
{
    struct mpi_comm *c = mpi_topology_base(self, comm_old);
    (void)reorder;
    if (!c) return self->code;
    if (nnodes < 0 || nnodes > c->size)
        return mpi_error(self, c, MPI_ERR_ARG, "a graph of %d nodes for %d ranks", nnodes, c->size);
    for (int i = 0; i < nnodes; i++)
        if (indx[i] < (i ? indx[i - 1] : 0))
            return mpi_error(self, c, MPI_ERR_ARG,
                             "the list of node %d ends at %d, before it begins", i, indx[i]);
    /* `indx` holds the ends of the nodes' lists, so the last one is the number of edges. */
    int nedges = nnodes ? indx[nnodes - 1] : 0;
    for (int i = 0; i < nedges; i++)
        if (edges[i] < 0 || edges[i] >= nnodes)
            return mpi_error(self, c, MPI_ERR_ARG, "edge %d goes to %d of %d nodes", i, edges[i],
                             nnodes);
    /* Nodes are the first ranks; those behind get MPI_COMM_NULL. */
    struct mpi_comm *made = mpi_comm_first(self, c, nnodes);
    *comm_graph = MPI_COMM_NULL;
    if (!made) return MPI_SUCCESS;
    struct mpi_topology *t = made->topology = mpi_topology_take(self, MPI_GRAPH);
    t->nnode = nnodes;
    t->nedge = nedges;
    t->index = mpi_topology_ints(self, indx, nnodes);
    t->edge = mpi_topology_ints(self, edges, nedges);
    *comm_graph = mpi_handle(made);
    return MPI_SUCCESS;
}

int mpi_graphdims_get(struct mpi_rank *self, MPI_Comm comm, int *nnodes, int *nedges)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_GRAPH, &c);
    if (!t) return self->code;
    *nnodes = t->nnode;
    *nedges = t->nedge;
    return MPI_SUCCESS;
}

/* Arrays that are too short get as much as they have room for. */
int mpi_graph_get(struct mpi_rank *self, MPI_Comm comm, int maxindex, int maxedges, int indx[],
                  int edges[])
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_GRAPH, &c);
    if (!t) return self->code;
    for (int i = 0; i < t->nnode && i < maxindex; i++) indx[i] = t->index[i];
    for (int i = 0; i < t->nedge && i < maxedges; i++) edges[i] = t->edge[i];
    return MPI_SUCCESS;
}

/* The edges of a rank: *n of them from the one returned on. */
static const int *edges_of(const struct mpi_topology *t, int rank, int *n)
{
    int first = rank ? t->index[rank - 1] : 0;
    *n = t->index[rank] - first;
    return t->edge + first;
}

int mpi_graph_neighbors_count(struct mpi_rank *self, MPI_Comm comm, int rank, int *nneighbors)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_GRAPH, &c);
    if (!t) return self->code;
    if (rank < 0 || rank >= t->nnode)
        return mpi_error(self, c, MPI_ERR_RANK, "rank %d of %d", rank, t->nnode);
    edges_of(t, rank, nneighbors);
    return MPI_SUCCESS;
}

int mpi_graph_neighbors(struct mpi_rank *self, MPI_Comm comm, int rank, int maxneighbors,
                        int neighbors[])
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_GRAPH, &c);
    int n;
    if (!t) return self->code;
    if (rank < 0 || rank >= t->nnode)
        return mpi_error(self, c, MPI_ERR_RANK, "rank %d of %d", rank, t->nnode);
    const int *edge = edges_of(t, rank, &n);
    for (int i = 0; i < n && i < maxneighbors; i++) neighbors[i] = edge[i];
    return MPI_SUCCESS;
}

/* The identity, as for grids. */
int mpi_graph_map(struct mpi_rank *self, MPI_Comm comm, int nnodes, const int indx[],
                  const int edges[], int *newrank)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    (void)indx, (void)edges;
    if (!c) return self->code;
    if (nnodes < 1 || nnodes > c->size)
        return mpi_error(self, c, MPI_ERR_ARG, "a graph of %d nodes for %d ranks", nnodes, c->size);
    *newrank = c->rank < nnodes ? c->rank : MPI_UNDEFINED;
    return MPI_SUCCESS;
}

/* --- distributed --- */

/* The topology was made before: what is wrong with arguments is found before ranks agree
 * on a context. */
static int made(struct mpi_rank *r, struct mpi_comm *c, struct mpi_topology *t, MPI_Comm *newcomm)
{
    struct mpi_comm *m = mpi_comm_first(r, c, c->size);
    m->topology = t;
    *newcomm = mpi_handle(m);
    return MPI_SUCCESS;
}

static int check_ranks(struct mpi_rank *r, struct mpi_comm *c, const int *rank, int n)
{
    for (int i = 0; i < n; i++)
        if (rank[i] < 0 || rank[i] >= c->size)
            return mpi_error(r, c, MPI_ERR_RANK, "rank %d is not in the communicator of %d",
                             rank[i], c->size);
    return MPI_SUCCESS;
}

/* A list of n ranks and its weights. */
static int check_list(struct mpi_rank *r, struct mpi_comm *c, const int *rank, int n,
                      const int *weight)
{
    if (n < 0) return mpi_error(r, c, MPI_ERR_ARG, "%d edges", n);
    /* NULL is none of the standard's two ways to leave weights out. */
    if (n > 0 && !weight) return mpi_error(r, c, MPI_ERR_ARG, "the list of weights is NULL");
    return check_ranks(r, c, rank, n);
}

/* Weights as the topology keeps them: NULL for none, one element more than edges, since
 * NULL means that there are none. MPI_UNWEIGHTED and MPI_WEIGHTS_EMPTY are fixed addresses of the
 * ABI and never read. */
static int *weights(struct mpi_rank *r, const int *from, int n)
{
    if (from == MPI_UNWEIGHTED) return NULL;
    if (n > 0 && from != MPI_WEIGHTS_EMPTY) return mpi_topology_ints(r, from, n);
    /* Edges without the weights that they should have get zeros: copies are as long as the list. */
    return mpi_take_zero(r->world, (n + 1) * (int64_t)sizeof(int));
}

int mpi_dist_graph_create_adjacent(struct mpi_rank *self, MPI_Comm comm_old, int indegree,
                                   const int sources[], const int sourceweights[], int outdegree,
                                   const int destinations[], const int destweights[], MPI_Info info,
                                   int reorder, MPI_Comm *comm_dist_graph)
{
    struct mpi_comm *c = mpi_topology_base(self, comm_old);
    (void)info, (void)reorder;
    if (!c) return self->code;
    int code = check_list(self, c, sources, indegree, sourceweights);
    if (code == MPI_SUCCESS) code = check_list(self, c, destinations, outdegree, destweights);
    if (code != MPI_SUCCESS) return code;
    /* Each rank names all its edges, so nothing need be told to others. Both ends must
     * name an edge; whether they do is not checked, as section 8.5.4 leaves it to the
     * program. */
    struct mpi_topology *t = mpi_topology_take(self, MPI_DIST_GRAPH);
    t->nin = indegree;
    t->nout = outdegree;
    t->in = mpi_topology_ints(self, sources, indegree);
    t->out = mpi_topology_ints(self, destinations, outdegree);
    t->in_weight = weights(self, sourceweights, indegree);
    t->out_weight = weights(self, destweights, outdegree);
    return made(self, c, t, comm_dist_graph);
}

/* An edge as any rank may name it. Three integers, so that a list of edges travels as
 * integers. */
struct edge {
    int from, to, weight;
};

/* Neighbours come in the order of their ranks, the same in every run. Section 8.5.4
 * leaves the order open, but a simulator should not. */
static int by_source(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    if (x->from != y->from) return x->from - y->from;
    if (x->to != y->to) return x->to - y->to;
    /* Edges given twice: how qsort treats equal ones is not laid down. */
    return (x->weight > y->weight) - (x->weight < y->weight);
}

/* gather_edges: everybody's edges on every rank, by numbers first and then all of them.
 * Every rank holds all E edges for a moment. A library for large machines sends each edge
 * to its two ends instead; that takes less memory, and an exchange in which ranks do not
 * know who sends to them. */
static struct edge *gather_edges(struct mpi_rank *r, struct mpi_comm *c, struct edge *own, int n,
                                 int *total)
{
    int *counts = mpi_take(r->world, 2 * c->size * (int64_t)sizeof *counts),
        *places = counts + c->size;
    mpi_collective_allgather(r, &c->channel, c->sequence++, &n, counts, sizeof n);
    *total = 0;
    /* From edges to integers: three each. */
    for (int i = 0; i < c->size; i++) {
        counts[i] *= 3;
        places[i] = 3 * *total;
        *total += counts[i] / 3;
    }
    struct edge *all = mpi_take(r->world, (*total + 1) * (int64_t)sizeof *all);
    struct mpi_type *integer = mpi_type_basic(MPI_INT);
    struct mpi_collective x = {.what = WHAT_ALLGATHER, .comm = c, .send = own, .send_count = 3 * n};
    x.send_type = x.recv_type = integer;
    x.recv = all;
    x.recv_counts = (struct mpi_counts){counts, 0};
    x.recv_places = (struct mpi_counts){places, 0};
    mpi_collective_now(r, &x);
    mpi_give(r->world, counts);
    qsort(all, (size_t)*total, sizeof *all, by_source);
    return all;
}

/* Any rank may name any edge: all edges are gathered, and each rank keeps those that touch it. */
int mpi_dist_graph_create(struct mpi_rank *self, MPI_Comm comm_old, int n, const int sources[],
                          const int degrees[], const int destinations[], const int weight[],
                          MPI_Info info, int reorder, MPI_Comm *comm_dist_graph)
{
    struct mpi_comm *c = mpi_topology_base(self, comm_old);
    int nown = 0, total,
        code = c ? check_list(self, c, sources, n, MPI_UNWEIGHTED) : self->code;
    (void)info, (void)reorder;
    if (code != MPI_SUCCESS) return code;
    /* Checks come before the first message. Degrees say how many destinations belong to
     * each source. */
    bool weighted = weight != MPI_UNWEIGHTED;
    for (int i = 0; i < n; i++) {
        if (degrees[i] < 0)
            return mpi_error(self, c, MPI_ERR_ARG, "%d edges from rank %d", degrees[i],
                             sources[i]);
        nown += degrees[i];
    }
    code = check_list(self, c, destinations, nown, weight);
    if (code != MPI_SUCCESS) return code;
    struct edge *own = mpi_take(self->world, (nown + 1) * (int64_t)sizeof *own);
    for (int i = 0, k = 0; i < n; i++)
        for (int d = 0; d < degrees[i]; d++, k++)
            own[k] = (struct edge){sources[i], destinations[k],
                                   weighted && weight != MPI_WEIGHTS_EMPTY ? weight[k] : 0};
    struct edge *all = gather_edges(self, c, own, nown, &total);
    struct mpi_topology *t = mpi_topology_take(self, MPI_DIST_GRAPH);
    /* Once over all edges to count, once more to keep them: lists are as long as needed.
     * An edge from a rank to itself counts on both sides. */
    for (int i = 0; i < total; i++) {
        t->nin += all[i].to == c->rank;
        t->nout += all[i].from == c->rank;
    }
    t->in = mpi_take(self->world, (t->nin + 1) * (int64_t)sizeof *t->in);
    t->out = mpi_take(self->world, (t->nout + 1) * (int64_t)sizeof *t->out);
    if (weighted) {
        t->in_weight = mpi_take(self->world, (t->nin + 1) * (int64_t)sizeof *t->in);
        t->out_weight = mpi_take(self->world, (t->nout + 1) * (int64_t)sizeof *t->out);
    }
    for (int i = 0, in = 0, out = 0; i < total; i++) {
        if (weighted && all[i].to == c->rank) t->in_weight[in] = all[i].weight;
        if (weighted && all[i].from == c->rank) t->out_weight[out] = all[i].weight;
        if (all[i].to == c->rank) t->in[in++] = all[i].from;
        if (all[i].from == c->rank) t->out[out++] = all[i].to;
    }
    mpi_give(self->world, own);
    mpi_give(self->world, all);
    return made(self, c, t, comm_dist_graph);
}

int mpi_dist_graph_neighbors_count(struct mpi_rank *self, MPI_Comm comm, int *indegree,
                                   int *outdegree, int *weighted)
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_DIST_GRAPH, &c);
    if (!t) return self->code;
    *indegree = t->nin;
    *outdegree = t->nout;
    *weighted = t->in_weight != NULL;
    return MPI_SUCCESS;
}

/* Weights are written only where the graph has some and the program wants them. */
int mpi_dist_graph_neighbors(struct mpi_rank *self, MPI_Comm comm, int maxindegree, int sources[],
                             int sourceweights[], int maxoutdegree, int destinations[],
                             int destweights[])
{
    struct mpi_comm *c;
    struct mpi_topology *t = mpi_topology_of(self, comm, MPI_DIST_GRAPH, &c);
    if (!t) return self->code;
    for (int i = 0; i < t->nin && i < maxindegree; i++) {
        sources[i] = t->in[i];
        if (t->in_weight && sourceweights != MPI_UNWEIGHTED) sourceweights[i] = t->in_weight[i];
    }
    for (int i = 0; i < t->nout && i < maxoutdegree; i++) {
        destinations[i] = t->out[i];
        if (t->out_weight && destweights != MPI_UNWEIGHTED) destweights[i] = t->out_weight[i];
    }
    return MPI_SUCCESS;
}
