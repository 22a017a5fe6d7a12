/* node_cost.h - how long counted operations take on a node. */
#ifndef MACHINE_NODE_COST_H
#define MACHINE_NODE_COST_H

#include <stdbool.h>
#include <stdint.h>

#include "base/picoseconds.h"
#include "base/work.h"
#include "spec/machine_spec.h"

/* Costs per operation [ps], from a node_spec. */
struct node_cost {
    double flop, div, sqrt, trig, byte, call;
    double instruction; /* one instruction of compiled code, whatever it does */
    double moved;       /* roofline: a byte loaded or stored, where the working set lies */
    bool roofline;      /* `byte` does not count, `moved` does */
    /* The same, finer; issue 0: not known. */
    double issue, code_div, code_root, chain, step;
    double load; /* 0: not known, and each block of a loop stands alone */
    double whole;
    double add, multiply; /* where nothing waits for them */
    double fetch;
    double window; /* [instructions], 0: no bound */
    double late, product; /* how much longer than c->chain, and than CODE_PRODUCT_CYCLES steps, an
                             addition that waits for no addition and a product of a chain take */
};

/* Nominal cycles that a product counts with in a chain. */
enum { CODE_PRODUCT_CYCLES = 4 };

/* node_cost_make: the costs of `s`; with the roofline model those of data in the first cache
 * (node_use.h: of any others). */
struct node_cost node_cost_make(const struct node_spec *s);

/* node_cost_roof_ps: time of a piece of work [ps], not rounded, by the roofline model: the longer
 * one of `operations` [ps] and the transfer of `bytes` that are loaded and stored.
 *
 * Source: S. Williams, A. Waterman, D. Patterson, "Roofline: an insightful visual performance model
 * for multicore architectures", Communications of the ACM 52 (2009) 65-76. */
static inline double node_cost_roof_ps(const struct node_cost *c, double operations, uint64_t bytes)
{
    const double transfer = (double)bytes * c->moved;
    return operations > transfer ? operations : transfer;
}

/* node_cost_ps: time of `w`, rounded to the nearest picosecond once per call; the same on every
 * host. PS_TOO_LONG where it is longer than simulated time is. */
static inline int64_t node_cost_ps(const struct node_cost *c, const struct work *w)
{
    double ps = (double)w->flop * c->flop + (double)w->div * c->div;
    ps += (double)w->sqrt * c->sqrt + (double)w->trig * c->trig;
    if (__builtin_expect(c->roofline, 0))
        return ps_rounded(node_cost_roof_ps(c, ps + (double)w->call * c->call, work_moved(w)));
    ps += (double)w->bytes * c->byte + (double)w->call * c->call;
    return ps_rounded(ps);
}

/* node_cost_stated_ps: time of `flops` operations that load and store `bytes` together [ps], not
 * rounded, where a program states both; numbers that are none cost nothing. By rates, bytes take
 * the time of copied ones, after the operations. */
static inline double node_cost_stated_ps(const struct node_cost *c, double flops, double bytes)
{
    const double operations = (flops > 0 ? flops : 0) * c->flop;
    const double transfer = (bytes > 0 ? bytes : 0) * (c->roofline ? c->moved : c->byte);
    if (!c->roofline) return operations + transfer;
    return operations > transfer ? operations : transfer;
}

/* node_cost_code_ps: time of a piece of compiled code [ps], not rounded: `instructions` that
 * together do `w`, where w->bytes counts loads and stores. A processor loads, computes and stores
 * side by side, and a flop rate is that of code with its loads and index arithmetic; so the longest
 * of three counts:
 *
 *   arithmetic    flop, div, sqrt, trig at their costs
 *   instructions  each at c->instruction
 *   memory        half the bytes at the cost of a copied byte, as a copy loads and stores each;
 *                 roofline: all bytes at that of a byte moved
 *
 * Calls cost what their instructions do. */
static inline double node_cost_code_ps(const struct node_cost *c, const struct work *w,
                                       uint64_t instructions)
{
    double arithmetic = (double)w->flop * c->flop + (double)w->div * c->div;
    arithmetic += (double)w->sqrt * c->sqrt + (double)w->trig * c->trig;
    const double issue = (double)instructions * c->instruction,
                 each = c->roofline ? c->moved : 0.5 * c->byte, memory = (double)w->bytes * each;
    const double longer = arithmetic > issue ? arithmetic : issue;
    return longer > memory ? longer : memory;
}

/* What a piece of code does beside its work: blocks entered, instructions, each once, loads of
 * vector registers, instructions that compute with whole numbers, those that add and multiply
 * floating-point numbers, and the longest chain of a loop: additions, `chain_late` of which wait
 * for no addition, and nominal cycles of other instructions, among them `chain_product` products.
 * `once` is the longest chain of a round by itself, and `floating` counts the instructions that
 * floating-point units execute. */
struct code_work {
    unsigned blocks, issue, load, whole, add, multiply;
    unsigned chain_flop, chain_cycle, chain_late, chain_product;
    unsigned once_flop, once_cycle, once_late, once_product, floating;
    unsigned fetch; /* pieces of code that are fetched one after the other in a round of a loop */
};

/* What a processor does side by side, so that the slowest of them is what a piece of code takes. */
enum code_bound {
    BOUND_CHAIN,    /* what a round of a loop waits for of the round before */
    BOUND_ISSUE,    /* instructions, one after the other; those of elementary functions, too */
    BOUND_DIVIDER,  /* divisions and square roots */
    BOUND_MEMORY,   /* bytes */
    BOUND_COUNTER,  /* the counter in each block waits for that of the block before */
    BOUND_LOAD,     /* loads of vector registers */
    BOUND_WHOLE,    /* computing with whole numbers, which the counter does, too */
    BOUND_FETCH,    /* where the code of a loop lies */
    BOUND_ADD,      /* the units that add floating-point numbers */
    BOUND_MULTIPLY, /* and those that multiply them */
    BOUND_WINDOW,   /* what a round waits for within itself, with few rounds on their way */
    CODE_BOUNDS
};

/* node_cost_window_ps: what a round takes at least [ps], as c->window floating-point ones can wait
 * at a time, so that 1 + window / F rounds with F of them are on their way; 0: unknown. */
double node_cost_window_ps(const struct node_cost *c, const struct code_work *code);

/* node_cost_bound_ps: what a piece of code takes by one of them [ps], not rounded, by the finer
 * prices. Where loads have a price, the counter counts as an instruction. */
static inline double node_cost_bound_ps(const struct node_cost *c, const struct work *w,
                                        const struct code_work *code, enum code_bound bound)
{
    const double each = c->roofline ? c->moved : 0.5 * c->byte;
    const unsigned counters = c->load > 0 ? code->blocks : 0;
    switch (bound) {
    case BOUND_CHAIN:
        return code->chain_flop * c->chain + code->chain_cycle * c->step +
               code->chain_late * c->late + code->chain_product * c->product;
    case BOUND_ISSUE:
        return (code->issue + counters) * c->issue + (double)w->trig * c->trig;
    case BOUND_DIVIDER:
        return (double)w->div * c->code_div + (double)w->sqrt * c->code_root;
    case BOUND_MEMORY:
        return (double)w->bytes * each;
    case BOUND_COUNTER:
        return code->blocks * c->step;
    case BOUND_LOAD:
        return code->load * c->load;
    case BOUND_FETCH:
        return code->fetch * c->fetch;
    case BOUND_ADD:
        return code->add * c->add;
    case BOUND_MULTIPLY:
        return code->multiply * c->multiply;
    case BOUND_WINDOW:
        return node_cost_window_ps(c, code);
    default:
        return (code->whole + code->blocks) * c->whole;
    }
}

/* node_cost_bound_of: the slowest of them; the first of equal ones. */
static inline enum code_bound node_cost_bound_of(const struct node_cost *c, const struct work *w,
                                                 const struct code_work *code)
{
    enum code_bound slowest = BOUND_CHAIN;
    for (enum code_bound b = BOUND_ISSUE; b < CODE_BOUNDS; b++)
        if (node_cost_bound_ps(c, w, code, b) > node_cost_bound_ps(c, w, code, slowest))
            slowest = b;
    return slowest;
}

#endif
