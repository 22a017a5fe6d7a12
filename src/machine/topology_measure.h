/* topology_measure.h - what a network is worth before any message is sent: distances, ways to
 * choose from, the narrowest cut, cables. */
#ifndef MACHINE_TOPOLOGY_MEASURE_H
#define MACHINE_TOPOLOGY_MEASURE_H

#include "machine/topology.h"

enum bisection_source {
    BISECTION_NONE,     /* one router: there is nothing to cut */
    BISECTION_EXACT,    /* a closed form of the family */
    BISECTION_PARTITION /* the best cut that partitioning found: the least one is at most this */
};

struct topology_measure {
    int nrouter, nnode;        /* those that work; so of all that follows */
    int64_t ncable;         /* two links each, there and back; a bus is one */
    int least_ports, ports; /* of a router, links and nodes together */
    int nsource;            /* routers from which distances were measured */
    bool sampled;           /* they are not all */
    int diameter;           /* links between any two nodes; sampled: between those looked at */
    double mean;            /* links between two different nodes, mean over pairs */
    double mean_route;      /* links of the routes between them */
    int longest_route;
    double mean_ways;  /* shortest ways between routers with nodes, mean over pairs */
    double least_ways; /* between the pair that has the fewest */
    enum bisection_source source;
    int64_t bisection; /* cables between two halves of the nodes */
    bool *half;        /* (nrouter) the half of each; NULL: not known router by router */
};

/* topology_measure: measure `t`; memory from a. Distances are exact up to 4,096 routers, above that
 * from 64 of them or, of more than 524,288, fewer. O(routers x links) and for partitioning
 * O(routers^2) a pass. */
struct topology_measure topology_measure(const struct topology *t, struct arena *a);

/* topology_bisection: cables between two halves of the nodes by the closed form of the family, -1
 * where it has none for these numbers. */
int64_t topology_bisection(const struct topology *t);

/* topology_partition: a cut into two halves with equally many nodes (one router's nodes more on one
 * side where they cannot be equal) and few cables between them, by moving routers from several
 * beginnings (Fiduccia and Mattheyses, "A linear-time heuristic for improving network partitions",
 * DAC 1982); always the same one.
 *
 *   half  out  (nrouter) the half of each router
 *
 *   Returns the number of cables between the halves. */
int64_t topology_partition(const struct topology *t, bool *half, struct arena *a);

#endif
