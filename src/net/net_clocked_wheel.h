/* net_clocked_wheel.h - the wheel of cycles of net_clocked.h: who is looked at when.
 *
 * A slot is the cycle whose number ends in its own; the wheel is longer than anybody looks ahead. A
 * slot has a bit for each router and then for each node. The bit of a look that an earlier one made
 * needless stays: it is passed over, but what comes up in that very cycle is served by it. */
#ifndef NET_NET_CLOCKED_WHEEL_H
#define NET_NET_CLOCKED_WHEEL_H

#include "net/net_clocked_records.h"

/* clocked_later, clocked_sooner: of two cycles the later, the sooner one. */
static inline int32_t clocked_later(int32_t a, int32_t b) { return a > b ? a : b; }
static inline int32_t clocked_sooner(int32_t a, int32_t b) { return a < b ? a : b; }

/* clocked_wake_if: see that router o is looked at, in cycle `at` or earlier, if `so`; of now:
 * again, after all others. */
static inline void clocked_wake_if(struct clocked *g, struct clocked_router *o, int32_t at, bool so)
{
    if (!so || o->wake <= at) return;
    o->wake = at;
    const uint64_t bit = UINT64_C(1) << o->bit;
    if (at == g->now) {
        g->again[o->slot - g->slot] |= bit;
        return;
    }
    o->slot[(size_t)(at & g->wheel) << g->word_shift] |= bit;
    if (at > g->last) g->last = at;
}

/* clocked_wake: the same of router r, always. */
static inline void clocked_wake(struct clocked *g, int r, int32_t at)
{
    clocked_wake_if(g, &g->router[r], at, true);
}

/* clocked_wake_source: the same of a node's way in; of now: still in this cycle. */
static inline void clocked_wake_source(struct clocked *g, int node, int32_t at)
{
    struct clocked_source *z = &g->source[node];
    if (z->wake <= at) return;
    z->wake = at;
    const unsigned i = (unsigned)node, w = (unsigned)g->router_words + i / CLOCKED_WORD;
    g->slot[((size_t)(at & g->wheel) << g->word_shift) + w] |= UINT64_C(1) << i % CLOCKED_WORD;
    if (at == g->now) g->sources = true;
    if (at > g->last) g->last = at;
}

/* clocked_take: the lowest number out of a set of `words`; -1: it is empty. */
static inline int clocked_take(uint64_t *set, int words)
{
    for (int w = 0; w < words; w++)
        if (set[w]) {
            const int i = __builtin_ctzll(set[w]);
            set[w] &= set[w] - 1;
            return w * CLOCKED_WORD + i;
        }
    return -1;
}

#endif
