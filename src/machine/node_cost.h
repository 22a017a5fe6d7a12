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
    double instruction; /* one instruction of compiled code, whatever it does */
};

/* node_cost_make: the costs of `s`. */
struct node_cost node_cost_make(const struct node_spec *s);

/* node_cost_ps: time of `w`, rounded to the nearest picosecond once per call; the same on every
 * host. PS_TOO_LONG where it is longer than simulated time is. */
static inline int64_t node_cost_ps(const struct node_cost *c, const struct work *w)
{
    double ps = (double)w->flop * c->flop + (double)w->div * c->div;
    ps += (double)w->sqrt * c->sqrt + (double)w->trig * c->trig;
    ps += (double)w->bytes * c->byte + (double)w->call * c->call;
    return ps_rounded(ps);
}

/* node_cost_code_ps: time of a piece of compiled code [ps], not rounded: `instructions` that
 * together do `w`, where w->bytes counts loads and stores. A processor loads, computes and stores
 * side by side, and a flop rate is that of code with its loads and index arithmetic; so the longest
 * of three counts (the roofline model): arithmetic    flop, div, sqrt, trig at their costs
 *   instructions  each at c->instruction
 *   memory        half the bytes at the cost of a copied byte, as a copy loads and stores each
 * Calls cost what their instructions do. */
static inline double node_cost_code_ps(const struct node_cost *c, const struct work *w,
                                       uint64_t instructions)
{
    double arithmetic = (double)w->flop * c->flop + (double)w->div * c->div;
    arithmetic += (double)w->sqrt * c->sqrt + (double)w->trig * c->trig;
    const double issue = (double)instructions * c->instruction,
                 memory = 0.5 * (double)w->bytes * c->byte;
    const double longer = arithmetic > issue ? arithmetic : issue;
    return longer > memory ? longer : memory;
}

#endif
