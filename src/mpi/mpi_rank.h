/* mpi_rank.h - MPI for programs on virtual processors: what whoever runs such a program needs of
 * this room.
 *
 * A program reaches MPI through mpi_functions (mimdsim/mpi_table.h), whose first argument is its
 * rank's state. All communication goes through comm.h; nothing here knows of networks. */
#ifndef MPI_MPI_RANK_H
#define MPI_MPI_RANK_H

#include <stdbool.h>

#include "base/arena.h"
#include "comm/collectives.h"
#include "comm/comm.h"
#include <mimdsim/mpi_table.h>

/* What a run of an MPI program is made of; all borrowed. Zero where nothing is to be said. */
struct mpi_setup {
    const char
        *processor_name; /* of MPI_Get_processor_name, before the node's number; NULL: "node" */
    const struct collective_rule *rule; /* (nrule) the machine's choice of algorithms */
    int nrule;
    bool hardware_barrier; /* comm_barrier is the machine's own */
    const int *node;       /* (ranks) where each rank lies, NULL: each on its own */

    /* Call a function of the program with six words, of which it takes as many as it has, and
     * account for its computing; NULL: call it plainly. `host` is what mpi_rank_create was given.
     */
    intptr_t (*call)(void *host, void (*function)(void), const intptr_t argument[6]);

    /* MPI_Abort: end the run with `code`; does not return. NULL: comm_fail. */
    void (*abort)(void *host, int code);

    /* "function (file.c:12)" of an address in the program into `text`; NULL: nobody knows. */
    void (*place)(void *host, const void *address, char *text, int size);
};

/* What all ranks of one run share. */
struct mpi_world;

/* mpi_world_create: for the ranks of one run; `setup` and `a` are borrowed as long as it runs. */
struct mpi_world *mpi_world_create(struct arena *a, const struct mpi_setup *setup);

/* mpi_world_destroy: give back what is not in the arena, after the run has ended however it did. */
void mpi_world_destroy(struct mpi_world *w);

/* mpi_rank_create: MPI for the rank of `c`, before its program starts. `host` is handed to setup's
 * functions. */
struct mpi_rank *mpi_rank_create(struct mpi_world *w, struct comm *c, void *host);

/* mpi_rank_end: the rank's program has returned; comm_fail when it lacks MPI_Finalize. */
void mpi_rank_end(struct mpi_rank *r);

/* mpi_functions: what the programs' stubs call. */
extern const struct mpi_functions mpi_functions;

#endif
