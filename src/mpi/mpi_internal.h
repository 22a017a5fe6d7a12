/* mpi_internal.h - the insides of room mpi: a rank's state, communicators, requests, and what the
 * files share. */
#ifndef MPI_MPI_INTERNAL_H
#define MPI_MPI_INTERNAL_H

#include <string.h>

#include "mpi/mpi_object.h"
#include "mpi/mpi_rank.h"

enum { MEMORY_CLASSES = 17, TASK_STACK = 256 << 10, TAG_LAST = INT32_MAX };

/* Contexts of the world and of ranks alone; the first that is given; the end of what tags have room
 * for. */
enum { WORLD_CONTEXT = 1, SELF_CONTEXT, FIRST_CONTEXT, LAST_CONTEXT = 1 << 29 };

/* Planes of one communicator's tags: messages of the program, of collective operations, of windows,
 * of its making. */
enum mpi_plane { PLANE_PROGRAM, PLANE_COLLECTIVE, PLANE_WINDOW, PLANE_MAKING };

struct mpi_world {
    const struct mpi_setup *setup;
    struct arena *arena;
    void *free_memory[MEMORY_CLASSES];
    struct mpi_large *large; /* blocks that the arena does not hold */
    struct mpi_pool *pools;  /* of stacks for operations in progress */
    struct mpi_stack *free_stack;
};

struct mpi_task;
struct mpi_buffered;
struct mpi_topology;
struct mpi_attribute;
struct mpi_window;
struct mpi_request;

/* comm.h for the ranks of a group: collectives.h runs on it. Ranks and tags are translated. */
struct mpi_channel {
    struct comm comm; /* first */
    struct mpi_rank *self;
    struct mpi_group *group;
    int64_t base; /* added to tags: context and plane */
};

struct mpi_comm {
    struct mpi_object o;
    int rank, size, context;
    struct mpi_group *group;
    struct mpi_group *remote;       /* NULL: not an intercommunicator */
    struct mpi_comm *local;         /* of an intercommunicator: the own side */
    struct mpi_channel channel;     /* of collective operations */
    unsigned sequence;              /* of collective operations so far */
    bool whole;                     /* the world's ranks in their order */
    struct mpi_errhandler *handler; /* NULL: the world's default */
    struct mpi_topology *topology;
    char *name;
    struct mpi_info *info;
    void *buffer; /* attached for MPI_Bsend */
    int64_t buffer_bytes;
    struct mpi_buffered *buffered; /* messages in it */
};

/* An operation that goes on while its rank does something else: a collective or a window's, on a
 * stack of its own. */
typedef void mpi_task_fn(struct mpi_rank *r, void *argument);
struct mpi_task {
    struct mpi_task *next;
    struct mpi_rank *self;
    struct mpi_stack *stack;
    struct comm_request *blocked; /* what it waits for */
    mpi_task_fn *run;
    void *argument;
    bool done;
    int code; /* what the completing call returns */
};

struct mpi_rank {
    struct comm *comm;
    struct mpi_world *world;
    void *host;
    const char *call; /* the function in progress, "MPI_Send" */
    const void *address;
    int code;      /* of the error that a look-up has just reported */
    int last_code; /* of MPI_LASTUSEDCODE */
    int rank, size;
    int initialized, finalized, thread_level;
    int given; /* contexts, to communicators whose first rank it is */
    struct mpi_comm *world_comm, *self_comm;
    void **object; /* (room) by number; free ones hold the next free number times two plus one */
    int room, nobject, free_object;
    struct mpi_task *tasks, *running; /* in progress; whose stack this is */
    struct mpi_attribute *attributes;
    struct mpi_request *spare_request;
    struct mpi_errors *errors; /* codes that the program added */
    struct mpi_window *windows;
    void *buffer; /* attached for MPI_Bsend */
    int64_t buffer_bytes;
    struct mpi_buffered *buffered; /* messages in it */
    int pending; /* requests that were started and not completed */
};

enum mpi_request_kind {
    REQUEST_SEND,
    REQUEST_RECEIVE,
    REQUEST_TASK,
    REQUEST_GENERAL,
    REQUEST_NOTHING
};
enum mpi_mode { MODE_STANDARD, MODE_BUFFERED, MODE_SYNCHRONOUS, MODE_READY };

struct mpi_request {
    struct mpi_object o;
    struct comm_request q;
    enum mpi_request_kind what;
    enum mpi_mode mode;
    bool active, persistent, freed, cancelled, matched;
    struct mpi_comm *comm;
    struct mpi_type *type; /* used */
    const void *buffer;    /* of the program */
    MPI_Count count;
    int peer, tag, error;
    void *staging; /* packed bytes, NULL: none */
    int64_t room, bytes;
    struct mpi_task *task;
    mpi_task_fn *run; /* of a task, with what it is for */
    void *argument;
    int64_t status_at; /* where in the argument a status is, -1: nowhere */
    void (*release)(struct mpi_rank *r, void *argument);
    struct mpi_request *next; /* spare */
};

#include "mpi/mpi_request.h"
#include "mpi/mpi_share.h"

#endif
