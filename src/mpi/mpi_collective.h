/* mpi_collective.h - one collective call of the program, from its arguments to comm/collectives.h.
 */
#ifndef MPI_MPI_COLLECTIVE_H
#define MPI_MPI_COLLECTIVE_H

#include "mpi/mpi_internal.h"

/* What is called; the same struct serves blocking, non-blocking and persistent calls. Unused parts
 * are zero. */
struct mpi_collective {
    enum mpi_what {
        WHAT_BARRIER,
        WHAT_BCAST,
        WHAT_GATHER,
        WHAT_SCATTER,
        WHAT_ALLGATHER,
        WHAT_ALLTOALL,
        WHAT_ALLTOALLW,
        WHAT_REDUCE,
        WHAT_ALLREDUCE,
        WHAT_REDUCE_SCATTER,
        WHAT_SCAN,
        WHAT_EXSCAN,
        WHAT_NEIGHBOR_ALLGATHER,
        WHAT_NEIGHBOR_ALLTOALL,
        WHAT_NEIGHBOR_ALLTOALLW
    } what;
    struct mpi_comm *comm;
    const void *send;
    void *recv;
    MPI_Count send_count, recv_count;
    struct mpi_type *send_type, *recv_type;
    struct mpi_counts send_counts, send_places, recv_counts, recv_places; /* at NULL: regular */
    const MPI_Datatype *send_types, *recv_types;                          /* of alltoallw */
    struct mpi_op *op;
    int root;
    unsigned sequence; /* where its tags begin: taken when called, of persistent ones when made */
};

/* One message of an exchange without an algorithm: everybody sends and receives what it has to. */
struct mpi_part {
    int peer; /* of the communicator */
    void *buffer;
    MPI_Count count;
    struct mpi_type *type;
};

/* mpi_exchange: post all receives, send everything, wait. Ranks MPI_PROC_NULL are left out. */
void mpi_exchange(struct mpi_rank *r, struct mpi_comm *c, unsigned sequence, int nin,
                  const struct mpi_part *in, int nout, const struct mpi_part *out);

/* mpi_collective_run: a checked call to its end, on whichever stack. mpi_collective_now: the same
 * with the next sequence of its communicator. */
void mpi_collective_run(struct mpi_rank *r, const struct mpi_collective *x);
void mpi_collective_now(struct mpi_rank *r, struct mpi_collective *x);

/* mpi_neighbor_run, mpi_intercomm_run: those of topologies and of intercommunicators. */
void mpi_neighbor_run(struct mpi_rank *r, const struct mpi_collective *x);
void mpi_intercomm_run(struct mpi_rank *r, const struct mpi_collective *x);

/* mpi_block_type: of a block in an operation with a type for each; the run ends if it is gone. */
struct mpi_type *mpi_block_type(struct mpi_rank *r, MPI_Datatype handle, int64_t count);

/* mpi_neighbor_edges: how many blocks a rank of a topology receives and sends. */
void mpi_neighbor_edges(const struct mpi_comm *c, int *nin, int *nout);

/* mpi_collective_call: by the algorithm that the machine's rules choose; `irregular` where only the
 * root has counts. */
void mpi_collective_call(struct mpi_rank *r, struct collective_call *k, bool irregular);

/* mpi_collective_tag: where the tags of a communicator's operation begin. */
static inline int mpi_collective_tag(unsigned sequence)
{
    return (int)(sequence % (1u << 25)) * COLLECTIVE_TAGS;
}

#endif
