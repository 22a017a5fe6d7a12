/* net_clocked_lane.h - what is done with the lanes of net_clocked.h at every step: numbers, room,
 * turns (net_router_lane.h, in cycles). */
#ifndef NET_NET_CLOCKED_LANE_H
#define NET_NET_CLOCKED_LANE_H

#include "net/net_clocked_set.h"

/* clocked_leg_return: l into its pool, the last in being the first out: it is still in the cache.
 */
static inline void clocked_leg_return(struct clocked *g, struct clocked_leg *l)
{
    l->behind = g->free_leg;
    g->free_leg = l;
}

/* clocked_worm_return: the same of a packet that has left the network. */
static inline void clocked_worm_return(struct clocked *g, struct clocked_worm *w)
{
    w->next = g->free_worm;
    g->free_worm = w;
}

/* clocked_channel_of: which channel of port p lane v is. */
static inline int clocked_channel_of(const struct clocked_port *p, const struct clocked_lane *v)
{
    return (int)(v - p->lane);
}

/* clocked_ways: the set of outputs that v's front may go over. */
static inline uint64_t clocked_ways(const struct clocked_lane *v)
{
    const uint64_t way = UINT64_C(1) << v->way->out;
    return v->head.noption > 1 ? way | UINT64_C(1) << v->other : way;
}

/* clocked_ring: what v remembers of flits, or of packets that have left; clocked_place: where
 * number n of it is; clocked_stay: both.
 *
 * A ring is a column of cache lines, those of all lanes side by side: as a lane that is clear
 * counts anew, mostly only the first line is used, and these lie one after the other, however large
 * the buffers are. */
static inline union clocked_stay *clocked_ring(const struct clocked *g,
                                               const struct clocked_lane *v)
{
    return g->stay + (v - g->lane) * CLOCKED_ROW;
}
static inline ptrdiff_t clocked_place(const struct clocked *g, int32_t n)
{
    const uint32_t k = (uint32_t)n & (uint32_t)g->ring;
    return (ptrdiff_t)(k / CLOCKED_ROW) * g->stay_row + k % CLOCKED_ROW;
}
static inline union clocked_stay *clocked_stay(const struct clocked *g,
                                               const struct clocked_lane *v, int32_t n)
{
    return clocked_ring(g, v) + clocked_place(g, n);
}

/* clocked_gone: when flit number `last` of v left: level packet. It is one of the packets that left
 * last; those behind it have `longest` flits at most. */
static inline int32_t clocked_gone(const struct clocked *g, const struct clocked_lane *v,
                                   int32_t last)
{
    const union clocked_stay *ring = clocked_ring(g, v);
    int32_t k = v->nleft - 1;
    if (v->out - last > 4 * g->longest) k -= (v->out - 1 - last) / g->longest;
    while (ring[clocked_place(g, k)].position > last) k--;
    const union clocked_stay *s = &ring[clocked_place(g, k)];
    return s->at + (last - s->position) * g->flit;
}

/* clocked_room: from which cycle on (>= now) `flits` flits may enter v, a lane of p, one after the
 * other; CLOCKED_NEVER: that is not known, and v remembers that somebody waits (router_room).
 *
 * Mostly v is empty and all its credits are back. Else the last flit needs the place of the one a
 * buffer's size before it: when that left, and a credit later, its place is free, and the flits
 * before it may have crossed by then. */
CLOCKED_INLINED int32_t clocked_room(const struct clocked *g, struct clocked_lane *v,
                                     const struct clocked_port *p, int32_t flits, int32_t now,
                                     const bool whole)
{
    const int32_t late = g->credit + p->wire;
    if (v->in == v->out && v->left + late <= now) return now;
    const int32_t last = v->in + flits - 1 - g->buffer;
    if (last >= v->out) {
        v->starved = true;
        return CLOCKED_NEVER;
    }
    if (last < 0) return now;
    const int32_t go = whole ? clocked_gone(g, v, last) : clocked_stay(g, v, last)->go;
    return clocked_later(now, go + late - (flits - 1) * g->flit);
}

/* clocked_restart: v is clear, and counts anew: it stays in the first places of its ring. */
static inline void clocked_restart(struct clocked_lane *v) { v->in = v->out = v->nleft = 0; }

/* clocked_enter: l at the end of v's FIFO. */
static inline void clocked_enter(struct clocked_lane *v, struct clocked_leg *l)
{
    *(v->front ? &v->back->behind : &v->front) = l;
    v->back = l;
}

/* clocked_after: the place of number n after `turn`, round. Numbers are below 256, so that those
 * that wrap come after all others in eight bits, too. */
static inline uint8_t clocked_after(int n, int turn) { return (uint8_t)(n - turn); }

/* clocked_next_channel: the channel after `channel`, round. */
static inline uint8_t clocked_next_channel(const struct clocked *g, int channel)
{
    return (uint8_t)((uint32_t)channel + 1 < g->nchannel ? channel + 1 : 0);
}

/* clocked_crosses: a flit comes from `in` over `out`: the turns of both sides of the switch move
 * on. */
static inline void clocked_crosses(struct clocked_port *in, struct clocked_port *out)
{
    out->grant = (uint8_t)(in->in + 1);
    in->accept = (uint8_t)(out->out + 1);
}

/* clocked_given: FIFO v, number `input` of its router, gets channel `out`, number `output` of those
 * that leave it: the turns of both move on. */
static inline void clocked_given(struct clocked_lane *v, int input, struct clocked_lane *out,
                                 int output)
{
    out->grant = (uint8_t)(input + 1);
    v->accept = (uint8_t)(output + 1);
}

#endif
