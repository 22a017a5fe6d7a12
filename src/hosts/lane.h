/* lane.h - messages of a program that runs for real on the processes of a job: MPI's own calls,
 * behind a table.
 *
 * A lane is a communicator apart from the one that carries the job's own traffic, so that a message
 * which a program has left behind is never taken for one of the job's. The functions add nothing to
 * those of MPI that they are named after: what a program waits for here is what MPI makes it wait
 * for. All return false when MPI reports an error. */
#ifndef HOSTS_LANE_H
#define HOSTS_LANE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct hosts_message;
struct hosts_request;

/* A lane; opaque, as large as any MPI's communicator. */
struct lane {
    uint64_t word;
};

struct lane_calls {
    /* open, close: by all processes of the job together. *largest_tag: tags are 0 .. that. */
    bool (*open)(struct lane *l, int *largest_tag);
    bool (*close)(struct lane *l);

    /* send_begin: MPI_Isend, or MPI_Issend when `synchronous`; `data` (bytes <= INT_MAX) stays
     * until the request is done. receive_begin: MPI_Irecv; a message longer than `bytes` is an
     * error. */
    bool (*send_begin)(const struct lane *l, int to, int tag, const void *data, size_t bytes,
                       bool synchronous, struct hosts_request *r);
    bool (*receive_begin)(const struct lane *l, int from, int tag, void *data, size_t bytes,
                          struct hosts_request *r);

    /* wait: MPI_Wait; of a receive, *bytes becomes the message's size (NULL: not asked). test:
     * MPI_Test. After either says done the request is spent. */
    bool (*wait)(struct hosts_request *r, size_t *bytes);
    bool (*test)(struct hosts_request *r, bool *done);

    /* look: MPI_Iprobe for any message from anybody. receive: MPI_Recv of the one it found. */
    bool (*look)(const struct lane *l, bool *there, struct hosts_message *m);
    bool (*receive)(const struct lane *l, const struct hosts_message *m, void *data);

    bool (*barrier)(const struct lane *l);
};

#endif
