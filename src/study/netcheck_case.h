/* netcheck_case.h - reference cases as machines and message lists: names of topologies, traffic
 * patterns.
 *
 * The reference's unit is the cycle, one flit of 16 B on a 16 GB/s link: 1000 ps. Its router takes
 * a head over a hop in 3 cycles, entry and exit add 2, a credit comes back in 2. */
#ifndef STUDY_NETCHECK_CASE_H
#define STUDY_NETCHECK_CASE_H

#include "base/arena.h"
#include "base/err.h"
#include "net/traffic.h"
#include "spec/machine_spec.h"

enum { NETCHECK_CYCLE_PS = 1000, NETCHECK_FLIT_BYTES = 16 };

/* What a file may ask for: nodes and links of a network, messages of a list, flits of a message,
 * cycles. */
enum {
    NETCHECK_MOST_NODES = 1 << 20,
    NETCHECK_MOST_LINKS = 1 << 24,
    NETCHECK_MOST_MESSAGES = 1 << 22,
    NETCHECK_MOST_FLITS = 1 << 20,
    NETCHECK_MOST_CYCLES = 1 << 30
};

/* netcheck_topology: the topology called "mesh8x8", "torus4x4x8", "ring4", "hcube7",
 * "fattree_k4_n3", "dragonfly_p2a4h2_72", "crossbar16", "fullmesh8" or "bus8": a family's name with
 * its numbers behind it (also "torus_k8n2": n times k), other words around it ignored but for
 * "valiant". tie: 0 positive, 1 random, 2 by parity; -1: positive, and random on a "native" torus.
 * Returns false with ERR_DATA, and with ERR_UNAVAILABLE where the name is of another family or
 * routing than ours. */
bool netcheck_topology(const char *name, int tie, struct topology_spec *s, struct err *e);

/* netcheck_machine: the reference's router on topology `s`: `vcs` virtual channels of `buffer`
 * flits, packets of at most `packet_flits` (0: any). head_cycles is the pipeline's 3 or 5. */
struct machine_spec netcheck_machine(const struct topology_spec *s, int vcs, int buffer,
                                     int packet_flits, int head_cycles);

/* netcheck_step: every node of `nnode` sends `flits` flits at 0 by pattern "shift", "trunc" or
 * "xor" at `distance`; arrays from a. Returns false with ERR_DATA for another pattern. */
bool netcheck_step(const char *pattern, int distance, int nnode, int flits, struct arena *a,
                   struct traffic *q, struct err *e);

/* netcheck_load: random arrivals (Bernoulli per cycle) of packets of `flits` flits for `cycles`
 * cycles at `load` flits per node and cycle, destinations by `pattern`: uniform, bitcomp, bitrev,
 * transpose, shuffle, tornado(k,n), neighbor(k,n), shift(d), xor(d), bad_dragon, hotspot(d). The
 * same seed gives the same list. Returns false with ERR_DATA for numbers that do not fit the
 * network, and with ERR_UNAVAILABLE for another pattern. */
bool netcheck_load(const char *pattern, const struct topology *t, int flits, double load,
                   int cycles, uint64_t seed, struct arena *a, struct traffic *q, struct err *e);

/* netcheck_channel_load: what the most loaded link carries when every node sends one flit a cycle
 * by `pattern`, by the routes alone; its inverse bounds the load. 0: not known (too many nodes); -1
 * with *e as netcheck_load. */
double netcheck_channel_load(const char *pattern, const struct topology *t, struct arena *a,
                             struct err *e);

/* netcheck_channel_cycles: what the reference's channels take longer than one cycle [cycles], mean
 * over the messages of q that start at `first` ps or later: 10 cycles inside a dragonfly's groups
 * and 100 between them, elsewhere 1. */
double netcheck_channel_cycles(const struct topology *t, const struct traffic *q, sim_ps first,
                               struct arena *a);

#endif
