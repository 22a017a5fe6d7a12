/* pattern.h - synthetic traffic: who sends to whom, when, and what the most loaded link then
 * carries.
 *
 * Definitions of Dally and Towles, Principles and Practices of Interconnection Networks (2004),
 * section 3.2. N nodes, b = log2 N; digits are those of the node's number to the base k:
 *
 *     uniform         any node, the sender included, each equally likely
 *     bitcomp         every bit of the number inverted                            N = 2^b
 *     bitrev          the bits in reverse order                                   N = 2^b
 *     transpose       upper and lower half of the bits exchanged                  N = 2^b
 *     shuffle         the bits rotated by one to the left                         N = 2^b
 *     tornado(k,n)    each of n digits up by ceil(k/2) - 1, around the ring       N = k^n
 *     neighbor(k,n)   each of n digits up by 1, around the ring                   N = k^n
 *     shift(d)        node i + d mod N
 *     xor(d)          node i xor d                                                N = 2^b
 *     randperm(s)     one permutation of all nodes, drawn with seed s (Fisher-Yates)
 *     badrandom       any node of the next group of a dragonfly or dragonfly+; also bad_dragon
 *     hotspot(d,...)  one of these nodes, each equally likely; node 0 if none is named
 *
 * Without (k,n) the digits are the coordinates of a torus or mesh, whose routers may have several
 * nodes; all other nodes stand in one ring. */
#ifndef NET_PATTERN_H
#define NET_PATTERN_H

#include "base/random.h"
#include "net/traffic.h"

enum pattern_rule {
    PATTERN_UNIFORM,
    PATTERN_BIT_COMPLEMENT,
    PATTERN_BIT_REVERSE,
    PATTERN_TRANSPOSE,
    PATTERN_SHUFFLE,
    PATTERN_TORNADO,
    PATTERN_NEIGHBOUR,
    PATTERN_SHIFT,
    PATTERN_XOR,
    PATTERN_PERMUTATION,
    PATTERN_BAD_GROUP,
    PATTERN_HOT_SPOT
};

/* A pattern with its numbers, for one network. Plain data. */
struct pattern {
    enum pattern_rule rule;
    int nnode, bits;        /* nodes; log2 of them, rounded up */
    int ndim;               /* tornado, neighbor: digits, */
    const int *radix;       /* (ndim) their bases; in the arena */
    int below;              /* nodes that differ in none of them: those of a router */
    int distance;           /* shift, xor */
    int group;              /* nodes in a group of a dragonfly */
    const int *permutation; /* (nnode) randperm; in the arena */
    const int *spot;        /* (nspot) hotspot; in the arena */
    int nspot;
};

/* pattern_read: the pattern that `text` names, for the network t; memory from a.
 *
 *   Returns false with ERR_DATA (a misspelt name, with the nearest one; numbers that do not fit the
 *   network) or ERR_UNAVAILABLE (a pattern that is not known, with those that are). */
bool pattern_read(struct pattern *p, const char *text, const struct topology *t, struct arena *a,
                  struct err *e);

/* pattern_destination: where node `src` sends its next message; *r is drawn from only by patterns
 * of chance. */
int pattern_destination(const struct pattern *p, int src, struct random *r);

/* pattern_is_random: whether destinations are drawn anew for each message. */
bool pattern_is_random(const struct pattern *p);

/* A load: every node begins a message in each cycle with probability load / flits. */
struct pattern_load {
    double load;     /* flits that a node offers per cycle, above 0 and up to 1 */
    int flits;       /* of a message */
    int64_t bytes;   /* of a message */
    double cycle_ps; /* time of a flit on a link */
    int64_t cycles;  /* how long */
    uint64_t seed;
    int most; /* messages at most */
};

/* pattern_traffic: the messages of a load by `p`, arrays from a. Each node draws from a stream of
 * its own, so a longer list begins with the shorter one of the same seed, node by node.
 *
 *   Returns false with ERR_DATA for a load, a size or a length out of range, or more messages than
 *   l->most. */
bool pattern_traffic(const struct pattern *p, const struct pattern_load *l, struct arena *a,
                     struct traffic *q, struct err *e);

/* pattern_channel_load: what the most loaded link carries, relative to its rate, when every node
 * sends one flit per cycle by `p`, by the routes alone: 1 over it bounds the load. Links of other
 * rates count by theirs. Random routes and destinations are averaged over `draws` messages of each
 * node.
 * Returns 0 for a network without links, and where nnode x (destinations or draws) is above 2^24.
 */
double pattern_channel_load(const struct pattern *p, const struct topology *t, int draws,
                            double link_bandwidth, struct arena *a);

#endif
