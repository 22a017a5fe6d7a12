/* network_spec.h - the wire of a machine, and what its network does by itself: settings network.*.
 *
 * Plain data in SI units; the field table is that of machine_spec.c. Semantics: room net,
 * docs/network.md; of collectives docs/collectives.md. */
#ifndef SPEC_NETWORK_SPEC_H
#define SPEC_NETWORK_SPEC_H

#include <stdint.h>

#include "spec/level_list.h"
#include "spec/routing_list.h"

enum network_level {
#define X(constant, word, stem, cost, fineness) constant,
    LEVEL_LIST(X)
#undef X
        LEVEL_AUTO_TOLERANCE /* the cheapest whose measured error is within `tolerance`; replaced by
                                it before a run */
};

enum { LEVELS = LEVEL_AUTO_TOLERANCE }; /* levels that a network can be simulated at */

/* What the units of a network can do, each more than the one before. */
enum network_operations { OPERATIONS_LOGICAL, OPERATIONS_INTEGER, OPERATIONS_REAL };

enum arbitration { ARBITRATION_ROUND_ROBIN, ARBITRATION_FIRST_COME };

/* What the network combines or hands out by itself (docs/collectives.md), in latency +
 * links x hop_latency + bytes / bandwidth; machines that state nothing have no such hardware. */
struct network_collective_spec {
    char kinds[64]; /* names of collectives; "": none */
    enum network_operations operations;
    int64_t largest;    /* vector [B]; 0: any */
    int radix;          /* of a tree of its own; 0: the tree goes over the network's links */
    double latency;     /* from the last rank's entry to the result everywhere, beside .. [s] */
    double hop_latency; /* .. each link of the tree, up and down [s] .. */
    double bandwidth;   /* .. and the vector's bytes [B/s]; 0: that of a link */
};

/* The wire. Zero-load time of a message of b bytes over R = links + 1 resources after injection:
 *   R hop_latency + serialisation(b) + end_latency, counted from its injection. */
struct network_spec {
    enum network_level level;
    double tolerance;           /* auto-tolerance: relative error of the makespan that may be */
    double link_bandwidth;      /* payload rate of one link and direction [B/s] */
    double injection_bandwidth; /* node into network [B/s]; 0: the link's */
    double ejection_bandwidth;  /* network into node [B/s]; 0: the link's */
    double hop_latency;         /* router and wire, head of a message, per resource [s] (tau) */
    double end_latency;         /* network interface, entry and exit together [s] */
    double credit_latency;      /* a freed buffer to the sender upstream [s] (c) */
    double routing_latency; /* part of hop_latency: a head's route at the front of a buffer [s] */
    double vc_allocation_latency; /* part of hop_latency: a virtual channel for it, once one is free
                                     [s] */
    int64_t flit_bytes;         /* [B] */
    int64_t packet_bytes;       /* largest payload of a packet [B]; 0: a message is one packet */
    int64_t header_bytes;       /* added to each packet on the wire [B] */
    int virtual_channels;       /* per link and direction, all classes together */
    int buffer_flits;           /* per virtual channel [flits] */
    enum arbitration arbitration;
    enum routing_rule routing;      /* which of several routes a packet takes */
    enum vc_allocator vc_allocator; /* with routing: how heads that ask get channels */
    int allocator_iterations;       /* with routing: rounds in which a router gives them */
    struct network_collective_spec collective;
};

#endif
