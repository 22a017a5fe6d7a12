/* collectives.h - collective operations out of point-to-point messages, by algorithms with names.
 * Every rank must call.
 *
 * One table per collective: an algorithm's name, its program, when it applies and what it costs in
 * closed form. A call says what is moved; collective_choose takes the algorithm that a rule of the
 * machine or else MPICH's published thresholds name. Blocks may differ in size (counts), vectors
 * may be empty, any rank may be root, P is any number. Results depend on the algorithm's order of
 * operations alone. Tags tag .. tag + COLLECTIVE_TAGS - 1 are used. */
#ifndef COMM_COLLECTIVES_H
#define COMM_COLLECTIVES_H

#include <stdbool.h>

#include "comm/comm.h"

enum { COLLECTIVE_TAGS = 40, COLLECTIVE_SEGMENT = 8192 /* [B] of pipelined algorithms */ };

enum collective_kind {
    COLLECTIVE_BARRIER,
    COLLECTIVE_BROADCAST,
    COLLECTIVE_REDUCE,
    COLLECTIVE_ALLREDUCE,
    COLLECTIVE_GATHER,
    COLLECTIVE_SCATTER,
    COLLECTIVE_ALLGATHER,
    COLLECTIVE_ALLTOALL,
    COLLECTIVE_SCAN,
    COLLECTIVE_REDUCE_SCATTER,
    COLLECTIVE_KINDS
};

/* An associative operation on elements. combine: into[i] = with[i] op into[i] when `before` (with
 * comes from lower ranks), else into[i] op with[i], i < n; adds to *w what it did. */
struct collective_op {
    void (*combine)(void *into, const void *with, bool before, int64_t n, void *context,
                    struct work *w);
    void *context;
    bool commutative;
    bool idempotent; /* a op a = a: maxima, not sums */
    enum comm_operation operation; /* whether networks can do it */
};

/* One call, the same on every rank but for buffers. Unused parts are zero.
 *
 *   broadcast           recv (count) in on root, out elsewhere
 *   reduce              send (count) in; recv (count) out on root
 *   allreduce, scan     send (count) in; recv (count) out; exclusive scan: rank 0's recv is left
 * alone gather              send (count) in; recv (size blocks) out on root scatter send (size
 * blocks) in on root; recv (count) out allgather           send (count) in; recv (size blocks) out
 *   alltoall            send (size blocks) in, block r for rank r; recv (size blocks) out, block r
 * from rank r reduce-scatter      send (size blocks) in; recv (count) out: the own block
 *
 * send may be recv, or the own block within it, where the collective has both of one size. */
struct collective_call {
    enum collective_kind kind;
    struct comm *comm;
    int64_t tag;
    int root;
    int64_t count, element; /* elements of a vector or block, bytes of one */
    /* Blocks of different sizes; NULL: all of `count`, one behind the other. (size) elements, and
     * where they begin. gather, scatter: read on root; count is the own block's. allgather,
     * reduce-scatter: the same on all ranks. alltoall: of recv, and send_* of send. */
    const int64_t *counts, *places, *send_counts, *send_places;
    const void *send;
    void *recv;
    const struct collective_op *op;
    bool exclusive; /* scan: without the own element */
    bool one_place; /* all blocks lie on each other: for benchmarks, whose data nobody reads */
    void *scratch;  /* collective_scratch bytes, aligned as elements and pointers need */
};

/* What a choice and a cost depend on: the same on every rank. */
struct collective_shape {
    enum collective_kind kind;
    int size, root;
    /* elements of the vector or largest block; of all blocks; bytes of one */
    int64_t count, total, element;
    bool irregular;                /* counts are given */
    bool commutative, idempotent, exclusive;
    enum comm_operation operation;        /* of reductions */
    const struct comm_hardware *hardware; /* of the ranks' network; NULL: none. Borrowed */
};

/* Costs in closed form, equal blocks. A round is one message out and one in for each rank; path is
 * the bytes of the messages that follow one another when every rank sends one and receives one at a
 * time. */
struct collective_cost {
    int64_t messages, bytes; /* of all ranks */
    int64_t rounds, path;    /* path -1: no closed form at these numbers */
    int64_t combined;        /* elements put through the operation, all ranks */
    /* bytes moved within ranks, all ranks, beside the own block from send to recv */
    int64_t copied;
};

struct collective_algorithm {
    const char *name;
    const char *needs;  /* when it applies, for people; NULL: always */
    const char *source; /* where it was published */
    bool (*applies)(const struct collective_shape *s);                 /* NULL: always */
    int64_t (*scratch)(const struct collective_shape *s, int rank);    /* [B]; NULL: none */
    void (*run)(const struct collective_call *k);
    void (*cost)(const struct collective_shape *s, struct collective_cost *out);
};

/* A rule: this algorithm for vectors of at least `from_bytes` on at least `from_ranks`. Of all that
 * match the last one counts. Bytes are the vector's, of allgather and reduce-scatter all blocks'
 * together, else one block's. */
struct collective_rule {
    enum collective_kind kind;
    const struct collective_algorithm *algorithm;
    int64_t from_bytes;
    int from_ranks;
};

/* collective_name: "broadcast", "reduce-scatter", ...; collective_find: the reverse,
 * COLLECTIVE_KINDS when none is. */
const char *collective_name(enum collective_kind kind);
enum collective_kind collective_find(const char *name);

/* collective_algorithms: the table of a collective, *n rows. collective_algorithm_find: by name,
 * NULL when none is. */
const struct collective_algorithm *collective_algorithms(enum collective_kind kind, int *n);
const struct collective_algorithm *collective_algorithm_find(enum collective_kind kind,
                                                             const char *name);

/* collective_by_network: whether it is what a network does by itself, the algorithm "hardware". */
bool collective_by_network(const struct collective_algorithm *a);

/* collective_applies: whether the algorithm can do a call of this shape. */
bool collective_applies(const struct collective_algorithm *a, const struct collective_shape *s);

/* collective_shape: of a call. collective_shape_bytes: what rules compare; 0 where blocks differ
 * and not all ranks know them. */
struct collective_shape collective_shape(const struct collective_call *k);
int64_t collective_shape_bytes(const struct collective_shape *s);

/* collective_choose: the last of n rules that matches and applies, else MPICH's choice
 * (docs/collectives.md). */
const struct collective_algorithm *collective_choose(const struct collective_shape *s,
                                                     const struct collective_rule *rule, int n);

/* collective_scratch: bytes that `a` needs on `rank`. collective_run: the call by algorithm `a`. */
int64_t collective_scratch(const struct collective_algorithm *a, const struct collective_shape *s,
                           int rank);
void collective_run(const struct collective_algorithm *a, const struct collective_call *k);

/* For kernels, each by one algorithm of the tables. collective_barrier: dissemination.
 * collective_broadcast: `bytes` bytes of `data` from `root`, binomial. collective_sum: data[k] =
 * sum over ranks, binomial to rank 0 and back, the same bits on every rank; n doubles. */
void collective_barrier(struct comm *c, int64_t tag);
void collective_broadcast(struct comm *c, int root, int64_t tag, void *data, int64_t bytes);
void collective_sum(struct comm *c, int64_t tag, double *data, int n);

#endif
