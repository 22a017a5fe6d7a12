/* mpi_topology.c - topologies as data: taken, copied, given back (mpi_topology.h).
 *
 * A communicator owns its topology. Any list may be NULL: kinds differ in which they
 * have. */
#include "mpi/mpi_topology.h"

/* One element more than n, so that a list of none still has an address: NULL means that
 * there is no list. */
int *mpi_topology_ints(struct mpi_rank *r, const int *from, int n)
{
    if (!from) return NULL;
    return memcpy(mpi_take(r->world, (n + 1) * (int64_t)sizeof *from), from,
                  (size_t)n * sizeof *from);
}

/* Zeroed, so that every list that the kind does not have is NULL. */
struct mpi_topology *mpi_topology_take(struct mpi_rank *r, int kind)
{
    struct mpi_topology *t = mpi_take_zero(r->world, sizeof *t);
    t->kind = kind;
    return t;
}

/* The communicator is about to end, too: its pointer is not cleared. */
void mpi_topology_end(struct mpi_rank *r, struct mpi_comm *c)
{
    struct mpi_topology *t = c->topology;
    if (!t) return;
    /* All lists are this topology's own; giving NULL does nothing. */
    void *const all[] = {t->dim, t->period, t->coordinate, t->index,      t->edge,
                         t->in,  t->out,    t->in_weight,  t->out_weight, t};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) mpi_give(r->world, all[i]);
}

/* A duplicate has lists of its own, so that either may be freed first. */
void mpi_topology_copy(struct mpi_rank *r, const struct mpi_comm *from, struct mpi_comm *to)
{
    const struct mpi_topology *f = from->topology;
    if (!f) return;
    struct mpi_topology *t = to->topology = mpi_topology_take(r, f->kind);
    *t = *f;
    t->dim = mpi_topology_ints(r, f->dim, f->ndim);
    t->period = mpi_topology_ints(r, f->period, f->ndim);
    t->coordinate = mpi_topology_ints(r, f->coordinate, f->ndim);
    t->index = mpi_topology_ints(r, f->index, f->nnode);
    t->edge = mpi_topology_ints(r, f->edge, f->nedge);
    t->in = mpi_topology_ints(r, f->in, f->nin);
    t->out = mpi_topology_ints(r, f->out, f->nout);
    t->in_weight = mpi_topology_ints(r, f->in_weight, f->nin);
    t->out_weight = mpi_topology_ints(r, f->out_weight, f->nout);
}

/* Ranks of one group lie to each other somehow, those of two have no common numbers (section
 * 8.5). */
struct mpi_comm *mpi_topology_base(struct mpi_rank *r, MPI_Comm comm)
{
    struct mpi_comm *c = mpi_comm_of(r, comm);
    if (!c || !c->remote) return c;
    r->code = mpi_error(r, c, MPI_ERR_COMM, "an intercommunicator has no topology");
    return NULL;
}

struct mpi_topology *mpi_topology_of(struct mpi_rank *r, MPI_Comm comm, int kind,
                                     struct mpi_comm **c)
{
    /* The kinds are neighbours in the ABI: MPI_CART, MPI_GRAPH, MPI_DIST_GRAPH. */
    static const char *const name[] = {"a Cartesian", "a graph", "a distributed graph"};
    *c = mpi_comm_of(r, comm);
    if (!*c) return NULL;
    if ((*c)->topology && (*c)->topology->kind == kind) return (*c)->topology;
    r->code = mpi_error(r, *c, MPI_ERR_TOPOLOGY, "the communicator has not %s topology",
                        name[kind - MPI_CART]);
    return NULL;
}
