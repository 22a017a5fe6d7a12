/* net_clocked_set.h - the lanes of a router of net_clocked.h that have a front: those whose front
 * has come are a set, those whose front is under way a queue by when it is due
 * (net_router_front.h). */
#ifndef NET_NET_CLOCKED_SET_H
#define NET_NET_CLOCKED_SET_H

#include "net/net_clocked_wheel.h"

/* clocked_number: of a lane among all lanes. */
static inline int clocked_number(const struct clocked *g, const struct clocked_lane *v)
{
    return (int)(v - g->lane);
}

/* clocked_port_of: the port behind which lane v lies. */
static inline struct clocked_port *clocked_port_of(const struct clocked *g,
                                                   const struct clocked_lane *v)
{
    return &g->port[v->port];
}

/* clocked_tries: v, of router o, takes part in an allocation of this cycle, and so in no other one
 * for a flit (router_tries). */
static inline void clocked_tries(const struct clocked *g, struct clocked_router *o,
                                 const struct clocked_lane *v)
{
    g->retry[clocked_number(g, v)] = o->retry = g->now + g->flit;
}

/* clocked_router_of: the router that v leads to. */
static inline struct clocked_router *clocked_router_of(const struct clocked *g,
                                                       const struct clocked_lane *v)
{
    return &g->router[clocked_port_of(g, v)->to];
}

/* clocked_has_front, clocked_has_none: lane number i of router o into the set of those whose front
 * has come, and out of it. */
static inline void clocked_has_front(struct clocked_router *o, int i)
{
    o->busy[(unsigned)i / CLOCKED_WORD] |= UINT64_C(1) << i % CLOCKED_WORD;
}
static inline void clocked_has_none(struct clocked_router *o, int i)
{
    o->busy[(unsigned)i / CLOCKED_WORD] &= ~(UINT64_C(1) << i % CLOCKED_WORD);
}

/* clocked_lane_of: the first of the lanes `busy`, word k of a set of those of router o. */
static inline struct clocked_lane *clocked_lane_of(const struct clocked_router *o, int k,
                                                   uint64_t busy)
{
    return &o->lane[k * CLOCKED_WORD + __builtin_ctzll(busy)];
}

/* clocked_comes: the front of lane number i of router o, which is not in the set, asks from `due`
 * on (router_comes). Where hops are short few are under way, and it is in the set at once. */
static inline void clocked_comes(const struct clocked *g, struct clocked_router *o, int i,
                                 int32_t due)
{
    struct clocked_coming *const c = o->coming;
    if (!g->queues) {
        clocked_has_front(o, i);
        return;
    }
    int k = o->end;
    if (k == o->room) {
        for (k = 0; k < o->end - o->next; k++) c[k] = c[k + o->next];
        o->next = 0;
    }
    o->end = (uint16_t)(k + 1);
    for (; k > o->next && c[k - 1].due > due; k--) c[k] = c[k - 1];
    c[k] = (struct clocked_coming){due, i};
}

/* clocked_have_come: those that are due now into the set. Returns when the next one is. */
static inline int32_t clocked_have_come(struct clocked_router *o, int32_t now)
{
    for (; o->next < o->end; o->next++) {
        const struct clocked_coming *c = &o->coming[o->next];
        if (c->due > now) return c->due;
        clocked_has_front(o, c->lane);
    }
    o->next = o->end = 0;
    return CLOCKED_NEVER;
}

/* clocked_next_due: when the first front that has not come yet is due. */
static inline int32_t clocked_next_due(const struct clocked_router *o)
{
    return o->next < o->end ? o->coming[o->next].due : CLOCKED_NEVER;
}

#endif
