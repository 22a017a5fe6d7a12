/* node_use.h - where the data of a run lie in its nodes, and with whom ranks share the way to them.
 *
 * The roofline model needs two numbers beside the node's own (docs/nodes.md): the working set of a
 * rank, which decides on the level of caches that it lies in, and how many ranks share each cache
 * and each memory. They are taken alike for all ranks of a run: the largest working set, and the
 * ranks of the fullest cache and memory, as if all of them computed at the same time. */
#ifndef MACHINE_NODE_USE_H
#define MACHINE_NODE_USE_H

#include <stdint.h>

#include "base/err.h"
#include "machine/node_cost.h"
#include "machine/placement.h"
#include "spec/machine_spec.h"

/* How the ranks of a run use their nodes. */
struct node_use {
    int64_t working_set;      /* of one rank [B] */
    int sharers[NODE_LEVELS]; /* ranks on the processors that share a level, the most of any */
};

/* node_use_check: whether machine `m` states what its model of nodes needs: 'roofline' is nothing
 * without a memory. False with ERR_CONFIG. */
bool node_use_check(const struct machine_spec *m, struct err *e);

/* node_use_alone: one rank that shares nothing. */
struct node_use node_use_alone(int64_t working_set);

/* node_use_placed: the ranks of `p`, with working sets of up to `working_set` bytes, on `m`. */
struct node_use node_use_placed(const struct machine_spec *m, const struct placement *p,
                                int64_t working_set);

/* node_use_make: the same for `nrank` ranks that are not placed yet. Looks at no placement where
 * the model is that of rates: then it is node_use_alone.
 * Returns false with ERR_CONFIG when the machine cannot hold the ranks, or as node_use_check. */
bool node_use_make(const struct machine_spec *m, int nrank, int64_t working_set,
                   struct node_use *out, struct err *e);

/* node_use_level: the nearest level that holds the working set of each rank that shares it:
 * capacity / sharers >= working set. The memory holds any. */
enum node_level node_use_level(const struct node_spec *s, const struct node_use *u);

/* node_use_bandwidth: bytes that each of u->sharers ranks moves a second through `level` while all
 * do [B/s]: the smaller one of its own bandwidth and its part of the shared one; INFINITY: neither
 * is stated. */
double node_use_bandwidth(const struct node_spec *s, const struct node_use *u,
                          enum node_level level);

/* node_use_cost: costs on a node used like this. A byte moved takes the time of the slowest level
 * from the first to that of the working set, since it passes all of them; with the model of rates
 * node_cost_make. */
struct node_cost node_use_cost(const struct node_spec *s, const struct node_use *u);

/* node_use_tell: where the data of these ranks lie and what that allows them, as a sentence into
 * `text` of `size` bytes: "" by rates on a node whose memory nobody has stated. */
void node_use_tell(const struct node_spec *s, const struct node_use *u, char *text, int size);

#endif
