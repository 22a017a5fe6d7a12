/* mpi_topology.h - how the ranks of a communicator lie to each other, as the program says. */
#ifndef MPI_MPI_TOPOLOGY_H
#define MPI_MPI_TOPOLOGY_H

#include "mpi/mpi_internal.h"

struct mpi_topology {
    int kind; /* MPI_CART, MPI_GRAPH, MPI_DIST_GRAPH */
    /* MPI_CART */
    int ndim, *dim, *period, *coordinate; /* (ndim) */
    /* MPI_GRAPH: as given */
    int nnode, nedge, *index, *edge;
    /* MPI_DIST_GRAPH: the own neighbours; weights NULL: unweighted */
    int nin, nout, *in, *out, *in_weight, *out_weight;
};

/* mpi_cart_rank_of: the rank at coordinates, MPI_PROC_NULL outside of a dimension that is not
 * periodic. */
int mpi_cart_rank_of(const struct mpi_topology *t, const int *coordinate);

/* mpi_cart_shifted: the rank `by` steps along dimension d from the own place. */
int mpi_cart_shifted(const struct mpi_topology *t, int d, int64_t by);

/* mpi_topology_take: an empty topology of a kind. mpi_topology_ints: a copy of n integers, NULL for
 * none. */
struct mpi_topology *mpi_topology_take(struct mpi_rank *r, int kind);
int *mpi_topology_ints(struct mpi_rank *r, const int *from, int n);

/* mpi_topology_base: the communicator of which a topology is to be made; NULL with the error
 * reported, also for an intercommunicator. */
struct mpi_comm *mpi_topology_base(struct mpi_rank *r, MPI_Comm comm);

/* mpi_topology_of: the communicator's topology of that kind; NULL with the error reported. */
struct mpi_topology *mpi_topology_of(struct mpi_rank *r, MPI_Comm comm, int kind,
                                     struct mpi_comm **c);

#endif
