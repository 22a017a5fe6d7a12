/* node_cost.h - how long counted operations take on a node. */
#ifndef MACHINE_NODE_COST_H
#define MACHINE_NODE_COST_H

#include <stdint.h>

#include "base/picoseconds.h"
#include "base/work.h"
#include "spec/machine_spec.h"

/* Costs per operation [ps], from a node_spec. */
struct node_cost {
    double flop, div, sqrt, trig, byte, call;
};

/* node_cost_make: the costs of `s`. */
struct node_cost node_cost_make(const struct node_spec *s);

/* node_cost_ps: time of `w`, rounded to the nearest picosecond once per call; the same on every host. PS_TOO_LONG where
 * it is longer than simulated time is. */
static inline int64_t node_cost_ps(const struct node_cost *c, const struct work *w)
{
    double ps = (double)w->flop * c->flop + (double)w->div * c->div;
    ps += (double)w->sqrt * c->sqrt + (double)w->trig * c->trig;
    ps += (double)w->bytes * c->byte + (double)w->call * c->call;
    return ps_rounded(ps);
}

#endif
