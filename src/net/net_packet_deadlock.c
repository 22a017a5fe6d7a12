/* net_packet_deadlock.c - who waits for whom when nothing moves.
 *
 * At a standstill every waiting packet wants a resource whose FIFO is full of packets that wait
 * themselves, so following the front packet of the full FIFO must come round to a resource seen
 * before. */
#include <stdio.h>

#include "net/net_packet.h"

static int resource_name(const struct net *n, int r, char *text, int size)
{
    int from, to, port;
    if (net_is_injection(n, r)) return snprintf(text, (size_t)size, "injection port of node %d", r);
    if (net_is_ejection(n, r))
        return snprintf(text, (size_t)size, "ejection port of node %d", r - n->nnode - n->nlink);
    topology_link_ends(n->topology, r - n->nnode, &from, &to, &port);
    return snprintf(text, (size_t)size, "link %d (router %d to %d)", r - n->nnode, from, to);
}

/* The first resource is named again at the end, so that the cycle is seen to close. */
bool packet_name_cycle(const struct net *n, const int *way, int count, char *text, int size)
{
    int at = snprintf(text, (size_t)size, "network deadlock: ");
    for (int i = 0; i <= count && at < size; i++) {
        if (i > 0) at += snprintf(text + at, (size_t)(size - at), " waits for ");
        if (at < size) at += resource_name(n, way[i % count], text + at, size - at);
    }
    return true;
}

/* the full FIFO that keeps packet p from its next resource; NULL when nothing does */
static const struct fifo *blocked_by(const struct fabric *f, const struct packet *p)
{
    const struct pass *s = &p->flight->pass[p->hop + 1];
    const struct resource *o = &f->resource[s->resource];
    if (s->hop == p->flight->nhop || !o->fifo) return NULL;
    return o->fifo[s->channel].front ? &o->fifo[s->channel] : NULL;
}

bool packet_deadlock(const struct net *n, char *text, int size)
{
    const struct fabric *f = n->state;
    const struct packet *p = NULL;
    /* Any packet that waits leads to the cycle. */
    for (int r = 0; r < n->nresource && !p; r++) p = f->resource[r].request;
    if (!p) return false;
    struct arena_mark mark = arena_mark(n->arena);
    int *way = TAKE(n->arena, n->nresource, int), *seen = TAKE(n->arena, n->nresource, int),
        count = 0;
    while (p) {
        int r = p->flight->pass[p->hop + 1].resource;
        /* seen[r] is the place of r in way, counted from 1. */
        if (seen[r]) {
            packet_name_cycle(n, way + seen[r] - 1, count - seen[r] + 1, text, size);
            break;
        }
        way[count++] = r;
        seen[r] = count;
        const struct fifo *q = blocked_by(f, p);
        p = q ? q->front : NULL;
    }
    arena_release(n->arena, mark);
    return p != NULL;
}
