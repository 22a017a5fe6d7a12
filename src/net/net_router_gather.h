/* net_router_gather.h - the wheel of instants in which routers and nodes are looked at
 * (net_router_gather.c): what is added to it at every step. */
#ifndef NET_NET_ROUTER_GATHER_H
#define NET_NET_ROUTER_GATHER_H

#include "net/net_router.h"

enum { GATHER_WORD = 64 };

/* A set of numbers: a bit for each, and a bit for each word that is not empty. */
struct gather_set {
    uint64_t *word, *full;
    int nfull;
};

struct gather_slot {
    struct gather_set source, router;
    bool posted; /* its event */
};

struct gather {
    sim_ps base;     /* the instant of slot `at`; none that is posted is earlier */
    sim_ps unit;     /* from slot to slot: a flit, or the cycle of the network */
    double per_unit; /* 1 / unit */
    sim_ps hop;      /* a hop latency, which most look ahead, */
    int hop_steps;   /* in slots; -1: none */
    unsigned at, last; /* last: number of slots, a power of two, less one */
    int posted;              /* slots */
    bool sources;            /* nodes came to slot `at` */
    struct gather_set again; /* routers that are looked at again at `base` */
    struct gather_slot *slot;
};

/* gather_set_add: number i into the set. */
static inline void gather_set_add(struct gather_set *s, int i)
{
    const unsigned n = (unsigned)i, w = n / GATHER_WORD;
    const uint64_t others = s->word[w];
    s->word[w] = others | UINT64_C(1) << n % GATHER_WORD;
    if (!others) s->full[w / GATHER_WORD] |= UINT64_C(1) << w % GATHER_WORD;
}

/* gather_steps: how many slots after `base` time `at` is; -1: it is between slots, or too far. */
static inline int gather_steps(const struct gather *q, sim_ps at)
{
    const sim_ps ahead = at - q->base;
    if (ahead == q->hop) return q->hop_steps;
    const int64_t k = (int64_t)((double)ahead * q->per_unit + 0.5);
    return k <= q->last && k * q->unit == ahead ? (int)k : -1;
}

/* router_cycle: the longest time that all of the network's times (a flit, a hop, a credit, setups,
 * gaps, cables) are multiples of [ps]; 0: it is shorter than a flit, and too short to count in.
 * *longest: the longest of these times [ps]. */
sim_ps router_cycle(const struct net *n, sim_ps *longest);

/* router_wake: see that router r is looked at, at time `at` or earlier. */
static inline void router_wake(struct routers *g, int r, sim_ps at)
{
    struct router *o = &g->router[r];
    struct gather *q = g->gather;
    if (o->wake && o->wake <= at + 1) return;
    o->wake = at + 1;
    o->second = false;
    /* Mostly into a later slot that others have asked for already. */
    const int k = q ? gather_steps(q, at) : -1;
    if (k > 0) {
        struct gather_slot *s = &q->slot[(q->at + (unsigned)k) & q->last];
        if (s->posted) {
            gather_set_add(&s->router, r);
            return;
        }
    }
    g->post(g, r, at);
}

#endif
