/* net_clocked_look.c - a cycle: nodes, then routers, each by number, then routers once more.
 *
 * A look at a router finds which of its lanes can do something now. One that is alone is served by
 * itself, mostly in the short step of net_clocked_hop.c; several go to net_clocked_allocate.c. What
 * comes of a look is when to look again. */
#include "net/net_clocked_step.h"

/* The lanes of router o that can do something now into g->active, and how many; *next: when the
 * first of the others can. A head whose way is asked for only where it stands asks here. `wide`:
 * the lanes are more than a word's, or have a queue. */
CLOCKED_INLINED int due_find(struct clocked *g, struct clocked_router *o, int32_t now,
                             int32_t *next, const bool whole, const bool wide)
{
    int n = 0;
    *next = wide ? clocked_have_come(o, now) : CLOCKED_NEVER;
    for (int k = 0; k < (wide ? g->sets : 1); k++)
        for (uint64_t busy = o->busy[k]; busy; busy &= busy - 1) {
            struct clocked_lane *v = clocked_lane_of(o, k, busy);
            int32_t at = v->due;
            if (v->head.state != LANE_ASKING) {
                if (v->head.state == LANE_SENDING) at = clocked_sends_from(g, v, now, whole);
                else if (at <= now) {
                    clocked_route(g, v);
                    at = v->due;
                }
            }
            if (at > now) *next = clocked_sooner(*next, at);
            else g->active[n++] = v;
        }
    return n;
}

/* Router o, of which no lane tried within the last flit. Returns when to look again. */
CLOCKED_INLINED int32_t look_once(struct clocked *g, struct clocked_router *o, int32_t now,
                                  const bool whole, const bool wide)
{
    int32_t next, again;
    const int n = due_find(g, o, now, &next, whole, wide);
    if (n == 0) return next;
    if (n > 1) {
        again = clocked_meet(g, o, n, now);
    } else {
        struct clocked_lane *v = g->active[0];
        again = CLOCKED_NEVER;
        if (v->head.state != LANE_ASKING ||
            !clocked_hop(g, o, (int)(v - o->lane), next, now, &again))
            again = clocked_alone(g, v, now);
        else if (again == CLOCKED_NEVER) return next;
    }
    return clocked_sooner(again, next);
}

/* If router r is due. Who is asked for in this very cycle comes after all others, whatever bits of
 * it are still there (`second`). */
CLOCKED_INLINED void look(struct clocked *g, int r, int32_t now, bool second, const bool whole,
                          const bool wide)
{
    struct clocked_router *o = &g->router[r];
    if (o->wake != now) return; /* an earlier look did it */
    if (!second && g->again[o->slot - g->slot] >> o->bit & 1) return;
    o->wake = CLOCKED_NEVER;
    const int32_t again =
        o->retry > now ? clocked_look_slowly(g, o, now) : look_once(g, o, now, whole, wide);
    clocked_wake_if(g, o, again, again != CLOCKED_NEVER);
}

/* All nodes that are due, by number; those that wake meanwhile, too. */
static inline void look_sources(struct clocked *g, uint64_t *source, int32_t now)
{
    g->sources = false;
    for (int i; (i = clocked_take(source, g->words - g->router_words)) >= 0;)
        clocked_source_look(g, i, now);
}

/* Seldom: kept out of the loop of the cycle. */
static __attribute__((noinline)) void clocked_look_again(struct clocked *g, int r, int32_t now)
{
    look(g, r, now, true, g->whole, true);
}

/* The sets of a slot are emptied on the way. A router that wakes a node of this cycle is followed
 * by it at once, and one that is woken in it comes after all others. */
CLOCKED_INLINED void cycle(struct clocked *g, uint64_t *router, const bool whole, const bool wide)
{
    const int32_t now = g->now;
    uint64_t *source = router + g->router_words;
    look_sources(g, source, now);
    for (int w = 0; w < g->router_words; w++) {
        uint64_t word = router[w];
        router[w] = 0;
        for (; word; word &= word - 1) {
            look(g, w * CLOCKED_WORD + __builtin_ctzll(word), now, false, whole, wide);
            if (g->sources) look_sources(g, source, now);
        }
    }
    for (int i; (i = clocked_take(g->again, g->router_words)) >= 0;) {
        clocked_look_again(g, i, now);
        if (g->sources) look_sources(g, source, now);
    }
}

/* In the order of net_router_gather.c. */
void clocked_cycle(struct clocked *g, uint64_t *slot)
{
    const bool wide = g->queues || g->sets > 1;
    if (g->whole && wide) cycle(g, slot, true, true);
    else if (g->whole) cycle(g, slot, true, false);
    else if (wide) cycle(g, slot, false, true);
    else cycle(g, slot, false, false);
}
