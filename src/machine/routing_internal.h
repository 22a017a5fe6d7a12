/* routing_internal.h - what a routing rule provides to routing.c, and what the rules share. */
#ifndef MACHINE_ROUTING_INTERNAL_H
#define MACHINE_ROUTING_INTERNAL_H

#include "base/check.h"
#include "machine/routing.h"

/* Beside the router and the goal (routing_steps). ROUTING_BY_ORDER: on phase, which stays.
 * ROUTING_BY_LEG: phase 0 leads to the router `via`, 1 to the target. ROUTING_BY_STAGE: on part; 0
 * leads to the node `via`. ROUTING_BY_CHANCE: nothing, but there may be a draw. */
enum routing_state_kind {
    ROUTING_BY_MORE,
    ROUTING_BY_GOAL,
    ROUTING_BY_ORDER,
    ROUTING_BY_LEG,
    ROUTING_BY_STAGE,
    ROUTING_BY_CHANCE
};

struct routing_type {
    enum routing_rule rule;
    unsigned families; /* bits 1 << TOPOLOGY_x; 0: all with links */
    /* check r->channels, fill the other members; false with ERR_CONFIG */
    bool (*create)(struct routing *r, struct arena *a, struct err *e);
    /* NULL: any channel */
    int (*inject)(const struct routing *r, struct route *p, int *first);
    int (*next)(const struct routing *r, struct route *p, const struct routing_view *view,
                struct route_option *option);
    /* NULL: any channel */
    int (*eject)(const struct routing *r, const struct route *p, int *first);
    enum routing_state_kind state; /* on what the way behind the first router depends */
};

enum { ROUTING_KEEP_MOST = 256 }; /* routers of a network of which pairs are kept */

/* The rules by file, each list ended by one without `create`. */
extern const struct routing_type routing_lattice_types[], routing_adaptive_types[],
    routing_leg_types[], routing_tree_types[], routing_dragonfly_types[];

/* routing_used: flits on `link` that are not yet accounted for; 0 in an empty network. */
int64_t routing_used(const struct routing_view *view, int link);

/* routing_needs: false with ERR_CONFIG unless there are at least `least` channels; `why` says what
 * for. 0 channels become `least`. */
bool routing_needs(struct routing *r, int least, const char *why, struct err *e);

/* routing_half: the channels of the lower (0) or upper (1) half into *first; returns how many. With
 * an odd number the lower half has one more. */
static inline int routing_half(const struct routing *r, int half, int *first)
{
    const int upper = r->channels / 2, lower = r->channels - upper;
    *first = half ? lower : 0;
    return half ? upper : lower;
}

/* routing_class: the channels of class c of n; those left over by the division stay idle. */
static inline int routing_class(const struct routing *r, int c, int n, int *first)
{
    const int lanes = r->channels / n;
    *first = c * lanes;
    return lanes;
}

#endif
