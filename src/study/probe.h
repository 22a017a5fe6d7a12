/* probe.h - what a benchmark would measure on a simulated machine: one number for each quantity
 * that is published.
 *
 * Message times come from the micro-benchmark kernels on virtual processors; wire times from the
 * same kernels with message software that costs nothing; rates of cuts from the links of the
 * topology. */
#ifndef STUDY_PROBE_H
#define STUDY_PROBE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "spec/machine_spec.h"

enum probe_quantity {
    PROBE_ONE_WAY,       /* ping-pong of ranks 0 and 1: half the round trip [s]; at: bytes */
    PROBE_ROUND_TRIP,    /* [s]; at: bytes */
    PROBE_BANDWIDTH,     /* bytes / one way [B/s]; at: bytes */
    PROBE_R_INF,         /* asymptotic rate: from 4 to 8 MiB [B/s] */
    PROBE_N_HALF,        /* smallest size that reaches half of r_inf [B] */
    PROBE_SEND_OVERHEAD, /* LogGP o_s: a send until it is complete [s]; at: bytes, 0: 8 */
    PROBE_RECV_OVERHEAD, /* LogGP o_r [s]; at: bytes, 0: 8 */
    PROBE_LATENCY,       /* LogGP L: one way less o_s and o_r [s]; at: bytes, 0: 8 */
    PROBE_GAP,           /* LogGP g: between 8-byte messages of one sender [s] */
    PROBE_WIRE,          /* one way without software, empty message [s]; at: links on the way */
    PROBE_READ, /* a remote read: request and reply over the wire, beside what memory takes [s]; at:
                   routers */
    PROBE_BISECTION, /* links that a halving cuts, both directions; the smallest over the dimensions
                        [B/s] */
    PROBE_GLOBAL,    /* all links between groups of a dragonfly, one direction [B/s] */
    PROBE_BARRIER,   /* [s]; at: ranks */
    PROBE_EXCHANGE,  /* total exchange: bytes that each rank sends, long messages, a second [B/s];
                        at: ranks */
    PROBE_HALVES,  /* ranks i and i + P/2 exchange: bytes that each sends a second [B/s]; at: ranks,
                      even */
    PROBE_LINPACK, /* LINPACK benchmark of order at [flop/s] */
    /* the four kernels of STREAM, all processors together [B/s]; at: processors, 0: one */
    PROBE_STREAM_COPY,
    PROBE_STREAM_SCALE,
    PROBE_STREAM_ADD,
    PROBE_STREAM_TRIAD,
    PROBE_INNER_PRODUCT, /* of vectors of at elements [flop/s] */
    PROBE_MEMORY_COPY,   /* bytes copied from memory to memory [B/s]; at: processors, 0: one */
    PROBE_BROADCAST, /* collectives by the machine's algorithms, the slowest rank [s]; at: bytes,
                        and ranks */
    PROBE_REDUCE,
    PROBE_ALLREDUCE,
    PROBE_GATHER,
    PROBE_SCATTER,
    PROBE_ALLGATHER,
    PROBE_ALLTOALL,
    PROBE_RING, /* what all ranks together send to both neighbours in a ring [B/s]; at: bytes, and
                   ranks */
    PROBE_RANDOM_RING, /* the same in random order */
    PROBE_B_EFF, /* effective bandwidth of all ranks together [B/s]; at: largest message [B], and
                    ranks */
    PROBE_PUT,   /* one-sided, between neighbours: until the data are there [s]; at: bytes */
    PROBE_GET,   /* until they are here: request and answer [s]; at: bytes */
    PROBE_QUANTITIES
};

/* probe_name: "one-way", "r-inf", ...; probe_find: the reverse, PROBE_QUANTITIES when there is
 * none. */
const char *probe_name(enum probe_quantity q);
enum probe_quantity probe_find(const char *name);

/* probe_computes: whether a quantity is one of computing, so that the model of the node matters and
 * the network does not. */
bool probe_computes(enum probe_quantity q);

/* probe_contends: whether messages of several ranks meet on the wires, so that the level of the
 * network matters. Where two ranks talk all levels agree. */
bool probe_contends(enum probe_quantity q, double at, int ranks);

/* probe_measure: quantity `q` of machine `m` at `at` (and of `ranks` ranks where it says so) into
 * *value (SI).
 *
 *   Between two ranks at level link, among more at the machine's own level.
 *
 *   Returns false with ERR_CONFIG when the machine has no such quantity (no route of so many links,
 * no groups), or as run_one. */
bool probe_measure(const struct machine_spec *m, enum probe_quantity q, double at, int ranks,
                   double *value, struct err *e);

#endif
