/* mpi_window.h - one-sided communication: memory that other ranks read and write by messages to its
 * owner.
 *
 * Each operation is a message to the target and its answer back. On the target an operation in
 * progress (mpi_task.c) serves them in the order of arrival, whenever the rank waits or tests in a
 * call of MPI, so that results and times are the same in every run. Ranks share the memory of the
 * simulator: a message carries what it would take on a machine, and the address of what it means.
 */
#ifndef MPI_MPI_WINDOW_H
#define MPI_MPI_WINDOW_H

#include "mpi/mpi_internal.h"

enum window_tag { TAG_OPERATION, TAG_POST, TAG_COMPLETE, TAG_ANSWERS = 16 };

enum rma_kind {
    RMA_PUT,
    RMA_GET,
    RMA_ACCUMULATE,
    RMA_GET_ACCUMULATE,
    RMA_COMPARE_AND_SWAP,
    RMA_LOCK,
    RMA_UNLOCK
};

/* One operation, in memory of both ends until it is answered. */
struct mpi_rma {
    struct mpi_rma *next;   /* pending at the origin */
    struct mpi_rma *queued; /* a lock: waiting at the target */
    enum rma_kind kind;
    int origin, target, lock_type, answer_tag;
    int64_t displacement, count;
    struct mpi_type *type; /* the target's */
    struct mpi_op *op;
    char *data; /* packed: what goes to the target */
    char *back; /* packed: what comes from it */
    int64_t nback;
    struct comm_request answer;
    struct mpi_task *task; /* of an operation with a request, while it goes on */
    bool done;
    /* at the origin: where an answer's data go */
    void *result;
    int64_t result_count;
    struct mpi_type *result_type;
};

struct mpi_window {
    struct mpi_object o;
    struct mpi_window *next; /* of the rank */
    struct mpi_comm *comm;   /* its own */
    char *base;
    MPI_Aint size;
    int unit, flavor, model;
    bool closing;
    struct mpi_task *server;
    struct comm_request served;
    struct mpi_rma *pending; /* of the origin, the newest first */
    int answers;             /* tags of answers so far */
    /* the target's lock */
    int exclusive, shared; /* who holds it: ranks */
    struct mpi_rma *waiting, **waiting_end;
    /* the origin's locks: a byte for each rank, made when first needed */
    char *locked;
    bool lock_all;
    /* epochs between groups */
    struct mpi_group *exposed, *access;
    struct comm_request *completed; /* (exposed->size) */
    /* shared memory: (ranks) sizes and places */
    int64_t *sizes;
    char **places;
};

/* mpi_window_serve: answer operations until the window closes; a task. */
void mpi_window_serve(struct mpi_rank *r, void *window);

/* mpi_window_of: the window of a handle, NULL after an error was reported. */
struct mpi_window *mpi_window_of(struct mpi_rank *r, MPI_Win handle);

enum { HELD_SHARED = 1, HELD_EXCLUSIVE };

/* mpi_window_locks: what is held, a byte for each rank. mpi_window_ask: a lock or its end, until it
 * is granted. mpi_window_take: make sure of the lock for an operation under MPI_Win_lock_all. */
char *mpi_window_locks(struct mpi_rank *r, struct mpi_window *w);
void mpi_window_ask(struct mpi_rank *r, struct mpi_window *w, enum rma_kind kind, int target,
                    int type);
void mpi_window_take(struct mpi_rank *r, struct mpi_window *w, int target);

/* mpi_rma_send: an operation on its way; mpi_rma_wait: until it is answered, and its data are in
 * place. */
void mpi_rma_send(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x, int64_t bytes);
void mpi_rma_wait(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x);

/* mpi_window_flush: wait for all operations on a rank, MPI_ANY_SOURCE: on all. */
void mpi_window_flush(struct mpi_rank *r, struct mpi_window *w, int target);

#endif
